//! Values between samples: the polynomial of degree 5 through the six samples around a time.
//!
//! Its error is that of interpolation by polynomials, |x⁽⁶⁾| |(t - t₁)…(t - t₆)| / 720, so below 0.0049 h⁶ |x⁽⁶⁾|
//! inside of a run whose steps are h, and below 0.024 h⁶ |x⁽⁶⁾| in its first and last two steps: of a sine 5e-6 of its
//! size with twenty samples in a period, 3e-4 with ten. Samples keep their values.

use std::collections::VecDeque;

/// Samples through which a polynomial goes.
pub(super) const NODES: usize = 6;

/// A sample: its time and its numbers.
pub(super) type Node = (f64, Vec<f64>);

/// The polynomial around a time through nodes with rising times.
pub(super) struct Polynomial {
    /// The first of its nodes.
    pub(super) start: usize,
    /// What each node counts; they add up to one.
    weights: [f64; NODES],
    count: usize,
}

impl Polynomial {
    /// The polynomial that is evaluated at `time`; `step` is the usual one between nodes.
    pub(super) fn new(nodes: &VecDeque<Node>, time: f64, step: f64) -> Self {
        let next = nodes.partition_point(|(own, _)| *own < time);
        let start = next
            .saturating_sub(NODES / 2)
            .min(nodes.len().saturating_sub(NODES));
        let count = NODES.min(nodes.len() - start);
        let mut weights = [0.0; NODES];
        let at = |node: usize| nodes[start + node].0;
        if let Some(node) = (0..count).find(|node| at(*node) == time) {
            weights[node] = 1.0;
            return Self {
                start,
                weights,
                count,
            };
        }
        let mut sum = 0.0;
        for (node, weight) in weights.iter_mut().enumerate().take(count) {
            let others = (0..count).filter(|other| *other != node);
            let product: f64 = others.map(|other| (at(node) - at(other)) / step).product();
            *weight = 1.0 / (product * ((time - at(node)) / step));
            sum += *weight;
        }
        weights.iter_mut().for_each(|weight| *weight /= sum);
        Self {
            start,
            weights,
            count,
        }
    }

    /// Its values.
    pub(super) fn values(&self, nodes: &VecDeque<Node>, values: &mut [f64]) {
        values.fill(0.0);
        for (weight, (_, row)) in self.weights[..self.count]
            .iter()
            .zip(nodes.range(self.start..))
        {
            // A sample that is met takes none of its neighbours' numbers.
            if *weight != 0.0 {
                values
                    .iter_mut()
                    .zip(row)
                    .for_each(|(value, own)| *value += weight * own);
            }
        }
    }
}
