//! Cross-validation within the data: each fold is predicted from all others.
//!
//! A fold is a run if the other runs determine the parameters, else the same part of every run.
//! From R factors, a fold costs one small factorisation, for runs of any length.

use super::super::estimate::percent;
use crate::regression::{
    elimination::eliminate,
    factor::{DATA_RANK_TOLERANCE, Factor},
    system::{RunPart, System},
};

/// Folds of a system.
#[derive(Debug, Clone)]
pub(crate) struct CrossValidationFolds {
    folds: Vec<Fold>,
    /// ||Y|| of all folds.
    measured: f64,
}

/// A fold and all other data.
#[derive(Debug, Clone)]
struct Fold {
    /// Unweighted equations of the fold, all lines together.
    own: Factor,
    /// Weighted equations of the other folds.
    others: Factor,
}

impl CrossValidationFolds {
    /// Folds of a system with these line weights.
    ///
    /// `None` if the columns `selected` are not determined without one of the folds.
    pub(crate) fn new(system: &System, selected: &[usize], weights: &[f64]) -> Option<Self> {
        let runs: Vec<usize> = system.parts.iter().map(|part| part.run).collect();
        // Number of each part within its run.
        let parts: Vec<usize> = (0..runs.len())
            .map(|part| {
                runs[..part]
                    .iter()
                    .filter(|run| **run == runs[part])
                    .count()
            })
            .collect();
        let by_label = |labels: &[usize]| Self::labelled(system, selected, weights, labels);
        by_label(&runs).or_else(|| by_label(&parts))
    }

    /// Folds of the parts with equal labels.
    fn labelled(
        system: &System,
        selected: &[usize],
        weights: &[f64],
        labels: &[usize],
    ) -> Option<Self> {
        let count = labels.iter().max()? + 1;
        if count < 2 {
            return None;
        }
        let ones = vec![1.0; weights.len()];
        let merged = |label: usize, held: bool, weights: &[f64]| -> Option<Factor> {
            let parts = system.parts.iter().zip(labels);
            let chosen: Vec<&RunPart> = parts
                .filter(|(_, own)| (**own == label) == held)
                .map(|(part, _)| part)
                .collect();
            let mut sum = Factor::new(system.lines.first()?.parameters());
            for part in chosen {
                sum.add(&Factor::merged(&part.lines, weights));
            }
            Some(sum)
        };
        let mut folds = Vec::new();
        for label in 0..count {
            let others = merged(label, false, weights)?;
            let determined = eliminate(others.matrix(), selected, DATA_RANK_TOLERANCE).kept;
            if determined.len() < selected.len() {
                return None;
            }
            folds.push(Fold {
                own: merged(label, true, &ones)?,
                others,
            });
        }
        let squares = folds.iter().map(|fold| fold.own.measured_norm().powi(2));
        Some(Self {
            measured: squares.sum::<f64>().sqrt(),
            folds,
        })
    }

    /// 100 ||Y - W χ||/||Y|| over all folds, with χ estimated from the others.
    pub(super) fn error_percent(&self, selected: &[usize]) -> Option<f64> {
        self.error_percent_in(self, selected)
    }

    /// ||Y - W χ||² of each fold, with χ estimated from the others.
    pub(crate) fn squares(&self, selected: &[usize]) -> Option<Vec<f64>> {
        let square = |fold: &Fold| {
            let reduced = fold.others.reduced(selected);
            let values = reduced.triangle.solve_upper_triangular(&reduced.rhs)?;
            Some(fold.own.residual_norm(selected, values.as_slice()).powi(2))
        };
        self.folds.iter().map(square).collect()
    }

    /// Relative error of predicting another projection's folds.
    ///
    /// χ is estimated from the other folds of this projection.
    pub(crate) fn error_percent_in(&self, other: &Self, selected: &[usize]) -> Option<f64> {
        if self.folds.len() != other.folds.len() {
            return None;
        }
        let mut squares = 0.0;
        for (fold, judge) in self.folds.iter().zip(&other.folds) {
            let reduced = fold.others.reduced(selected);
            let values = reduced.triangle.solve_upper_triangular(&reduced.rhs)?;
            squares += judge.own.residual_norm(selected, values.as_slice()).powi(2);
        }
        Some(percent(squares.sqrt(), other.measured))
    }
}
