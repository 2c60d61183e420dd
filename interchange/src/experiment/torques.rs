//! Typical motor torques along a run: inertia, gravity and friction.

use super::{
    course::{Course, Stop},
    guide::Guide,
};
use crate::model::{Inertia, Model};
use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};
use std::collections::BTreeMap;

/// Typical torque of each actuated joint (N m, N) for a fundamental frequency in Hz.
///
/// This is the root mean square of inertia and gravity along the run, plus the Coulomb friction.
/// Centrifugal and Coriolis forces are neglected. `None` if the mass matrix is singular somewhere.
pub(super) fn sizes(guide: &Guide<'_, '_>, course: &Course, fundamental: f64) -> Option<Vec<f64>> {
    let model = guide.network.model;
    if guide.actuators.is_empty() {
        return Some(Vec::new());
    }
    let mut sums = vec![0.0; guide.actuators.len()];
    for stop in &course.stops {
        let (mass, weight) = reduced(guide, stop);
        if !is_positive_definite(&mass) {
            return None;
        }
        let forces = mass * &stop.accelerations * fundamental.powi(2) - weight;
        // Distribute the forces over redundant actuators by least-norm torques.
        let torques = stop.actuators.transpose().pseudo_inverse(1e-12).ok()? * forces;
        for (sum, torque) in sums.iter_mut().zip(torques.iter()) {
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
    // A lower bound, since noise is proportional to the result.
    let noisy = sizes.iter().map(|size| size.max(1e-3 * largest).max(1e-6));
    Some(noisy.collect())
}

/// Largest ratio by which the reduced mass matrix grows along a run.
///
/// Each configuration has a largest generalised eigenvalue of M relative to M of the first one. The
/// result is the largest of these values divided by the smallest, or 1 if M is singular. Large
/// ratios are avoided, because the controller is designed for a nearly constant inertia.
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
        let relative = &inverse * mass * inverse.transpose();
        relative.symmetric_eigenvalues().amax()
    });
    let (smallest, largest) = sizes.fold((f64::INFINITY, 0.0_f64), |(low, high), size| {
        (low.min(size), high.max(size))
    });
    largest / smallest.max(f64::MIN_POSITIVE)
}

/// Reduced mass matrix and gravity forces of the independent coordinates.
fn reduced(guide: &Guide<'_, '_>, stop: &Stop) -> (DMatrix<f64>, DVector<f64>) {
    let model = guide.network.model;
    let gravity = Vector3::from(model.gravity);
    let twists = guide.motion.twists(&stop.state);
    let count = guide.motion.coordinates.len();
    let (mut mass, mut weight) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for (at, (inertia, wrench)) in rigid_groups(model, stop, &gravity) {
        mass += twists[at].transpose() * inertia * &*twists[at];
        weight += twists[at].transpose() * wrench;
    }
    for (at, coordinate) in guide.motion.coordinates.iter().enumerate() {
        mass[(at, at)] += model.joints[coordinate.joint].armature;
    }
    let tree = &stop.tree;
    (tree.transpose() * mass * tree, tree.transpose() * weight)
}

/// Spatial inertia and weight, about the world origin, of bodies that are fixed together.
///
/// The key is the first body of each group, which a joint moves, or the ground.
fn rigid_groups(
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
        let Some(inertia) = body
            .inertia
            .map(|own| own.transformed(&stop.state.poses[at]))
        else {
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

/// Whether a mass matrix, scaled to a unit diagonal, is positive definite.
fn is_positive_definite(mass: &DMatrix<f64>) -> bool {
    let scale: Vec<f64> = mass.diagonal().iter().map(|v| v.sqrt()).collect();
    let scaled = DMatrix::from_fn(mass.nrows(), mass.ncols(), |i, j| {
        mass[(i, j)] / (scale[i] * scale[j])
    });
    scaled.iter().all(|v| v.is_finite()) && scaled.symmetric_eigenvalues().min() > 1e-9
}

/// Spatial inertia (6 × 6) about the world origin, for twists (velocity, angular velocity).
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
