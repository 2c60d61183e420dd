//! Choices for a robot before its functions are derived: columns, actuators, forms.

use super::parameter::BodyParameter;
use crate::cas::Number;
use crate::cas::jacobian::Order;

/// The choices that the derivation of a function needs in addition to the mechanism.
#[derive(Debug, Clone, Default)]
pub struct Selection {
    /// The standard parameters whose columns are not identically zero.
    pub standard: Vec<BodyParameter>,
    /// The independent ones among them.
    pub base: Vec<BodyParameter>,
    /// The payload's parameters whose columns are not identically zero.
    pub payload: Vec<BodyParameter>,
    /// Kept actuators of the actuator projection.
    pub kept_actuators: Vec<usize>,
    /// The form of the robot's equations.
    pub formulation: Formulation,
    /// Dependent columns that are cheaper as combinations of others than from their definition.
    pub combined: Vec<Combination>,
    /// How the joints follow from the pose.
    ///
    /// With Newton's method, programs of a pose or of actuators have the joints as an input. They
    /// are found with [`Function::ClosureError`](overact_core::Function::ClosureError) and
    /// [`Function::LegsJacobian`](overact_core::Function::LegsJacobian).
    pub joints: JointsBy,
    /// Form in which the forces of several bodies are summed.
    pub dynamics: DynamicsBy,
    /// Known values of the standard and payload parameters.
    ///
    /// Functions of given parameters then contain them as constants, missing ones as zero, and have
    /// no such input.
    pub values: Option<Vec<(BodyParameter, f64)>>,
}

/// One of several equivalent forms of a robot's equations.
///
/// Which form needs the fewest operations depends on the robot.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Formulation {
    /// For each leg, the index of the axes in which its closure is written.
    ///
    /// It counts the frames on the path from the base along the leg. 0, also for a missing entry,
    /// is the base.
    pub closure_frames: Vec<usize>,
    /// For each chain, the index of the observer's axes, in which its closure expresses the end
    /// body.
    ///
    /// It counts the frames on the path from the body at the chain's start. 0, also for a missing
    /// entry, is that body. With another index, closure frame 0 means the observer's axes.
    pub observer_frames: Vec<usize>,
    /// Whether axes that meet in a point share the moment about it.
    pub meeting: bool,
    /// Whether the forces of a chain act on the skeleton as one force at the chain's end, not joint
    /// by joint.
    ///
    /// For legs of a platform this is always so.
    pub at_end: bool,
    /// Whether forces on a platform with parasitic motion are projected in the platform's axes.
    ///
    /// This saves operations if the independent coordinates rotate the platform about fewer than
    /// three axes.
    pub own_axes: bool,
    /// Whether gravity is an acceleration of the ground in the closures of chains, as it is for bodies.
    pub gravity_as_acceleration: bool,
    /// Whether a leg that ends in a point lumps a mass of its last body there, which leaves that body fewer forces.
    pub lump_end_masses: bool,
    /// Whether joint rates of legs on a platform with parasitic motion follow from the velocity of
    /// the leg's end.
    ///
    /// All joints share that velocity. Otherwise they follow from the six components of the
    /// platform's velocity.
    pub by_ends: bool,
    /// Whether leg rates are the rows of the reduced Jacobian times the independent rates.
    ///
    /// Otherwise they are products with the velocity of the leg's end.
    pub by_rows: bool,
    /// Whether a mass at a leg's end is a mass point of the end body, in the identification model.
    ///
    /// It applies to the mass of a last body whose frame is at the leg's end.
    pub masses_at_ends: bool,
    /// Whether sums are searched as known expressions over a divisor, such as link directions in
    /// observer's axes.
    pub over_divisors: bool,
    /// Order in which derivatives of the dynamics eliminate intermediate quantities.
    pub elimination: Order,
}

/// A column as a linear combination of other columns.
#[derive(Debug, Clone)]
pub struct Combination {
    /// The parameter whose column it is.
    pub parameter: BodyParameter,
    /// The other columns with their coefficients.
    pub of: Vec<(BodyParameter, Number)>,
}

/// How the joints follow from the pose.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum JointsBy {
    /// In closed form, as part of the function.
    #[default]
    Rule,
    /// By Newton's method, before the function is evaluated: joints are an input of the program.
    Newton,
}

/// Form in which the forces of given parameters are summed.
///
/// Both are equivalent; which needs fewer operations depends on the robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum DynamicsBy {
    /// Parameter by parameter, as in the identification model.
    #[default]
    Parameters,
    /// Body by body, summed from the tips to the base.
    Bodies,
}

impl DynamicsBy {
    /// The other form.
    pub(crate) const fn other(self) -> Self {
        match self {
            Self::Parameters => Self::Bodies,
            Self::Bodies => Self::Parameters,
        }
    }
}
