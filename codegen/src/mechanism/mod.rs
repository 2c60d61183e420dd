//! The checked mechanism: bodies, joints, legs and platform as plain data.
//!
//! Frames follow Khalil and Kleinfinger's modified Denavit-Hartenberg convention. From the antecedent
//! frame to frame j: Rot(z, γ) Trans(z, b) Rot(x, α) Trans(x, d) Rot(z, θ) Trans(z, r). The joint's
//! position is θ (revolute) or r (prismatic), plus a constant. Every leg starts at a base frame and
//! ends on the platform: its last frame is fixed on the platform (`Rigid`), or its origin coincides
//! with a platform point (`Point`). A robot without a platform is a tree, one leg without an end,
//! or a skeleton with chains. Chains are legs that end on bodies of other legs; they may carry
//! branches, which are legs without an end.

mod actuation;
mod actuators;
mod cable;
mod check;
mod dependent;
mod explain;
mod home;
mod mobility;
pub mod numeric;
mod parasitic;
mod reach;
mod singular_values;
mod springs;
pub(crate) mod states;
mod still;
mod structure;
#[cfg(test)]
mod tests;

pub use check::check;
pub use home::Home;
pub use numeric::placement_isometry;
pub use overact_description::TwistCoordinate;

pub use crate::cas::{Angle, Number, Ratio};
pub use overact_description::{
    ActuatorNames, BaseColumns, BodyIndex, Cable, End, Formula, FrameBody, JointKind, Motion,
    Placement, Spring, SpringBody, SpringEnd, StandardParameter,
};

/// A joint and the body that it moves.
#[derive(Debug, Clone)]
pub struct Joint {
    /// Name, unique in its leg.
    pub name: String,
    /// Revolute, prismatic or fixed.
    pub kind: JointKind,
    /// The joint that this joint's frame is described from; `None` for the leg's base frame.
    pub antecedent: Option<usize>,
    /// MDH γ.
    pub gamma: Angle,
    /// MDH b, m.
    pub b: Number,
    /// MDH α.
    pub alpha: Angle,
    /// MDH d, m.
    pub d: Number,
    /// MDH θ; for a revolute joint the constant part.
    pub theta: Angle,
    /// MDH r, m; for a prismatic joint the constant part.
    pub r: Number,
    /// The joint position as a linear combination of the leg's independent joint variables.
    ///
    /// An independent joint has itself with factor one, a coupled joint has others, a fixed joint
    /// none.
    pub variable: Vec<(usize, Ratio)>,
    /// Whether a motor drives the joint.
    pub actuated: bool,
    /// Whether the chains determine the joint, which is one of a skeleton or branch.
    pub dependent: bool,
    /// Standard parameters of the body and the joint that are not absent.
    pub parameters: Vec<StandardParameter>,
    /// Gear ratio, rotor turns per unit of the variable, of a motor that moves other joints and
    /// carries no body.
    pub motor: Option<f64>,
    /// Position-dependent torque with an unknown coefficient.
    pub spring: Option<Spring>,
    /// Position-dependent torque that is known, without a coefficient.
    pub known: Option<Formula>,
    /// Stribeck velocity of the joint's friction, rad/s or m/s.
    pub stribeck: Option<Number>,
    /// Load to which friction is proportional, with an unknown coefficient.
    pub load: Option<Spring>,
}

impl Joint {
    /// Whether the joint at `index` has a variable of its own.
    #[must_use]
    pub fn is_independent(&self, index: usize) -> bool {
        self.variable.len() == 1 && self.variable[0].0 == index
    }

    /// The joint at the end of the name of a quantity: `2` in `force2`, `_elbow` in `force_elbow`.
    #[must_use]
    pub(crate) fn suffix(&self) -> String {
        if self.name.starts_with(|c: char| c.is_ascii_digit()) {
            self.name.clone()
        } else {
            format!("_{}", self.name)
        }
    }
}

/// A leg.
#[derive(Debug, Clone)]
pub struct Leg {
    /// Name, unique in the robot.
    pub name: String,
    /// Index of the leg's shape, equal for legs that are described once and placed several times.
    pub shape: usize,
    /// The leg's base frame in the robot's base frame.
    pub base: Placement,
    /// The joints; antecedents come first. A cable has one, its length.
    pub joints: Vec<Joint>,
    /// The cable, of a leg that is one.
    pub cable: Option<Cable>,
    /// End of the leg on the platform or on a body; `None` for a tree.
    pub end: Option<End>,
    /// The body of the skeleton, or of an earlier chain, that the leg starts from; `None` for the
    /// ground.
    ///
    /// The leg's base frame is relative to this body's frame.
    pub base_body: Option<BodyIndex>,
    /// The body of the skeleton, or of an earlier chain, that the leg ends on; `None` for the
    /// platform.
    pub end_body: Option<BodyIndex>,
}

impl Leg {
    /// Indices of the joints with a variable of their own.
    pub fn independent(&self) -> impl Iterator<Item = usize> + '_ {
        self.joints
            .iter()
            .enumerate()
            .filter(|(i, j)| j.is_independent(*i))
            .map(|(i, _)| i)
    }
}

/// A payload on a body, which some runs carry.
#[derive(Debug, Clone)]
pub struct Payload {
    /// Name, unique in the robot.
    pub name: String,
    /// The body on which it is fixed.
    pub body: FrameBody,
    /// Its frame in the body's frame.
    pub placement: Placement,
    /// Inertial parameters about its frame that are not absent.
    pub parameters: Vec<StandardParameter>,
}

/// A motor that drives a combination of joints of a robot with loops.
#[derive(Debug, Clone)]
pub struct Motor {
    /// Name, unique in its leg, or in the robot without one.
    pub name: String,
    /// The leg with whose shape it is described.
    pub leg: Option<usize>,
    /// Whether the combination is an angle or a length.
    pub kind: JointKind,
    /// The joints that it drives, as positions among [`Mechanism::joints`], with factors.
    pub terms: Vec<(usize, Ratio)>,
    /// Parameters of rotor and friction that are not absent, of the combination's rate.
    pub parameters: Vec<StandardParameter>,
    /// Stribeck velocity of the friction, rad/s or m/s.
    pub stribeck: Option<Number>,
}

/// An actuator of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Actuator {
    /// An actuated joint, as its position among [`Mechanism::joints`].
    Joint(usize),
    /// The motor of this index.
    Motor(usize),
}

/// A spring or damper between two points on two bodies.
#[derive(Debug, Clone)]
pub struct PointSpring {
    /// Name, unique in the robot.
    pub name: String,
    /// The points between which it acts, in the frames of their bodies.
    pub ends: [SpringEnd; 2],
    /// Force per unit of an unknown coefficient; a positive force pulls the points together.
    pub force: Option<Spring>,
    /// Known force.
    pub known: Option<Formula>,
}

/// The platform.
#[derive(Debug, Clone)]
pub struct Platform {
    /// The platform's motion.
    pub motion: Motion,
    /// Inertial parameters of the platform that are not absent.
    pub parameters: Vec<StandardParameter>,
    /// Inertial parameters of the payload, if the robot may carry one.
    pub payload: Option<Vec<StandardParameter>>,
}

/// A frame on a body, such as a tool.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Name, the beginning of the names of its functions.
    pub name: String,
    /// The body on which it is fixed.
    pub body: FrameBody,
    /// Its placement in the body's frame.
    pub placement: Placement,
}

/// A robot.
#[derive(Debug, Clone)]
pub struct Mechanism {
    /// Name of the Rust type.
    pub name: String,
    /// One sentence about the robot.
    pub summary: String,
    /// Origin of the description.
    pub source: String,
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: [Number; 3],
    /// Named constants of the description, in SI units, for readers of generated code.
    pub constants: Vec<(String, f64)>,
    /// Magnitudes of the description's numbers without a name, in SI units.
    pub magnitudes: Vec<f64>,
    /// The platform; `None` for a serial or tree robot.
    pub platform: Option<Platform>,
    /// The legs.
    pub legs: Vec<Leg>,
    /// Payloads on bodies, with tables of their own.
    pub payloads: Vec<Payload>,
    /// Motors that drive combinations of joints of a robot with loops.
    pub motors: Vec<Motor>,
    /// Springs and dampers between two points.
    pub springs: Vec<PointSpring>,
    /// Frames on bodies.
    pub frames: Vec<Frame>,
    /// Origin of the mechanism's axes in the description's base frame, m.
    ///
    /// A platform on a fixed axis is described relative to that axis.
    pub origin: [Number; 3],
    /// The home configuration, which fixes assembly and working modes.
    pub home: Home,
    /// Kept actuators of the actuator projection, as indices among the actuators.
    pub kept_actuators: Vec<usize>,
    /// Columns that represent the base parameters.
    pub base_columns: BaseColumns,
    /// Pose coordinates of a platform with parasitic motion that the closures keep at zero.
    pub still: Vec<usize>,
    /// Chains with too few joints, which block directions of a skeleton with dependent joints.
    pub blocking: Vec<usize>,
}

/// A joint of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JointIndex {
    /// The leg.
    pub leg: usize,
    /// The joint in its leg.
    pub joint: usize,
}

impl Mechanism {
    /// All joints with a variable of their own, leg by leg: the order of q_t.
    #[must_use]
    pub fn joints(&self) -> Vec<JointIndex> {
        let legs = self.legs.iter().enumerate();
        legs.flat_map(|(leg, l)| l.independent().map(move |joint| JointIndex { leg, joint }))
            .collect()
    }

    /// The joint of an index.
    #[must_use]
    pub fn joint(&self, index: JointIndex) -> &Joint {
        &self.legs[index.leg].joints[index.joint]
    }

    /// Positions of the actuated joints among [`Self::joints`]: the order of q and τ, before the
    /// motors.
    #[must_use]
    pub fn actuated(&self) -> Vec<usize> {
        let joints = self.joints();
        let actuated = joints
            .iter()
            .enumerate()
            .filter(|(_, j)| self.joint(**j).actuated);
        actuated.map(|(i, _)| i).collect()
    }

    /// Whether the robot has cables.
    #[must_use]
    pub fn has_cables(&self) -> bool {
        self.legs.iter().any(|leg| leg.cable.is_some())
    }

    /// Whether each actuator is a cable, whose torque is its tension.
    #[must_use]
    pub fn pulls(&self) -> Vec<bool> {
        let joints = self.joints();
        let is_cable = |at: usize| self.legs[joints[at].leg].cable.is_some();
        let of_joints = self.actuated().into_iter().map(is_cable);
        of_joints.chain(self.motors.iter().map(|_| false)).collect()
    }

    /// Least torque of each actuator: the minimum tension of a cable, N; `None` for other
    /// actuators.
    #[must_use]
    pub fn minimum_tensions(&self) -> Vec<Option<f64>> {
        let joints = self.joints();
        let cable = |&at: &usize| self.legs[joints[at].leg].cable.as_ref();
        let least = |at: &usize| cable(at).map(|cable| cable.minimum.value());
        let of_joints = self.actuated();
        let of_motors = self.motors.iter().map(|_| None);
        of_joints.iter().map(least).chain(of_motors).collect()
    }

    /// Whether the robot has no loop: neither a platform nor chains.
    #[must_use]
    pub fn is_tree(&self) -> bool {
        self.platform.is_none() && self.skeleton().is_none()
    }

    /// The leg that chains are attached to, whose joints are independent coordinates.
    ///
    /// It is the first leg of a robot without a platform that has legs with ends.
    #[must_use]
    pub fn skeleton(&self) -> Option<&Leg> {
        let has_chains = self.platform.is_none() && self.legs.iter().any(|leg| leg.end.is_some());
        self.legs.first().filter(|_| has_chains)
    }

    /// Indices in [`Self::joints`] of the joints in the pose of a robot without a platform.
    ///
    /// They are the joints of legs without an end: the skeleton and the branches on chains. Those
    /// that are not dependent are the independent coordinates.
    #[must_use]
    pub fn coordinate_joints(&self) -> Vec<usize> {
        let free = (0..self.legs.len()).filter(|&leg| self.legs[leg].end.is_none());
        free.flat_map(|leg| self.leg_range(leg)).collect()
    }

    /// Range of the joints of a leg without an end in the pose.
    #[must_use]
    pub fn coordinate_range(&self, leg: usize) -> std::ops::Range<usize> {
        let before = self.legs[..leg].iter().filter(|own| own.end.is_none());
        let start = before.map(|own| own.independent().count()).sum::<usize>();
        start..start + self.legs[leg].independent().count()
    }

    /// The joints in the pose of a robot without a platform.
    fn pose_joints(&self) -> Vec<JointIndex> {
        let all = self.joints();
        let own = self.coordinate_joints().into_iter();
        own.map(|at| all[at]).collect()
    }

    /// The joints that are independent coordinates of a robot without a platform.
    fn independent_joints(&self) -> Vec<JointIndex> {
        let own = self.pose_joints().into_iter();
        own.filter(|at| !self.joint(*at).dependent).collect()
    }

    /// r, the number of independent coordinates: of the platform, or of the joints of a tree or
    /// skeleton.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.platform.as_ref().map_or_else(
            || self.independent_joints().len(),
            |p| p.motion.twist().len(),
        )
    }

    /// Length of a pose.
    #[must_use]
    pub fn pose_len(&self) -> usize {
        self.platform.as_ref().map_or_else(
            || self.coordinate_joints().len(),
            |p| p.motion.pose_coordinates().len(),
        )
    }

    /// Name of a joint for messages: `leg1.2`, or `2` in a robot of one leg without a platform.
    #[must_use]
    pub fn joint_name(&self, index: JointIndex) -> String {
        let joint = &self.joint(index).name;
        if self.platform.is_none() && self.legs.len() == 1 {
            return joint.clone();
        }
        format!("{}.{joint}", self.legs[index.leg].name)
    }

    /// Names of the independent coordinates in the order of the twist: of the platform, or of the
    /// joints of a robot without one.
    #[must_use]
    pub fn coordinates(&self) -> Vec<String> {
        match &self.platform {
            Some(platform) => {
                let names = platform.motion.coordinates();
                names.into_iter().map(str::to_owned).collect()
            }
            None => self.own_names(self.independent_joints(), |name| name),
        }
    }

    /// Names of the pose's components, such as `qw`, `qx`, `qy`, `qz` of a quaternion.
    ///
    /// They are those of the platform, or the joints of a robot without one.
    #[must_use]
    pub fn pose_coordinates(&self) -> Vec<String> {
        match &self.platform {
            Some(platform) => {
                let names = platform.motion.pose_coordinates();
                names.into_iter().map(str::to_owned).collect()
            }
            None => self.own_names(self.pose_joints(), |name| format!("q_{name}")),
        }
    }

    /// Names of the joints in the pose of a robot without a platform; none with one.
    #[must_use]
    pub fn pose_joint_names(&self) -> Vec<String> {
        self.own_names(self.pose_joints(), |name| name)
    }

    /// Names of joints of a robot without a platform; those of a skeleton are named without their
    /// leg.
    fn own_names(&self, joints: Vec<JointIndex>, form: impl Fn(String) -> String) -> Vec<String> {
        let name = |j: JointIndex| match self.skeleton() {
            Some(_) if j.leg == 0 => self.joint(j).name.clone(),
            _ => self.joint_name(j),
        };
        joints.into_iter().map(|j| form(name(j))).collect()
    }

    /// Name of a leg's standard parameter: `zz_2_leg3`, or `zz_2` in a robot of one leg without a
    /// platform.
    #[must_use]
    pub fn parameter_name(&self, symbol: StandardParameter, leg: usize, joint: usize) -> String {
        let body = &self.legs[leg].joints[joint].name;
        if self.platform.is_none() && self.legs.len() == 1 {
            return format!("{}_{body}", symbol.name());
        }
        format!("{}_{body}_{}", symbol.name(), self.legs[leg].name)
    }
}
