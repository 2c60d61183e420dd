//! Rows of the columns at sampled states.

use super::{Column, ColumnSet, Origin};
use crate::regression::{
    collect_rows::{RowSource, collect_rows},
    states::SampledStates,
};
use overact::{Columns, Function, Model, SampleError};
use std::cell::Cell;

thread_local! {
    /// Buffer for the numbers of the model's columns, reused between blocks.
    static NUMBERS: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
}

impl ColumnSet {
    /// Evaluates the columns `picked` of Γ¹.
    ///
    /// For each of the r lines, the result is samples × (picked + `more`), row-major, with zeros in
    /// the additional columns. Columns of payloads that are not carried are zero, eq. (49).
    ///
    /// # Errors
    /// The first sample at which the model has no value.
    pub fn evaluate(
        &self,
        model: &dyn Model,
        states: &SampledStates<'_>,
        picked: &[usize],
        more: usize,
    ) -> Result<Vec<Vec<f64>>, SampleError> {
        let sizes = model.info().sizes;
        let &SampledStates {
            samples,
            interval,
            pose,
            twist,
            acceleration,
            carried,
        } = states;
        let inputs = [pose, twist, acceleration];
        let fill = |function: Function, mut output: Vec<f64>| -> Result<Vec<f64>, SampleError> {
            let (rows, columns) = function.shape(&sizes);
            output.resize(samples * rows * columns, 0.0);
            if !output.is_empty() {
                let inputs = &inputs[..function.inputs().len()];
                model.evaluate(function, inputs, &mut output)?;
            }
            Ok(output)
        };
        let ask = |function: Function, wanted: bool| {
            if wanted {
                fill(function, Vec::new())
            } else {
                Ok(Vec::new())
            }
        };
        let columns = || picked.iter().filter_map(|&index| self.columns.get(index));
        let split = columns().any(|column| column.rate.is_some());
        let of_payload =
            |column: &Column| matches!(column.origin, Origin::Payload(_)) && column.counts(carried);
        let has_payload = columns().any(of_payload);
        let robot = fill(Function::IdmRedPlatform(Columns::Standard), NUMBERS.take())?;
        let payload = ask(Function::IdmRedPayload, has_payload)?;
        let averaged = columns().any(|column| column.reversal.is_some_and(|own| own.averaged));
        let velocities = ask(Function::JointVelocities, split)?;
        let accelerations = ask(Function::JointAccelerations, averaged)?;
        let width = picked.len() + more;
        // Sources of the numbers of a row: the robot's columns, then the payload's.
        let (mut own, mut load) = (Vec::new(), Vec::new());
        for (to, column) in columns().enumerate() {
            if !column.counts(carried) {
                continue;
            }
            match column.origin {
                Origin::Robot(k) => own.push((to, k)),
                Origin::Both(both) => own.extend(both.map(|k| (to, k))),
                Origin::Carried(k) => own.push((to, k)),
                Origin::Payload(k) => load.push((to, k)),
            }
        }
        let sources = [
            RowSource {
                numbers: &robot,
                count: sizes.parameters,
                places: own,
            },
            RowSource {
                numbers: &payload,
                count: sizes.payload_parameters,
                places: load,
            },
        ];
        let mut lines: Vec<Vec<f64>> = (0..sizes.dof)
            .map(|line| collect_rows(&sources, line, sizes.dof, samples, width))
            .collect();
        NUMBERS.set(robot);
        for (place, column) in columns().enumerate() {
            let Some(rate) = &column.rate else {
                continue;
            };
            let mut changes = accelerations.chunks_exact(sizes.joints);
            for (sample, joints) in velocities.chunks_exact(sizes.joints).enumerate() {
                let change = changes.next().map_or(0.0, |joints| rate.of(joints));
                let factor = column.factor(rate.of(joints), change * interval);
                if factor != 1.0 {
                    let place = sample * width + place;
                    lines.iter_mut().for_each(|rows| rows[place] *= factor);
                }
            }
        }
        Ok(lines)
    }
}
