//! Typical motor torques along a run: inertia, gravity and friction.

use super::{
    course::{Course, Stop},
    guide::Guide,
};
use crate::model::{Inertia, Model};
use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};
use std::collections::BTreeMap;

/// Root mean square torque of each actuated joint for a fundamental frequency in Hz.
///
/// `None` if the masses and inertias leave an acceleration undetermined.
pub(super) fn sizes(guide: &Guide<'_, '_>, course: &Course, fundamental: f64) -> Option<Vec<f64>> {
    let model = guide.network.model;
    if guide.actuators.is_empty() {
        return Some(Vec::new());
    }
    let mut sums = vec![0.0; guide.actuators.len()];
    for stop in &course.stops {
        let (mass, weight) = reduced(guide, stop);
        if !is_positive(&mass) {
            return None;
        }
        let forces = mass * &stop.accelerations * fundamental.powi(2) - weight;
        // Least-norm torques, as of a controller without internal torques.
        let shared = stop.actuators.transpose().pseudo_inverse(1e-12).ok()? * forces;
        for (sum, torque) in sums.iter_mut().zip(shared.iter()) {
            *sum += torque * torque;
        }
    }
    #[allow(clippy::cast_precision_loss, reason = "some hundred stops")]
    let count = course.stops.len() as f64;
    let driven = guide.actuators.iter().zip(sums);
    let sizes: Vec<f64> = driven
        .map(|(&joint, sum)| (sum / count).sqrt() + model.joints[joint].friction)
        .collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    // A motor without torque still has sensor noise.
    let noisy = sizes.iter().map(|size| size.max(1e-3 * largest).max(1e-6));
    Some(noisy.collect())
}

/// Largest growth of the reduced mass matrix along a run (generalised eigenvalue).
///
/// Controllers are designed for a robot of nearly constant inertia. The result is 1 if the mass
/// matrix is singular.
pub(super) fn growth(guide: &Guide<'_, '_>, course: &Course) -> f64 {
    let masses = course.stops.iter().map(|stop| reduced(guide, stop).0);
    let masses: Vec<DMatrix<f64>> = masses.collect();
    let Some(factor) = masses.first().and_then(|first| first.clone().cholesky()) else {
        return 1.0;
    };
    let Some(inverse) = factor.l().try_inverse() else {
        return 1.0;
    };
    let sizes = masses.iter().map(|mass| {
        let beside = &inverse * mass * inverse.transpose();
        beside.symmetric_eigenvalues().amax()
    });
    let (smallest, largest) = sizes.fold((f64::INFINITY, 0.0_f64), |(low, high), size| {
        (low.min(size), high.max(size))
    });
    largest / smallest.max(f64::MIN_POSITIVE)
}

/// Reduced mass matrix and gravity forces of the coordinates.
fn reduced(guide: &Guide<'_, '_>, stop: &Stop) -> (DMatrix<f64>, DVector<f64>) {
    let model = guide.network.model;
    let gravity = Vector3::from(model.gravity);
    let twists = guide.motion.twists(&stop.state);
    let count = guide.motion.coordinates.len();
    let (mut mass, mut weight) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for (at, (inertia, wrench)) in moved_together(model, stop, &gravity) {
        mass += twists[at].transpose() * inertia * &*twists[at];
        weight += twists[at].transpose() * wrench;
    }
    for (at, coordinate) in guide.motion.coordinates.iter().enumerate() {
        mass[(at, at)] += model.joints[coordinate.joint].armature;
    }
    let tree = &stop.tree;
    (tree.transpose() * mass * tree, tree.transpose() * weight)
}

/// Spatial inertia and weight about the world origin of bodies that are fixed together.
///
/// The key is the body of each group that a joint carries, or the ground.
fn moved_together(
    model: &Model,
    stop: &Stop,
    gravity: &Vector3<f64>,
) -> BTreeMap<usize, (Matrix6<f64>, Vector6<f64>)> {
    let mut carriers: Vec<usize> = Vec::with_capacity(model.bodies.len());
    let mut sums = BTreeMap::new();
    for (at, body) in model.bodies.iter().enumerate() {
        let is_fixed = at > 0 && body.joint.is_none();
        let carrier = if is_fixed { carriers[body.parent] } else { at };
        carriers.push(carrier);
        let Some(inertia) = body.inertia.map(|own| own.seen(&stop.state.poses[at])) else {
            continue;
        };
        let force = gravity * inertia.mass;
        let moment = inertia.centre.coords.cross(&force);
        let (mass, weight) = sums
            .entry(carrier)
            .or_insert((Matrix6::zeros(), Vector6::zeros()));
        *mass += spatial(&inertia);
        *weight += Vector6::from_iterator(force.iter().chain(moment.iter()).copied());
    }
    sums
}

/// Whether a mass matrix is positive definite.
fn is_positive(mass: &DMatrix<f64>) -> bool {
    let scale: Vec<f64> = mass.diagonal().iter().map(|v| v.sqrt()).collect();
    let scaled = DMatrix::from_fn(mass.nrows(), mass.ncols(), |i, j| {
        mass[(i, j)] / (scale[i] * scale[j])
    });
    scaled.iter().all(|v| v.is_finite()) && scaled.symmetric_eigenvalues().min() > 1e-9
}

/// Spatial inertia about the world origin, for (velocity, angular velocity).
fn spatial(inertia: &Inertia) -> Matrix6<f64> {
    let mut all = Matrix6::zeros();
    let cross = inertia.centre.coords.cross_matrix() * inertia.mass;
    all.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(inertia.mass);
    all.fixed_view_mut::<3, 3>(0, 3).copy_from(&-cross);
    all.fixed_view_mut::<3, 3>(3, 0).copy_from(&cross);
    all.fixed_view_mut::<3, 3>(3, 3)
        .copy_from(&inertia.about_origin());
    all
}
