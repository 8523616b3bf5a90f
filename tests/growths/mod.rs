//! Growths that several tests use.

use ribbonrs::growth::Growth;

/// Growth with every field, even and odd, sizes as the theory scales them.
pub fn every_field(eta: f64) -> Growth {
    let e2 = eta * eta;
    Growth {
        gamma33: [0.3, -1.0, 12.0, 5.0, -20.0].map(|c| c * e2).to_vec().into(),
        d33: [0.8, 1.5, -2.0].map(|c| c * eta).to_vec().into(),
        d22: [-0.4, 0.7].map(|c| c * eta).to_vec().into(),
        d23: [0.6, -1.0, 3.0].map(|c| c * eta).to_vec().into(),
        g21: [0.1, 0.5, -0.8, 2.0].map(|c| c * eta).to_vec().into(),
        g31: [0.0, 0.3, 1.1].map(|c| c * eta).to_vec().into(),
        gamma22: vec![e2].into(),
        gamma23: vec![0.0, e2].into(),
    }
}
