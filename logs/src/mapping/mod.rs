//! Columns of time, positions and torques in a file, and their units.

pub(crate) mod expression;
pub(crate) mod load;
pub(crate) mod scales;
pub(crate) mod transmission;

use overact::Code;
use overact::Info;
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Problem},
    mapping::transmission::Transmission,
};

/// The factor that turns a torque column into N m or N, for instance a drive gain in N/V.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Gain {
    /// A number.
    Value(f64),
    /// The name of a scalar variable of the `.mat` file.
    Variable(String),
}

/// Timing of the samples of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Time {
    /// The column of the time, s, with uniform steps.
    Column(String),
    /// No column: uniform samples at this frequency, Hz.
    Frequency(f64),
}

/// Assignment of columns to time, positions and torques.
///
/// Columns of a text have names or numbers (`$1` is the first one). Variables of a `.mat` file are
/// `q` for a vector and `q(:,2)` for a matrix column, counted from 1 as in MATLAB.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// Timing of the samples.
    pub time: Time,
    /// Positions of the n actuators.
    pub positions: Vec<String>,
    /// Torques, forces or drive signals of the n actuators.
    pub torques: Vec<String>,
    /// Measured velocities of the n actuators, or empty.
    ///
    /// In the units of the positions per second. They replace differences of the positions.
    #[serde(default)]
    pub velocities: Vec<String>,
    /// Factors to rad or m, one per actuator (π/180 for degrees).
    pub position_scale: Vec<f64>,
    /// Offsets subtracted from the scaled positions, rad or m, one per actuator.
    ///
    /// Empty if all are zero.
    #[serde(default)]
    pub position_offset: Vec<f64>,
    /// Factors to N m or N, one per actuator.
    pub torque_gain: Vec<Gain>,
    /// Rate for resampling a non-uniform run, Hz; `None` if its time is uniform.
    #[serde(default)]
    pub resample: Option<f64>,
    /// Transmission matrix T if the columns are those of motors, one row per motor.
    ///
    /// Motor positions are θ = T q, and joint torques τ = Tᵀ τ_θ. Empty if the columns are those of
    /// the actuated joints.
    #[serde(default)]
    pub transmission: Vec<Vec<f64>>,
    /// Whether each position is that of a rotating joint or motor.
    ///
    /// Rotating positions logged within one turn are unwrapped. Empty if none is to be unwrapped.
    #[serde(default)]
    pub rotating: Vec<bool>,
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
            time: Time::Column(String::from("time")),
            positions: named("q_"),
            torques: named("tau_"),
            velocities: Vec::new(),
            position_scale: vec![1.0; info.actuators.len()],
            position_offset: Vec::new(),
            torque_gain: vec![Gain::Value(1.0); info.actuators.len()],
            resample: None,
            transmission: Vec::new(),
            rotating: info.actuator_is_revolute.to_vec(),
        }
    }

    /// Checks the lengths of the lists and the factors.
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
                    Problem::new(
                        Code::DATA_TABLE,
                        format!(
                            "the mapping names {actuators} positions, but `{name}` has {found} {}",
                            if found == 1 { "entry" } else { "entries" }
                        ),
                    )
                    .column(name)
                    .help("give one entry per actuator"),
                );
            }
        }
        let optional = [
            ("position_offset", self.position_offset.len()),
            ("velocities", self.velocities.len()),
        ];
        for (name, found) in optional.into_iter().filter(|(_, found)| *found > 0) {
            if found != actuators {
                let message = format!(
                    "the mapping names {actuators} positions, but `{name}` has {found} {}",
                    if found == 1 { "entry" } else { "entries" }
                );
                let problem = Problem::new(Code::DATA_TABLE, message).column(name);
                problems.push(problem.help("give one entry per actuator, or none"));
            }
        }
        let offsets = &self.position_offset;
        for offset in offsets.iter().filter(|offset| !offset.is_finite()) {
            let message = format!("an offset of `position_offset` is {offset}");
            problems.push(Problem::new(Code::DATA_TABLE, message).column("position_offset"));
        }
        if let Time::Frequency(frequency) = self.time
            && !(frequency.is_finite() && frequency > 0.0)
        {
            let message = format!("the sampling frequency is {frequency} Hz");
            problems.push(Problem::new(Code::DATA_TABLE, message).column("sampling"));
        }
        problems.extend(self.bad_rate());
        if actuators == 0 {
            problems.push(
                Problem::new(Code::DATA_TABLE, "the mapping has no position").column("positions"),
            );
        }
        problems.extend(self.bad_factors());
        problems.extend(Transmission::new(&self.transmission, actuators).err());
        Error::check(problems)
    }

    /// The problem of an invalid rate, or of a rate without a time column.
    fn bad_rate(&self) -> Option<Problem> {
        let rate = self.resample?;
        let problem = |message: String| Problem::new(Code::DATA_TABLE, message).column("resample");
        if !(rate.is_finite() && rate > 0.0) {
            return Some(problem(format!("the run can't be resampled at {rate} Hz")));
        }
        matches!(self.time, Time::Frequency(_)).then(|| {
            let message = String::from(
                "a run without a column of the time is uniform and can't be resampled",
            );
            problem(message).help("leave out `resample`; `decimation` keeps fewer samples")
        })
    }

    /// The problems of factors that are zero or not finite.
    fn bad_factors(&self) -> Vec<Problem> {
        let gains = self.torque_gain.iter().filter_map(|gain| match gain {
            Gain::Value(value) => Some(("torque_gain", *value)),
            Gain::Variable(_) => None,
        });
        let scales = self.position_scale.iter();
        let scales = scales.map(|scale| ("position_scale", *scale));
        let bad = |(_, value): &(&str, f64)| !value.is_finite() || *value == 0.0;
        let problem = |(name, value): (&str, f64)| {
            Problem::new(Code::DATA_TABLE, format!("a factor of `{name}` is {value}"))
                .column(name)
                .help("give the number by which the column is to be multiplied")
        };
        gains.chain(scales).filter(bad).map(problem).collect()
    }
}
