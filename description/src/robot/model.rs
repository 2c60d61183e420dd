//! The evaluated robot of a description: one value per placement, lengths in m, masses in kg.

use crate::diagnostic::Span;
pub use crate::diagnostic::Spanned;
use crate::expressions::formula::{Formula, Spring};
use overact_core::StandardParameter;
use overact_exact::{Angle, Number, Ratio};

/// A motion of a platform. Axes are 0, 1, 2 for x, y, z of the base frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Translation along an axis.
    FixedAxis {
        /// The axis.
        axis: usize,
    },
    /// Rotation about an axis through the platform's origin.
    Rotation {
        /// The axis.
        axis: usize,
    },
    /// A point in a plane.
    Point {
        /// The plane's normal.
        axis: usize,
    },
    /// Translations in a plane and rotation about its normal.
    Planar {
        /// The plane's normal.
        axis: usize,
    },
    /// Three translations.
    Translation,
    /// Three translations and one rotation.
    Schoenflies {
        /// The rotation's axis.
        axis: usize,
    },
    /// Rotations about the platform's origin.
    Spherical,
    /// All six motions.
    Spatial,
    /// A free body with parasitic motion: legs block directions that change with the pose.
    ///
    /// Only some of x, y, z, rx, ry, rz are independent.
    Parasitic {
        /// Whether each of the six is independent.
        independent: [bool; 6],
    },
}

const AXES: [&str; 3] = ["x", "y", "z"];
/// The coordinates of a free body.
pub const SIX: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl Motion {
    /// Names of the coordinates in a description: translations, then `phi` or `rx`, `ry`, `rz`.
    ///
    /// Their number is r, the number of degrees of freedom.
    #[must_use]
    pub fn coordinates(self) -> Vec<&'static str> {
        let in_plane = |axis: usize| [AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]];
        match self {
            Self::FixedAxis { axis } => vec![AXES[axis % 3]],
            Self::Rotation { .. } => vec!["phi"],
            Self::Point { axis } => in_plane(axis).to_vec(),
            Self::Planar { axis } => [&in_plane(axis)[..], &["phi"]].concat(),
            Self::Translation => AXES.to_vec(),
            Self::Schoenflies { .. } => [&AXES[..], &["phi"]].concat(),
            Self::Spherical => vec!["rx", "ry", "rz"],
            Self::Spatial => SIX.to_vec(),
            Self::Parasitic { independent } => {
                let all = SIX.into_iter().zip(independent);
                all.filter_map(|(name, is_own)| is_own.then_some(name))
                    .collect()
            }
        }
    }

    /// The motion of the pose's numbers: that of a free body for a platform with parasitic motion.
    #[must_use]
    pub const fn of_pose(self) -> Self {
        match self {
            Self::Parasitic { .. } => Self::Spatial,
            other => other,
        }
    }
}

/// The platform.
#[derive(Debug, Clone, PartialEq)]
pub struct Platform {
    /// Motion of the platform.
    pub motion: Spanned<Motion>,
    /// Position of the platform's origin on a fixed axis at zero, m; zero for other motions.
    pub axis_at: [Number; 3],
    /// The home pose.
    pub home: PlatformHome,
    /// Intended number of redundant actuators, if given.
    pub redundancy: Option<Spanned<usize>>,
    /// Inertial parameters of the platform that are not absent.
    pub parameters: Vec<StandardParameter>,
    /// Inertial parameters of the payload, if the robot may carry one.
    pub payload: Option<Vec<StandardParameter>>,
    /// Location of the table.
    pub span: Span,
}

/// The platform's home pose; coordinates without motion are zero.
#[derive(Debug, Clone, PartialEq)]
pub struct PlatformHome {
    /// Coordinates x, y, z of the platform's origin, m.
    pub at: [Number; 3],
    /// The angle φ of a motion with one rotation.
    pub phi: Angle,
    /// The angles rx, ry, rz of a motion with three: the orientation is Rz(rz) Ry(ry) Rx(rx).
    pub rotation: [Angle; 3],
}

impl PlatformHome {
    /// All coordinates zero.
    pub const ZERO: Self = Self {
        at: [Number::ZERO; 3],
        phi: Angle::ZERO,
        rotation: [Angle::ZERO; 3],
    };
}

/// A position and an orientation Rz(rz) Ry(ry) Rx(rx).
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Coordinates of the origin, m.
    pub at: [Number; 3],
    /// The angles rx, ry, rz.
    pub rotation: [Angle; 3],
}

/// A body of a leg: the one that a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BodyIndex {
    /// The leg, in the order of placement.
    pub leg: usize,
    /// The joint in its leg.
    pub joint: usize,
}

/// A frame on a body, such as a tool.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Name, the beginning of the names of its functions.
    pub name: Spanned<String>,
    /// The body on which it is fixed.
    pub body: FrameBody,
    /// Its placement in the body's frame.
    pub placement: Placement,
}

/// The body that carries a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameBody {
    /// The platform.
    Platform,
    /// The body after a joint.
    Joint(BodyIndex),
}

/// A placed leg.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Name, unique in the robot.
    pub name: Spanned<String>,
    /// Index of its shape in the order of the file, equal for legs that are described once and
    /// placed several times.
    pub shape: usize,
    /// Name of its shape.
    pub shape_name: String,
    /// The leg's base frame in the robot's base frame.
    pub base: Placement,
    /// The joints; antecedents come first. A cable has one, the slide of its length.
    pub joints: Vec<Joint>,
    /// The cable, of a leg that is one.
    pub cable: Option<Cable>,
    /// End of the leg on the platform or on a body; `None` for a tree.
    pub end: Option<Spanned<End>>,
    /// The body of the skeleton, or of an earlier chain, that the leg starts from; `None` for the
    /// ground.
    pub base_body: Option<BodyIndex>,
    /// The body of the skeleton, or of an earlier chain, that the leg ends on; `None` for the
    /// platform.
    pub end_body: Option<BodyIndex>,
    /// Location of its `[[place]]`.
    pub span: Span,
}

/// A cable between an exit point, the origin of the leg's base frame, and a platform point.
#[derive(Debug, Clone, PartialEq)]
pub struct Cable {
    /// Radius of the pulley that swivels about the base frame's z axis, m; zero for an eyelet.
    pub pulley: Number,
    /// Least tension, N.
    pub minimum: Number,
    /// Radius of the drum, m, if logs contain the drum's torque instead of the tension.
    pub drum: Option<Number>,
}

/// End of a leg on the platform.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// The last frame is fixed on the platform, at this placement in the platform frame.
    Rigid(Placement),
    /// The last frame's origin coincides with a point of the platform.
    Point {
        /// The point in the platform frame, m.
        at: [Number; 3],
        /// Axes of the robot's base frame along which it coincides; along others the leg's end may
        /// slide.
        along: [bool; 3],
    },
}

impl End {
    /// The platform point that coincides with the last frame's origin, in the platform frame, m.
    #[must_use]
    pub const fn point(&self) -> [Number; 3] {
        match self {
            Self::Rigid(placement) => placement.at,
            Self::Point { at, .. } => *at,
        }
    }

    /// Components of the six-vector (position, orientation) in the base frame that the last frame
    /// shares with the platform.
    #[must_use]
    pub fn shared_components(&self) -> Vec<usize> {
        match self {
            Self::Rigid(_) => (0..6).collect(),
            Self::Point { along, .. } => (0..3).filter(|&axis| along[axis]).collect(),
        }
    }
}

/// The kind of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum JointKind {
    /// σ = 0: rotates about its z axis.
    Revolute,
    /// σ = 1: slides along its z axis.
    Prismatic,
    /// σ = 2: fixed.
    Fixed,
}

/// A joint and the body that it moves.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name, unique in its leg.
    pub name: Spanned<String>,
    /// Revolute, prismatic or fixed.
    pub kind: Spanned<JointKind>,
    /// The earlier joint that this joint's frame is described from; `None` for the leg's base.
    pub antecedent: Option<usize>,
    /// MDH γ.
    pub gamma: Spanned<Angle>,
    /// MDH b, m.
    pub b: Spanned<Number>,
    /// MDH α.
    pub alpha: Spanned<Angle>,
    /// MDH d, m.
    pub d: Spanned<Number>,
    /// MDH θ; for a revolute joint the constant part.
    pub theta: Spanned<Angle>,
    /// MDH r, m; for a prismatic joint the constant part.
    pub r: Spanned<Number>,
    /// The joint's variable, which adds to θ (revolute) or r (prismatic).
    ///
    /// It is a linear combination of the leg's independent joint variables. An independent joint
    /// has itself with factor one, a coupled joint has others (in rad or m per rad or m), a fixed
    /// joint none.
    pub variable: Vec<(usize, Ratio)>,
    /// Whether a motor drives the joint.
    pub actuated: bool,
    /// Location of `dependent = true`: a joint of a skeleton or branch whose position the chains
    /// determine.
    pub dependent: Option<Span>,
    /// Standard parameters of the body and the joint that are not absent, in order.
    pub parameters: Vec<StandardParameter>,
    /// Rough position at home, rad or m; zero for a coupled or fixed joint.
    pub home: Number,
    /// Gear ratio, rotor turns per unit of the variable, of a motor that moves other joints and
    /// carries no body.
    pub motor: Option<Number>,
    /// Position-dependent torque with an unknown coefficient.
    pub spring: Option<Spring>,
    /// Position-dependent torque that is known, N m or N, without a coefficient.
    pub known: Option<Formula>,
    /// Stribeck velocity of the joint's friction, rad/s or m/s.
    pub stribeck: Option<Number>,
    /// Load to which friction is proportional, with an unknown coefficient.
    pub load: Option<Spring>,
    /// Location of its table.
    pub span: Span,
}

impl Joint {
    /// The formula that multiplies one of its parameters, if there is one.
    pub(crate) fn formula_of(&self, symbol: StandardParameter) -> Option<&Spring> {
        match symbol {
            StandardParameter::K => self.spring.as_ref(),
            StandardParameter::Fl => self.load.as_ref(),
            _ => None,
        }
    }

    /// Whether its body is the payload of a robot without loops: a fixed joint named `payload`.
    #[must_use]
    pub fn is_payload(&self) -> bool {
        self.kind.value == JointKind::Fixed && self.name.value == "payload"
    }

    /// Whether the joint at `index` has a variable of its own.
    #[must_use]
    pub fn is_independent(&self, index: usize) -> bool {
        matches!(self.variable.as_slice(), [(own, _)] if *own == index)
    }
}

/// A payload on a body, which some runs carry.
#[derive(Debug, Clone, PartialEq)]
pub struct Payload {
    /// Name, unique in the robot.
    pub name: Spanned<String>,
    /// The body on which it is fixed.
    pub body: FrameBody,
    /// Its frame in the body's frame.
    pub placement: Placement,
    /// Inertial parameters about its frame that are not absent.
    pub parameters: Vec<StandardParameter>,
    /// Location of its table.
    pub span: Span,
}

/// A motor that drives a combination of joints of a robot with loops.
#[derive(Debug, Clone, PartialEq)]
pub struct Motor {
    /// Name, unique in its leg, or in the robot without one.
    pub name: Spanned<String>,
    /// The leg with whose shape it is described.
    pub leg: Option<usize>,
    /// Whether the combination is an angle or a length.
    pub kind: JointKind,
    /// The independent joints that it drives, with their factors.
    pub terms: Vec<MotorTerm>,
    /// Gear ratio, rotor turns per unit of the combination.
    pub ratio: Number,
    /// Parameters of rotor and friction, of the combination's rate.
    pub parameters: Vec<StandardParameter>,
    /// Stribeck velocity of the friction, rad/s or m/s.
    pub stribeck: Option<Number>,
    /// Location of its table.
    pub span: Span,
}

/// A joint that a motor drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotorTerm {
    /// The independent joint.
    pub joint: BodyIndex,
    /// Its factor in the combination.
    pub factor: Ratio,
}

/// All actuated joints, as leg and joint, leg by leg.
pub(crate) fn actuators(legs: &[Leg]) -> Vec<(usize, usize)> {
    let of_leg = |(index, leg): (usize, &Leg)| {
        let actuated = leg.joints.iter().enumerate().filter(|(_, j)| j.actuated);
        actuated
            .map(|(joint, _)| (index, joint))
            .collect::<Vec<_>>()
    };
    legs.iter().enumerate().flat_map(of_leg).collect()
}
