//! The distribution of forces on cables, after a program's entries.

use super::Failed;
use crate::lowering::Program;
use overact_core::Error;
use overact_core::limits::DOUBLE;
use overact_core::tension::{Workspace, solve};

/// Working memory of the distribution.
#[derive(Debug, Default)]
pub(super) struct Tensions {
    /// Entries of all samples of a call.
    pub(super) entries: Vec<f64>,
    internal: Vec<f64>,
    direction: Vec<f64>,
    multipliers: Vec<f64>,
    changes: Vec<f64>,
    active: Vec<usize>,
    products: Vec<f64>,
}

impl Tensions {
    /// Memory for a program; empty if it has no cables.
    pub(super) fn new(program: &Program) -> Self {
        let actuators = program.least_torques.len();
        let Some(redundancy) = program.entries.len().checked_div(actuators) else {
            return Self::default();
        };
        let m = redundancy.saturating_sub(1);
        Self {
            entries: Vec::new(),
            internal: vec![0.0; m],
            direction: vec![0.0; m],
            multipliers: vec![0.0; m],
            changes: vec![0.0; m],
            active: vec![0; m],
            products: vec![0.0; m * m],
        }
    }

    /// Torques of the first `samples` samples from their entries.
    pub(super) fn distribute(
        &mut self,
        program: &Program,
        samples: usize,
        entries: &[f64],
        output: &mut [f64],
    ) -> Result<(), Failed> {
        let (width, count) = (program.entries.len(), program.least_torques.len());
        let rows = entries
            .chunks_exact(width)
            .zip(output.chunks_exact_mut(count));
        for (sample, (system, torques)) in rows.take(samples).enumerate() {
            let workspace = Workspace {
                internal: &mut self.internal,
                direction: &mut self.direction,
                multipliers: &mut self.multipliers,
                changes: &mut self.changes,
                active: &mut self.active,
                products: &mut self.products,
            };
            let least = &program.least_torques;
            solve(system, least, DOUBLE.tension, torques, workspace).map_err(|error| Failed {
                sample,
                guard: program.guards.len(),
                value: if error == Error::Tensions {
                    0.0
                } else {
                    f64::NAN
                },
            })?;
        }
        Ok(())
    }
}
