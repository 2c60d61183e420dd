//! Distribution of the squared residual over time, and pace of the motion.

use super::scores::Scores;

/// Fraction of the samples that are tested as outliers.
const FEW: f64 = 0.01;

/// The samples with the largest residuals.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    /// Fraction of the squared residual in the worst 1 % of the samples.
    pub(crate) part: f64,
    /// Run and time (s) of the worst sample.
    pub(crate) run: usize,
    pub(crate) time: f64,
}

/// Pace of an actuator's motion in all runs together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    /// Frequency (Hz): 2 π f is the RMS acceleration divided by the RMS velocity.
    pub(crate) frequency: f64,
    /// Number of such periods in all runs.
    pub(crate) periods: f64,
    /// RMS acceleration (m/s², rad/s²).
    pub(crate) acceleration: f64,
}

/// RMS acceleration of an actuator, m/s² or rad/s², below which inertia forces are negligible.
///
/// It is two thousandths of the acceleration of gravity; angles count with a lever of 1 m.
const QUASI_STATIC: f64 = 2e-2;

/// Whether all actuators move so slowly that the forces depend on positions and directions of
/// motion only.
pub(crate) fn is_quasi_static(paces: &[Option<Pace>]) -> bool {
    let mut moving = paces.iter().flatten().peekable();
    moving.peek().is_some() && moving.all(|pace| pace.acceleration < QUASI_STATIC)
}

impl Scores {
    /// The worst 1 % of all samples; `None` below `instants` samples.
    pub(crate) fn peak(&self, instants: usize) -> Option<Peak> {
        let mut all: Vec<(f64, usize, usize)> = Vec::new();
        for (number, run) in self.runs.iter().enumerate() {
            let squares = run.squares.iter().enumerate();
            all.extend(squares.map(|(at, square)| (*square, number, at)));
        }
        if all.len() < instants {
            return None;
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let total: f64 = all.iter().map(|one| one.0).sum();
        let few = (FEW * all.len() as f64) as usize;
        let &(_, run, at) = all.first()?;
        let tempo = &self.runs[run].tempo;
        Some(Peak {
            part: all[..few].iter().map(|one| one.0).sum::<f64>() / total,
            run,
            time: tempo.start + at as f64 * tempo.interval,
        })
    }

    /// Pace of each actuator; `None` for those that do not move.
    pub(crate) fn paces(&self) -> Vec<Option<Pace>> {
        let duration: f64 = self
            .runs
            .iter()
            .map(|run| run.squares.len() as f64 * run.tempo.interval)
            .sum();
        let count = self
            .runs
            .first()
            .map_or(0, |run| run.tempo.velocities.len());
        let pace = |actuator: usize| {
            let (mut velocity, mut acceleration) = (0.0, 0.0);
            for run in &self.runs {
                velocity += run.tempo.velocities[actuator];
                acceleration += run.tempo.accelerations[actuator];
            }
            let samples: usize = self.runs.iter().map(|run| run.tempo.samples).sum();
            let rms = (acceleration / samples.max(1) as f64).sqrt();
            let frequency = (acceleration / velocity).sqrt() / std::f64::consts::TAU;
            frequency.is_finite().then_some(Pace {
                frequency,
                periods: frequency * duration,
                acceleration: rms,
            })
        };
        (0..count).map(pace).collect()
    }
}
