//! The home configuration: refines rough joint positions until every leg closes.

use super::cable::{CableProblem, wrap};
use super::singular_values::SingularValues;
use super::{Leg, Mechanism};
use crate::cas::{Arena, Expr, InputElement};
use nalgebra::DMatrix;

/// The home configuration.
#[derive(Debug, Clone, Default)]
pub struct Home {
    /// Pose of the platform; joint positions of a tree.
    pub pose: Vec<f64>,
    /// Positions of all independent joints.
    pub joints: Vec<f64>,
    /// Positions of the actuators.
    pub actuators: Vec<f64>,
    /// Sign inputs of the square roots in the first leg's closed form, in order.
    ///
    /// A root has one if the leg's code is shared with legs of other working modes. The leg's own
    /// signs are those of home.
    pub signs: Vec<Option<InputElement>>,
}

impl Home {
    /// The home configuration of a mechanism.
    #[must_use]
    pub fn new(mechanism: &Mechanism, pose: Vec<f64>, joints: Vec<f64>) -> Self {
        Self {
            actuators: mechanism.actuator_positions(&joints),
            pose,
            joints,
            signs: Vec::new(),
        }
    }

    /// The value of an element of an input array; rates have none.
    #[must_use]
    pub fn input(&self, element: InputElement) -> Option<f64> {
        let values = match element.array {
            "pose" => &self.pose,
            "joints" => &self.joints,
            "actuators" => &self.actuators,
            _ => return self.signs.contains(&Some(element)).then_some(1.0),
        };
        values.get(element.index).copied()
    }

    /// The value of an expression at home, with all rates set to small numbers.
    #[must_use]
    pub fn value<'a>(&self, arena: &'a Arena, expr: Expr<'a>) -> f64 {
        let known = |symbol| self.input(arena.input_element(symbol)?);
        let known = |symbol| known(symbol).or_else(|| arena.constant_of(symbol));
        expr.evaluate(&|symbol| known(symbol).unwrap_or(0.1))
    }
}

/// The reason why a leg has no home configuration.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum HomeError {
    /// Newton's iteration ends with this distance between leg end and platform (m, rad).
    Open {
        /// Index of the leg.
        leg: usize,
        /// Remaining distance.
        gap: f64,
    },
    /// A cable does not reach its platform point.
    Cable {
        /// Index of the leg.
        leg: usize,
        /// The reason.
        problem: CableProblem,
    },
    /// The platform's motion does not determine the leg's joint rates.
    Singular {
        /// Index of the leg.
        leg: usize,
        /// Ratio of the largest and smallest singular value of the leg's Jacobian.
        condition: f64,
    },
}

/// Largest gap that counts as closed, m and rad.
const CLOSED: f64 = 1e-10;
/// Gap of a leg that is closed up to rounding, m.
const FINELY: f64 = 1e-15;
/// Condition number of a leg's Jacobian above which the leg counts as singular.
const SINGULAR: f64 = 1e7;
/// Condition number above which singularity is examined more closely.
const DOUBTFUL: f64 = 1e3;
/// Largest entry of the shared rows of a leg's Jacobian, relative to that of all rows, below which
/// the shared rows count as zero.
const ROUNDING: f64 = 1e-10;
const STEPS: usize = 200;
/// Steps within which the gap has to decrease; otherwise the target is out of the leg's reach.
const PATIENCE: usize = 20;
/// Factor by which the gap has to decrease, at least.
const PROGRESS: f64 = 0.99;

impl Home {
    /// Closes all legs by Newton's iteration, starting from the rough joint positions.
    ///
    /// # Errors
    /// Every leg that does not close, or is singular where it closes.
    pub(crate) fn refine(mechanism: &Mechanism, rough: &Self) -> Result<Self, Vec<HomeError>> {
        if mechanism.is_tree() {
            let joints = || rough.joints.clone();
            return Ok(Self::new(mechanism, joints(), joints()));
        }
        let mut joints = rough.joints.clone();
        let mut errors = Vec::new();
        for (index, leg) in mechanism.legs.iter().enumerate() {
            let Some(target) = mechanism.target(index, &rough.pose, &joints) else {
                continue;
            };
            let range = mechanism.leg_range(index);
            if let Some(cable) = &leg.cable {
                match wrap(leg, cable, &target) {
                    Ok(found) => joints[range].fill(found.length),
                    Err(problem) => errors.push(HomeError::Cable {
                        leg: index,
                        problem,
                    }),
                }
                continue;
            }
            match close(leg, &rough.joints[range.clone()], &target) {
                Ok(q) => joints[range].copy_from_slice(&q),
                Err(Failure::Open(gap)) => errors.push(HomeError::Open { leg: index, gap }),
                Err(Failure::Singular(condition)) => {
                    errors.push(HomeError::Singular {
                        leg: index,
                        condition,
                    });
                }
            }
        }
        if errors.is_empty() {
            Ok(Self::new(mechanism, rough.pose.clone(), joints))
        } else {
            Err(errors)
        }
    }
}

/// Joint positions of all legs that come closest to closing at the given platform pose.
///
/// The pose need not be one that the legs allow.
#[must_use]
pub(super) fn approach(mechanism: &Mechanism, rough: &Home) -> Home {
    let mut near = rough.clone();
    for (index, leg) in mechanism.legs.iter().enumerate() {
        let Some(target) = mechanism.target(index, &rough.pose, &rough.joints) else {
            continue;
        };
        let range = mechanism.leg_range(index);
        let (q, gap) = iterate(leg, &rough.joints[range.clone()], &target, FINELY);
        if gap.is_finite() {
            near.joints[range].copy_from_slice(&q);
        }
    }
    near
}

enum Failure {
    Open(f64),
    Singular(f64),
}

/// Solves a leg's closure equations by damped Gauss-Newton until the largest error is below
/// `closed`.
///
/// Returns the joint positions and that error.
fn iterate(
    leg: &Leg,
    start: &[f64],
    target: &nalgebra::Isometry3<f64>,
    closed: f64,
) -> (Vec<f64>, f64) {
    let mut q = start.to_vec();
    let mut gap = f64::INFINITY;
    let mut damping = 1e-6;
    let (mut best, mut since) = (f64::INFINITY, 0);
    for step in 0..STEPS {
        let error = leg.closure_error(&q, target);
        gap = error.amax();
        // `max` ignores NaN.
        if error.iter().any(|e| !e.is_finite()) {
            return (q, f64::INFINITY);
        }
        if gap < PROGRESS * best {
            (best, since) = (gap, step);
        }
        if gap < closed || step > since + PATIENCE {
            break;
        }
        let jacobian = leg.closure_jacobian(&q);
        let normal = jacobian.tr_mul(&jacobian) + DMatrix::identity(q.len(), q.len()) * damping;
        let Some(step) = normal.lu().solve(&jacobian.tr_mul(&error)) else {
            break;
        };
        // A step of more than half a radian may jump to another working mode.
        let limit = 0.5 / step.amax().max(0.5);
        let trial: Vec<f64> = q
            .iter()
            .zip(step.iter())
            .map(|(q, s)| q + limit * s)
            .collect();
        let better = leg.closure_error(&trial, target).amax();
        damping = if better < gap {
            (damping * 0.1).max(1e-14)
        } else {
            (damping * 10.0).min(1e2)
        };
        if better < gap || damping > 1.0 {
            q = trial;
        }
    }
    (q, gap)
}

/// Joint positions that close a leg, if the leg is regular there.
fn close(leg: &Leg, start: &[f64], target: &nalgebra::Isometry3<f64>) -> Result<Vec<f64>, Failure> {
    let (q, gap) = iterate(leg, start, target, CLOSED);
    if gap.is_nan() || gap >= CLOSED {
        return Err(Failure::Open(gap));
    }
    let mut condition = condition_of_closure(leg, &q);
    // The gap of a stretched leg is quadratic in its bend: it counts as closed while the leg is
    // still bent. Only iteration until the gap stops decreasing shows the singularity.
    if condition > DOUBTFUL {
        let (end, _) = iterate(leg, &q, target, 0.0);
        condition = condition.max(condition_of_closure(leg, &end));
    }
    if q.len() > leg.shared_components().len() || condition.is_nan() || condition >= SINGULAR {
        return Err(Failure::Singular(condition));
    }
    Ok(q)
}

/// Condition number of a leg's closure at given joint positions.
fn condition_of_closure(leg: &Leg, joints: &[f64]) -> f64 {
    let jacobian = leg.closure_jacobian(joints);
    // An end that does not move along its shared axes has a Jacobian of rounding errors, which may
    // be well conditioned.
    if jacobian.amax() < ROUNDING * leg.end_jacobian(joints).amax() {
        f64::INFINITY
    } else {
        condition(&jacobian)
    }
}

/// Joint positions that close a leg regularly, however far from the start.
pub(super) fn close_anywhere(
    leg: &Leg,
    start: &[f64],
    target: &nalgebra::Isometry3<f64>,
) -> Option<Vec<f64>> {
    close(leg, start, target).ok()
}

/// Smallest distance between a leg's end and its target that the iteration reaches (m, rad).
pub(super) fn nearest(leg: &Leg, start: &[f64], target: &nalgebra::Isometry3<f64>) -> f64 {
    let (q, _) = iterate(leg, start, target, CLOSED);
    leg.closure_error(&q, target).norm()
}

/// Condition number of a leg's Jacobian up to which it is far from singular.
pub(super) const REGULAR: f64 = 50.0;

/// Joint positions near `start` that close a leg; `None` if the iteration fails or the condition is
/// too large.
#[must_use]
pub(super) fn close_within(
    leg: &Leg,
    start: &[f64],
    target: &nalgebra::Isometry3<f64>,
    limit: f64,
) -> Option<Vec<f64>> {
    let q = close(leg, start, target).ok()?;
    (condition(&leg.closure_jacobian(&q)) < limit).then_some(q)
}

/// Largest condition number that counts as regular for a leg that is poorly conditioned at home.
#[must_use]
pub(super) fn lenient_limit(leg: &Leg, home: &[f64]) -> f64 {
    (4.0 * condition(&leg.closure_jacobian(home))).max(REGULAR)
}

/// Joint positions that close a leg up to rounding, from positions that close it.
///
/// Columns that are dependent because of the closure are only as dependent as the leg is closed.
#[must_use]
pub(super) fn close_finely(leg: &Leg, q: &[f64], target: &nalgebra::Isometry3<f64>) -> Vec<f64> {
    iterate(leg, q, target, FINELY).0
}

/// Ratio of the largest to the smallest singular value; infinite for entries that are not finite.
pub(super) fn condition(matrix: &DMatrix<f64>) -> f64 {
    SingularValues::new(matrix).map_or(f64::INFINITY, |found| found.condition())
}
