//! Platforms that move aside while they move: free bodies whose legs block directions that change with the
//! pose, such as that of a 3-RPS.
//!
//! At a pose the legs block directions A t = 0, and leave L twists t. Where the same L directions are left
//! beside it, one of the platform's motions may be chosen for them. Where they turn with the pose, L of
//! the six coordinates of t determine the others, t = D v, with a D that depends on the pose. D has the
//! condition of the L rows of what is left that belong to the chosen coordinates.

use super::home::Home;
use super::mobility::{Mobility, end_velocities, stacked};
use super::numeric::{platform_frame, target};
use super::singular_values::SingularValues;
use super::{Mechanism, Motion};
use nalgebra::{DMatrix, DVector, Quaternion, UnitQuaternion, Vector3};

/// What is left to a platform with parasitic motion. Directions are three along and three about the axes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parasitic {
    /// The L directions that determine the others, best conditioned at home.
    pub(super) independent: Vec<usize>,
    /// Those that follow from them, at home or beside it.
    pub(super) following: Vec<usize>,
    /// Ratio of the largest and smallest singular value of the rows of the independent ones at home.
    pub(super) condition: f64,
}

/// How far beside home it is looked, rad, and in units of the robot's length.
const BESIDE: f64 = 0.1;
/// Singular value of directions of length one, those at home and those beside it, above which they differ,
/// and the part of a direction above which it is there. Directions turn by some of [`BESIDE`].
const TURNED: f64 = 1e-4;
/// Largest gap of a leg that counts as closed, m and rad.
const CLOSED: f64 = 1e-10;
/// Steps of Newton's iteration on all closures.
const STEPS: usize = 30;
/// Singular value of all closures, relative to the largest, up to which it counts as zero.
const ROUNDING: f64 = 1e-9;

impl Parasitic {
    /// What is left to a free platform at home, where all legs close; `None` if other directions are left to it
    /// nowhere near, if their number differs beside home, and for a motion that is not free.
    pub(super) fn at_home(mechanism: &Mechanism) -> Option<Self> {
        let motion = mechanism.platform.as_ref()?.motion;
        if motion.of_pose() != Motion::Spatial {
            return None;
        }
        let own = Mobility::at_home(mechanism)?.allowed;
        let count = own.ncols();
        let mut all = own.transpose();
        for direction in own.column_iter() {
            for side in [-BESIDE, BESIDE] {
                let beside = beside(mechanism, &(direction * side))?;
                let allowed = Mobility::at_home(&beside)?.allowed;
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

/// The rows, as many as columns, that are best conditioned; the first of those that are equally so.
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

/// All choices of `count` of the numbers below `of`, in order.
fn choices(of: usize, count: usize) -> Vec<Vec<usize>> {
    let all = (0..1_usize << of).filter(|set| set.count_ones() as usize == count);
    let members = |set| (0..of).filter(|at| set >> at & 1 == 1).collect();
    all.map(members).collect()
}

/// The mechanism with its home displaced by a twist, lengths in units of the robot's, and from there brought
/// back onto its closures.
fn beside(mechanism: &Mechanism, twist: &DVector<f64>) -> Option<Mechanism> {
    let mut start = mechanism.home.clone();
    let mut step = twist.clone();
    step.rows_mut(0, 3).scale_mut(mechanism.length_scale());
    displace(&mut start.pose, &step);
    closed(mechanism, &start)
}

/// The mechanism of a free platform with a home near `start` at which all legs close, by Newton's iteration on
/// all closures: pose and joints together, by the smallest step, and on to rounding. `None` if it does not get
/// there.
pub(super) fn closed(mechanism: &Mechanism, start: &Home) -> Option<Mechanism> {
    if mechanism.platform.as_ref()?.motion.of_pose() != Motion::Spatial {
        return None;
    }
    let mut found: Option<(f64, Home)> = None;
    let mut pose = start.pose.clone();
    let mut joints = start.joints.clone();
    for _ in 0..STEPS {
        let (jacobian, error) = closures(mechanism, &pose, &joints)?;
        // The maximum of numbers passes over NaN.
        if error.iter().any(|missed| !missed.is_finite()) {
            return None;
        }
        let missed = error.amax();
        if missed < CLOSED {
            // Where steps get no nearer, what is left is rounding.
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

    /// Of a platform with parasitic motion, which of x, y, z, rx, ry, rz are independent.
    #[must_use]
    pub fn independent_coordinates(&self) -> Option<Vec<usize>> {
        match self.platform.as_ref()?.motion {
            Motion::Parasitic { independent } => {
                Some((0..6).filter(|&at| independent[at]).collect())
            }
            _ => None,
        }
    }

    /// D of t = D v at a pose and joints that close the legs of a platform with parasitic motion, 6 x r; `None`
    /// where the legs leave another number of motions than there are independent coordinates, or these do
    /// not determine the others.
    #[must_use]
    pub(crate) fn platform_jacobian(&self, pose: &[f64], joints: &[f64]) -> Option<DMatrix<f64>> {
        let own = self.independent_coordinates()?;
        let mut left = Mobility::at(self, pose, joints)?.allowed;
        left.rows_mut(0, 3).scale_mut(self.length_scale());
        if own.len() != left.ncols() {
            return None;
        }
        let inverse = left.select_rows(&own).try_inverse()?;
        Some(left * inverse)
    }
}

/// Condition number of some coordinates as independent ones, and the choice that is best: of a platform that
/// moves aside, at home, where all legs close. `None` where the legs leave another number of motions.
pub(super) fn rated(mechanism: &Mechanism) -> Option<Rated> {
    let own = mechanism.independent_coordinates()?;
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

/// How well chosen coordinates determine the others, beside the best choice.
pub(super) struct Rated {
    /// Ratio of the largest and smallest singular value of the chosen rows.
    pub(super) condition: f64,
    /// The best choice.
    pub(super) best: Vec<usize>,
    /// Its condition number.
    pub(super) least: f64,
}

/// What all legs' ends miss, and how platform and joints take it away: J q̇ - E t.
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

/// Moves a free platform's pose by a small twist.
fn displace(pose: &mut [f64], twist: &DVector<f64>) {
    for axis in 0..3 {
        pose[axis] += twist[axis];
    }
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(twist[3], twist[4], twist[5]));
    let own = Quaternion::new(pose[3], pose[4], pose[5], pose[6]);
    let turned = turn * UnitQuaternion::new_normalize(own);
    pose[3..].copy_from_slice(&[turned.w, turned.i, turned.j, turned.k]);
}
