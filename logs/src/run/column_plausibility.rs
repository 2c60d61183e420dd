//! Checks whether columns can be the signals that the mapping assigns to them.
//!
//! It finds swapped positions and torques, one column with two meanings, and wrong velocities. The
//! checks use the numbers only, and only fail in clear cases.

use overact::Code;

use crate::{
    display_names::called,
    error::{Error, Problem},
    run::log::Log,
    significant,
};

/// Number of samples at the start of a run that are checked.
const LOOKED_AT: usize = 1 << 16;

/// Noise of positions, by their standard deviation, that no smooth motion has.
const ROUGH: f64 = 1e-3;

/// Ratio of the positions' roughness to the torques' that proves a swap.
///
/// Torques contain the accelerations, so they are rougher: by 500 to 20000 times in measured logs.
const ROUGHER: f64 = 100.0;

/// Two columns are equal if a factor and an offset transform one into the other to this fraction.
const SAME: f64 = 1e-9;

/// Pieces of a run over which velocities are integrated, and the fewest for a check.
const PIECES: usize = 1000;
const LEAST_PIECES: usize = 20;

/// Smallest ratio of the steps of positions over these pieces to their noise.
const ABOVE_NOISE: f64 = 20.0;

/// Correlation with the steps of the positions below which velocities are wrong.
const UNLIKE: f64 = 0.5;

/// Correlation from which on the factor between both is certain.
const LIKE: f64 = 0.95;

/// Factor between both beyond which velocities have another unit.
const OTHER_UNIT: f64 = 1.5;

impl Log {
    /// Checks that positions, torques and velocities can be what the mapping says.
    ///
    /// `actuators` are the names of the actuators.
    ///
    /// # Errors
    /// Positions and torques that look swapped, columns with two meanings, velocities that do not
    /// belong to the positions; a file that cannot be read any more.
    pub fn check_column_plausibility(&self, actuators: &[&str]) -> Result<(), Error> {
        let samples = self.first_samples(LOOKED_AT)?;
        let names: Vec<String> = actuators.iter().map(|name| called(name)).collect();
        let found = Columns {
            positions: columns(&samples.positions, self.actuators()),
            torques: columns(&samples.torques, self.actuators()),
            velocities: columns(&samples.velocities, self.actuators()),
            names,
            frequency: self.sampling_frequency(),
        };
        let problems = found.problems().into_iter();
        Error::check(problems.map(|problem| problem.file(self.name())).collect())
    }
}

/// Splits interleaved signals.
fn columns(values: &[f64], width: usize) -> Vec<Vec<f64>> {
    if values.is_empty() {
        return Vec::new();
    }
    let column = |place: usize| values.iter().skip(place).step_by(width).copied().collect();
    (0..width).map(column).collect()
}

/// Signals of a run.
struct Columns {
    positions: Vec<Vec<f64>>,
    torques: Vec<Vec<f64>>,
    velocities: Vec<Vec<f64>>,
    names: Vec<String>,
    /// Sampling frequency f_m, Hz.
    frequency: f64,
}

impl Columns {
    /// Contradictions to the assigned meanings.
    fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let same = self.all(&self.torques, |place| {
            is_same(&self.positions[place], &self.torques[place])
        });
        if !same.is_empty() {
            let message = format!("torque and position are the same column: {same}");
            let problem = Problem::new(Code::SAME_COLUMN, message).column("torques");
            problems.push(problem.help(
                "name columns of torques, forces or currents in `torques` of [data], or give the other file",
            ));
        } else {
            problems.extend(self.exchanged());
        }
        problems.extend(self.velocities_of_others());
        problems
    }

    /// Names of the actuators for which `is_so` holds; empty without such signals.
    fn all(&self, signals: &[Vec<f64>], is_so: impl Fn(usize) -> bool) -> String {
        let places = (0..signals.len().min(self.positions.len())).filter(|place| is_so(*place));
        let names = places.filter_map(|place| self.names.get(place).map(String::as_str));
        names.collect::<Vec<_>>().join(", ")
    }

    /// The problem if positions are noise and torques are smooth, for every actuator.
    fn exchanged(&self) -> Option<Problem> {
        let pairs = self.positions.iter().zip(&self.torques);
        let rough: Option<Vec<(f64, f64)>> = pairs
            .map(|(position, torque)| Some((roughness(position)?, roughness(torque)?)))
            .collect();
        let rough = rough.filter(|all| !all.is_empty())?;
        let (position, torque) = *rough
            .iter()
            .min_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
        let exchanged =
            |&(position, torque): &(f64, f64)| position > ROUGH && position > ROUGHER * torque;
        if !rough.iter().all(exchanged) {
            return None;
        }
        let percent = |part: f64| significant(100.0 * part, 2);
        let message = format!(
            "positions and torques look exchanged: from sample to sample positions jump by {} % of their standard deviation or more, torques by {} %",
            percent(position),
            percent(torque)
        );
        let problem = Problem::new(Code::LOG_COLUMNS, message).column("positions");
        Some(
            problem.help("exchange `positions` and `torques` in [data], or the order of the files"),
        )
    }

    /// The problems of velocities whose integrals are not the steps of the positions.
    fn velocities_of_others(&self) -> Vec<Problem> {
        let tell = |names: &str, message: String, help: &str| {
            let problem = Problem::new(Code::LOG_COLUMNS, message).column("velocities");
            (!names.is_empty()).then(|| problem.help(help))
        };
        let same = |place: usize| is_same(&self.positions[place], &self.velocities[place]);
        let fit = |place: usize| {
            let (position, velocity) = (&self.positions[place], &self.velocities[place]);
            fit(position, velocity, self.frequency).filter(|_| !same(place))
        };
        let fits: Vec<Option<Fit>> = (0..self.velocities.len()).map(fit).collect();
        let is = |place: usize, of: &dyn Fn(&Fit) -> bool| fits[place].as_ref().is_some_and(of);
        let unlike = |fit: &Fit| fit.correlation.abs() < UNLIKE;
        let scaled = |fit: &Fit| {
            fit.correlation.abs() > LIKE && !(1.0 / OTHER_UNIT..OTHER_UNIT).contains(&fit.factor)
        };
        let identical = self.all(&self.velocities, same);
        let others = self.all(&self.velocities, |place| is(place, &unlike));
        let of_other_unit = self.all(&self.velocities, |place| is(place, &scaled));
        let factor = fits
            .iter()
            .flatten()
            .find(|fit| scaled(fit))
            .map_or(1.0, |fit| fit.factor);
        let without = "name columns of velocities in `velocities` of [data], or leave the key out: velocities are then differences of the positions";
        let all = [
            tell(
                &identical,
                format!("velocity and position are the same column: {identical}"),
                without,
            ),
            tell(
                &others,
                format!("the velocities are not the derivatives of the positions: {others}"),
                without,
            ),
            tell(
                &of_other_unit,
                format!(
                    "the velocities are {} times what the positions give: {of_other_unit}",
                    significant(factor, 3)
                ),
                "check unit and sign of the columns (scaled by `position_scale`), and the time or `sampling`",
            ),
        ];
        all.into_iter().flatten().collect()
    }
}

/// Relation of velocities to positions.
struct Fit {
    correlation: f64,
    /// Velocities divided by rates of the positions.
    factor: f64,
}

/// Fits integrated velocities to steps of positions; `None` if the steps are mostly noise.
fn fit(positions: &[f64], velocities: &[f64], frequency: f64) -> Option<Fit> {
    let length = (positions.len() / PIECES).max(8);
    let pieces = positions.len().checked_sub(1)? / length;
    if pieces < LEAST_PIECES {
        return None;
    }
    let (mut steps, mut sums, mut both) = (0.0, 0.0, 0.0);
    for piece in 0..pieces {
        let (first, behind) = (piece * length, (piece + 1) * length);
        let step = positions[behind] - positions[first];
        // Trapezoidal rule.
        let inside: f64 = velocities[first + 1..behind].iter().sum();
        let sum = (inside + 0.5 * (velocities[first] + velocities[behind])) / frequency;
        steps += step * step;
        sums += sum * sum;
        both += step * sum;
    }
    let size = (steps / pieces as f64).sqrt();
    if !(size > 0.0 && size > ABOVE_NOISE * noise(positions)) {
        return None;
    }
    Some(Fit {
        correlation: if sums > 0.0 {
            both / (steps * sums).sqrt()
        } else {
            0.0
        },
        factor: both / steps,
    })
}

/// Standard deviation of white noise in a signal, from third differences.
fn noise(signal: &[f64]) -> f64 {
    // Squares of the binomial coefficients 1, 3, 3, 1.
    const GAIN: f64 = 20.0;
    let differences = signal
        .windows(4)
        .map(|w| w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]);
    let sum: f64 = differences.map(|one| one * one).sum();
    (sum / GAIN / signal.len().max(1) as f64).sqrt()
}

/// Noise by standard deviation; `None` for a constant or short signal.
fn roughness(signal: &[f64]) -> Option<f64> {
    let deviation = (squares(signal) / signal.len() as f64).sqrt();
    (signal.len() >= 100 && deviation > 0.0).then(|| noise(signal) / deviation)
}

fn mean(signal: &[f64]) -> f64 {
    signal.iter().sum::<f64>() / signal.len().max(1) as f64
}

/// Sum of squared deviations from the mean.
fn squares(signal: &[f64]) -> f64 {
    let mean = mean(signal);
    signal.iter().map(|one| (one - mean).powi(2)).sum()
}

/// Whether two varying signals are equal up to a factor and an offset.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    let (own, theirs) = (mean(one), mean(other));
    let (varies, other_varies) = (squares(one), squares(other));
    if one.len() < 100 || !(varies > 0.0 && other_varies > 0.0) {
        return false;
    }
    let pairs = || one.iter().zip(other).map(|(a, b)| (a - own, b - theirs));
    let factor = pairs().map(|(a, b)| a * b).sum::<f64>() / varies;
    let left: f64 = pairs().map(|(a, b)| (b - factor * a).powi(2)).sum();
    left < SAME.powi(2) * other_varies
}

#[cfg(test)]
mod tests {
    use super::Log;

    /// A run of 4 s at 1 kHz with two actuators and noisy torques.
    fn run(change: impl Fn([f64; 3], usize) -> [f64; 3]) -> Result<(), String> {
        let (mut positions, mut torques, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
        let mut state = 1_u64;
        for sample in 0..4000 {
            for actuator in 0..2 {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                let noise = (state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5;
                let rate = 3.0 + actuator as f64;
                let phase = rate * 1e-3 * f64::from(sample);
                let own = [
                    phase.sin(),
                    7.0 * phase.cos() + 0.3 * noise,
                    rate * phase.cos(),
                ];
                let [position, torque, velocity] = change(own, actuator);
                positions.push(position);
                torques.push(torque);
                velocities.push(velocity);
            }
        }
        let log = Log::new("run", 1000.0, 2, positions, torques, false).expect("a log");
        let log = log.with_velocities(velocities);
        log.check_column_plausibility(&["1", "leg2"])
            .map_err(|error| error.to_string())
    }

    #[test]
    fn plausible_columns_are_accepted() {
        assert_eq!(run(|own, _| own), Ok(()));
        // A robot at rest allows no conclusion.
        assert_eq!(run(|_, _| [0.25, 3.0, 0.0]), Ok(()));
    }

    #[test]
    fn exchanged_and_dependent_columns_are_reported() {
        let rejection =
            |change: &dyn Fn([f64; 3], usize) -> [f64; 3]| run(change).expect_err("a slip");
        let text = rejection(&|[q, t, _], _| [t, q, 0.0]);
        assert!(
            text.contains("positions and torques look exchanged"),
            "{text}"
        );
        let text =
            rejection(&|[q, t, v], actuator| [q, if actuator == 0 { 2.0 * q + 1.0 } else { t }, v]);
        assert!(
            text.starts_with("run: torque and position are the same column: joint 1\n"),
            "{text}"
        );
        let text = rejection(&|[q, t, _], _| [q, t, q]);
        assert!(
            text.starts_with("run: velocity and position are the same column: joint 1, `leg2`\n"),
            "{text}"
        );
        let text = rejection(&|[q, t, v], _| [q, t, -57.3 * v]);
        assert!(
            text.contains("the velocities are -57.3 times what the positions give"),
            "{text}"
        );
        let text = rejection(&|[q, t, _], _| [q, t, t * t]);
        assert!(
            text.contains(
                "the velocities are not the derivatives of the positions: joint 1, `leg2`"
            ),
            "{text}"
        );
    }
}
