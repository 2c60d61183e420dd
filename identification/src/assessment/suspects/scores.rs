//! One pass over the beginnings of the runs: products of all columns with each other and, section by
//! section of the time, with the residual. What is kept does not grow with the data.

use nalgebra::{DMatrix, DVector};
use overact::{Function, Model};
use rayon::prelude::*;

use super::{
    columns::{Sample, Shape, Suspect, moments, rates, suspects},
    nearby::Nearby,
};
use crate::{
    blocks::{BLOCK, evaluate, slice},
    data::Log,
    error::Error,
    estimation::intervals::scores::cosines,
    filters::{Decimation, Decimator},
    kinematics::{
        Motion, Motions,
        conditioning::{KeptActuators, home_scales},
        distribution::{least_norm, product},
    },
    regression::{chunk::projected, columns::ColumnSet, projection::ModelKind},
    result::Estimate,
    settings::Settings,
};

/// Samples of all runs together that are gone through, at most.
const MOST_SAMPLES: usize = 100_000;

/// Sections of a run for each cosine of the covariance.
const SECTIONS: usize = 4;

/// What all runs tell.
#[derive(Debug, Clone)]
pub(crate) struct Scores {
    /// The suspects, and the names of the payload's parameters, each of which is a suspect in each run.
    pub(crate) suspects: Vec<Suspect>,
    pub(crate) payload: Vec<String>,
    /// Places of the estimate's parameters among the base parameters.
    pub(super) selected: Vec<usize>,
    /// What each run tells.
    pub(super) runs: Vec<RunScores>,
}

/// What one run tells. Columns are the base parameters', the suspects', the payload's.
#[derive(Debug, Clone)]
pub(super) struct RunScores {
    /// Products of all columns, weighted.
    pub(super) gram: DMatrix<f64>,
    /// Products of all columns with the residual in each section, columns x sections.
    pub(super) sections: DMatrix<f64>,
    /// Σ ρ², weighted, and number of equations of each line.
    pub(super) square: f64,
    pub(super) instants: usize,
}

/// What a pass needs.
struct Pass<'a> {
    model: &'a dyn Model,
    columns: &'a ColumnSet,
    base: &'a [usize],
    estimate: &'a Estimate,
    /// For each base parameter its estimate; zero for what is not estimated.
    values: Vec<f64>,
    suspects: &'a [Suspect],
    settings: &'a Settings,
}

/// Goes through the runs with an estimate of all base parameters.
///
/// # Errors
/// As [`Motions::next`]; the runs have been gone through before.
pub(crate) fn scores(
    model: &dyn Model,
    runs: &[Log],
    (columns, base): (&ColumnSet, &[usize]),
    estimate: &Estimate,
    settings: &Settings,
) -> Result<Scores, Error> {
    let suspects = suspects(model, estimate.model);
    let mut values = vec![0.0; base.len()];
    for parameter in &estimate.parameters {
        values[parameter.column] = parameter.value;
    }
    let pass = Pass {
        model,
        columns,
        base,
        estimate,
        values,
        suspects: &suspects,
        settings,
    };
    let most = (MOST_SAMPLES / runs.len().max(1)).max(settings.samples_needed());
    let run = |log: &Log| pass.run(&log.beginning(most.min(log.samples()))?);
    let scores = runs
        .par_iter()
        .map(run)
        .collect::<Result<Vec<_>, Error>>()?;
    let info = model.info();
    let payload = info.payload_parameters.iter();
    Ok(Scores {
        payload: payload.map(|one| one.name.to_owned()).collect(),
        selected: estimate.columns(),
        runs: scores,
        suspects,
    })
}

impl Scores {
    /// The part of the squared residual that white noise of the torques explains, given its variance for
    /// each run and actuator at the full rate, of which decimation leaves the part `passed`.
    pub(crate) fn noise(&self, variances: &[Vec<f64>], passed: f64) -> f64 {
        let offset = |actuator: usize| {
            let wanted = Suspect::Torque(actuator, Shape::Constant);
            self.suspects.iter().position(|one| *one == wanted)
        };
        let (mut noise, mut square) = (0.0, 0.0);
        for (run, variances) in self.runs.iter().zip(variances) {
            let base = run.gram.nrows() - self.suspects.len() - self.payload.len();
            square += run.square;
            for (actuator, variance) in variances.iter().enumerate() {
                // Σ λ² J² over all equations.
                let shares = offset(actuator).map(|k| run.gram[(base + k, base + k)]);
                noise += shares.unwrap_or(0.0) * variance * passed;
            }
        }
        if square > 0.0 { noise / square } else { 1.0 }
    }
}

impl Pass<'_> {
    /// Columns of a row: the base parameters', Y, the suspects', the payload's.
    fn width(&self) -> usize {
        let payload = self.model.info().sizes.payload_parameters;
        self.base.len() + 1 + self.suspects.len() + payload
    }

    fn run(&self, log: &Log) -> Result<RunScores, Error> {
        let lines = self.model.info().sizes.dof;
        let mut motions = Motions::new(self.model, log, self.settings)?;
        let decimator = Decimator::new(self.settings.decimation)?;
        let samples = motions.samples();
        let mut streams: Vec<Decimation> = (0..lines)
            .map(|_| decimator.stream(self.width(), samples))
            .collect::<Result<_, _>>()?;
        let equations = decimator.kept(samples);
        let mut sinks = vec![Sink::new(self, equations); lines];
        while let Some(motion) = motions.next()? {
            let rows = self.rows(&motion)?;
            let streams = streams.par_iter_mut().zip(&mut sinks).zip(&rows);
            streams
                .enumerate()
                .for_each(|(line, ((stream, sink), rows))| {
                    let mut kept = Vec::new();
                    stream.push(rows, &mut kept);
                    sink.take(self, line, &kept);
                });
        }
        let mut all = sinks.into_iter().map(|sink| sink.scores);
        let first = all.next().unwrap_or_else(|| Sink::new(self, 0).scores);
        Ok(all.fold(first, |mut sum, one| {
            sum.gram += one.gram;
            sum.sections += one.sections;
            sum.square += one.square;
            sum
        }))
    }

    /// The rows of all samples of a motion, line by line of the estimate's inputs.
    fn rows(&self, motion: &Motion) -> Result<Vec<Vec<f64>>, Error> {
        let info = self.model.info();
        let (n, r) = (info.sizes.actuators, info.sizes.dof);
        let at =
            |error: overact::SampleError| Error::from(motion.outside(error.sample, error.error));
        let ask = |function: Function, inputs: &[&[f64]]| {
            evaluate(self.model, function, inputs, motion.samples).map_err(at)
        };
        let states: [&[f64]; 3] = [&motion.pose, &motion.twist, &motion.acceleration];
        let jacobians = ask(Function::InverseJacobian, &states[..1])?;
        let positions = ask(Function::ActuatorPositions, &states[..1])?;
        let payload = match info.sizes.payload_parameters {
            0 => Vec::new(),
            _ => ask(Function::IdmRedPayload, &states)?,
        };
        let more = self.width() - self.base.len();
        let mut lines: Vec<Vec<f64>> = vec![Vec::new(); r];
        for first in (0..motion.samples).step_by(BLOCK) {
            let count = BLOCK.min(motion.samples - first);
            let states = [
                slice(&motion.pose, info.sizes.pose, first, count),
                slice(&motion.twist, r, first, count),
                slice(&motion.acceleration, r, first, count),
            ];
            let interval = 1.0 / motion.sampling_frequency;
            let rows = self
                .columns
                .evaluate(
                    self.model,
                    &states,
                    (count, interval),
                    motion.payload,
                    (self.base, more),
                )
                .map_err(at)?;
            lines
                .iter_mut()
                .zip(rows)
                .for_each(|(all, rows)| all.extend(rows));
        }
        let torques = self.inputs(motion, &jacobians, &mut lines);
        let torque_rates = rates(&torques, n, motion.sampling_frequency);
        let actuators = moments(&info, motion, &positions, &jacobians);
        let nearby = Nearby {
            model: self.model,
            columns: self.columns,
            base: self.base,
            values: &self.values,
        };
        let clock = nearby.clock(motion)?;
        let moved = self
            .suspects
            .iter()
            .any(|one| matches!(one, Suspect::Offset(_)));
        let offsets = match moved {
            true => nearby.offsets(motion, (&torques, &jacobians), &actuators)?,
            false => Vec::new(),
        };
        let width = self.width();
        let own = self.base.len() + 1;
        for sample in 0..motion.samples {
            let here = Sample {
                jacobian: slice(&jacobians, n * r, sample, 1),
                torques: slice(&torques, n, sample, 1),
                torque_rates: slice(&torque_rates, n, sample, 1),
                actuators: &actuators[sample * n..(sample + 1) * n],
                pose: slice(&motion.pose, info.sizes.pose, sample, 1),
                clock: slice(&clock, r, sample, 1),
                offsets: slice(&offsets, n * r, sample, 1),
            };
            for (line, rows) in lines.iter_mut().enumerate() {
                let row = &mut rows[sample * width..(sample + 1) * width];
                let (suspects, load) = row[own..].split_at_mut(self.suspects.len());
                for (to, suspect) in suspects.iter_mut().zip(self.suspects) {
                    *to = here.entry(*suspect, line);
                }
                load.copy_from_slice(slice(&payload, load.len(), sample * r + line, 1));
            }
        }
        Ok(self.kept(lines, &jacobians))
    }

    /// Puts the measured inputs into the rows, and gives the torques freed of the residual.
    fn inputs(&self, motion: &Motion, jacobians: &[f64], lines: &mut [Vec<f64>]) -> Vec<f64> {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let (width, p) = (self.width(), self.base.len());
        let mut freed = motion.torques.clone();
        for (sample, torques) in freed.chunks_exact_mut(n).enumerate() {
            let jacobian = slice(jacobians, n * r, sample, 1);
            let mut residual = vec![0.0; r];
            for (line, rows) in lines.iter_mut().enumerate() {
                let row = &mut rows[sample * width..(sample + 1) * width];
                let measured = torques.iter().enumerate();
                let input: f64 = measured
                    .map(|(i, torque)| jacobian[i * r + line] * torque)
                    .sum();
                let explained: f64 = row[..p].iter().zip(&self.values).map(|(w, x)| w * x).sum();
                row[p] = input;
                residual[line] = input - explained;
            }
            if let Some(distribution) = least_norm(jacobian, r) {
                let mut own = vec![0.0; n];
                product(&distribution, &residual, &mut own);
                torques
                    .iter_mut()
                    .zip(&own)
                    .for_each(|(torque, own)| *torque -= own);
            }
        }
        freed
    }

    /// Rows of Γ¹ as the estimate's model takes them.
    fn kept(&self, lines: Vec<Vec<f64>>, jacobians: &[f64]) -> Vec<Vec<f64>> {
        let sizes = self.model.info().sizes;
        let kept = match self.estimate.model {
            ModelKind::Platform => return lines,
            ModelKind::Joints => (0..sizes.actuators).collect(),
            ModelKind::Actuators => self.settings.kept_actuators.clone(),
        };
        let mut choice = KeptActuators::new(kept, &home_scales(self.model));
        projected(&lines, &mut choice, jacobians, sizes.actuators * sizes.dof).0
    }
}

/// Where the equations of one line go.
#[derive(Debug, Clone)]
struct Sink {
    /// Equations that have come, and those to come in all.
    taken: usize,
    expected: usize,
    scores: RunScores,
}

impl Sink {
    fn new(pass: &Pass<'_>, equations: usize) -> Self {
        let size = pass.width() - 1;
        let sections = (SECTIONS * cosines(equations)).min(equations).max(1);
        Self {
            taken: 0,
            expected: equations,
            scores: RunScores {
                gram: DMatrix::zeros(size, size),
                sections: DMatrix::zeros(size, sections),
                square: 0.0,
                instants: equations,
            },
        }
    }

    /// Takes decimated rows of a line.
    fn take(&mut self, pass: &Pass<'_>, line: usize, rows: &[f64]) {
        let (width, p) = (pass.width(), pass.base.len());
        let count = rows.len() / width;
        if count == 0 {
            return;
        }
        let weight = pass.estimate.weights.get(line).copied().unwrap_or(1.0);
        let all = DMatrix::from_row_slice(count, width, rows) * weight;
        let mut residual: DVector<f64> = all.column(p).clone_owned();
        for (column, value) in pass.values.iter().enumerate() {
            residual.axpy(-value, &all.column(column), 1.0);
        }
        let columns = all.remove_column(p);
        self.scores.gram.gemm_tr(1.0, &columns, &columns, 1.0);
        let sections = self.scores.sections.ncols();
        let mut first = 0;
        while first < count {
            let section = (self.taken + first) * sections / self.expected.max(1);
            let section = section.min(sections - 1);
            let end = (section + 1) * self.expected;
            let end = end.div_ceil(sections).saturating_sub(self.taken);
            let end = end.clamp(first + 1, count);
            let part = columns.rows(first, end - first);
            self.scores.sections.column_mut(section).gemv_tr(
                1.0,
                &part,
                &residual.rows(first, end - first),
                1.0,
            );
            first = end;
        }
        self.scores.square += residual.norm_squared();
        self.taken += count;
    }
}
