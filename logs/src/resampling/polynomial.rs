//! Interpolation by the polynomial of degree 5 through the six samples around a time.
//!
//! Its error is |x⁽⁶⁾| |(t - t₁)…(t - t₆)|/720. For steps h:
//!
//! | place | bound of the error |
//! |---|---|
//! | inside a run | 0.0049 h⁶ \|x⁽⁶⁾\| |
//! | first and last two steps | 0.024 h⁶ \|x⁽⁶⁾\| |
//!
//! The relative error of a sine is 5e-6 with twenty samples per period, and 3e-4 with ten. Samples
//! keep their values.

use std::collections::VecDeque;

/// Number of samples of a polynomial.
pub(super) const NODES: usize = 6;

/// A sample: its time and its values.
pub(super) type Node = (f64, Vec<f64>);

/// The polynomial around a time, through nodes with increasing times.
pub(super) struct Polynomial {
    /// Index of its first node.
    pub(super) start: usize,
    /// Weights of the nodes; their sum is one.
    weights: [f64; NODES],
    count: usize,
}

impl Polynomial {
    /// The polynomial for `time`; `step` is the usual one between nodes.
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

    /// Evaluates the polynomial.
    pub(super) fn values(&self, nodes: &VecDeque<Node>, values: &mut [f64]) {
        values.fill(0.0);
        for (weight, (_, row)) in self.weights[..self.count]
            .iter()
            .zip(nodes.range(self.start..))
        {
            // At a sample's time, its neighbours have no influence, even if they are NaN.
            if *weight != 0.0 {
                values
                    .iter_mut()
                    .zip(row)
                    .for_each(|(value, own)| *value += weight * own);
            }
        }
    }
}
