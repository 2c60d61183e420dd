//! Equations of some successive samples, with the actuator projection.

use pulp::NullaryFnOnce;

use crate::{
    kinematics::conditioning::{Condition, KeptActuators},
    with_avx::with_avx2,
};

/// Evaluated samples: for each projection and line, samples × (columns + 1), Y last.
pub(crate) struct Chunk {
    pub(crate) lines: Vec<Vec<Vec<f64>>>,
    /// For each projection and line, what was subtracted from Y; empty without held parameters.
    pub(crate) subtracted: Vec<Vec<Vec<f64>>>,
    /// For each projection, the conditions of its kept actuators.
    pub(crate) conditions: Vec<Vec<Condition>>,
}

impl Chunk {
    /// Number of samples.
    pub(crate) fn samples(&self) -> usize {
        self.conditions.first().map_or(0, Vec::len)
    }
}

/// Rows of Γ² = J_a^-T Γ¹ from rows of Γ¹, line by line, and the first singular sample.
///
/// Rows from the singular sample on are invalid. `None` if J_a is the identity at all samples, as in
/// robots without loops: both are then equal.
pub(crate) fn projected(
    platform: &[Vec<f64>],
    choice: &KeptActuators,
    jacobians: &[f64],
    size: usize,
) -> Option<(Vec<Vec<f64>>, Option<usize>)> {
    let mut all = jacobians.chunks_exact(size);
    if all.all(|jacobian| choice.is_identity(jacobian)) {
        return None;
    }
    let r = platform.len();
    let samples = jacobians.len() / size;
    let width = platform
        .first()
        .map_or(0, |rows| rows.len() / samples.max(1));
    let mut lines = vec![vec![0.0; samples * width]; r];
    let (inverses, singular) = choice.inverses(jacobians, size);
    for (line, rows) in lines.iter_mut().enumerate() {
        with_avx2(Combined {
            platform,
            inverses: &inverses,
            line,
            width,
            rows,
        });
    }
    for (sample, jacobian) in jacobians.chunks_exact(size).enumerate() {
        // Copy unchanged numbers to keep all digits and signs.
        if choice.is_identity(jacobian) {
            let range = sample * width..(sample + 1) * width;
            for (line, rows) in lines.iter_mut().zip(platform) {
                line[range.clone()].copy_from_slice(&rows[range.clone()]);
            }
        }
    }
    Some((lines, singular))
}

/// Vectorised computation of a line of Γ²: combination of the lines of Γ¹.
struct Combined<'a> {
    platform: &'a [Vec<f64>],
    /// Inverses, r × r for each sample.
    inverses: &'a [f64],
    line: usize,
    width: usize,
    rows: &'a mut [f64],
}

impl NullaryFnOnce for Combined<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (r, width) = (self.platform.len(), self.width);
        let rows = self.rows.chunks_exact_mut(width.max(1));
        for (sample, (inverse, target)) in self.inverses.chunks_exact(r * r).zip(rows).enumerate() {
            let range = sample * width..(sample + 1) * width;
            let factor = |j: usize| inverse[j * r + self.line];
            if let [a, b, c] = self.platform {
                let [a, b, c] = [a, b, c].map(|rows| &rows[range.clone()]);
                let (f, g, h) = (factor(0), factor(1), factor(2));
                for (k, to) in target.iter_mut().enumerate() {
                    *to = f * a[k] + g * b[k] + h * c[k];
                }
                continue;
            }
            for (j, rows) in self.platform.iter().enumerate() {
                let (factor, rows) = (factor(j), &rows[range.clone()]);
                for (k, to) in target.iter_mut().enumerate() {
                    *to += factor * rows[k];
                }
            }
        }
    }
}
