//! Decides whether the file's inertial parameters are physically consistent and usable as a prior.

use nalgebra::{Matrix3, Vector3};

/// Relative size below which a moment counts as zero.
const ROUNDING: f64 = 1e-12;

/// Parameter values by symbol.
pub(super) type Values = [(&'static str, f64)];

/// Second moments.
const SECOND: [&str; 6] = ["xx", "xy", "xz", "yy", "yz", "zz"];

/// Whether a parameter value can be part of the prior.
///
/// Omitted values follow from the mass.
pub(super) fn is_believable(values: &Values, symbol: &str) -> bool {
    match symbol {
        "mx" | "my" | "mz" | "m" => value(values, "m") > 0.0,
        _ if SECOND.contains(&symbol) => is_body(values),
        _ => value(values, symbol) >= 0.0,
    }
}

/// Whether moments are given that no body can have.
///
/// For a planar body, a file may give only the moment about the normal, which must be large enough
/// for its centre of mass.
pub(super) fn is_impossible(values: &Values) -> bool {
    let moments = ["xx", "yy", "zz"].map(|symbol| value(values, symbol));
    let first = ["mx", "my", "mz"].map(|symbol| value(values, symbol));
    let largest = moments
        .iter()
        .fold(0.0, |most: f64, own| most.max(own.abs()));
    let given = (0..3).filter(|axis| moments[*axis].abs() > ROUNDING * largest);
    match given.collect::<Vec<_>>()[..] {
        [] => false,
        [axis] => {
            let others = (0..3).filter(|other| *other != axis);
            let square: f64 = others.map(|other| first[other].powi(2)).sum();
            moments[axis] * value(values, "m") <= square
        }
        _ => !is_body(values),
    }
}

/// Whether the pseudo-inertia of a body is positive definite.
fn is_body(values: &Values) -> bool {
    let [xx, xy, xz, yy, yz, zz] = SECOND.map(|symbol| value(values, symbol));
    let [x, y, z, mass] = ["mx", "my", "mz", "m"].map(|symbol| value(values, symbol));
    let about = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let second = Matrix3::identity() * (0.5 * about.trace()) - about;
    let first = Vector3::new(x, y, z);
    // A zero mass gives infinities here, which must not reach the eigenvalues.
    let central = second - first * first.transpose() / mass;
    let is_finite = central.iter().all(|one| one.is_finite());
    mass > 0.0 && is_finite && central.symmetric_eigenvalues().min() > ROUNDING * second.trace()
}

fn value(values: &Values, symbol: &str) -> f64 {
    let found = values.iter().find(|(own, _)| *own == symbol);
    found.map_or(0.0, |(_, value)| *value)
}
