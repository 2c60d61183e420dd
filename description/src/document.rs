//! The whole of a description, evaluated.

use crate::effort::Effort;
use crate::experiments::controller::Controller;
use crate::experiments::data::Data;
use crate::experiments::excitation::Excitation;
use crate::experiments::experiment::Experiment;
use crate::experiments::prior::Prior;
use crate::experiments::settings::Identification;
use crate::robot::model::{Leg, Platform, Spanned, actuators};
use overact_exact::Number;

/// A robot as its author describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// Name; letters, digits and underscores.
    pub name: Spanned<String>,
    /// One sentence.
    pub summary: String,
    /// Where the numbers come from.
    pub source: String,
    /// How hard the generator searches for fewer operations; `None` leaves it to whoever generates.
    pub effort: Option<Effort>,
    /// Which columns stand for the base parameters; `None` leaves it to the kind of robot.
    pub base_columns: Option<BaseColumns>,
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: [Number; 3],
    /// Names of the payloads, where there are several.
    pub payloads: Vec<Spanned<String>>,
    /// The named constants that are no angles, in SI units.
    pub constants: Vec<(String, f64)>,
    /// The platform; `None` for a serial or tree robot.
    pub platform: Option<Platform>,
    /// The legs in the order of their placement.
    pub legs: Vec<Leg>,
    /// The virtual experiment.
    pub experiment: Option<Experiment>,
    /// What a search of exciting trajectories keeps to.
    pub excitation: Option<Excitation>,
    /// How a measured log maps on the robot.
    pub data: Option<Data>,
    /// The loops with which measured runs were made.
    pub controller: Option<Controller>,
    /// What is believed of the parameters before data speak.
    pub prior: Prior,
    /// Settings of the identification.
    pub identification: Identification,
    /// What the text says that may not be meant, in the order of the text: numbers without a unit that are
    /// those of another one, for instance.
    pub doubts: Vec<Spanned<String>>,
}

/// Which independent columns stand for the base parameters, among choices of equal rank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BaseColumns {
    /// The platform's first, then each parameter of all legs together, eq. (43): the same ones in legs
    /// that are alike.
    Symmetric,
    /// Those that take the fewest operations.
    Cheapest,
}

impl BaseColumns {
    /// All, with their names in descriptions.
    pub const ALL: [(&'static str, Self); 2] =
        [("symmetric", Self::Symmetric), ("cheapest", Self::Cheapest)];
}

impl Description {
    /// The name as a Rust type: `dual_v` becomes `DualV`.
    #[must_use]
    pub fn type_name(&self) -> String {
        type_name(&self.name.value)
    }

    /// All actuators, as leg and joint, leg by leg: the order of q and τ.
    #[must_use]
    pub fn actuators(&self) -> Vec<(usize, usize)> {
        actuators(&self.legs)
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
