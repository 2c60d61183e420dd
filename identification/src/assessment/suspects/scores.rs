//! One pass over the beginnings of the runs. What is kept does not grow with the data.

use overact::{Function, Model};
use rayon::prelude::*;

use super::{
    columns::{Layout, Sample, Suspect, moments, rates, suspects},
    nearby::Nearby,
    pairs::{Correlation, correlations},
    sections::{Frame, RunScores, Sink},
    shapes::{Reach, Shape},
};
use crate::{
    blocks::{BLOCK, evaluate, slice},
    data::Log,
    error::Error,
    filters::{Decimation, Decimator},
    kinematics::{
        Motion, Motions,
        conditioning::{KeptActuators, home_scales},
        distribution::{least_norm, product},
    },
    regression::{
        chunk::projected,
        columns::{ColumnSet, Reversal},
        projection::ModelKind,
    },
    result::Estimate,
    settings::Settings,
};

/// Samples of all runs together that are gone through, at most.
const MOST_SAMPLES: usize = 100_000;

/// What all runs tell.
#[derive(Debug, Clone)]
pub(crate) struct Scores {
    /// The suspects, and the names of the payload's parameters, each of which is a suspect in each run.
    pub(crate) suspects: Vec<Suspect>,
    pub(crate) payload: Vec<String>,
    /// Where their columns stand.
    pub(super) layout: Layout,
    /// Places of the estimate's parameters among the base parameters.
    pub(super) selected: Vec<usize>,
    /// What each run tells.
    pub(super) runs: Vec<RunScores>,
}

/// What a pass needs.
struct Pass<'a> {
    model: &'a dyn Model,
    columns: &'a ColumnSet,
    base: &'a [usize],
    kind: ModelKind,
    frame: Frame<'a>,
    settings: &'a Settings,
}

/// Goes through the runs with an estimate of all base parameters; `reaches` are those of the actuators.
///
/// # Errors
/// As [`Motions::next`]; the runs have been gone through before.
pub(crate) fn scores(
    model: &dyn Model,
    runs: &[Log],
    (columns, base): (&ColumnSet, &[usize]),
    (estimate, reaches): (&Estimate, &[Reach]),
    settings: &Settings,
) -> Result<Scores, Error> {
    let suspects = suspects(model, estimate.model);
    let payload = model.info().payload_parameters;
    let layout = Layout::new(base.len(), &suspects, payload.len());
    let mut values = vec![0.0; base.len()];
    for parameter in &estimate.parameters {
        values[parameter.column] = parameter.value;
    }
    let pass = Pass {
        model,
        columns,
        base,
        kind: estimate.model,
        frame: Frame {
            suspects: &suspects,
            layout: &layout,
            reaches,
            weights: &estimate.weights,
            values: &values,
        },
        settings,
    };
    let most = (MOST_SAMPLES / runs.len().max(1)).max(settings.samples_needed());
    let run = |log: &Log| pass.run(&log.beginning(most.min(log.samples()))?);
    let scores = runs
        .par_iter()
        .map(run)
        .collect::<Result<Vec<_>, Error>>()?;
    Ok(Scores {
        payload: payload.iter().map(|one| one.name.to_owned()).collect(),
        layout,
        selected: estimate.columns(),
        runs: scores,
        suspects,
    })
}

impl Scores {
    /// How the residuals of all pairs of actuators hang together, as far as the motion tells.
    pub(crate) fn correlations(&self) -> Vec<Correlation> {
        correlations(self.runs.iter().map(|run| (&run.pairs, run.cosines)))
    }

    /// The part of the squared residual that white noise of the torques explains, given its variance for
    /// each run and actuator at the full rate, of which decimation leaves the part `passed`.
    pub(crate) fn noise(&self, variances: &[Vec<f64>], passed: f64) -> f64 {
        let offset = |actuator: usize| {
            let wanted = Suspect::Torque(actuator, Shape::Constant);
            self.suspects.iter().position(|one| *one == wanted)
        };
        let (mut noise, mut square) = (0.0, 0.0);
        for (run, variances) in self.runs.iter().zip(variances) {
            square += run.square;
            for (actuator, variance) in variances.iter().enumerate() {
                // Σ λ² J² over all equations.
                let shares = offset(actuator).map(|k| run.own(&self.layout, k, 0)[(0, 0)]);
                noise += shares.unwrap_or(0.0) * variance * passed;
            }
        }
        if square > 0.0 { noise / square } else { 1.0 }
    }
}

impl Pass<'_> {
    /// Columns of a row: the base parameters', Y, the suspects' of one column each, the payload's.
    fn width(&self) -> usize {
        self.frame.layout.decimated + 1
    }

    fn run(&self, log: &Log) -> Result<RunScores, Error> {
        let lines = self.model.info().sizes.dof;
        let mut motions = Motions::new(self.model, log, self.settings)?;
        let decimator = Decimator::new(self.settings.decimation)?;
        let samples = motions.samples();
        let mut streams: Vec<Decimation> = (0..lines)
            .map(|_| decimator.stream(self.width(), samples))
            .collect::<Result<_, _>>()?;
        let actuators = self.model.info().sizes.actuators;
        let mut places = decimator.stream(actuators, samples)?;
        let mut sink = Sink::new(self.frame, decimator.kept(samples));
        while let Some(motion) = motions.next()? {
            let (rows, positions) = self.rows(&motion)?;
            let mut kept: Vec<Vec<f64>> = vec![Vec::new(); lines];
            let all = streams.par_iter_mut().zip(&mut kept).zip(&rows);
            all.for_each(|((stream, kept), rows)| stream.push(rows, kept));
            let mut at = Vec::new();
            places.push(&positions, &mut at);
            sink.take(&kept, &at);
        }
        Ok(sink.told())
    }

    /// The rows of all samples of a motion, line by line of the estimate's inputs, and the positions of the
    /// actuators.
    fn rows(&self, motion: &Motion) -> Result<(Vec<Vec<f64>>, Vec<f64>), Error> {
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
        let nearby = Nearby {
            model: self.model,
            columns: self.columns,
            base: self.base,
            values: self.frame.values,
        };
        let [velocities, accelerations] = nearby.actuators(motion, &jacobians)?;
        let signals: [&[f64]; 4] = [&positions, &velocities, &accelerations, &torques];
        let actuators = moments((motion, Reversal::new(self.settings)), signals);
        let clock = nearby.clock(motion)?;
        let moved = self
            .frame
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
                reaches: self.frame.reaches,
                pose: slice(&motion.pose, info.sizes.pose, sample, 1),
                clock: slice(&clock, r, sample, 1),
                offsets: slice(&offsets, n * r, sample, 1),
            };
            for (line, rows) in lines.iter_mut().enumerate() {
                let row = &mut rows[sample * width..(sample + 1) * width];
                let narrow = row.len() - own - self.model.info().sizes.payload_parameters;
                let (suspects, load) = row[own..].split_at_mut(narrow);
                // Waves, which come last, are made of decimated positions.
                for (to, suspect) in suspects.iter_mut().zip(self.frame.suspects) {
                    *to = here.entry(*suspect, line);
                }
                load.copy_from_slice(slice(&payload, load.len(), sample * r + line, 1));
            }
        }
        Ok((self.kept(lines, &jacobians), positions))
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
                let explained: f64 = row[..p]
                    .iter()
                    .zip(self.frame.values)
                    .map(|(w, x)| w * x)
                    .sum();
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
        let kept = match self.kind {
            ModelKind::Platform => return lines,
            ModelKind::Joints => (0..sizes.actuators).collect(),
            ModelKind::Actuators => self.settings.kept_actuators.clone(),
        };
        let mut choice = KeptActuators::new(kept, &home_scales(self.model));
        projected(&lines, &mut choice, jacobians, sizes.actuators * sizes.dof).0
    }
}
