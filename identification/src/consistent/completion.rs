//! Completion of a body from some of its parameters.

use nalgebra::{DMatrix, DVector};

use super::{
    pseudo_inertia::{Inertia, divergence},
    solve::solve,
    unknowns::{UnknownGroup, UnknownKind, Unknowns},
};

/// Relative tolerance of given parameters; beyond it no body has them.
const MET: f64 = 1e-3;

/// Standard deviation of given parameters, relative to the scale of their kind.
///
/// It is small enough to meet them and large enough for floating point.
const DEVIATION: f64 = 1e-7;

/// Completes a body from some given parameters.
///
/// - A missing mass is that of the best-fitting uniform body.
/// - Missing first moments are zero.
/// - If no second moments are given, they are those of the uniform body of that mass about its
///   centre.
/// - If some are given, the result is the body nearest to that uniform one.
///
/// If no body has the given parameters, the result is no body, either.
pub(super) fn completed(given: &[Option<f64>; 10], uniform: &Inertia) -> Inertia {
    let mass = given[9].unwrap_or_else(|| fitting_mass(given, uniform));
    let mut own = Inertia::from(given.map(Option::unwrap_or_default));
    own[9] = mass;
    let scaled = uniform * (mass / uniform[9]);
    let (from, to) = (steiner(&scaled), steiner(&own));
    let centred = Inertia::from_fn(|k, _| match k {
        0..6 => scaled[k] - from[k] + to[k],
        _ => own[k],
    });
    if given[..6].iter().all(Option::is_none) {
        return centred;
    }
    nearest(&centred, given).unwrap_or(own)
}

/// Mass of the uniform body with second moments nearest to the given ones.
fn fitting_mass(given: &[Option<f64>; 10], uniform: &Inertia) -> f64 {
    let pairs = given[..6].iter().zip(uniform.iter());
    let (mut product, mut square) = (0.0, 0.0);
    for (given, own) in pairs {
        product += given.unwrap_or_default() * own;
        square += own * own * f64::from(u8::from(given.is_some()));
    }
    if square > 0.0 && product > 0.0 {
        uniform[9] * product / square
    } else {
        uniform[9]
    }
}

/// Second moments of the whole mass at a body's centre.
fn steiner(body: &Inertia) -> [f64; 6] {
    let [x, y, z] = [6, 7, 8].map(|k| body[k] / body[9]);
    let square = [
        y * y + z * z,
        -x * y,
        -x * z,
        x * x + z * z,
        -y * z,
        x * x + y * y,
    ];
    square.map(|value| body[9] * value)
}

/// The body nearest to a prior that has the given parameters and its mass.
fn nearest(prior: &Inertia, given: &[Option<f64>; 10]) -> Option<Inertia> {
    let unknowns = Unknowns {
        groups: vec![UnknownGroup {
            first: 0,
            kind: UnknownKind::Body { prior: *prior },
            bounds: Vec::new(),
        }],
        of_column: (0..10).collect(),
        names: vec![String::new(); 10],
    };
    let second = given[..6].iter().flatten().map(|value| value.abs());
    let second = second.fold(prior[0] + prior[3] + prior[5], f64::max);
    let scale = |k: usize| match k {
        0..6 => second,
        6..9 => (second * prior[9]).sqrt(),
        _ => prior[9],
    };
    let fixed: Vec<(usize, f64)> = (0..10)
        .filter_map(|k| Some((k, given[k].or((k == 9).then_some(prior[9]))?)))
        .collect();
    let mut rows = DMatrix::zeros(fixed.len(), 10);
    let mut wanted = DVector::zeros(fixed.len());
    for (row, &(k, value)) in fixed.iter().enumerate() {
        let weight = 1.0 / (DEVIATION * scale(k));
        rows[(row, k)] = weight;
        wanted[row] = weight * value;
    }
    let found = solve(&unknowns, &rows, &wanted)?.values;
    let mut own = Inertia::from_iterator(found.iter().copied());
    for (k, value) in fixed {
        if (own[k] - value).abs() > MET * scale(k) {
            return None;
        }
        own[k] = value;
    }
    divergence(&own, &own).map(|_| own)
}

#[cfg(test)]
mod tests {
    use super::{Inertia, completed, divergence};

    /// A ball of 1 kg at the origin.
    fn ball() -> Inertia {
        Inertia::from([0.01, 0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0, 0.0, 1.0])
    }

    #[test]
    fn mass_and_centre_are_completed_by_uniform_body_moments() {
        // A ball of 1 kg and moments 0.01 becomes 4 kg with centre (0.5, 0, 0).
        let mut given = [None; 10];
        (given[6], given[9]) = (Some(2.0), Some(4.0));
        let expected = Inertia::from([0.04, 0.0, 0.0, 1.04, 0.0, 1.04, 2.0, 0.0, 0.0, 4.0]);
        assert!((completed(&given, &ball()) - expected).norm() < 1e-15);
        // The reverse: a body that is not uniform about its own origin.
        let mut back = [None; 10];
        back[9] = Some(1.0);
        assert!((completed(&back, &expected) - ball()).norm() < 1e-15);
    }

    #[test]
    fn a_planar_moment_is_kept_and_the_others_are_completed() {
        let mut given = [None; 10];
        (given[5], given[6], given[9]) = (Some(0.3), Some(0.5), Some(2.0));
        let own = completed(&given, &ball());
        assert_eq!((own[5], own[6], own[9]), (0.3, 0.5, 2.0));
        assert!(divergence(&own, &own).is_some(), "{own}");
        // Less than a point mass at its centre has.
        given[5] = Some(0.1);
        assert!(divergence(&completed(&given, &ball()), &ball()).is_none());
    }

    #[test]
    fn a_single_moment_scales_the_uniform_body() {
        let mut given = [None; 10];
        given[5] = Some(0.03);
        assert!((completed(&given, &ball()) - ball() * 3.0).norm() < 1e-6);
    }
}
