//! Search for one run after the other: feasible random series, then evolution from the best.
//!
//! Each run adds to the information of the earlier ones.

use super::course::Bench;
use super::evolution::Evolution;
use super::fourier_run::{FourierRun, Series};
use super::information::Question;
use super::kind::LimitKind;
use super::limits::{Limit, uses};
use nalgebra::DMatrix;
use overact_simulation::Trajectory;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use std::time::Instant;

/// Number of random series.
pub(super) const RANDOM: usize = 100;

/// Largest number of random series that are tried.
const ATTEMPTS: usize = 5 * RANDOM;

/// Largest number of steps to scale a random series to the limits.
const FITS: usize = 15;

/// Candidates per generation.
const CANDIDATES: usize = 16;

/// Initial step size of the evolution, relative to the limits.
const FIRST_STEP: f64 = 0.15;

/// Step size at which the evolution ends.
const LAST_STEP: f64 = 1e-4;

/// Samples per period for judging candidates: at least, and per harmonic.
const SAMPLES: [usize; 2] = [96, 12];

/// Samples per period for the final check of limits: at least, and per harmonic.
const FINE_SAMPLES: [usize; 2] = [2048, 200];

/// Fraction of the limits that candidates use, because peaks lie between their few samples.
const AIM: f64 = 0.995;

/// Penalty per parameter and projection for exceeding a limit by its own size.
///
/// It outweighs the gain from the larger motion, which is 2 to 4.
const PENALTY: f64 = 20.0;

/// Value of an unreachable candidate.
const UNREACHED: f64 = -1e9;

/// Smallest and largest scale factor between two attempts to keep the limits.
const SHRINK: [f64; 2] = [0.9, 0.9995];

/// The same after the time limit, when fewer attempts matter more than a slightly smaller motion.
const LATE_SHRINK: [f64; 2] = [0.7, 0.99];

/// Largest number of such attempts.
const SETTLING: usize = 300;

/// Fraction of a run's time for random series; the evolution has the rest.
const RANDOM_SHARE: f64 = 0.5;

/// Relative rounding of printed numbers.
const PRINTED: f64 = 1e-9;

/// A feasible run and its information.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) trajectory: Trajectory,
    pub(super) information: Vec<DMatrix<f64>>,
}

/// Search problem of a run and its time limit.
pub(super) struct Search<'a> {
    pub(super) bench: &'a Bench<'a>,
    pub(super) question: &'a Question,
    pub(super) limits: &'a [Limit],
    pub(super) generations: usize,
    pub(super) deadlines: Option<Deadlines>,
}

/// End of each phase of a run's search.
#[derive(Clone, Copy)]
pub(super) struct Deadlines {
    /// End of the random search, once there is a series.
    random: Instant,
    /// End of the search.
    whole: Instant,
}

impl Deadlines {
    /// Deadlines of a run whose search starts now.
    pub(super) fn until(whole: Instant) -> Self {
        let now = Instant::now();
        let random = now + whole.saturating_duration_since(now).mul_f64(RANDOM_SHARE);
        Self { random, whole }
    }
}

impl<'a> Search<'a> {
    /// Whether the random search and the whole search are over.
    pub(super) fn late(&self) -> (bool, bool) {
        let now = Instant::now();
        self.deadlines
            .map_or((false, false), |ends| (now > ends.random, now > ends.whole))
    }

    /// Series of a run; coordinates with limit 0 have none.
    pub(super) fn series(&self, frame: &'a FourierRun) -> Series<'a> {
        let limits = self
            .limits
            .iter()
            .find(|limit| limit.kind == LimitKind::Position);
        let limits = limits.map_or(&[][..], |limit| &limit.values);
        let all = self.bench.info.coordinates.iter().zip(limits).enumerate();
        let moving = all.filter(|(_, (_, limit))| **limit > 0.0);
        let [least, each] = SAMPLES;
        Series {
            frame,
            coordinates: moving
                .map(|(index, (name, limit))| (*name, *limit, self.bench.is_length(index)))
                .collect(),
            samples: least.max(each * frame.harmonics),
        }
    }

    /// Random feasible series of a run, each as large as possible.
    ///
    /// After the deadline, those found so far, but at least one if possible.
    pub(super) fn random(&self, series: &Series<'_>, random: &mut Pcg64) -> Vec<Candidate> {
        let mut found = Vec::new();
        // No coordinate may move.
        if series.len() == 0 {
            return found;
        }
        'all: for _ in 0..ATTEMPTS / RANDOM {
            let draw = |_| {
                (0..series.len())
                    .map(|_| StandardNormal.sample(random))
                    .collect()
            };
            let drawn: Vec<Vec<f64>> = (0..RANDOM).map(draw).collect();
            // Without a time limit, draw all candidates in parallel.
            let together = match self.deadlines {
                Some(_) => rayon::current_num_threads().min(CANDIDATES),
                None => RANDOM,
            };
            for drawn in drawn.chunks(together) {
                let fitted = drawn.par_iter().map(|numbers| self.fitted(series, numbers));
                found.extend(fitted.collect::<Vec<_>>().into_iter().flatten());
                if self.late().0 && !found.is_empty() {
                    break 'all;
                }
            }
            // If none of so many is feasible, further ones hardly would be.
            if found.is_empty() || found.len() >= RANDOM {
                break;
            }
        }
        found.truncate(RANDOM);
        found
    }

    /// Series scaled down until it keeps all limits at the samples.
    fn fitted(&self, series: &Series<'_>, numbers: &[f64]) -> Option<Candidate> {
        let (whole, _) = series.bounded(numbers);
        let mut factor = AIM;
        for _ in 0..FITS {
            let trajectory = series.scaled(&whole, factor);
            let course = self.bench.course(series.frame, &trajectory, series.samples);
            let worst = course.as_ref().map_or(f64::INFINITY, |course| {
                largest(&uses(course, self.limits, false))
            });
            if let (Ok(course), true) = (&course, worst <= 1.0) {
                let information = self
                    .question
                    .information(self.bench, series.frame, course)?;
                return Some(Candidate {
                    trajectory,
                    information,
                });
            }
            factor *= (0.99 / worst).clamp(0.6, 0.98);
        }
        None
    }

    /// Value of a candidate given the earlier runs' information, and whether it is feasible.
    fn value(&self, series: &Series<'_>, numbers: &[f64], before: &[DMatrix<f64>]) -> (f64, bool) {
        let (trajectory, excess) = series.bounded(numbers);
        let unreached = || {
            (
                UNREACHED - numbers.iter().map(|x| x * x).sum::<f64>(),
                false,
            )
        };
        let Ok(course) = self.bench.course(series.frame, &trajectory, series.samples) else {
            return unreached();
        };
        let uses = uses(&course, self.limits, false).into_iter();
        let kinds = self.limits.iter().map(|limit| limit.kind);
        // The series already keeps the position limits.
        let others = uses
            .zip(kinds)
            .filter(|(_, kind)| *kind != LimitKind::Position);
        let violation: f64 = others.map(|(used, _)| (used - AIM).clamp(0.0, 10.0)).sum();
        let Some(own) = self.question.information(self.bench, series.frame, &course) else {
            return unreached();
        };
        let parameters = (self.question.len() * self.question.scales.len()) as f64;
        let score = self.question.score(&added(before, &own));
        let lost = PENALTY * violation + 0.1 * excess;
        (score - parameters * lost, violation == 0.0)
    }

    /// Best series that evolution finds from a start; `tell` receives the number of completed
    /// generations.
    pub(super) fn evolved(
        &self,
        series: &Series<'_>,
        start: &Candidate,
        before: &[DMatrix<f64>],
        random: &mut Pcg64,
        tell: &dyn Fn(usize),
    ) -> Trajectory {
        let numbers = series.numbers(&start.trajectory);
        let mut best = (
            self.question.score(&added(before, &start.information)),
            None,
        );
        let mut evolution = Evolution::new(&numbers, FIRST_STEP, CANDIDATES);
        for generation in 0..self.generations {
            if self.late().1 || evolution.step() < LAST_STEP {
                break;
            }
            let drawn = evolution.draw(CANDIDATES, random);
            let values = drawn
                .par_iter()
                .map(|numbers| self.value(series, numbers, before));
            let values: Vec<(f64, bool)> = values.collect();
            for (numbers, (value, keeps)) in drawn.iter().zip(&values) {
                if *keeps && *value > best.0 {
                    best = (*value, Some(numbers.clone()));
                }
            }
            let values: Vec<f64> = values.into_iter().map(|(value, _)| value).collect();
            evolution.learn(&values);
            tell(generation + 1);
        }
        best.1.map_or_else(
            || start.trajectory.clone(),
            |numbers| series.bounded(&numbers).0,
        )
    }

    /// Series with rounded numbers, scaled down until it keeps all limits at and between fine
    /// samples.
    pub(super) fn settled(
        &self,
        series: &Series<'_>,
        trajectory: &Trajectory,
    ) -> Option<Candidate> {
        let [least, each] = FINE_SAMPLES;
        let samples = least.max(each * series.frame.harmonics);
        let mut factor = 1.0;
        for _ in 0..SETTLING {
            let trajectory = series.rounded(&series.scaled(trajectory, factor));
            // All amplitudes were rounded to zero.
            if is_standstill(&trajectory) {
                return None;
            }
            let course = self.bench.course(series.frame, &trajectory, samples);
            let worst = course.map_or(f64::INFINITY, |course| {
                largest(&uses(&course, self.limits, true))
            });
            if worst <= 1.0 - PRINTED {
                let coarse = self
                    .bench
                    .course(series.frame, &trajectory, series.samples)
                    .ok()?;
                let information = self
                    .question
                    .information(self.bench, series.frame, &coarse)?;
                return Some(Candidate {
                    trajectory,
                    information,
                });
            }
            let [least, most] = if self.late().1 { LATE_SHRINK } else { SHRINK };
            factor *= (1.0 / worst).clamp(least, most);
        }
        None
    }

    /// Best random series for which [`settled`](Self::settled) succeeds, regardless of the
    /// deadline.
    pub(super) fn settled_random(
        &self,
        series: &Series<'_>,
        before: &[DMatrix<f64>],
        random: &mut Pcg64,
    ) -> Option<Candidate> {
        let unhurried = Self {
            deadlines: None,
            ..*self
        };
        let mut all = unhurried.random(series, random);
        let score = |own: &Candidate| self.question.score(&added(before, &own.information));
        all.sort_by(|a, b| score(b).total_cmp(&score(a)));
        all.iter()
            .find_map(|one| unhurried.settled(series, &one.trajectory))
    }

    /// Candidate with the most information in addition to that of the earlier runs.
    pub(super) fn best<'c>(
        &self,
        all: &'c [Candidate],
        before: &[DMatrix<f64>],
    ) -> Option<&'c Candidate> {
        let score =
            |candidate: &&Candidate| self.question.score(&added(before, &candidate.information));
        let scored = all.iter().map(|candidate| (score(&candidate), candidate));
        scored
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, candidate)| candidate)
    }
}

/// Sum of the information matrices of runs.
pub(super) fn added(before: &[DMatrix<f64>], own: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
    if before.is_empty() {
        own.to_vec()
    } else {
        before.iter().zip(own).map(|(a, b)| a + b).collect()
    }
}

/// Whether a series has no terms.
fn is_standstill(trajectory: &Trajectory) -> bool {
    matches!(trajectory, Trajectory::Periodic { terms, .. } if terms.is_empty())
}

fn largest(uses: &[f64]) -> f64 {
    uses.iter().copied().fold(0.0, f64::max)
}
