//! Skeletons with dependent joints: the pose has the positions of all joints of the skeleton and of
//! branches, and the chains determine those of the dependent ones.
//!
//! The loops are opened at the ends of the chains. Φ q̇ = 0 closes them again, with the rates q̇ of
//! all joints: the relative velocities of both sides in the components that they share. The null
//! space of Φ are the allowed motions, as many as there are independent joints. Its basis with unit
//! rates of the independent joints gives the rates of all joints per independent one.

use super::home::{Home, REGULAR, condition, lenient_limit};
use super::mobility::stacked;
use super::numeric::best_conditioned;
use super::singular_values::{SingularValues, rank};
use super::{BodyIndex, JointKind, Mechanism};
use nalgebra::{DMatrix, DVector, Vector3};

/// Largest ratio of the condition of chosen independent coordinates to that of the best choice.
pub(super) const WEAK: f64 = 1e3;

/// Largest gap of a chain that counts as closed, m and rad.
const CLOSED: f64 = 1e-10;
/// Steps of Newton's iteration on all closures.
const STEPS: usize = 60;
/// Largest step of a joint, rad or lengths of the robot; longer ones may change the working mode.
const LONGEST_STEP: f64 = 0.5;
/// Singular value of Φ, relative to the largest, up to which it counts as zero.
const ROUNDING: f64 = 1e-9;
/// The same for the number of allowed motions, which is counted at closed configurations.
const COUNTED: f64 = 1e-7;

impl Mechanism {
    /// Whether chains determine joints of the skeleton or of branches.
    #[must_use]
    pub fn has_dependent_joints(&self) -> bool {
        self.legs
            .iter()
            .any(|leg| leg.joints.iter().any(|joint| joint.dependent))
    }

    /// Whether the pose has coordinates that the closures determine: of a platform with parasitic
    /// motion, or of a skeleton with dependent joints.
    #[must_use]
    pub fn has_dependent_coordinates(&self) -> bool {
        self.is_parasitic() || self.has_dependent_joints()
    }

    /// Positions in the pose of the independent joints of a skeleton with dependent joints.
    pub(super) fn independent_places(&self) -> Vec<usize> {
        let joints = self.joints();
        let of_pose = self.coordinate_joints().into_iter().enumerate();
        let own = of_pose.filter(|(_, at)| !self.joint(joints[*at]).dependent);
        own.map(|(place, _)| place).collect()
    }

    /// Rates of all joints per rate of each independent joint of a skeleton with dependent joints.
    ///
    /// At a pose and joint positions that close the chains. `None` if the number of allowed motions
    /// is not that of the independent joints, or if these do not determine the others.
    pub(super) fn rates_of_joints(&self, pose: &[f64], joints: &[f64]) -> Option<DMatrix<f64>> {
        let mut allowed = allowed(self, pose, joints)?;
        let scale = scales(self, self.length_scale());
        for (mut row, scale) in allowed.row_iter_mut().zip(&scale) {
            row *= *scale;
        }
        let own = allowed.select_rows(&independent_rows(self));
        if own.nrows() != own.ncols() {
            return None;
        }
        Some(&allowed * own.try_inverse()?)
    }
}

/// Indices in q_t of the independent joints of a skeleton with dependent joints.
fn independent_rows(mechanism: &Mechanism) -> Vec<usize> {
    let of_pose = mechanism.coordinate_joints();
    let places = mechanism.independent_places().into_iter();
    places.map(|place| of_pose[place]).collect()
}

/// Chains that hold their ends in more directions than they have joints, at home.
pub(super) fn blocking(mechanism: &Mechanism) -> Vec<usize> {
    if !mechanism.has_dependent_joints() {
        return Vec::new();
    }
    let size = mechanism.length_scale();
    let blocks = |index: &usize| {
        let home = &mechanism.home;
        let rows = closure(mechanism, *index, &home.pose, &home.joints, size);
        rows.is_some_and(|rows| rank(&rows, COUNTED) > mechanism.legs[*index].independent().count())
    };
    (0..mechanism.legs.len()).filter(blocks).collect()
}

/// Rates of all joints of the allowed motions, as orthonormal columns; those of slides in units of the
/// robot's length.
fn allowed(mechanism: &Mechanism, pose: &[f64], joints: &[f64]) -> Option<DMatrix<f64>> {
    let size = mechanism.length_scale();
    let scale = scales(mechanism, size);
    let mut closures = closures(mechanism, pose, joints, size)?;
    for (mut column, scale) in closures.column_iter_mut().zip(&scale) {
        column *= *scale;
    }
    Some(SingularValues::new(&closures)?.null_space(COUNTED))
}

/// Units of all joints: rad, or the robot's length.
fn scales(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let joints = mechanism.joints().into_iter();
    let scale = joints.map(|at| match mechanism.joint(at).kind {
        JointKind::Prismatic => size,
        _ => 1.0,
    });
    scale.collect()
}

/// Φ, with lengths of its rows in units of `size`.
fn closures(
    mechanism: &Mechanism,
    pose: &[f64],
    joints: &[f64],
    size: f64,
) -> Option<DMatrix<f64>> {
    let mut all = DMatrix::zeros(0, mechanism.joints().len());
    for index in 0..mechanism.legs.len() {
        if mechanism.legs[index].end.is_some() {
            all = stacked(&all, &closure(mechanism, index, pose, joints, size)?);
        }
    }
    Some(all)
}

/// The rows of Φ of a chain; `None` for other legs.
fn closure(
    mechanism: &Mechanism,
    index: usize,
    pose: &[f64],
    joints: &[f64],
    size: f64,
) -> Option<DMatrix<f64>> {
    let leg = &mechanism.legs[index];
    let target = mechanism.target(index, pose, joints)?;
    let ground = mechanism.ground_of(index, pose, joints);
    let reached = mechanism.frames_of(index, pose, joints);
    let last = BodyIndex {
        leg: index,
        joint: leg.joints.len().checked_sub(1)?,
    };
    let own = reached.last()?.translation.vector;
    let other = (ground * target).translation.vector;
    let mut velocities = on_body(mechanism, Some(last), own, pose, joints)
        - on_body(mechanism, leg.end_body, other, pose, joints);
    let into = ground.rotation.inverse();
    for mut column in velocities.column_iter_mut() {
        for part in [0, 3] {
            let turned = into * Vector3::new(column[part], column[part + 1], column[part + 2]);
            let unit = if part == 0 { size } else { 1.0 };
            column.rows_mut(part, 3).copy_from(&(turned / unit));
        }
    }
    Some(velocities.select_rows(&leg.shared_components()))
}

/// Velocity of a point of a body and its angular velocity, per rate of all joints with the loops
/// open.
fn on_body(
    mechanism: &Mechanism,
    body: Option<BodyIndex>,
    point: Vector3<f64>,
    pose: &[f64],
    joints: &[f64],
) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(6, mechanism.joints().len());
    let mut at = body;
    while let Some(body) = at {
        let leg = &mechanism.legs[body.leg];
        let frames = mechanism.frames_of(body.leg, pose, joints);
        let range = mechanism.leg_range(body.leg);
        let own = leg.body_jacobian(&frames, body.joint, point);
        all.columns_mut(range.start, range.len()).copy_from(&own);
        at = leg.base_body;
    }
    all
}

/// Distance of the sides of all chains' ends, in the rows of Φ.
fn gaps(mechanism: &Mechanism, pose: &[f64], joints: &[f64]) -> Vec<f64> {
    let mut all = Vec::new();
    for (index, leg) in mechanism.legs.iter().enumerate() {
        if let Some(target) = mechanism.target(index, pose, joints) {
            let own = &joints[mechanism.leg_range(index)];
            all.extend(leg.closure_error(own, &target).iter());
        }
    }
    all
}

/// The joints that a Newton iteration may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Moving {
    /// Those of chains, and the dependent ones.
    Dependent,
    /// All.
    All,
}

/// The mechanism with a home near `start` that closes all chains.
///
/// Newton's iteration on all closures with the least-norm step of the moving joints, until
/// rounding. `None` if it does not converge.
pub(super) fn closed(mechanism: &Mechanism, start: &Home, moving: Moving) -> Option<Mechanism> {
    let mechanism = &Mechanism {
        home: start.clone(),
        ..mechanism.clone()
    };
    let of_pose = mechanism.coordinate_joints();
    let scale = scales(mechanism, mechanism.length_scale());
    let mut joints = start.joints.clone();
    for (place, &at) in of_pose.iter().enumerate() {
        joints[at] = start.pose[place];
    }
    let pose_of = |joints: &[f64]| of_pose.iter().map(|&at| joints[at]).collect::<Vec<f64>>();
    let fixed = match moving {
        Moving::Dependent => independent_rows(mechanism),
        Moving::All => Vec::new(),
    };
    let mut found: Option<(f64, Vec<f64>)> = None;
    for _ in 0..STEPS {
        let pose = pose_of(&joints);
        let gaps = gaps(mechanism, &pose, &joints);
        // `max` ignores NaN.
        if gaps.iter().any(|gap| !gap.is_finite()) {
            return None;
        }
        let missed = gaps.iter().fold(0.0, |most: f64, gap| most.max(gap.abs()));
        if missed < CLOSED {
            // When steps do not reduce the error any more, the rest is rounding.
            if found
                .as_ref()
                .is_some_and(|(known, _)| missed > 0.5 * known)
            {
                break;
            }
            found = Some((missed, joints.clone()));
        }
        let mut matrix = closures(mechanism, &pose, &joints, 1.0)?;
        for (at, mut column) in matrix.column_iter_mut().enumerate() {
            column *= if fixed.contains(&at) { 0.0 } else { scale[at] };
        }
        let solved = SingularValues::new(&matrix)?;
        let step = solved.pseudo_inverse(ROUNDING * solved.largest()) * DVector::from_vec(gaps);
        let limit = LONGEST_STEP / step.amax().max(LONGEST_STEP);
        for ((joint, change), scale) in joints.iter_mut().zip(step.iter()).zip(&scale) {
            *joint += limit * change * scale;
        }
    }
    let (_, joints) = found?;
    Some(Mechanism {
        home: Home::new(mechanism, pose_of(&joints), joints),
        ..mechanism.clone()
    })
}

/// Rates the independent joints of a skeleton at home, where all chains close.
pub(super) struct Rated {
    /// Number of motions that the chains allow.
    pub(super) motions: usize,
    /// Largest ratio of the rates of all joints to those of the independent ones; infinite for a wrong
    /// number of them.
    pub(super) gain: f64,
    /// Places in the pose of joints that determine the others well.
    pub(super) best: Vec<usize>,
    /// Their gain.
    pub(super) least: f64,
}

impl Rated {
    /// Rates the independent joints; `None` if values are not finite.
    pub(super) fn at_home(mechanism: &Mechanism) -> Option<Self> {
        let home = &mechanism.home;
        let allowed = allowed(mechanism, &home.pose, &home.joints)?;
        let of_pose = allowed.select_rows(&mechanism.coordinate_joints());
        let own = of_pose.select_rows(&mechanism.independent_places());
        let best = best_conditioned(&of_pose);
        let is_square = own.nrows() == own.ncols();
        Some(Self {
            motions: allowed.ncols(),
            gain: if is_square { gain(&own) } else { f64::INFINITY },
            least: gain(&of_pose.select_rows(&best)),
            best,
        })
    }

    /// Whether the independent joints are as many as the allowed motions, and determine the others.
    pub(super) fn is_good(&self) -> bool {
        self.gain < WEAK * self.least
    }
}

/// Largest ratio of the norm of an allowed motion to that of its rows.
fn gain(rows: &DMatrix<f64>) -> f64 {
    SingularValues::new(rows).map_or(f64::INFINITY, |found| found.condition() / found.largest())
}

/// A state at independent joints, tracked from home in small steps so that the working mode stays.
///
/// `None` where a chain or the dependent joints are nearly singular.
pub(super) fn follow(
    mechanism: &Mechanism,
    pose: &[f64],
    is_lenient: bool,
) -> Option<(Vec<f64>, Vec<f64>)> {
    const PARTS: usize = 8;
    let home = &mechanism.home;
    let own = mechanism.independent_places();
    let chosen = |allowed: &Rated| allowed.gain;
    let limit = if is_lenient {
        (4.0 * chosen(&Rated::at_home(mechanism)?)).max(REGULAR)
    } else {
        REGULAR
    };
    let mut at = mechanism.clone();
    for part in 1..=PARTS {
        let part = part as f64 / PARTS as f64;
        let mut start = at.home.clone();
        for &place in &own {
            start.pose[place] = home.pose[place] + part * (pose[place] - home.pose[place]);
        }
        at = closed(&at, &start, Moving::Dependent)?;
        let is_regular = |(index, leg): (usize, &super::Leg)| {
            let range = mechanism.leg_range(index);
            let limit = if is_lenient {
                lenient_limit(leg, &home.joints[range.clone()])
            } else {
                REGULAR
            };
            leg.end.is_none() || condition(&leg.closure_jacobian(&at.home.joints[range])) < limit
        };
        let rated = Rated::at_home(&at)?;
        if !mechanism.legs.iter().enumerate().all(is_regular) || chosen(&rated) >= limit {
            return None;
        }
    }
    Some((at.home.pose, at.home.joints))
}
