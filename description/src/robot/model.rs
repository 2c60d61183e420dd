//! The robot that a description gives, evaluated: one value per placement, lengths in m, masses in kg.

use crate::diagnostic::Span;
pub use crate::diagnostic::Spanned;
use crate::expressions::formula::{Formula, Spring};
use overact_core::StandardParameter;
use overact_exact::{Angle, Number, Ratio};

/// A motion that a platform can have. Axes are 0, 1, 2 for x, y, z of the base frame.
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
    /// A free body whose legs block some directions, which change with the pose: it moves aside while it
    /// moves, and only these of x, y, z, rx, ry, rz are independent.
    Parasitic {
        /// Whether each of the six is independent.
        independent: [bool; 6],
    },
}

const AXES: [&str; 3] = ["x", "y", "z"];
/// The coordinates of a free body.
pub const SIX: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl Motion {
    /// Names of the coordinates that a description gives: translations, then `phi` or `rx`, `ry`,
    /// `rz`. Their number is r, the number of degrees of freedom.
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

    /// The motion of a pose's numbers: of a platform that moves aside that of a free body.
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
    /// Which motion it has.
    pub motion: Spanned<Motion>,
    /// The point of a fixed axis where the platform's origin is at zero, m; zero for other motions.
    pub axis_at: [Number; 3],
    /// The home pose.
    pub home: PlatformHome,
    /// How many actuators more than coordinates the robot is meant to have, if that is said.
    pub redundancy: Option<Spanned<usize>>,
    /// Its inertial parameters that are not absent.
    pub parameters: Vec<StandardParameter>,
    /// Inertial parameters of the payload, if the robot may carry one.
    pub payload: Option<Vec<StandardParameter>>,
    /// Place of its table.
    pub span: Span,
}

/// The platform's home pose; coordinates that its motion has not are zero.
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

/// A body of a leg: that behind one of its joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BodyIndex {
    /// The leg, in the order of their places.
    pub leg: usize,
    /// The joint in its leg.
    pub joint: usize,
}

/// A placed leg.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Name, unique in the robot.
    pub name: Spanned<String>,
    /// Number of its shape in the order of the file: legs written once and placed several times
    /// share it.
    pub shape: usize,
    /// Name of its shape.
    pub shape_name: String,
    /// The leg's base frame in the robot's base frame.
    pub base: Placement,
    /// The joints; antecedents come first.
    pub joints: Vec<Joint>,
    /// Where the leg ends on the platform, or on a body; `None` for a tree.
    pub end: Option<Spanned<End>>,
    /// The body of the skeleton, or of a chain before, that the leg starts from; `None` for the ground.
    pub base_body: Option<BodyIndex>,
    /// The body of the skeleton, or of a chain before, that the leg ends on; `None` for the platform.
    pub end_body: Option<BodyIndex>,
    /// Place of its `[[place]]`.
    pub span: Span,
}

/// How a leg ends on the platform.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// The last frame is fixed on the platform, at this placement in the platform frame.
    Rigid(Placement),
    /// The last frame's origin coincides with a point of the platform.
    Point {
        /// The point in the platform frame, m.
        at: [Number; 3],
        /// Along which axes of the robot's base frame it does. Where it does not, the leg's end may
        /// slide.
        along: [bool; 3],
    },
}

impl End {
    /// The platform point that the last frame's origin meets, in the platform frame, m.
    #[must_use]
    pub const fn point(&self) -> [Number; 3] {
        match self {
            Self::Rigid(placement) => placement.at,
            Self::Point { at, .. } => *at,
        }
    }

    /// The components of the six-vector (position, orientation) in the base frame that the last frame
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

/// A joint and the body behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Name, unique in its leg.
    pub name: Spanned<String>,
    /// Revolute, prismatic or fixed.
    pub kind: Spanned<JointKind>,
    /// The joint whose frame this one starts from, an earlier one; `None` for the leg's base.
    pub antecedent: Option<usize>,
    /// MDH γ.
    pub gamma: Spanned<Angle>,
    /// MDH b, m.
    pub b: Spanned<Number>,
    /// MDH α.
    pub alpha: Spanned<Angle>,
    /// MDH d, m.
    pub d: Spanned<Number>,
    /// MDH θ; for a revolute joint its constant part.
    pub theta: Spanned<Angle>,
    /// MDH r, m; for a prismatic joint its constant part.
    pub r: Spanned<Number>,
    /// The joint's variable, which adds to θ (revolute) or r (prismatic), as a linear combination
    /// of the independent joint variables of the leg: itself with factor one, or others for a
    /// dependent joint (in rad or m per rad or m). Empty for a fixed joint.
    pub variable: Vec<(usize, Ratio)>,
    /// Whether a motor drives the joint.
    pub actuated: bool,
    /// The body's and the joint's standard parameters that are not absent, in order.
    pub parameters: Vec<StandardParameter>,
    /// Rough position at home, rad or m; zero for a dependent or fixed joint.
    pub home: Number,
    /// Of a motor that turns other joints, and carries no body, its gear ratio: turns of the rotor for one of
    /// the variable.
    pub motor: Option<Number>,
    /// What the position adds to its torque, with an unknown coefficient.
    pub spring: Option<Spring>,
    /// The torque of its position that is known, N m or N, without any coefficient.
    pub known: Option<Formula>,
    /// The Stribeck velocity of its friction, rad/s or m/s.
    pub stribeck: Option<Number>,
    /// The load in proportion to which it has friction, with an unknown coefficient.
    pub load: Option<Spring>,
    /// Place of its table.
    pub span: Span,
}

impl Joint {
    /// What one of its parameters multiplies that is described as a formula, if it does.
    pub(crate) fn formula_of(&self, symbol: StandardParameter) -> Option<&Spring> {
        match symbol {
            StandardParameter::K => self.spring.as_ref(),
            StandardParameter::Fl => self.load.as_ref(),
            _ => None,
        }
    }

    /// Whether the joint at `index` has a variable of its own.
    #[must_use]
    pub fn is_independent(&self, index: usize) -> bool {
        matches!(self.variable.as_slice(), [(own, _)] if *own == index)
    }
}

/// All actuators, as leg and joint, leg by leg.
pub(crate) fn actuators(legs: &[Leg]) -> Vec<(usize, usize)> {
    let of_leg = |(index, leg): (usize, &Leg)| {
        let actuated = leg.joints.iter().enumerate().filter(|(_, j)| j.actuated);
        actuated
            .map(|(joint, _)| (index, joint))
            .collect::<Vec<_>>()
    };
    legs.iter().enumerate().flat_map(of_leg).collect()
}
