//! Which columns of a file hold the time, the positions and the torques, and their units.

use overact::Code;
use overact::Info;
use serde::{Deserialize, Serialize};

use super::transmission::Transmission;
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

/// How the samples of a run follow one another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Time {
    /// The column of the time, s, which steps uniformly.
    Column(String),
    /// No column: one sample after the other at this frequency, Hz.
    Frequency(f64),
}

/// Columns of a text by name or number (`$1` is the first one), or variables of a `.mat` file (`q` for a vector, `q(:,2)` for a column
/// of a matrix, counted from 1 as in MATLAB).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// How the samples follow one another.
    pub time: Time,
    /// Positions of the n actuators.
    pub positions: Vec<String>,
    /// Torques, forces or drive signals of the n actuators.
    pub torques: Vec<String>,
    /// Velocities of the n actuators in the units of their positions and s, where they were measured; else
    /// empty. They take the place of differences of the positions.
    #[serde(default)]
    pub velocities: Vec<String>,
    /// Factors to rad or m, one per actuator (π/180 for degrees).
    pub position_scale: Vec<f64>,
    /// What is subtracted from the positions after that, rad or m, one per actuator: the offset of an
    /// encoder. Empty where all are zero.
    #[serde(default)]
    pub position_offset: Vec<f64>,
    /// Factors to N m or N, one per actuator.
    pub torque_gain: Vec<Gain>,
    /// The rate of uniform times at which the run is resampled, Hz; absent if its time is uniform.
    #[serde(default)]
    pub resample: Option<f64>,
    /// Where the columns are those of motors, the matrix T of their positions θ = T q, a row for each motor;
    /// their torques are τ = Tᵀ τ_θ at the joints. Empty where the columns are those of the actuated joints.
    #[serde(default)]
    pub transmission: Vec<Vec<f64>>,
    /// Whether each position is that of a rotating joint or motor: where it was logged within one turn, it is
    /// unwrapped. Empty where no position is to be unwrapped.
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
                Problem::new(Code::DATA_TABLE, "the mapping names no position").column("positions"),
            );
        }
        problems.extend(self.bad_factors());
        problems.extend(Transmission::new(&self.transmission, actuators).err());
        Error::check(problems)
    }

    /// A rate that is none, or for which there is no time.
    fn bad_rate(&self) -> Option<Problem> {
        let rate = self.resample?;
        let problem = |message: String| Problem::new(Code::DATA_TABLE, message).column("resample");
        if !(rate.is_finite() && rate > 0.0) {
            return Some(problem(format!("the run is to be resampled at {rate} Hz")));
        }
        matches!(self.time, Time::Frequency(_)).then(|| {
            let message = String::from(
                "a run without a column of the time is uniform and can't be resampled",
            );
            problem(message).help("leave out `resample`; `decimation` keeps fewer samples")
        })
    }

    /// Factors that lose a signal.
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
