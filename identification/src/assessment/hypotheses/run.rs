//! One pass over the start of a run: rows of all columns, block by block.

use overact::Function;

use super::{
    motion_data::MotionData,
    pass::Pass,
    products::live_columns::LiveColumns,
    sections::{RunScores, Sink, Tempo},
};
use crate::{
    blocks::{evaluate, slice},
    filters::Decimation,
    kinematics::{
        Motions,
        conditioning::{KeptActuators, couples, home_scales},
        distribution::are_identities,
    },
    regression::{chunk::projected, phase_sums::Phases, projection::ModelKind},
};
use overact_logs::{Error, Log};

/// Number of rows computed before decimation; few, since rows are long and should fit the cache.
const TOGETHER: usize = 64;

impl Pass<'_> {
    /// Reads a run, with the phases of its periodic motion.
    pub(super) fn run(&self, log: &Log, phases: Option<Phases>) -> Result<RunScores, Error> {
        let lines = self.model.info().sizes.dof;
        let is_uncoupled = self.kind == ModelKind::Joints && !couples(self.model);
        let all = self.all_columns();
        let of_actuators = || all.of_actuators(self.model, self.settings.seed);
        let mut uncoupled = is_uncoupled.then(of_actuators).flatten();
        let all = all.in_all(lines);
        loop {
            let live = uncoupled.as_ref().unwrap_or(&all);
            if let Some(scores) = self.read(log, phases, live, uncoupled.is_some())? {
                return Ok(scores);
            }
            uncoupled = None;
        }
    }

    /// Reads a run with these columns in each line.
    ///
    /// `None` if they are those of actuators that are uncoupled at home, and coupled elsewhere.
    fn read(
        &self,
        log: &Log,
        phases: Option<Phases>,
        live: &[LiveColumns],
        is_uncoupled: bool,
    ) -> Result<Option<RunScores>, Error> {
        let lines = live.len();
        let mut motions = Motions::new(self.model, log, self.settings)?.unwatched();
        let decimator = self
            .settings
            .decimator(self.decimation, log.sampling_frequency())?;
        let samples = motions.samples();
        let mut streams: Vec<Decimation> = live
            .iter()
            .map(|own| decimator.stream(own.decimated + 1, samples))
            .collect::<Result<_, _>>()?;
        let actuators = self.model.info().sizes.actuators;
        let mut places = decimator.stream(actuators, samples)?;
        let mut sink = Sink::new(self.frame, live, decimator.kept(samples), phases);
        let frequency = log.sampling_frequency();
        let mut tempo = Tempo {
            start: self.settings.skip_start as f64 / frequency,
            interval: self.decimation as f64 / frequency,
            velocities: vec![0.0; actuators],
            accelerations: vec![0.0; actuators],
            samples: 0,
        };
        let (choice, size) = (self.choice(), actuators * lines);
        let mut rows = vec![Vec::new(); lines];
        while let Some(motion) = motions.next()? {
            let jacobians = evaluate(
                self.model,
                Function::InverseJacobian,
                &[&motion.pose],
                motion.samples,
            );
            let jacobians = jacobians.map_err(|error| motion.outside(error.sample, error.error))?;
            if is_uncoupled && !are_identities(&jacobians, actuators, lines) {
                return Ok(None);
            }
            let motion_data = MotionData::new(self, &motion, &jacobians)?;
            tempo.take(&motion_data.actuators);
            let mut kept: Vec<Vec<f64>> = vec![Vec::new(); lines];
            for first in (0..motion.samples).step_by(TOGETHER) {
                let count = TOGETHER.min(motion.samples - first);
                motion_data.rows(first..first + count, live, &mut rows);
                let jacobians = slice(&jacobians, size, first, count);
                let projected = self.projected(&rows, choice.as_ref(), jacobians);
                let rows = projected.as_ref().unwrap_or(&rows);
                let all = streams.iter_mut().zip(&mut kept).zip(rows);
                all.for_each(|((stream, kept), rows)| stream.push(rows, kept));
            }
            let mut at = Vec::new();
            places.push(&motion_data.positions, &mut at);
            sink.take(&kept, &at);
        }
        Ok(Some(sink.into_scores(tempo)))
    }

    /// Rows of Γ¹ in the projection of the estimate's model; `None` if they are equal.
    fn projected(
        &self,
        lines: &[Vec<f64>],
        choice: Option<&KeptActuators>,
        jacobians: &[f64],
    ) -> Option<Vec<Vec<f64>>> {
        let sizes = self.model.info().sizes;
        let projected = projected(lines, choice?, jacobians, sizes.actuators * sizes.dof);
        projected.map(|(lines, _)| lines)
    }

    /// The actuators on which the estimate's model projects, if it does.
    fn choice(&self) -> Option<KeptActuators> {
        let kept = match self.kind {
            ModelKind::Platform => return None,
            ModelKind::Joints => (0..self.model.info().sizes.actuators).collect(),
            ModelKind::Actuators => self.settings.kept_actuators.clone(),
        };
        Some(KeptActuators::new(kept, &home_scales(self.model)))
    }
}
