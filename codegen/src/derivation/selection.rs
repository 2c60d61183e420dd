//! Choices for a robot before its functions are derived: columns, actuators, forms.

use super::parameter::BodyParameter;
use crate::cas::Number;

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
    /// For each leg, the axes in which its closure is written: the number of a frame on the path from the base along
    /// the leg. 0, and a missing number, are the base's axes.
    pub closure_frames: Vec<usize>,
    /// For each chain, the axes in which its closure sees the body at its end: the number of a frame on the path from
    /// the body at its start. 0, and a missing number, are the axes of that body. With another number, closure frame
    /// 0 means these axes.
    pub observer_frames: Vec<usize>,
    /// Whether axes that meet in a point share the moment about it.
    pub meeting: bool,
    /// Whether the forces of a chain act on the skeleton as one force at the chain's end, rather than joint by joint.
    /// For legs of a platform this is always so.
    pub at_end: bool,
    /// Whether forces on a platform with parasitic motion are projected in the platform's axes. It pays if the
    /// independent coordinates turn the platform about fewer than three axes.
    pub own_axes: bool,
    /// Whether gravity is an acceleration of the ground in the closures of chains, as it is for bodies.
    pub gravity_as_acceleration: bool,
    /// Whether a leg that ends in a point lumps a mass of its last body there, which leaves that body fewer forces.
    pub lump_end_masses: bool,
    /// Whether the joint rates of legs on a platform with parasitic motion are derived from the velocity of the leg's
    /// end, which all joints share, rather than from the six components of the platform's velocity.
    pub by_ends: bool,
    /// Whether leg rates are the rows of the reduced Jacobian times the independent rates, rather than products with
    /// the velocity of the leg's end.
    pub by_rows: bool,
    /// Whether, in the identification model, the mass of a last body whose frame is at the leg's end is a mass point of
    /// the body at which the leg ends.
    pub masses_at_ends: bool,
    /// Whether sums are searched that are known over a divisor, such as directions of links in the observer's axes.
    pub over_divisors: bool,
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
