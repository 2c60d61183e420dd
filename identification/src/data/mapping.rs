//! Which columns of a file hold the time, the positions and the torques, and their units.

use overact::Info;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Problem};

/// The factor that turns a torque column into N m or N, for instance a drive gain in N/V.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Gain {
    /// A number.
    Value(f64),
    /// The name of a scalar variable of the `.mat` file.
    Variable(String),
}

/// Columns of a CSV file, or variables of a `.mat` file (`q` for a vector, `q(:,2)` for a column
/// of a matrix, counted from 1 as in MATLAB).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// Time, s.
    pub time: String,
    /// Positions of the n actuators.
    pub positions: Vec<String>,
    /// Torques, forces or drive signals of the n actuators.
    pub torques: Vec<String>,
    /// Factors to rad or m, one per actuator (π/180 for degrees).
    pub position_scale: Vec<f64>,
    /// What is subtracted from the positions after that, rad or m, one per actuator: the offset of an
    /// encoder. Empty where all are zero.
    #[serde(default)]
    pub position_offset: Vec<f64>,
    /// Factors to N m or N, one per actuator.
    pub torque_gain: Vec<Gain>,
}

impl Mapping {
    /// The columns `time`, `q_<actuator>` and `tau_<actuator>`, in SI units.
    #[must_use]
    pub fn for_robot(info: &Info<'_>) -> Self {
        let named = |prefix: &str| -> Vec<String> {
            info.actuators
                .iter()
                .map(|name| format!("{prefix}{name}"))
                .collect()
        };
        Self {
            time: String::from("time"),
            positions: named("q_"),
            torques: named("tau_"),
            position_scale: vec![1.0; info.actuators.len()],
            position_offset: Vec::new(),
            torque_gain: vec![Gain::Value(1.0); info.actuators.len()],
        }
    }

    /// Checks that the lists have one entry per actuator and that factors are numbers.
    ///
    /// # Errors
    /// Every list of a wrong length and every factor that is zero or not finite.
    pub fn check(&self) -> Result<(), Error> {
        let actuators = self.positions.len();
        let mut problems = Vec::new();
        let lists = [
            ("torques", self.torques.len()),
            ("position_scale", self.position_scale.len()),
            ("torque_gain", self.torque_gain.len()),
        ];
        for (name, found) in lists {
            if found != actuators {
                problems.push(
                    Problem::new(format!(
                        "the mapping names {actuators} positions, but `{name}` has {found} {}",
                        if found == 1 { "entry" } else { "entries" }
                    ))
                    .column(name)
                    .help("give one entry per actuator"),
                );
            }
        }
        let offsets = &self.position_offset;
        if !offsets.is_empty() && offsets.len() != actuators {
            let found = offsets.len();
            let message = format!(
                "the mapping names {actuators} positions, but `position_offset` has {found} {}",
                if found == 1 { "entry" } else { "entries" }
            );
            let problem = Problem::new(message).column("position_offset");
            problems.push(problem.help("give one entry per actuator, or none"));
        }
        for offset in offsets.iter().filter(|offset| !offset.is_finite()) {
            let message = format!("an offset of `position_offset` is {offset}");
            problems.push(Problem::new(message).column("position_offset"));
        }
        if actuators == 0 {
            problems.push(Problem::new("the mapping names no position").column("positions"));
        }
        let gains = self.torque_gain.iter().filter_map(|gain| match gain {
            Gain::Value(value) => Some(("torque_gain", *value)),
            Gain::Variable(_) => None,
        });
        let scales = self
            .position_scale
            .iter()
            .map(|scale| ("position_scale", *scale));
        for (name, value) in gains.chain(scales) {
            if !value.is_finite() || value == 0.0 {
                problems.push(
                    Problem::new(format!("a factor of `{name}` is {value}"))
                        .column(name)
                        .help("give the number by which the column is to be multiplied"),
                );
            }
        }
        Error::check(problems)
    }

    /// All names that the file must have: time, positions, torques.
    pub(super) fn names(&self) -> Vec<&str> {
        std::iter::once(self.time.as_str())
            .chain(self.positions.iter().map(String::as_str))
            .chain(self.torques.iter().map(String::as_str))
            .collect()
    }
}
