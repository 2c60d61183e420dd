//! Platforms with parasitic motion: free bodies whose legs block directions that change with the
//! pose, as in a 3-RPS.
//!
//! At a pose the legs block directions A t = 0 and allow L twists t. If the allowed twists are the
//! same at nearby poses, a platform motion with these coordinates describes the robot. If they
//! change with the pose, L of the six coordinates of t determine the others: t = D v, with D
//! dependent on the pose. The condition number of D is that of the L rows of the chosen
//! coordinates.

use super::home::Home;
use super::mobility::{Mobility, end_velocities, stacked};
use super::numeric::{platform_frame, target};
use super::singular_values::SingularValues;
use super::{Mechanism, Motion};
use nalgebra::{DMatrix, DVector, Quaternion, UnitQuaternion, Vector3};

/// Allowed directions of a platform with parasitic motion, indexed three along and three about the
/// axes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parasitic {
    /// The L directions that determine the others, best conditioned at home.
    pub(super) independent: Vec<usize>,
    /// Dependent directions, at home or near it.
    pub(super) following: Vec<usize>,
    /// Condition number of the rows of the independent directions at home.
    pub(super) condition: f64,
}

/// Distance of the nearby poses from home, rad and in units of the robot's length.
const DISPLACEMENT: f64 = 0.1;
/// Smallest singular value at which directions at home and near it differ, and smallest component
/// that counts. Directions rotate by a fraction of [`DISPLACEMENT`].
const TURNED: f64 = 1e-4;
/// Largest gap of a leg that counts as closed, m and rad.
const CLOSED: f64 = 1e-10;
/// Steps of Newton's iteration on all closures.
const STEPS: usize = 30;
/// Singular value of all closures, relative to the largest, up to which it counts as zero.
const ROUNDING: f64 = 1e-9;

impl Parasitic {
    /// Allowed directions of a free platform at home, where all legs close.
    ///
    /// `None` if they do not change near home, if their number does, or if the motion is not free.
    pub(super) fn at_home(mechanism: &Mechanism) -> Option<Self> {
        let motion = mechanism.platform.as_ref()?.motion;
        if motion.of_pose() != Motion::Spatial {
            return None;
        }
        let own = Mobility::at_home(mechanism)?.allowed;
        let count = own.ncols();
        let mut all = own.transpose();
        for direction in own.column_iter() {
            for side in [-DISPLACEMENT, DISPLACEMENT] {
                let displaced = displaced(mechanism, &(direction * side))?;
                let allowed = Mobility::at_home(&displaced)?.allowed;
                if allowed.ncols() != count {
                    return None;
                }
                all = stacked(&all, &allowed.transpose());
            }
        }
        if SingularValues::new(&all)?.rank(TURNED) == count {
            return None;
        }
        let (independent, condition) = best_rows(&own)?;
        let is_there = |&row: &usize| all.column(row).amax() > TURNED;
        let others = (0..6).filter(|row| !independent.contains(row));
        Some(Self {
            following: others.filter(is_there).collect(),
            independent,
            condition,
        })
    }
}

/// The best conditioned rows, as many as columns; the first of equally good choices.
fn best_rows(matrix: &DMatrix<f64>) -> Option<(Vec<usize>, f64)> {
    let choices = choices(matrix.nrows(), matrix.ncols()).into_iter();
    let rated = choices.filter_map(|rows| {
        let condition = SingularValues::new(&matrix.select_rows(&rows))?.condition();
        condition.is_finite().then_some((rows, condition))
    });
    // Rounding does not decide between equals.
    rated.reduce(|best, other| {
        let better = other.1 < best.1 * (1.0 - 1e-6);
        if better { other } else { best }
    })
}

/// All subsets of `count` numbers below `of`, in order.
fn choices(of: usize, count: usize) -> Vec<Vec<usize>> {
    let all = (0..1_usize << of).filter(|set| set.count_ones() as usize == count);
    let members = |set| (0..of).filter(|at| set >> at & 1 == 1).collect();
    all.map(members).collect()
}

/// The mechanism with its home displaced by a twist and projected onto the closures.
///
/// Lengths are in units of the robot's.
fn displaced(mechanism: &Mechanism, twist: &DVector<f64>) -> Option<Mechanism> {
    let mut start = mechanism.home.clone();
    let mut step = twist.clone();
    step.rows_mut(0, 3).scale_mut(mechanism.length_scale());
    displace(&mut start.pose, &step);
    closed(mechanism, &start)
}

/// The mechanism of a free platform with a home near `start` that closes all legs.
///
/// Newton's iteration on all closures with the least-norm step of pose and joints, until rounding.
/// `None` if it does not converge.
pub(super) fn closed(mechanism: &Mechanism, start: &Home) -> Option<Mechanism> {
    if mechanism.platform.as_ref()?.motion.of_pose() != Motion::Spatial {
        return None;
    }
    let mut found: Option<(f64, Home)> = None;
    let mut pose = start.pose.clone();
    let mut joints = start.joints.clone();
    for _ in 0..STEPS {
        let (jacobian, error) = closures(mechanism, &pose, &joints)?;
        // `max` ignores NaN.
        if error.iter().any(|missed| !missed.is_finite()) {
            return None;
        }
        let missed = error.amax();
        if missed < CLOSED {
            // When steps do not reduce the error any more, the rest is rounding.
            if found
                .as_ref()
                .is_some_and(|(known, _)| missed > 0.5 * known)
            {
                break;
            }
            found = Some((missed, Home::new(mechanism, pose.clone(), joints.clone())));
        }
        let found = SingularValues::new(&jacobian)?;
        let step = found.pseudo_inverse(ROUNDING * found.largest()) * error;
        displace(&mut pose, &step.rows(0, 6).into_owned());
        for (joint, change) in joints.iter_mut().zip(step.iter().skip(6)) {
            *joint += change;
        }
    }
    let (_, home) = found?;
    Some(Mechanism {
        home,
        ..mechanism.clone()
    })
}

impl Mechanism {
    /// Whether the platform is a free body whose legs block directions that change with its pose.
    #[must_use]
    pub fn is_parasitic(&self) -> bool {
        let platform = self.platform.as_ref();
        platform.is_some_and(|own| matches!(own.motion, Motion::Parasitic { .. }))
    }

    /// Independent ones among the coordinates of a pose with dependent coordinates.
    ///
    /// They are counted among x, y, z, rx, ry, rz for a platform with parasitic motion, and among
    /// the joints in the pose for a skeleton with dependent joints.
    #[must_use]
    pub fn independent_coordinates(&self) -> Option<Vec<usize>> {
        if self.has_dependent_joints() {
            return Some(self.independent_places());
        }
        match self.platform.as_ref()?.motion {
            Motion::Parasitic { independent } => {
                Some((0..6).filter(|&at| independent[at]).collect())
            }
            _ => None,
        }
    }

    /// Number of velocities of a pose with dependent coordinates: six of a platform, or the rates
    /// of the joints in the pose.
    #[must_use]
    pub fn velocity_len(&self) -> usize {
        if self.is_parasitic() {
            6
        } else {
            self.pose_len()
        }
    }

    /// D of t = D v for a platform with parasitic motion, 6 × r, at a pose and joints that close
    /// the legs.
    ///
    /// `None` if the number of allowed motions differs from that of the independent coordinates, or
    /// if these do not determine the others.
    #[must_use]
    pub(crate) fn platform_jacobian(&self, pose: &[f64], joints: &[f64]) -> Option<DMatrix<f64>> {
        let own = self
            .independent_coordinates()
            .filter(|_| self.is_parasitic())?;
        let mut left = Mobility::at(self, pose, joints)?.allowed;
        left.rows_mut(0, 3).scale_mut(self.length_scale());
        if own.len() != left.ncols() {
            return None;
        }
        let inverse = left.select_rows(&own).try_inverse()?;
        Some(left * inverse)
    }
}

/// Rates the chosen independent coordinates of a platform with parasitic motion against the best
/// choice.
///
/// Evaluated at home, where all legs close. `None` if the number of allowed motions differs.
pub(super) fn rated(mechanism: &Mechanism) -> Option<Rated> {
    let own = mechanism
        .independent_coordinates()
        .filter(|_| mechanism.is_parasitic())?;
    let left = Mobility::at_home(mechanism)?.allowed;
    if own.len() != left.ncols() {
        return None;
    }
    let condition = SingularValues::new(&left.select_rows(&own))?.condition();
    let (best, least) = best_rows(&left)?;
    Some(Rated {
        condition,
        best,
        least,
    })
}

/// Condition of the chosen independent coordinates and of the best choice.
pub(super) struct Rated {
    /// Condition number of the chosen rows.
    pub(super) condition: f64,
    /// The best choice.
    pub(super) best: Vec<usize>,
    /// Its condition number.
    pub(super) least: f64,
}

/// Closure errors of all legs and their Jacobian with respect to pose and joints: J q̇ - E t.
fn closures(
    mechanism: &Mechanism,
    pose: &[f64],
    joints: &[f64],
) -> Option<(DMatrix<f64>, DVector<f64>)> {
    let motion = mechanism.platform.as_ref()?.motion;
    let frame = platform_frame(motion, pose);
    let width = 6 + joints.len();
    let mut jacobian = DMatrix::zeros(0, width);
    let mut errors: Vec<f64> = Vec::new();
    for (index, leg) in mechanism.legs.iter().enumerate() {
        let end = leg.end.as_ref()?;
        let range = mechanism.leg_range(index);
        let own = &joints[range.clone()];
        errors.extend(leg.closure_error(own, &target(end, &frame)).iter());
        let arms = end_velocities(motion, pose, end, 1.0);
        let rates = leg.closure_jacobian(own);
        let mut rows = DMatrix::zeros(arms.nrows(), width);
        rows.columns_mut(0, 6).copy_from(&-arms);
        rows.columns_mut(6 + range.start, range.len())
            .copy_from(&rates);
        jacobian = stacked(&jacobian, &rows);
    }
    Some((jacobian, DVector::from_vec(errors)))
}

/// Displaces a free platform's pose by a small twist.
fn displace(pose: &mut [f64], twist: &DVector<f64>) {
    for axis in 0..3 {
        pose[axis] += twist[axis];
    }
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(twist[3], twist[4], twist[5]));
    let own = Quaternion::new(pose[3], pose[4], pose[5], pose[6]);
    let turned = turn * UnitQuaternion::new_normalize(own);
    pose[3..].copy_from_slice(&[turned.w, turned.i, turned.j, turned.k]);
}
