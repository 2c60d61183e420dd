//! What was chosen for a robot before its functions are derived: columns, actuators, forms.

use super::parameter::BodyParameter;
use crate::cas::Number;

/// What the derivation of a function needs beside the mechanism.
#[derive(Debug, Clone, Default)]
pub struct Selection {
    /// The standard parameters whose columns are not identically zero.
    pub standard: Vec<BodyParameter>,
    /// The independent ones among them.
    pub base: Vec<BodyParameter>,
    /// The payload's parameters whose columns are not identically zero.
    pub payload: Vec<BodyParameter>,
    /// Kept actuators of case 2.
    pub kept_actuators: Vec<usize>,
    /// How the robot is written.
    pub formulation: Formulation,
    /// Dependent columns that are had more cheaply from others than from their definition.
    pub combined: Vec<Combination>,
    /// How the joints follow from the pose. By Newton's method, programs from a pose or from
    /// actuators have the joints as an input, which [`Function::ClosureError`](overact_core::Function::ClosureError) and
    /// [`Function::LegsJacobian`](overact_core::Function::LegsJacobian) serve to find.
    pub joints: JointsBy,
    /// How the forces of several bodies are added up.
    pub dynamics: DynamicsBy,
    /// Values of the standard parameters and the payload's, where they are known: functions of given
    /// parameters have them as constants then, those that are missing as zero, and no such input.
    pub values: Option<Vec<(BodyParameter, f64)>>,
}

/// In which of several equal forms a robot is written; which needs the fewest operations depends on the
/// robot.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Formulation {
    /// The axes in which the closure of each leg is written: by number, a frame that is met on the way
    /// from the base along the leg; 0, and none, are the base's.
    pub stations: Vec<usize>,
    /// The axes in which a chain's closure sees the body that it ends on: by number, a frame that is met on the way
    /// from the body that it starts from, whose own axes are 0, and none. Where there are others, station 0 stands
    /// for them.
    pub seats: Vec<usize>,
    /// Whether axes that meet in a point share the moment about it.
    pub meeting: bool,
    /// Whether what acts on the joints of a chain goes to the skeleton as one force at the chain's end, rather than
    /// joint by joint. Legs of a platform always have it so.
    pub at_end: bool,
    /// Whether what acts on a platform that moves aside, whose independent coordinates turn it about fewer than three axes,
    /// meets these in the platform's own axes.
    pub own_axes: bool,
    /// Whether accelerations of what chains on the ground end on are taken less gravity, as those of bodies are.
    pub weighted: bool,
    /// Whether legs that end in a point lend masses there to what they end on, which leaves their last bodies fewer
    /// forces.
    pub lends: bool,
    /// Whether what the joints of legs on a platform that moves aside are per independent coordinate is told of the
    /// velocities of the legs' ends, which all joints of a leg share, rather than by way of the platform's six components.
    pub by_ends: bool,
    /// Whether rates of legs are taken from the independent rates by the rows of the reduced Jacobians, rather than
    /// from the velocities of what the legs end on.
    pub by_rows: bool,
    /// Whether the masses of last bodies whose frames stand at the ends of legs are masses at points of what the legs
    /// end on, in the identification model.
    pub masses_at_ends: bool,
    /// Whether sums that are known over a divisor are looked for, beside the directions of links in the axes in which
    /// closures are seen.
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

/// In which of two equal forms the forces of given parameters are written; which needs fewer operations
/// depends on the robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum DynamicsBy {
    /// Parameter by parameter, as the identification model is.
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
