//! Structural defects of legs: joints without effect, joints with equal effect, and too many
//! joints.
//!
//! The motion of a leg's end must determine its joint rates: the columns of its Jacobian are
//! independent. Columns that are dependent at several random configurations are dependent
//! everywhere, because of the leg's structure and not of its home configuration.

use super::singular_values::rank;
use super::{JointKind, Leg};
use crate::cas::Stream;
use nalgebra::DMatrix;

/// A defect of a leg in every configuration. Joints are indices of the leg.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Defect {
    /// Joints on a branch that does not lead to the leg's end.
    Branch(Vec<usize>),
    /// Joints that never move the components that the leg's end shares with the platform.
    Idle(Vec<usize>),
    /// Two joints with the same effect.
    Twins(usize, usize),
    /// Too few joints to follow the platform.
    Stiff {
        /// Rank of the end velocities that the joints give, in the shared components.
        motions: usize,
        /// Rank of the end velocities that the platform gives.
        needed: usize,
    },
    /// More joints than the end has motions.
    Loose {
        /// Independent joints.
        joints: usize,
        /// Independent motions of the end in the shared components.
        motions: usize,
    },
}

/// Number of random configurations.
const SAMPLES: usize = 4;
/// Length of a column, and of its part outside the span of others, below which it is rounding.
const ROUNDING: f64 = 1e-9;

/// Defects of a leg; empty if it is regular in almost every configuration.
///
/// `velocities` are those of its end per twist coordinate of the platform, in the shared
/// components.
#[must_use]
pub(super) fn defects(leg: &Leg, velocities: &DMatrix<f64>) -> Vec<Defect> {
    let independent: Vec<usize> = leg.independent().collect();
    let samples = samples(leg);
    // Values far out of scale say nothing about the structure.
    if samples.is_empty() || samples.iter().flatten().any(|value| !value.is_finite()) {
        return Vec::new();
    }
    let count = independent.len();
    let idle = |c: usize| samples.iter().all(|j| j.column(c).norm() < ROUNDING);
    let (still, moving): (Vec<usize>, Vec<usize>) = (0..count).partition(|&c| idle(c));
    let (branch, still): (Vec<usize>, Vec<usize>) = still
        .into_iter()
        .map(|c| independent[c])
        .partition(|&joint| !leads_to_end(leg, joint));
    let mut defects = Vec::new();
    if !branch.is_empty() {
        defects.push(Defect::Branch(branch));
    }
    if !still.is_empty() {
        defects.push(Defect::Idle(still));
    }
    // If the end shares a single component, all joints look alike, whatever their axes are.
    let tells_axes = samples.iter().all(|j| j.nrows() > 1);
    let mut kept: Vec<usize> = Vec::new();
    for &c in &moving {
        let twin = kept
            .iter()
            .find(|&&k| tells_axes && samples.iter().all(|j| are_parallel(j, k, c)));
        match twin {
            Some(&twin) => defects.push(Defect::Twins(independent[twin], independent[c])),
            None => kept.push(c),
        }
    }
    let motions = samples.iter().map(|j| rank(j, ROUNDING)).max().unwrap_or(0);
    if kept.len() > motions {
        defects.push(Defect::Loose {
            joints: kept.len(),
            motions,
        });
    }
    let needed = rank(velocities, ROUNDING * velocities.amax());
    if defects.is_empty() && motions < needed {
        defects.push(Defect::Stiff { motions, needed });
    }
    defects
}

/// The leg's Jacobian at random configurations, with lengths in units of the leg's size.
fn samples(leg: &Leg) -> Vec<DMatrix<f64>> {
    let size = size(leg);
    let mut stream = Stream::new(1);
    let rows = leg.shared_components();
    let sample = |_| {
        let q: Vec<f64> = leg
            .independent()
            .map(|joint| match leg.joints[joint].kind {
                JointKind::Prismatic => size * stream.number(),
                _ => std::f64::consts::PI * stream.number(),
            })
            .collect();
        let mut jacobian = leg.closure_jacobian(&q);
        for (row, _) in rows
            .iter()
            .enumerate()
            .filter(|(_, component)| **component < 3)
        {
            jacobian.row_mut(row).scale_mut(1.0 / size);
        }
        for (mut column, joint) in jacobian.column_iter_mut().zip(leg.independent()) {
            if leg.joints[joint].kind == JointKind::Prismatic {
                column *= size;
            }
        }
        jacobian
    };
    (0..SAMPLES).map(sample).collect()
}

/// Typical length of the leg, m: the sum of all its link lengths.
#[must_use]
pub(super) fn size(leg: &Leg) -> f64 {
    let step = |joint: &super::Joint| {
        let lengths = [joint.b, joint.d, joint.r];
        lengths.iter().map(|l| l.value().abs()).sum::<f64>()
    };
    let sum: f64 = leg.joints.iter().map(step).sum();
    if sum > 0.0 { sum } else { 1.0 }
}

/// Whether a joint, or a joint coupled to it, lies between the base and the leg's end.
fn leads_to_end(leg: &Leg, joint: usize) -> bool {
    let mut at = leg.joints.len().checked_sub(1);
    while let Some(index) = at {
        if leg.joints[index]
            .variable
            .iter()
            .any(|(of, _)| *of == joint)
        {
            return true;
        }
        at = leg.joints[index].antecedent;
    }
    false
}

fn are_parallel(matrix: &DMatrix<f64>, a: usize, b: usize) -> bool {
    let (a, b) = (matrix.column(a), matrix.column(b));
    let along = a.dot(&b) / a.norm_squared();
    (b - a * along).norm() < ROUNDING * b.norm()
}
