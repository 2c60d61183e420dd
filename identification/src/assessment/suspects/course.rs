//! How what is left unexplained, and the motion itself, are spread over the time.

use super::scores::Scores;

/// Part of the instants that are told apart from the others.
const FEW: f64 = 0.01;

/// The few instants that leave most unexplained.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peak {
    /// The part of the squared residual that the worst hundredth of the instants holds.
    pub(crate) part: f64,
    /// The run that holds the worst of them, and its time there, s.
    pub(crate) run: usize,
    pub(crate) time: f64,
}

/// How an actuator moves in all runs together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    /// The frequency of its motion, Hz: 2 π f is the root mean square of its acceleration by that of its
    /// velocity.
    pub(crate) frequency: f64,
    /// How many such periods the runs last.
    pub(crate) periods: f64,
}

impl Scores {
    /// The worst hundredth of all instants; none of fewer than so many `instants`.
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

    /// How each actuator moves; none for those that stand still.
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
            let frequency = (acceleration / velocity).sqrt() / std::f64::consts::TAU;
            frequency.is_finite().then_some(Pace {
                frequency,
                periods: frequency * duration,
            })
        };
        (0..count).map(pace).collect()
    }
}
