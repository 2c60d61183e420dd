//! Search for closed positions of a leg that does not close from the given home.

use super::home::{close_anywhere, nearest};
use super::structure::size;
use super::{End, JointKind, Leg};
use crate::cas::Stream;
use nalgebra::Isometry3;

/// Result of the search for a leg that does not close from its rough home.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Reach {
    /// It closes at these joint positions, which may serve as home.
    Elsewhere(Vec<f64>),
    /// Its end reaches the position, but not the orientation of the platform.
    Turned,
    /// Its end stays at least this distance away, m.
    Away(f64),
}

/// Number of starts of the iteration.
const STARTS: usize = 60;

/// Searches joint positions that close the leg, from many starts.
#[must_use]
pub(super) fn look(leg: &Leg, rough: &[f64], target: &Isometry3<f64>) -> Reach {
    let starts = starts(leg, rough, target);
    let far = |q: &[f64]| {
        let one = |(joint, (q, r)): (usize, (&f64, &f64))| match leg.joints[joint].kind {
            JointKind::Prismatic => (q - r).abs() / size(leg),
            _ => wrapped(q - r).abs(),
        };
        leg.independent()
            .zip(q.iter().zip(rough))
            .map(one)
            .sum::<f64>()
    };
    let closed = starts
        .iter()
        .filter_map(|start| close_anywhere(leg, start, target));
    if let Some(found) = closed.min_by(|a, b| far(a).total_cmp(&far(b))) {
        return Reach::Elsewhere(found);
    }
    let place = Leg {
        end: leg.end.as_ref().map(as_point),
        ..leg.clone()
    };
    let distances = starts.iter().map(|start| nearest(&place, start, target));
    let distance = distances.fold(f64::INFINITY, f64::min);
    if distance < 1e-6 * size(leg) && matches!(leg.end, Some(End::Rigid(_))) {
        Reach::Turned
    } else {
        Reach::Away(distance)
    }
}

/// The end with its position only.
fn as_point(end: &End) -> End {
    match end {
        End::Rigid(placement) => End::Point {
            at: placement.at,
            along: [true; 3],
        },
        End::Point { .. } => end.clone(),
    }
}

fn starts(leg: &Leg, rough: &[f64], target: &Isometry3<f64>) -> Vec<Vec<f64>> {
    let mut stream = Stream::new(2);
    let base = super::placement_isometry(&leg.base).translation.vector;
    let far = size(leg) + (target.translation.vector - base).norm();
    let mut starts = vec![rough.to_vec()];
    for _ in 1..STARTS {
        let start = leg.independent().map(|joint| match leg.joints[joint].kind {
            JointKind::Prismatic => far * stream.number(),
            _ => std::f64::consts::PI * stream.number(),
        });
        starts.push(start.collect());
    }
    starts
}

/// The equivalent angle between -π and π.
#[must_use]
pub(super) fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}
