//! The search: random series that keep all limits, and evolution from the best of them, run after run, each of
//! which adds to what those before it tell.

use super::course::Bench;
use super::evolution::Evolution;
use super::frame::{Frame, Series};
use super::information::Question;
use super::kind::LimitKind;
use super::limits::{Limit, uses};
use nalgebra::DMatrix;
use overact_simulation::Trajectory;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use std::time::Instant;

/// Random series from which the best one is taken.
pub(super) const RANDOM: usize = 100;

/// Random series that are tried for so many that keep all limits, at most.
const ATTEMPTS: usize = 5 * RANDOM;

/// Steps in which a random series is scaled down to the limits.
const FITS: usize = 15;

/// Candidates of a generation.
const CANDIDATES: usize = 16;

/// Length of the first steps of the evolution, as a part of the limits.
const FIRST_STEP: f64 = 0.15;

/// A step of this length finds nothing better.
const LAST_STEP: f64 = 1e-4;

/// Samples of a period at which candidates are judged, at least, and for each harmonic.
const SAMPLES: [usize; 2] = [96, 12];

/// Samples of a period at which limits are checked in the end, at least, and for each harmonic.
const FINE_SAMPLES: [usize; 2] = [2048, 200];

/// Part of the limits that candidates use: between their few samples a motion goes further.
const AIM: f64 = 0.995;

/// What a parameter loses in each case where a limit is exceeded by its own size: more than the larger motion
/// gains, which is 2 to 4.
const PENALTY: f64 = 20.0;

/// The value of a candidate that the robot can't follow.
const UNREACHED: f64 = -1e9;

/// Factor from one attempt to keep the limits for certain to the next, at least and at most.
const SHRINK: [f64; 2] = [0.9, 0.9995];

/// The same where the time is up: a motion that is a little smaller costs less than many more attempts.
const LATE_SHRINK: [f64; 2] = [0.7, 0.99];

/// Attempts to keep the limits for certain, at most.
const SETTLING: usize = 300;

/// Part of a run's time after which no more random series are drawn: the rest is the evolution's.
const RANDOM_SHARE: f64 = 0.5;

/// How far numbers that are printed may be off, relatively.
const PRINTED: f64 = 1e-9;

/// A run that keeps the limits, and what it tells.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) trajectory: Trajectory,
    pub(super) information: Vec<DMatrix<f64>>,
}

/// What is searched, and how long.
pub(super) struct Search<'a> {
    pub(super) bench: &'a Bench<'a>,
    pub(super) question: &'a Question,
    pub(super) limits: &'a [Limit],
    pub(super) generations: usize,
    pub(super) deadlines: Option<Deadlines>,
}

/// When the phases of the search of a run end, if the time is limited.
#[derive(Clone, Copy)]
pub(super) struct Deadlines {
    /// No more random series are drawn, once there is one.
    random: Instant,
    /// Nothing better is searched.
    whole: Instant,
}

impl Deadlines {
    /// Those of a run that is searched from now on until then.
    pub(super) fn until(whole: Instant) -> Self {
        let now = Instant::now();
        let random = now + whole.saturating_duration_since(now).mul_f64(RANDOM_SHARE);
        Self { random, whole }
    }
}

impl<'a> Search<'a> {
    /// Whether no more random series are drawn, and whether nothing better is searched.
    pub(super) fn late(&self) -> (bool, bool) {
        let now = Instant::now();
        self.deadlines
            .map_or((false, false), |ends| (now > ends.random, now > ends.whole))
    }

    /// The series of a run: coordinates with a limit of 0 have none.
    pub(super) fn series(&self, frame: &'a Frame) -> Series<'a> {
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

    /// Random series of a run that keep all limits, each as large as it can be. Once the time for them is up, those
    /// that were found so far, one at least where there is any.
    pub(super) fn random(&self, series: &Series<'_>, random: &mut Pcg64) -> Vec<Candidate> {
        let mut found = Vec::new();
        // Where no coordinate may move there is nothing to draw.
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
            // With all the time there is no need to wait for one another.
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
            // Where none of so many keeps the limits, more would hardly.
            if found.is_empty() || found.len() >= RANDOM {
                break;
            }
        }
        found.truncate(RANDOM);
        found
    }

    /// The series of these numbers, scaled down until it keeps all limits at the samples.
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

    /// The value of a candidate beside what the runs before it tell, and whether it keeps all limits.
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
        // The series itself keeps the limits of position.
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

    /// The best series that evolution finds from a start. `tell` hears how many generations are done.
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

    /// A series with the numbers that are written, scaled down until it keeps all limits at and between the
    /// samples of a fine grid.
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
            // Amplitudes below the written digits are no motion.
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

    /// The best of some random series, as [`settled`](Self::settled), that can be; the time is not looked at, for
    /// there is nothing yet.
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

    /// The candidate that tells most beside what the runs before it tell.
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

/// The information of runs together.
pub(super) fn added(before: &[DMatrix<f64>], own: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
    match before.is_empty() {
        true => own.to_vec(),
        false => before.iter().zip(own).map(|(a, b)| a + b).collect(),
    }
}

/// Whether a series has no terms.
fn is_standstill(trajectory: &Trajectory) -> bool {
    matches!(trajectory, Trajectory::Periodic { terms, .. } if terms.is_empty())
}

fn largest(uses: &[f64]) -> f64 {
    uses.iter().copied().fold(0.0, f64::max)
}
