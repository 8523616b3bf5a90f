//! Numbers and quaternions of all stages of an element at once.

use std::array::from_fn;

use nalgebra::Quaternion;

use super::gauss::MAX_DEGREE;

/// A number for every stage, and zeros; two at a time are worked on.
pub type Lane<const L: usize> = [f64; L];
/// The same of the components of a quaternion `w, i, j, k`.
pub type Quaternions<const L: usize> = [Lane<L>; 4];

/// Quaternions, one a stage.
#[inline(always)]
#[must_use]
pub fn lanes<const L: usize>(q: &[Quaternion<f64>; MAX_DEGREE]) -> Quaternions<L> {
    [from_fn(|l| q[l].w), from_fn(|l| q[l].i), from_fn(|l| q[l].j), from_fn(|l| q[l].k)]
}

/// The quaternion of a stage.
#[inline(always)]
#[must_use]
pub fn at<const L: usize>(q: &Quaternions<L>, stage: usize) -> Quaternion<f64> {
    Quaternion::new(q[0][stage], q[1][stage], q[2][stage], q[3][stage])
}

/// Sets the quaternion of a stage.
#[inline(always)]
pub fn set<const L: usize>(q: &mut Quaternions<L>, stage: usize, value: &Quaternion<f64>) {
    (q[0][stage], q[1][stage], q[2][stage], q[3][stage]) = (value.w, value.i, value.j, value.k);
}

/// The same quaternion for every stage.
#[inline(always)]
#[must_use]
pub fn all<const L: usize>(q: &Quaternion<f64>) -> Quaternions<L> {
    [[q.w; L], [q.i; L], [q.j; L], [q.k; L]]
}

/// `x += factor y`.
#[inline(always)]
pub fn add<const L: usize>(x: &mut Lane<L>, factor: f64, y: &Lane<L>) {
    for l in 0..L {
        x[l] += factor * y[l];
    }
}

/// The weighted sum of rows.
#[inline(always)]
#[must_use]
pub fn weighted<const L: usize, const S: usize>(weights: &Lane<L>, rows: &[Lane<L>; S]) -> Lane<L> {
    let mut sum = [0.0; L];
    for k in 0..S {
        add(&mut sum, weights[k], &rows[k]);
    }
    sum
}

/// `p q` for every stage.
#[inline(always)]
#[must_use]
pub fn times<const L: usize>(p: &Quaternions<L>, q: &Quaternions<L>) -> Quaternions<L> {
    let mut product = [[0.0; L]; 4];
    for l in 0..L {
        product[0][l] = p[0][l] * q[0][l] - p[1][l] * q[1][l] - p[2][l] * q[2][l] - p[3][l] * q[3][l];
    }
    for l in 0..L {
        product[1][l] = p[0][l] * q[1][l] + p[1][l] * q[0][l] + p[2][l] * q[3][l] - p[3][l] * q[2][l];
    }
    for l in 0..L {
        product[2][l] = p[0][l] * q[2][l] - p[1][l] * q[3][l] + p[2][l] * q[0][l] + p[3][l] * q[1][l];
    }
    for l in 0..L {
        product[3][l] = p[0][l] * q[3][l] + p[1][l] * q[2][l] - p[2][l] * q[1][l] + p[3][l] * q[0][l];
    }
    product
}

/// `q (0, e_c)`: a permutation.
#[inline(always)]
#[must_use]
pub fn times_unit<const L: usize>(q: &Quaternions<L>, c: usize) -> Quaternions<L> {
    let [w, i, j, k] = q;
    let minus = |x: &Lane<L>| x.map(|x| -x);
    match c {
        0 => [minus(i), *w, *k, minus(j)],
        1 => [minus(j), minus(k), *w, *i],
        _ => [minus(k), *j, minus(i), *w],
    }
}
