//! Data of all samples of a motion, from which the rows of any samples are computed.

use std::ops::Range;

use overact::Function;

use super::{
    columns::{ActuatorSignals, FaultHypothesis, Sample, rates},
    misreading::Misreading,
    pass::Pass,
    prediction::{Prediction, dot, inputs_of},
    products::live_columns::LiveColumns,
    shapes::ActuatorState,
};
use crate::{
    blocks::{BLOCK, evaluate, slice},
    kinematics::{
        Motion,
        distribution::{are_identities, least_torques},
    },
    regression::{columns::Reversal, states::SampledStates},
};
use overact_logs::Error;

/// Data of a motion; samples are consecutive.
pub(super) struct MotionData<'a> {
    pass: &'a Pass<'a>,
    /// J_p^inv, n × r.
    jacobians: &'a [f64],
    pose: &'a [f64],
    /// Rows of the base parameter columns, by block and line of Γ¹.
    base: Vec<Vec<Vec<f64>>>,
    /// Measured inputs, r per sample.
    inputs: Vec<f64>,
    /// For each line, the rates of the dry friction columns.
    friction: Vec<Vec<f64>>,
    /// Positions of the actuators.
    pub(super) positions: Vec<f64>,
    /// Torques and their derivatives, see [`Sample`].
    torques: Vec<f64>,
    torque_rates: Vec<f64>,
    torque_bends: Vec<f64>,
    torque_turns: Vec<f64>,
    pub(super) actuators: Vec<ActuatorState>,
    clock: Vec<f64>,
    common_filter: Vec<f64>,
    misread: Vec<f64>,
    lengths: Vec<f64>,
    /// Payload columns, r rows per sample.
    payload: Vec<f64>,
}

/// Inputs that the estimate predicts for a motion.
struct Explained {
    /// Predicted Γ¹, samples × r.
    all: Vec<f64>,
    /// Its part from dry friction.
    dry: Vec<f64>,
}

impl<'a> MotionData<'a> {
    /// Collects the data of a motion.
    pub(super) fn new(
        pass: &'a Pass<'a>,
        motion: &'a Motion,
        jacobians: &'a [f64],
    ) -> Result<Self, Error> {
        let sizes = pass.model.info().sizes;
        let (n, frequency) = (sizes.actuators, motion.sampling_frequency);
        let states: [&[f64]; 3] = [&motion.pose, &motion.twist, &motion.acceleration];
        let ask = |function: Function, inputs: &[&[f64]]| -> Result<Vec<f64>, Error> {
            let all = evaluate(pass.model, function, inputs, motion.samples);
            all.map_err(|error| motion.outside(error.sample, error.error).into())
        };
        let positions = ask(Function::ActuatorPositions, &states[..1])?;
        let base = base(pass, motion)?;
        let explained = explained(pass, &base);
        let inputs = inputs_of(jacobians, &motion.torques, n, sizes.dof);
        let [torques, smooth] = torques_without_residual(motion, jacobians, &inputs, &explained);
        let torque_rates = rates(&torques, n, frequency);
        let prediction = Prediction {
            model: pass.model,
            columns: pass.columns,
            base: pass.base,
            values: pass.frame.values,
            jacobians,
            is_direct: are_identities(jacobians, n, sizes.dof),
        };
        let predicted = prediction.inputs(motion, states, jacobians, 1.0 / frequency)?;
        let [velocities, accelerations] = prediction.actuators(motion)?;
        let signals = ActuatorSignals {
            positions: &positions,
            velocities: &velocities,
            accelerations: &accelerations,
            torques: &torques,
        };
        let actuators = signals.states(motion, Reversal::new(pass.settings));
        let torque_turns = rates(&torque_rates, n, frequency);
        let unchanged = prediction.unchanged(motion, &torques, &actuators)?;
        let common_filter = prediction.common_filter(&unchanged, &torque_turns);
        let hypotheses = pass.frame.hypotheses;
        let moved = hypotheses
            .iter()
            .any(|one| matches!(one, FaultHypothesis::Offset(_)));
        let misread = if moved {
            prediction.misread(&unchanged)?
        } else {
            Vec::new()
        };
        let payload = match sizes.payload_parameters {
            0 => Vec::new(),
            _ => ask(Function::IdmRedPayload, &states)?,
        };
        Ok(Self {
            friction: friction(pass, &base, frequency),
            torque_turns,
            torque_bends: rates(&rates(&smooth, n, frequency), n, frequency),
            common_filter,
            clock: prediction.clock(motion, &predicted)?,
            lengths: prediction.lengths(motion, pass.variants, &explained.all)?,
            pose: &motion.pose,
            pass,
            jacobians,
            base,
            inputs,
            positions,
            torques,
            torque_rates,
            actuators,
            misread,
            payload,
        })
    }

    /// Data of one sample.
    fn sample(&self, sample: usize) -> Sample<'_> {
        let sizes = self.pass.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let part = |all, width| slice(all, width, sample, 1);
        Sample {
            jacobian: part(self.jacobians, n * r),
            torques: part(&self.torques, n),
            torque_rates: part(&self.torque_rates, n),
            torque_bends: part(&self.torque_bends, n),
            torque_turns: part(&self.torque_turns, n),
            actuators: &self.actuators[sample * n..(sample + 1) * n],
            position_ranges: self.pass.frame.position_ranges,
            pose: part(self.pose, sizes.pose),
            clock: part(&self.clock, r),
            common_filter: part(&self.common_filter, r),
            misread: part(&self.misread, Misreading::ALL.len() * n * r),
            lengths: part(&self.lengths, self.pass.variants.len() * r),
        }
    }

    /// Overwrites `lines` with the rows of some samples, one vector per line of Γ¹.
    ///
    /// Order of the live columns: base parameters, friction rates, Y, hypotheses, payload.
    pub(super) fn rows(&self, samples: Range<usize>, live: &[LiveColumns], lines: &mut [Vec<f64>]) {
        let (pass, r) = (self.pass, lines.len());
        let (p, count) = (pass.base.len(), pass.friction.len());
        let load = pass.model.info().sizes.payload_parameters;
        for (rows, live) in lines.iter_mut().zip(live) {
            rows.resize(samples.len() * (live.decimated + 1), 0.0);
        }
        // Waves come last and are computed from decimated positions.
        let narrow = pass.width() - p - count - 1 - load;
        let hypotheses = &pass.frame.hypotheses[..narrow];
        let mut factors = vec![0.0; narrow];
        let mut own_factors = Vec::with_capacity(narrow);
        for (place, sample) in samples.enumerate() {
            let here = self.sample(sample);
            let all = factors.iter_mut().zip(hypotheses);
            all.for_each(|(factor, hypothesis)| *factor = here.factor(*hypothesis));
            let (block, inside) = (&self.base[sample / BLOCK], sample % BLOCK);
            for (line, (rows, live)) in lines.iter_mut().zip(live).enumerate() {
                let width = live.decimated + 1;
                let row = &mut rows[place * width..(place + 1) * width];
                let (base, row) = row.split_at_mut(live.base.len());
                pick(slice(&block[line], p, inside, 1), &live.base, base);
                let (late, row) = row.split_at_mut(live.friction.len());
                pick(
                    slice(&self.friction[line], count, sample, 1),
                    &live.friction,
                    late,
                );
                late.iter_mut().for_each(|rate| *rate = -*rate);
                row[0] = self.inputs[sample * r + line];
                let (own, payload) = row[1..].split_at_mut(live.hypotheses.len());
                own_factors.clear();
                own_factors.extend(live.places.iter().map(|place| factors[*place]));
                here.entries(&live.hypotheses, &own_factors, line, own);
                payload.copy_from_slice(slice(&self.payload, load, sample * r + line, 1));
            }
        }
    }
}

/// Copies the values at some `places`, or all values.
fn pick(values: &[f64], places: &[usize], to: &mut [f64]) {
    if values.len() == to.len() {
        to.copy_from_slice(values);
        return;
    }
    let picked = to.iter_mut().zip(places);
    picked.for_each(|(to, place)| *to = values[*place]);
}

/// Rows of the base parameter columns, by block and line.
fn base(pass: &Pass<'_>, motion: &Motion) -> Result<Vec<Vec<Vec<f64>>>, Error> {
    let block = |first: usize| {
        let count = BLOCK.min(motion.samples - first);
        let states = SampledStates::of_motion(motion, first, count);
        let rows = { pass.columns }.evaluate(pass.model, &states, pass.base, 0);
        rows.map_err(|error| motion.outside(first + error.sample, error.error).into())
    };
    let blocks = (0..motion.samples).step_by(BLOCK);
    blocks.map(block).collect()
}

/// Inputs that the estimate predicts for all samples.
fn explained(pass: &Pass<'_>, base: &[Vec<Vec<f64>>]) -> Explained {
    let p = pass.base.len();
    let values = &pass.frame.values[..p];
    let (mut all, mut dry) = (Vec::new(), Vec::new());
    for block in base {
        let samples = block.first().map_or(0, |rows| rows.len() / p.max(1));
        for sample in 0..samples {
            for rows in block {
                let row = slice(rows, p, sample, 1);
                let friction = pass.friction.iter();
                all.push(dot(row, values));
                dry.push(friction.map(|place| row[*place] * values[*place]).sum());
            }
        }
    }
    Explained { all, dry }
}

/// Torques without the residual, and torques without residual and dry friction.
fn torques_without_residual(
    motion: &Motion,
    jacobians: &[f64],
    inputs: &[f64],
    explained: &Explained,
) -> [Vec<f64>; 2] {
    let of_sample = |all: &[f64]| all.len() / motion.samples.max(1);
    let (n, r) = (of_sample(&motion.torques), of_sample(inputs));
    let left = inputs.iter().zip(&explained.all).map(|(y, all)| y - all);
    let left: Vec<f64> = left.collect();
    let rough = left
        .iter()
        .zip(&explained.dry)
        .map(|(left, dry)| left + dry);
    let rough: Vec<f64> = rough.collect();
    let taken = least_torques(jacobians, n, r, [&left, &rough]);
    taken.map(|taken| {
        let both = motion.torques.iter().zip(taken);
        both.map(|(torque, taken)| torque - taken).collect()
    })
}

/// Rates ẇ of the dry friction columns, by line.
fn friction(pass: &Pass<'_>, base: &[Vec<Vec<f64>>], frequency: f64) -> Vec<Vec<f64>> {
    let (p, count) = (pass.base.len(), pass.friction.len());
    let line = |line: usize| {
        let blocks = base.iter().map(|block| &block[line]);
        let rows = blocks.flat_map(|rows| rows.chunks_exact(p.max(1)));
        let columns = rows.flat_map(|row| pass.friction.iter().map(|place| row[*place]));
        rates(&columns.collect::<Vec<_>>(), count, frequency)
    };
    (0..pass.model.info().sizes.dof).map(line).collect()
}
