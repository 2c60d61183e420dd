//! Scores of fault hypotheses on the starts of all runs, in a size independent of the data.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use overact::Model;
use rayon::prelude::*;

use super::{
    columns::{FaultHypothesis, Layout},
    model_columns::ModelColumns,
    pass::Pass,
    scaled::{Scaled, independent_columns},
    sections::{Frame, MotionMean, RunScores},
    shapes::{PositionRange, Shape},
    wald_test::WaldTest,
};
use crate::{
    estimation::periodic_variance::Mean,
    filters::DECIMATION_PADDING,
    regression::{
        columns::ColumnSet,
        phase_sums::{self, PhaseSums, Phases},
        projection::ModelKind,
    },
    result::Estimate,
    settings::Settings,
};
use overact_logs::{Dataset, Error, Log, periods::PeriodicMotion};

/// Largest number of samples of all runs together.
const MOST_SAMPLES: usize = 100_000;

/// Ratio of the estimate's band to that of the tests.
///
/// Position errors enter as accelerations and torque rates. Their power grows with the fifth power
/// of the band.
const NARROWER: usize = 2;

/// Fewest equations per column of the model; decimation is reduced to keep them.
const LEAST_EQUATIONS: usize = 4;

/// Scores of all runs.
#[derive(Debug, Clone)]
pub(crate) struct Scores {
    /// Hypotheses, and names of the payload parameters, which are tested in each run.
    pub(crate) hypotheses: Vec<FaultHypothesis>,
    pub(crate) payload: Vec<String>,
    /// Column indices.
    pub(super) layout: Layout,
    /// Indices of the estimate's parameters among the base parameters.
    pub(super) selected: Vec<usize>,
    /// Columns of friction rates after the base parameters, as far as they are independent.
    pub(super) late: Vec<usize>,
    /// Scores of each run.
    pub(super) runs: Vec<RunScores>,
    /// Periodic motions.
    pub(super) means: Vec<MotionMean>,
    /// Weight of each actuator's equation, if each line is the equation of an actuator.
    pub(super) actuator_weights: Option<Vec<f64>>,
    /// Ratio of the estimate's band to that of the equations.
    pub(crate) narrower: usize,
    /// Cached tests with the estimate's own columns.
    pub(super) own: CachedTests,
}

/// Products and results of the tests with the estimate's own columns, computed on demand.
#[derive(Debug, Clone, Default)]
pub(super) struct CachedTests {
    pub(super) model_columns: OnceLock<Option<ModelColumns>>,
    pub(super) wald_tests: OnceLock<Vec<Option<WaldTest>>>,
}

/// Inputs of the scores: an estimate of all base parameters, and the runs.
pub(crate) struct ScoreTest<'a> {
    pub(crate) model: &'a dyn Model,
    pub(crate) dataset: &'a Dataset<'a>,
    /// Columns of the model, and the base parameters among them.
    pub(crate) columns: &'a ColumnSet,
    pub(crate) base: &'a [usize],
    pub(crate) estimate: &'a Estimate,
    /// The hypotheses to test.
    pub(crate) hypotheses: Vec<FaultHypothesis>,
    /// Position ranges of the actuators.
    pub(crate) position_ranges: &'a [PositionRange],
    /// Periodic motion of each run, if it has one.
    pub(crate) periodic_motions: &'a [Option<PeriodicMotion>],
    pub(crate) settings: &'a Settings,
}

impl ScoreTest<'_> {
    /// Reads the runs and computes the scores.
    ///
    /// The band is `times` narrower than usual, as far as enough equations remain.
    ///
    /// # Errors
    /// As [`Motions::next`]; the runs have been read before.
    pub(crate) fn scores(&self, times: usize) -> Result<Scores, Error> {
        let (model, settings, estimate) = (self.model, self.settings, self.estimate);
        let (runs, variants) = (self.dataset.runs, self.dataset.variants);
        let hypotheses = self.hypotheses.clone();
        let payload = model.info().payload_parameters;
        let friction = coulomb(self.columns, self.base);
        let base = self.base.len();
        let layout = Layout::new(base + friction.len(), &hypotheses, payload.len());
        let mut values = vec![0.0; layout.base];
        for parameter in &estimate.parameters {
            values[parameter.column] = parameter.value;
        }
        let most = (MOST_SAMPLES / runs.len().max(1)).max(settings.samples_needed());
        let beginning = |log: &Log| log.beginning(most.min(log.samples()));
        let runs: Vec<Log> = runs.iter().map(beginning).collect::<Result<_, _>>()?;
        let lines = model.info().sizes.dof;
        let narrower = narrower(&runs, settings, layout.base, lines, NARROWER * times);
        let pass = Pass {
            model,
            variants,
            columns: self.columns,
            base: self.base,
            friction: &friction,
            kind: estimate.model,
            frame: Frame {
                hypotheses: &hypotheses,
                layout: &layout,
                position_ranges: self.position_ranges,
                weights: &estimate.weights,
                values: &values,
            },
            decimation: settings.decimation * narrower,
            settings,
        };
        let phases = |number: usize| {
            let motion = self.periodic_motions.get(number).copied().flatten();
            motion.and_then(|motion| Phases::new(motion, pass.decimation))
        };
        let scores = runs
            .par_iter()
            .enumerate()
            .map(|(number, log)| pass.run(log, phases(number)))
            .collect::<Result<Vec<_>, Error>>()?;
        let selected = estimate.columns();
        Ok(Scores {
            late: late(&layout, &scores, &selected, base),
            payload: payload.iter().map(|one| one.name.to_owned()).collect(),
            layout,
            selected,
            means: means(&scores),
            actuator_weights: (estimate.model != ModelKind::Platform)
                .then(|| estimate.weights.clone()),
            narrower,
            runs: scores,
            hypotheses,
            own: CachedTests::default(),
        })
    }
}

/// The periodic motions.
fn means(runs: &[RunScores]) -> Vec<MotionMean> {
    let (mut all, mut owners) = (Vec::new(), Vec::<Vec<usize>>::new());
    for (number, run) in runs.iter().enumerate() {
        if run.folds.is_empty() {
            continue;
        }
        let place = phase_sums::add(&mut all, run.folds.clone());
        owners.resize(all.len(), Vec::new());
        owners[place].push(number);
    }
    let split = |_, rows: DMatrix<f64>| {
        let last = rows.ncols() - 1;
        (
            rows.columns(0, last).clone_owned(),
            rows.column(last).clone_owned(),
        )
    };
    let mean = |(runs, folds): (Vec<usize>, Vec<PhaseSums>)| {
        let mean = Mean::new(&folds, split)?;
        Some(MotionMean { runs, mean })
    };
    owners.into_iter().zip(all).filter_map(mean).collect()
}

/// Ratio of the estimate's band to that of the equations, at most `most`.
///
/// `columns` and `lines` are those of the model.
fn narrower(runs: &[Log], settings: &Settings, columns: usize, lines: usize, most: usize) -> usize {
    let kept = |log: &Log| log.samples() - settings.skip_start - settings.skip_end;
    if runs.iter().any(|log| kept(log) <= DECIMATION_PADDING) {
        return 1;
    }
    let samples: usize = runs.iter().map(kept).sum();
    let equations = samples * lines / settings.decimation;
    (equations / (LEAST_EQUATIONS * columns).max(1)).clamp(1, most)
}

/// Indices of the dry friction columns among the base parameters.
fn coulomb(columns: &ColumnSet, base: &[usize]) -> Vec<usize> {
    let is_coulomb = |column: usize| {
        let column = columns.as_slice().get(column);
        column.is_some_and(|column| column.symbol.has_sign())
    };
    let places = base.iter().enumerate();
    let places = places.filter(|(_, column)| is_coulomb(**column));
    places.map(|(place, _)| place).collect()
}

/// The columns after the `base` ones that are independent of `selected` and of each other.
fn late(layout: &Layout, runs: &[RunScores], selected: &[usize], base: usize) -> Vec<usize> {
    let late: Vec<usize> = (base..layout.base).collect();
    let sum = |rows: &[usize], columns: &[usize]| {
        let start = DMatrix::zeros(rows.len(), columns.len());
        runs.iter().fold(start, |sum, run| {
            sum + run
                .cross(layout, 0)
                .select_rows(rows)
                .select_columns(columns)
        })
    };
    let Some(gram) = Scaled::new(&sum(selected, selected)) else {
        return Vec::new();
    };
    let (cross, square) = (sum(selected, &late), sum(&late, &late));
    let outside = &square - cross.tr_mul(&gram.solve(&cross));
    let places = independent_columns(&outside, &square).into_iter();
    places.map(|place| late[place]).collect()
}

impl Scores {
    /// Mean of λ² e² over all equations for white torque noise.
    ///
    /// `variances` are those of each run and actuator at the full rate. Decimation keeps the
    /// fraction `passed` of them.
    pub(crate) fn noise(&self, variances: &[Vec<f64>], passed: f64) -> f64 {
        let offset = |actuator: usize| {
            let wanted = FaultHypothesis::Torque(actuator, Shape::Constant);
            self.hypotheses.iter().position(|one| *one == wanted)
        };
        let (mut noise, mut equations) = (0.0, 0);
        for (run, variances) in self.runs.iter().zip(variances) {
            equations += run.equations;
            for (actuator, variance) in variances.iter().enumerate() {
                // Σ λ² J² over all equations.
                let shares = offset(actuator).map(|k| run.own(&self.layout, k, 0)[(0, 0)]);
                noise += shares.unwrap_or(0.0) * variance * passed;
            }
        }
        noise / equations.max(1) as f64
    }
}
