//! The shortest wave in which a ribbon could buckle, and meshes that show it.
//!
//! A uniform state is exact on any mesh, the ways in which it buckles are not: the index counts those that the mesh
//! has room for. A change of angles `theta` along the directors (`kappa = theta' + K x theta`) changes the energy by
//!
//! ```text
//! 1/2 int kappa.B kappa + kappa.(theta x M) + (1 + eps) (N_3 |theta|^2 - theta_3 N.theta) - (N_1 theta_2 - N_2 theta_1)^2/EA dS
//! ```
//!
//! With `phi_i = theta_i/sqrt(c_i)`, `c_i` the compliances, and waves `exp(i k S)` much shorter than the radius of
//! curvature, the integrand is the Hermitian form `k^2 + i k [m]x + A` with `m_1 = sqrt(c_2 c_3) M_1` and so on. Its
//! determinant is a cubic in `z = k^2`,
//!
//! ```text
//! det (z + A) - z m.(z + A) m,
//! ```
//!
//! and above the largest root all waves raise the energy. Without moments `z` is Euler's `-N_3/EI`, with tension it
//! vanishes below Greenhill's moment `M_3^2 = 4 EI N_3`.

use nalgebra::{Matrix3, Matrix4, UnitQuaternion, Vector3};

use super::iterate::Iterate;
use super::mesh::Mesh;
use crate::InvalidInput;
use crate::section::Strain;

/// Radians of the shortest wave within an element of degree one, how many more for each further degree, and at most: its phase is
/// told to 1e-2, of degree three and more to 1e-3.
const RADIANS: f64 = 0.5;
const RADIANS_BY_DEGREE: f64 = 0.7;
const MOST_RADIANS: f64 = 3.0;
/// Part of these that the elements span into which a longer one is divided.
const AIM: f64 = 0.75;
/// Radians of a wave along all the ribbon for it to buckle, a little less than the quarter of one of a cantilever.
const LEAST: f64 = 1.5;

/// Compliance, over that of the ungrown section, above which waves crowd, and radians of one along all the ribbon, some ten ways to
/// buckle, beyond which those that crowd need not be told apart.
const CROWDING: f64 = 10.0;
const CROWDED: f64 = 40.0;

/// Into how many parts each element is to be divided for the ways in which it may buckle, or for the first ten where they crowd; `None` if
/// none is.
///
/// # Errors
/// Where a section is refused.
pub fn parts_for_waves(mesh: &Mesh, x: &Iterate, all: bool) -> Result<Option<Vec<usize>>, InvalidInput> {
    let degree = mesh.gauss.degree;
    let most = (RADIANS + RADIANS_BY_DEGREE * (degree - 1) as f64).min(MOST_RADIANS);
    let mut parts = Vec::with_capacity(mesh.elements());
    let mut made = Vec::new();
    for i in 0..mesh.elements() {
        let response = &mesh.responses(i, &mut made)?[0];
        let strain = x.strains[i * degree];
        let compliance = soft(&response.value(&strain).1, &response.compliance);
        let shortest = |node: usize| {
            let at = &x.nodes[node];
            let frame = UnitQuaternion::new_unchecked(at.rotation);
            let own = |v: Vector3<f64>| frame.inverse_transform_vector(&v);
            let (force, moment) = (own(at.force), own(at.moment()));
            let wave = largest_wave_number(&compliance, strain[0], force, moment);
            let firm = compliance.inf(&(CROWDING * response.compliance));
            if all || firm == compliance {
                return wave;
            }
            let before = largest_wave_number(&firm, strain[0], force, moment);
            wave.min(before.max(CROWDED / mesh.problem.length))
        };
        let wave = shortest(i).max(shortest(i + 1));
        let curvature = strain.rows(1, 3).norm();
        let radians =
            if wave * mesh.problem.length > LEAST { (wave + 0.5 * curvature) * mesh.length(i) } else { 0.0 };
        parts.push(if radians > most { (radians / (AIM * most)).ceil() as usize } else { 1 });
    }
    Ok(parts.iter().any(|&count| count > 1).then_some(parts))
}

/// Nodes of a mesh with its elements divided into parts.
#[must_use]
pub fn divided(mesh: &Mesh, parts: &[usize]) -> Vec<f64> {
    let mut nodes = vec![0.0];
    for (i, &parts) in parts.iter().enumerate() {
        let (from, h) = (mesh.nodes[i], mesh.length(i));
        nodes.extend((1..parts).map(|part| from + h * part as f64 / parts as f64));
        nodes.push(mesh.nodes[i + 1]);
    }
    nodes
}

/// Compliances in extension, bending and torsion, of the tangent where it is stable.
fn soft(tangent: &Matrix4<f64>, compliance: &Strain) -> Strain {
    let Some(inverse) = tangent.try_inverse() else { return *compliance };
    Strain::from_fn(|i, _| {
        let own = inverse[(i, i)] * compliance[i];
        if own >= 0.0 && own.is_finite() { own } else { compliance[i] }
    })
}

/// `k` of the shortest wave that does not raise the energy, zero if there is none.
fn largest_wave_number(c: &Strain, eps: f64, force: Vector3<f64>, moment: Vector3<f64>) -> f64 {
    let root = Vector3::new(c[1], c[2], c[3]).map(f64::sqrt);
    let m = Vector3::new(root[1] * root[2], root[0] * root[2], root[0] * root[1]).component_mul(&moment);
    let across = Vector3::new(-force.y, force.x, 0.0).component_mul(&root);
    let (t, n) = ((1.0 + eps) * force.z, 0.5 * (1.0 + eps) * force);
    let bending = Matrix3::new(t, 0.0, -n.x, 0.0, t, -n.y, -n.x, -n.y, 0.0);
    let a = bending.component_mul(&(root * root.transpose())) - c[0] * across * across.transpose();
    let trace = a.trace();
    let minors = 0.5 * (trace * trace - (a * a).trace());
    largest_root(trace - m.norm_squared(), minors - m.dot(&(a * m)), a.determinant()).max(0.0).sqrt()
}

/// Part of the discriminant that is rounding.
const ROUNDING: f64 = 1e-12;

/// The largest real root of `z^3 + b z^2 + c z + d`.
fn largest_root(b: f64, c: f64, d: f64) -> f64 {
    // z = y - b/3 with y^3 + 3 p y + 2 q = 0.
    let (p, q) = (c / 3.0 - b * b / 9.0, (b / 3.0).powi(3) - b * c / 6.0 + 0.5 * d);
    let discriminant = q * q + p.powi(3);
    // Two that are equal but for rounding are real: a rod that is the same in all directions buckles in pairs.
    let y = if discriminant > ROUNDING * q * q {
        // One real root; the cube root that does not cancel first.
        let u = -(q.abs() + discriminant.sqrt()).cbrt() * q.signum();
        if u == 0.0 { 0.0 } else { u - p / u }
    } else {
        let r = (-p).sqrt();
        let angle = if r == 0.0 { 0.0 } else { (-q / r.powi(3)).clamp(-1.0, 1.0).acos() };
        2.0 * r * (angle / 3.0).cos()
    };
    y - b / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_root_is_that_of_a_product() {
        for roots in
            [[3.0, 1.0, -2.0], [5.0, 5.0, 1.0], [-1.0, -1.0, -1.0], [2.0, -7.0, -7.0], [0.0, 0.0, -4.0]]
        {
            let [x, y, z]: [f64; 3] = roots;
            let found = largest_root(-(x + y + z), x * y + y * z + z * x, -x * y * z);
            // A double root moves by the root of what counts as rounding.
            assert!((found - x).abs() < 1e-5, "{roots:?} {found}");
        }
        // A single real one, below and above the real part of the others.
        for (real, part) in [(2.0, -1.0), (-3.0, 1.0)] {
            let found = largest_root(
                -real - 2.0 * part,
                part * part + 4.0 + 2.0 * part * real,
                -real * (part * part + 4.0),
            );
            assert!((found - real).abs() < 1e-14);
        }
    }

    #[test]
    fn waves_are_those_of_euler_greenhill_and_prandtl() {
        let c = Strain::new(0.0, 0.5, 2.0, 0.25);
        let wave = |force, moment| largest_wave_number(&c, 0.0, force, moment);
        let (x, z) = (Vector3::x(), Vector3::z());
        let zero = Vector3::zeros();
        // Euler: k^2 = P/EI of the softer plane.
        assert!((wave(-8.0 * z, zero) - 4.0).abs() < 1e-14);
        // A root of zero that is known to rounding.
        assert!(wave(8.0 * z, zero) < 1e-7);
        // Prandtl: a moment about the stiff director, k = M/sqrt(EI2 GJ).
        assert!((wave(zero, 6.0 * x) - 6.0 * 0.5_f64.sqrt()).abs() < 1e-7);
        // Greenhill: isotropic, pulled by T = 1 and twisted, k = (M + sqrt(M^2 - 4 T))/2 above M = 2, none below.
        let round = Strain::new(0.0, 1.0, 1.0, 1.0);
        let twisted = |moment: f64| largest_wave_number(&round, 0.0, z, moment * z);
        assert!(twisted(1.99) < 1e-7);
        assert!((twisted(3.0) - 0.5 * (3.0 + 5.0_f64.sqrt())).abs() < 1e-14);
    }

    /// The form itself is positive above the root and not just below it.
    #[test]
    fn above_the_shortest_wave_all_raise_the_energy() {
        use nalgebra::{Complex, SMatrix};
        let c = Strain::new(0.02, 0.7, 1.3, 0.4);
        let (eps, force, moment) = (0.1, Vector3::new(0.8, -1.7, 0.9), Vector3::new(1.2, 0.4, -2.0));
        let k = largest_wave_number(&c, eps, force, moment);
        let least = |k: f64| {
            let skew = |v: Vector3<f64>| v.cross_matrix();
            let across = Vector3::new(-force.y, force.x, 0.0);
            let turning = 0.5 * (Vector3::z() * force.transpose() + force * Vector3::z().transpose());
            let a =
                (1.0 + eps) * (force.z * Matrix3::identity() - turning) - c[0] * across * across.transpose();
            let b = Matrix3::from_diagonal(&c.fixed_rows::<3>(1).map(|c| 1.0 / c));
            let form = SMatrix::<Complex<f64>, 3, 3>::from_fn(|i, j| {
                Complex::new(k * k * b[(i, j)] + a[(i, j)], k * skew(moment)[(i, j)])
            });
            form.symmetric_eigenvalues().min()
        };
        assert!(k > 1.0 && least(k).abs() < 1e-12, "{k} {}", least(k));
        assert!(least(1.01 * k) > 0.0 && least(0.99 * k) < 0.0);
    }
}
