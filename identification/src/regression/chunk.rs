//! Some successive samples as equations: conditions of the kept actuators, and rows projected on them.

use crate::kinematics::conditioning::{Condition, KeptActuators};

/// Some successive samples, evaluated: for each projection and line samples x (columns + 1), Y last.
pub(crate) struct Chunk {
    pub(crate) lines: Vec<Vec<Vec<f64>>>,
    /// For each projection, the conditions of its kept actuators.
    pub(super) conditions: Vec<Vec<Condition>>,
}

impl Chunk {
    /// Number of samples.
    pub(crate) fn samples(&self) -> usize {
        self.conditions.first().map_or(0, Vec::len)
    }
}

/// The conditions of a choice of actuators sample by sample.
pub(super) fn conditions(
    choice: &mut KeptActuators,
    jacobians: &[f64],
    size: usize,
) -> Vec<Condition> {
    let one = |jacobian: &[f64]| {
        if choice.is_identity(jacobian) {
            Condition::PERFECT
        } else {
            choice.condition(jacobian)
        }
    };
    jacobians.chunks_exact(size).map(one).collect()
}

/// Rows of Γ² = J_a^-T Γ¹ from rows of Γ¹, line by line, and the first sample at which J_a is singular.
pub(crate) fn projected(
    platform: &[Vec<f64>],
    choice: &mut KeptActuators,
    jacobians: &[f64],
    size: usize,
) -> (Vec<Vec<f64>>, Option<usize>) {
    let r = platform.len();
    let samples = jacobians.len() / size;
    let width = platform
        .first()
        .map_or(0, |rows| rows.len() / samples.max(1));
    let mut lines = vec![vec![0.0; samples * width]; r];
    for (sample, jacobian) in jacobians.chunks_exact(size).enumerate() {
        let range = sample * width..(sample + 1) * width;
        if choice.is_identity(jacobian) {
            for (line, rows) in lines.iter_mut().zip(platform) {
                line[range.clone()].copy_from_slice(&rows[range.clone()]);
            }
            continue;
        }
        let Some(inverse) = choice.inverse(jacobian) else {
            return (lines, Some(sample));
        };
        for (line, target) in lines.iter_mut().enumerate() {
            let target = &mut target[range.clone()];
            for (j, rows) in platform.iter().enumerate() {
                // Entry (line, j) of the transposed inverse.
                let factor = inverse[j * r + line];
                let rows = &rows[range.clone()];
                target
                    .iter_mut()
                    .zip(rows)
                    .for_each(|(to, from)| *to += factor * from);
            }
        }
    }
    (lines, None)
}
