//! A complete description, evaluated.

use crate::effort::Effort;
use crate::experiments::controller::Controller;
use crate::experiments::data::Data;
use crate::experiments::excitation::Excitation;
use crate::experiments::experiment::Experiment;
use crate::experiments::prior::Prior;
use crate::experiments::settings::Identification;
use crate::experiments::stribeck;
use crate::robot::model::{Frame, Leg, Motor, Payload, Platform, Spanned, actuators};
use crate::robot::point_spring::PointSpring;
use overact_exact::Number;

/// A robot as its author describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// Name; letters, digits and underscores.
    pub name: Spanned<String>,
    /// One sentence.
    pub summary: String,
    /// Origin of the numbers.
    pub source: String,
    /// Effort of the search for fewer operations; `None` for the generator's default.
    pub effort: Option<Effort>,
    /// Choice of the base parameters' columns; `None` for the default of the kind of robot.
    pub base_columns: Option<BaseColumns>,
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: [Number; 3],
    /// Names of the payloads, if there are several.
    pub payloads: Vec<Spanned<String>>,
    /// Payloads on bodies, whose names are the above.
    pub payload_bodies: Vec<Payload>,
    /// Named constants that are not angles, in SI units.
    pub constants: Vec<(String, f64)>,
    /// Magnitudes of all numbers of platform and legs that are written without a name, in SI units,
    /// sorted.
    ///
    /// If one of them equals a constant, generated code does not use the constant's name.
    pub magnitudes: Vec<f64>,
    /// The platform; `None` for a serial or tree robot.
    pub platform: Option<Platform>,
    /// The legs in the order of their placement.
    pub legs: Vec<Leg>,
    /// Motors of a robot with loops that drive combinations of joints.
    ///
    /// Those of a robot without loops are coupled joints of its leg.
    pub motors: Vec<Motor>,
    /// Springs and dampers between two points.
    pub springs: Vec<PointSpring>,
    /// Frames on bodies, in the order of the file.
    pub frames: Vec<Frame>,
    /// The virtual experiment.
    pub experiment: Option<Experiment>,
    /// Limits of the search for exciting trajectories.
    pub excitation: Option<Excitation>,
    /// Mapping of measured logs to the robot.
    pub data: Option<Data>,
    /// Controller of measured runs.
    pub controller: Option<Controller>,
    /// Prior knowledge of the parameters.
    pub prior: Prior,
    /// Settings of the identification.
    pub identification: Identification,
    /// Warnings about text that is probably not intended, sorted by location.
    ///
    /// Examples are numbers without a unit that would fit another unit.
    pub warnings: Vec<Spanned<String>>,
}

/// Choice of the columns that represent the base parameters, among sets of equal rank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BaseColumns {
    /// Those of the platform first, then each parameter of all legs together, eq. (43).
    ///
    /// Equal legs then have the same ones.
    Symmetric,
    /// Those with the fewest operations.
    Cheapest,
}

impl BaseColumns {
    /// All choices, with their names in descriptions.
    pub const ALL: [(&'static str, Self); 2] =
        [("symmetric", Self::Symmetric), ("cheapest", Self::Cheapest)];
}

impl Description {
    /// Name of the Rust type: `dual_v` becomes `DualV`.
    #[must_use]
    pub fn type_name(&self) -> String {
        type_name(&self.name.value)
    }

    /// All actuated joints, as leg and joint, leg by leg: the order of q and τ, before the motors.
    #[must_use]
    pub fn actuators(&self) -> Vec<(usize, usize)> {
        actuators(&self.legs)
    }

    /// Whether a joint or motor has Stribeck friction.
    #[must_use]
    pub fn has_stribeck(&self) -> bool {
        stribeck::is_present(&self.legs, &self.motors)
    }
}

/// A name as a Rust type.
pub(crate) fn type_name(name: &str) -> String {
    let word = |word: &str| {
        let mut letters = word.chars();
        let first = letters.next().map(|c| c.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    };
    name.split('_').map(word).collect()
}
