//! A parallel, serial or tree robot as plain data.
//!
//! Frames follow the modified Denavit-Hartenberg notation of Khalil and Kleinfinger. From the
//! antecedent frame to frame j: Rot(z,γ) Trans(z,b) Rot(x,α) Trans(x,d) Rot(z,θ) Trans(z,r).
//! A revolute joint turns θ, a prismatic joint slides r. The joint's own constant is its offset:
//! θ = `theta` + Σ c_i q_i, or r = `r` + Σ c_i q_i, over the variables q_i of the same leg. A joint
//! whose sum contains its own index owns a variable; a joint whose sum doesn't is dependent, like
//! the return joints of a parallelogram.
//!
//! Every joint carries a body. Whether the body has mass is a matter of the parameters alone.

use super::motion::Motion;
use super::placement::Frame;
use nalgebra::Vector3;
use std::fmt::{Debug, Formatter};
use std::sync::Arc;

/// Points and weights of Gauss's quadrature with six points on [-1, 1], each for both signs.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_04),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];
/// Pieces of an interval of integration.
const INTEGRATION_PIECES: usize = 16;

/// What a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Rotation about z.
    Revolute,
    /// Translation along z.
    Prismatic,
    /// No motion: a frame fixed to its antecedent.
    Fixed,
}

/// A joint with the frame and body that it carries.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Revolute, prismatic or fixed.
    pub kind: JointKind,
    /// Index of the antecedent joint in the leg; none is the base of the leg.
    pub antecedent: Option<usize>,
    /// Rotation about the antecedent's z, rad.
    pub gamma: f64,
    /// Translation along the antecedent's z, m.
    pub b: f64,
    /// Rotation about x, rad.
    pub alpha: f64,
    /// Translation along x, m.
    pub d: f64,
    /// Rotation about the joint's z, rad: the offset of a revolute joint.
    pub theta: f64,
    /// Translation along the joint's z, m: the offset of a prismatic joint.
    pub r: f64,
    /// Coefficients of the leg's joint variables in this joint's position.
    pub terms: Vec<(usize, f64)>,
    /// Whether a motor drives the joint.
    pub actuated: bool,
    /// Whether the chains determine the joint, although it is one of the pose.
    pub is_dependent: bool,
    /// Spring of the joint, a function of its position.
    pub spring: Option<Spring>,
    /// Known torque as a function of its position.
    pub known: Option<Spring>,
    /// Stribeck velocity, at which the excess friction of standstill has fallen to half, rad/s or
    /// m/s.
    pub stribeck: Option<f64>,
    /// Load that increases dry friction.
    pub load: Option<Spring>,
}

/// Torque for a unit coefficient, or known torque, as a function of the joint's sum Σ c_i q_i.
#[derive(Clone)]
pub struct Spring(Arc<dyn Fn(f64) -> f64 + Send + Sync>);

impl Spring {
    /// A spring of this torque.
    #[must_use]
    pub fn new(torque: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self(Arc::new(torque))
    }

    /// The torque at a position.
    #[must_use]
    pub fn torque(&self, position: f64) -> f64 {
        (self.0)(position)
    }

    /// Work against the torque between two positions, by Gauss's quadrature.
    #[must_use]
    pub fn work(&self, from: f64, to: f64) -> f64 {
        let length = (to - from) / INTEGRATION_PIECES as f64;
        let piece = |piece: usize| {
            let middle = from + length * (piece as f64 + 0.5);
            let point = |&(at, weight): &(f64, f64)| {
                let half_distance = 0.5 * length * at;
                weight * (self.torque(middle - half_distance) + self.torque(middle + half_distance))
            };
            0.5 * length * GAUSS.iter().map(point).sum::<f64>()
        };
        (0..INTEGRATION_PIECES).map(piece).sum()
    }
}

impl Debug for Spring {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "Spring({}, {})", self.torque(0.0), self.torque(1.0))
    }
}

/// Compares springs at a few positions.
impl PartialEq for Spring {
    fn eq(&self, other: &Self) -> bool {
        [-0.7, 0.0, 0.3, 1.1].map(|q| self.torque(q))
            == [-0.7, 0.0, 0.3, 1.1].map(|q| other.torque(q))
    }
}

impl Joint {
    /// Joint `index` of a serial chain, with its own variable; geometry all zero.
    #[must_use]
    pub fn new(kind: JointKind, index: usize) -> Self {
        let terms = if kind == JointKind::Fixed {
            Vec::new()
        } else {
            vec![(index, 1.0)]
        };
        Self {
            kind,
            antecedent: index.checked_sub(1),
            gamma: 0.0,
            b: 0.0,
            alpha: 0.0,
            d: 0.0,
            theta: 0.0,
            r: 0.0,
            terms,
            actuated: false,
            is_dependent: false,
            spring: None,
            known: None,
            stribeck: None,
            load: None,
        }
    }

    /// Revolute joint `index` of a serial chain at `alpha`, `d` from its antecedent.
    #[must_use]
    pub fn revolute(index: usize, alpha: f64, d: f64) -> Self {
        Self {
            alpha,
            d,
            ..Self::new(JointKind::Revolute, index)
        }
    }

    /// Prismatic joint `index` of a serial chain at `alpha`, `d` from its antecedent.
    #[must_use]
    pub fn prismatic(index: usize, alpha: f64, d: f64) -> Self {
        Self {
            alpha,
            d,
            ..Self::new(JointKind::Prismatic, index)
        }
    }

    /// The same joint, driven by a motor.
    #[must_use]
    pub fn actuated(self) -> Self {
        Self {
            actuated: true,
            ..self
        }
    }

    /// The same joint, moved by other joints' variables instead of its own.
    #[must_use]
    pub fn dependent(self, terms: &[(usize, f64)]) -> Self {
        Self {
            terms: terms.to_vec(),
            ..self
        }
    }

    /// Placement in the antecedent frame, the joint's sum Σ c_i q_i being `value`.
    #[must_use]
    pub fn placement(&self, value: f64) -> Frame {
        let (mut theta, mut r) = (self.theta, self.r);
        match self.kind {
            JointKind::Revolute => theta += value,
            JointKind::Prismatic => r += value,
            JointKind::Fixed => {}
        }
        Frame::about_z(self.gamma)
            * Frame::along_z(self.b)
            * Frame::about_x(self.alpha)
            * Frame::along_x(self.d)
            * Frame::about_z(theta)
            * Frame::along_z(r)
    }
}

/// How a leg ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// Free: a branch of a serial or tree robot.
    Free,
    /// A frame of the leg is fixed to the platform.
    Rigid {
        /// Index of the joint whose frame is fixed.
        joint: usize,
        /// Pose of that frame in the platform frame.
        attachment: Frame,
    },
    /// The origin of a frame of the leg coincides with a point of the platform.
    Point {
        /// Index of the joint whose frame's origin it is.
        joint: usize,
        /// The point in the platform frame.
        attachment: Vector3<f64>,
        /// Along which axes of the base frame they coincide.
        along: [bool; 3],
    },
    /// A cable runs from the leg's base over a pulley to a point of the platform; the leg's only
    /// variable is its length.
    Cable {
        /// The point in the platform frame.
        attachment: Vector3<f64>,
        /// Radius of the pulley that swivels about the base's z axis; zero for an eyelet.
        radius: f64,
        /// Least tension, N.
        minimum: f64,
    },
}

/// A chain or tree of joints between the base and the platform.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// Placement of the leg's base in the robot's base frame, or in that of its carrier.
    pub base: Frame,
    /// Body that carries the base, as (leg, joint) of an earlier leg; `None` for the ground.
    pub carrier: Option<(usize, usize)>,
    /// Body that the end is attached to, as (leg, joint) of an earlier leg; `None` for the
    /// platform.
    pub body: Option<(usize, usize)>,
    /// Joints; every antecedent comes before its successors.
    pub joints: Vec<Joint>,
    /// How the leg meets the platform.
    pub end: End,
    /// Joint variables near the home pose; they choose the working mode.
    pub start: Vec<f64>,
}

impl Leg {
    /// Indices of the joints that own a variable, in order.
    #[must_use]
    pub fn variables(&self) -> Vec<usize> {
        let owns = |index: &usize| {
            self.joints[*index]
                .terms
                .iter()
                .any(|term| term.0 == *index)
        };
        (0..self.joints.len()).filter(owns).collect()
    }

    /// Sum Σ c_i q_i of every joint for the values of the leg's variables.
    ///
    /// The map is linear, so it serves positions, velocities and accelerations alike.
    #[must_use]
    pub fn joint_values(&self, variables: &[f64]) -> Vec<f64> {
        let owners = self.variables();
        let value = |owner: usize| {
            owners
                .iter()
                .position(|&index| index == owner)
                .map_or(0.0, |at| variables[at])
        };
        let sum = |joint: &Joint| joint.terms.iter().map(|&(owner, c)| c * value(owner)).sum();
        self.joints.iter().map(sum).collect()
    }
}

/// A force along the line between two points of two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The points.
    pub ends: [ElementEnd; 2],
    /// Force for a unit coefficient.
    pub force: Option<Law>,
    /// Known force.
    pub known: Option<Law>,
}

/// An end of an element.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementEnd {
    /// The body.
    pub body: ElementBody,
    /// The point in the body's frame.
    pub at: Vector3<f64>,
}

/// A body that carries an end of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementBody {
    /// The base frame.
    Ground,
    /// The platform.
    Platform,
    /// The body of a leg and joint.
    Joint(usize, usize),
}

/// Force as a function of length and rate; a positive force pulls the points together.
#[derive(Clone)]
pub struct Law(Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>);

impl Law {
    /// A law of this force.
    #[must_use]
    pub fn new(force: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) -> Self {
        Self(Arc::new(force))
    }

    /// The force at a length and a rate.
    #[must_use]
    pub fn force(&self, length: f64, rate: f64) -> f64 {
        (self.0)(length, rate)
    }
}

impl Debug for Law {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "Law({}, {})", self.force(1.0, 0.0), self.force(1.0, 1.0))
    }
}

/// Compares laws at a few lengths and rates.
impl PartialEq for Law {
    fn eq(&self, other: &Self) -> bool {
        [(0.3, -0.2), (0.7, 0.0), (1.1, 0.9)]
            .into_iter()
            .all(|(length, rate)| self.force(length, rate) == other.force(length, rate))
    }
}

/// A motor that drives a combination of joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Motor {
    /// Positions of the joints among all variables, with their factors.
    pub terms: Vec<(usize, f64)>,
    /// Stribeck velocity of its friction, rad/s or m/s.
    pub stribeck: Option<f64>,
}

/// A whole robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: Vector3<f64>,
    /// Free motions of the platform.
    pub motion: Motion,
    /// Pose coordinates around which random states are drawn.
    pub home: Vec<f64>,
    /// Largest displacement of random poses from home, by twist coordinate.
    pub workspace: Vec<f64>,
    /// Legs.
    pub legs: Vec<Leg>,
    /// Springs and dampers between two points.
    pub elements: Vec<Element>,
    /// Motors that drive combinations of joints; they are the last actuators.
    pub motors: Vec<Motor>,
}

impl Mechanism {
    /// Leg and joint of every variable, legs in order: the layout of all joint vectors.
    #[must_use]
    pub fn variables(&self) -> Vec<(usize, usize)> {
        let of_leg = |(k, leg): (usize, &Leg)| leg.variables().into_iter().map(move |j| (k, j));
        self.legs.iter().enumerate().flat_map(of_leg).collect()
    }

    /// Positions of the actuated variables.
    ///
    /// Without a platform, all are actuated: the model of a serial robot gives every joint's
    /// torque, eq. (1).
    #[must_use]
    pub fn actuated(&self) -> Vec<usize> {
        let all = self.motion == Motion::None;
        let variables = self.variables();
        let driven = |at: &usize| {
            let (leg, joint) = variables[*at];
            all || self.legs[leg].joints[joint].actuated
        };
        (0..variables.len()).filter(driven).collect()
    }

    /// Number of joint variables, n_t.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.variables().len()
    }

    /// Number of independent coordinates, r.
    #[must_use]
    pub fn dof(&self) -> usize {
        if self.motion == Motion::None {
            self.joints()
        } else {
            self.motion.dof()
        }
    }

    /// Independent variables of a robot with loops between bodies: those of the pose that no chain
    /// determines.
    #[must_use]
    pub fn independent(&self) -> Vec<usize> {
        let variables = self.variables();
        let is_dependent = |at: &usize| {
            let (leg, joint) = variables[*at];
            self.legs[leg].joints[joint].is_dependent
        };
        let own = self.in_pose().into_iter();
        own.filter(|at| !is_dependent(at)).collect()
    }

    /// Whether the pose of a robot with loops between bodies has joints that the chains determine.
    #[must_use]
    pub fn has_dependent_joints(&self) -> bool {
        let mut all = self.legs.iter().flat_map(|leg| &leg.joints);
        all.any(|joint| joint.is_dependent)
    }

    /// Variables in the pose of a robot with loops between bodies: those of legs with a free end.
    #[must_use]
    pub fn in_pose(&self) -> Vec<usize> {
        let free = self.legs.iter().zip(self.leg_ranges());
        free.filter(|(leg, _)| leg.end == End::Free)
            .flat_map(|(_, range)| range)
            .collect()
    }

    /// Least tension of each actuator that is a cable.
    #[must_use]
    pub fn least_tensions(&self) -> Vec<Option<f64>> {
        let variables = self.variables();
        let least = |at: usize| match self.legs[variables[at].0].end {
            End::Cable { minimum, .. } => Some(minimum),
            _ => None,
        };
        let of_joints = self.actuated().into_iter().map(least);
        of_joints.chain(self.motors.iter().map(|_| None)).collect()
    }

    /// Whether an actuator is a cable.
    #[must_use]
    pub fn has_cables(&self) -> bool {
        self.least_tensions().iter().any(Option::is_some)
    }

    /// Number of actuators, n.
    #[must_use]
    pub fn actuators(&self) -> usize {
        self.actuated().len() + self.motors.len()
    }

    /// Range of every leg's variables within a joint vector.
    #[must_use]
    pub fn leg_ranges(&self) -> Vec<std::ops::Range<usize>> {
        let mut start = 0;
        let mut range = |leg: &Leg| {
            let first = start;
            start += leg.variables().len();
            first..start
        };
        self.legs.iter().map(&mut range).collect()
    }
}
