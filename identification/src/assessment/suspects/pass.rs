//! One pass over the beginning of a run: the rows of all columns, block by block.

use overact::{Function, Model};
use rayon::prelude::*;

use super::{
    columns::{Sample, Suspect, moments, rates},
    nearby::{Misreading, Nearby},
    sections::{Frame, RunScores, Sink, Tempo},
};
use crate::{
    blocks::{BLOCK, evaluate, slice},
    data::{Log, Variant},
    error::Error,
    filters::Decimation,
    kinematics::{
        Motion, Motions,
        conditioning::{KeptActuators, home_scales},
        distribution::{least_norm, product},
    },
    regression::{
        chunk::projected,
        columns::{ColumnSet, Reversal},
        fold::Phases,
        projection::ModelKind,
    },
    settings::Settings,
};

/// What a pass needs.
pub(super) struct Pass<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) variants: &'a [Variant<'a>],
    pub(super) columns: &'a ColumnSet,
    pub(super) base: &'a [usize],
    /// Places of the columns of dry friction among the base parameters.
    pub(super) friction: &'a [usize],
    pub(super) kind: ModelKind,
    pub(super) frame: Frame<'a>,
    /// One sample in so many is kept.
    pub(super) decimation: usize,
    pub(super) settings: &'a Settings,
}

impl Pass<'_> {
    /// Columns of a row: the base parameters', Y, the suspects' of one column each, the payload's.
    fn width(&self) -> usize {
        self.frame.layout.decimated + 1
    }

    /// Goes through a run, at the phases of a motion that returns.
    pub(super) fn run(&self, log: &Log, phases: Option<Phases>) -> Result<RunScores, Error> {
        let lines = self.model.info().sizes.dof;
        let mut motions = Motions::new(self.model, log, self.settings)?.unwatched();
        let decimator = self
            .settings
            .decimator(self.decimation, log.sampling_frequency())?;
        let samples = motions.samples();
        let mut streams: Vec<Decimation> = (0..lines)
            .map(|_| decimator.stream(self.width(), samples))
            .collect::<Result<_, _>>()?;
        let actuators = self.model.info().sizes.actuators;
        let mut places = decimator.stream(actuators, samples)?;
        let mut sink = Sink::new(self.frame, decimator.kept(samples), phases);
        let frequency = log.sampling_frequency();
        let mut tempo = Tempo {
            start: self.settings.skip_start as f64 / frequency,
            interval: self.decimation as f64 / frequency,
            velocities: vec![0.0; actuators],
            accelerations: vec![0.0; actuators],
        };
        let mut rows = vec![Vec::new(); lines];
        while let Some(motion) = motions.next()? {
            let jacobians = self.jacobians(&motion)?;
            let positions = self.rows(&motion, &jacobians, &mut tempo, &mut rows)?;
            let projected = self.projected(&rows, &jacobians);
            let rows = projected.as_ref().unwrap_or(&rows);
            let mut kept: Vec<Vec<f64>> = vec![Vec::new(); lines];
            let all = streams.par_iter_mut().zip(&mut kept).zip(rows);
            all.for_each(|((stream, kept), rows)| stream.push(rows, kept));
            let mut at = Vec::new();
            places.push(&positions, &mut at);
            sink.take(&kept, &at);
        }
        Ok(sink.told(tempo))
    }

    /// J_p^inv at all samples of a motion, n x r each.
    fn jacobians(&self, motion: &Motion) -> Result<Vec<f64>, Error> {
        self.ask(motion, Function::InverseJacobian, &[&motion.pose])
    }

    /// The rows of all samples of a motion, line by line of Γ¹, in the place of those of another one; gives the
    /// positions of the actuators, whose motion is noted.
    fn rows(
        &self,
        motion: &Motion,
        jacobians: &[f64],
        tempo: &mut Tempo,
        lines: &mut [Vec<f64>],
    ) -> Result<Vec<f64>, Error> {
        let n = self.model.info().sizes.actuators;
        let states: [&[f64]; 3] = [&motion.pose, &motion.twist, &motion.acceleration];
        let positions = self.ask(motion, Function::ActuatorPositions, &states[..1])?;
        self.base_rows(motion, lines)?;
        self.late_friction(motion, lines);
        let [torques, smooth] = self.inputs(motion, jacobians, lines);
        let frequency = motion.sampling_frequency;
        let torque_rates = rates(&torques, n, frequency);
        let nearby = Nearby {
            model: self.model,
            columns: self.columns,
            base: self.base,
            values: self.frame.values,
        };
        let [velocities, accelerations] = nearby.actuators(motion, jacobians)?;
        tempo.take([&velocities, &accelerations]);
        let signals: [&[f64]; 4] = [&positions, &velocities, &accelerations, &torques];
        let actuators = moments((motion, Reversal::new(self.settings)), signals);
        let suspects = self.frame.suspects;
        let moved = suspects.iter().any(|one| matches!(one, Suspect::Offset(_)));
        let misread = match moved {
            true => nearby.misread(motion, (&torques, jacobians), &actuators, &Misreading::ALL)?,
            false => Vec::new(),
        };
        let whole = Sample {
            jacobian: jacobians,
            torque_rates: &torque_rates,
            torque_turns: &rates(&torque_rates, n, frequency),
            torque_bends: &rates(&rates(&smooth, n, frequency), n, frequency),
            torques: &torques,
            actuators: &actuators,
            reaches: self.frame.reaches,
            pose: &motion.pose,
            clock: &nearby.clock(motion)?,
            misread: &misread,
            lengths: &nearby.lengths(motion, self.variants)?,
        };
        self.entries(motion, &whole, lines)?;
        Ok(positions)
    }

    /// What a function of the model gives at all samples of a motion.
    fn ask(
        &self,
        motion: &Motion,
        function: Function,
        inputs: &[&[f64]],
    ) -> Result<Vec<f64>, Error> {
        let all = evaluate(self.model, function, inputs, motion.samples);
        all.map_err(|error| motion.outside(error.sample, error.error).into())
    }

    /// The columns of base parameters, with room behind them.
    fn base_rows(&self, motion: &Motion, lines: &mut [Vec<f64>]) -> Result<(), Error> {
        let sizes = self.model.info().sizes;
        let more = self.width() - self.base.len();
        for rows in &mut *lines {
            rows.clear();
            rows.reserve_exact(motion.samples * self.width());
        }
        for first in (0..motion.samples).step_by(BLOCK) {
            let count = BLOCK.min(motion.samples - first);
            let states = [
                slice(&motion.pose, sizes.pose, first, count),
                slice(&motion.twist, sizes.dof, first, count),
                slice(&motion.acceleration, sizes.dof, first, count),
            ];
            let time = (count, 1.0 / motion.sampling_frequency);
            let picked = (self.base, more);
            let own = self.columns;
            let rows = own.evaluate(self.model, &states, time, motion.carried(), picked);
            let rows = rows.map_err(|error| motion.outside(first + error.sample, error.error))?;
            let both = lines.iter_mut().zip(rows);
            both.for_each(|(all, rows)| all.extend(rows));
        }
        Ok(())
    }

    /// The columns -ẇ of dry friction that comes late.
    fn late_friction(&self, motion: &Motion, lines: &mut [Vec<f64>]) {
        let p = self.base.len();
        for (to, from) in self.friction.iter().enumerate() {
            for rows in &mut *lines {
                let column = rows.iter().skip(*from).step_by(self.width());
                let column: Vec<f64> = column.copied().collect();
                let late = rates(&column, 1, motion.sampling_frequency);
                let places = rows.iter_mut().skip(p + to).step_by(self.width());
                places.zip(late).for_each(|(place, rate)| *place = -rate);
            }
        }
    }

    /// The columns of suspects and the payload's, of what `whole` has of all samples.
    fn entries(
        &self,
        motion: &Motion,
        whole: &Sample<'_>,
        lines: &mut [Vec<f64>],
    ) -> Result<(), Error> {
        let sizes = self.model.info().sizes;
        let (n, r, width) = (sizes.actuators, sizes.dof, self.width());
        let states: [&[f64]; 3] = [&motion.pose, &motion.twist, &motion.acceleration];
        let payload = match sizes.payload_parameters {
            0 => Vec::new(),
            _ => self.ask(motion, Function::IdmRedPayload, &states)?,
        };
        let layout = self.frame.layout;
        let own = layout.base + 1;
        let mut factors = Vec::new();
        for sample in 0..motion.samples {
            let part = |all, width| slice(all, width, sample, 1);
            let here = Sample {
                jacobian: part(whole.jacobian, n * r),
                torques: part(whole.torques, n),
                torque_rates: part(whole.torque_rates, n),
                torque_bends: part(whole.torque_bends, n),
                torque_turns: part(whole.torque_turns, n),
                actuators: &whole.actuators[sample * n..(sample + 1) * n],
                reaches: whole.reaches,
                pose: part(whole.pose, sizes.pose),
                clock: part(whole.clock, r),
                misread: part(whole.misread, Misreading::ALL.len() * n * r),
                lengths: part(whole.lengths, self.variants.len() * r),
            };
            // Waves, which come last, are made of decimated positions.
            let narrow = self.frame.suspects.iter();
            let narrow = narrow.take(layout.decimated - layout.base);
            factors.clear();
            factors.extend(narrow.map(|suspect| here.factor(*suspect)));
            for (line, rows) in lines.iter_mut().enumerate() {
                let row = &mut rows[sample * width..(sample + 1) * width];
                let narrow = row.len() - own - sizes.payload_parameters;
                let (suspects, load) = row[own..].split_at_mut(narrow);
                let all = self.frame.suspects.iter().zip(&factors);
                for (to, (suspect, factor)) in suspects.iter_mut().zip(all) {
                    *to = here.entry(*suspect, *factor, line);
                }
                load.copy_from_slice(slice(&payload, load.len(), sample * r + line, 1));
            }
        }
        Ok(())
    }

    /// Puts the measured inputs into the rows, and gives the torques freed of the residual, and freed of dry friction
    /// beside it.
    fn inputs(&self, motion: &Motion, jacobians: &[f64], lines: &mut [Vec<f64>]) -> [Vec<f64>; 2] {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let (width, p, y) = (self.width(), self.base.len(), self.frame.layout.base);
        let mut both = [motion.torques.clone(), motion.torques.clone()];
        let (mut taken, mut own) = ([vec![0.0; r], vec![0.0; r]], vec![0.0; n]);
        for sample in 0..motion.samples {
            let jacobian = slice(jacobians, n * r, sample, 1);
            let torques = slice(&motion.torques, n, sample, 1);
            for (line, rows) in lines.iter_mut().enumerate() {
                let row = &mut rows[sample * width..(sample + 1) * width];
                let measured = torques.iter().enumerate();
                let input: f64 = measured
                    .map(|(i, torque)| jacobian[i * r + line] * torque)
                    .sum();
                let part = |place: usize| row[place] * self.frame.values[place];
                let explained: f64 = (0..p).map(part).sum();
                let dry: f64 = self.friction.iter().map(|place| part(*place)).sum();
                row[y] = input;
                taken[0][line] = input - explained;
                taken[1][line] = input - explained + dry;
            }
            let Some(distribution) = least_norm(jacobian, r) else {
                continue;
            };
            for (all, taken) in both.iter_mut().zip(&taken) {
                product(&distribution, taken, &mut own);
                let torques = &mut all[sample * n..(sample + 1) * n];
                torques
                    .iter_mut()
                    .zip(&own)
                    .for_each(|(torque, own)| *torque -= own);
            }
        }
        both
    }

    /// Rows of Γ¹ as the estimate's model takes them, where it takes others.
    fn projected(&self, lines: &[Vec<f64>], jacobians: &[f64]) -> Option<Vec<Vec<f64>>> {
        let sizes = self.model.info().sizes;
        let kept = match self.kind {
            ModelKind::Platform => return None,
            ModelKind::Joints => (0..sizes.actuators).collect(),
            ModelKind::Actuators => self.settings.kept_actuators.clone(),
        };
        let choice = KeptActuators::new(kept, &home_scales(self.model));
        Some(projected(lines, &choice, jacobians, sizes.actuators * sizes.dof).0)
    }
}
