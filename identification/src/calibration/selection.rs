//! Choice of the changed parameters: stepwise selection.
//!
//! The closure has n - r equations per sample. If all parameters may change, many sets explain them
//! equally well, since only the description defines the base frame, the platform frame and the unit
//! of length. The smallest set is therefore searched:
//!
//! - Parameters enter one by one, the one with the largest gain first, while the gain is
//!   significant for white noise.
//! - After each entry, parameters are exchanged for better ones, and useless ones are removed.
//! - Finally, parameters that are insignificant for correlated noise are removed.
//!
//! All other parameters stay as described.

use nalgebra::DVector;

use super::{
    deviations::{Deviations, variance},
    elimination::{Normal, Problem, State},
    fit::{Fit, inverted, restricted, solved},
};
use crate::estimation::intervals::distributions::student_quantile;

/// Probability that any parameter enters although the description is right.
pub(super) const FALSE_ALARM: f64 = 1e-3;

/// Smallest squared fraction of a parameter's effect outside those of others.
///
/// It is the square root of the rounding error of sums of squares.
pub(super) const INDEPENDENT: f64 = 1e-10;

/// Largest number of entries and exchanges for each candidate.
const ROUNDS: usize = 4;

/// Inputs of the selection.
#[derive(Clone, Copy)]
pub(super) struct Choice<'a> {
    pub(super) problem: &'a Problem<'a>,
    /// Candidates for change.
    pub(super) candidates: &'a [usize],
    /// n - r.
    pub(super) redundancy: usize,
}

impl Choice<'_> {
    /// Fit of the smallest set that explains the samples.
    pub(super) fn smallest(&self, start: State) -> Result<Fit, overact::Error> {
        let mut fit = Fit::new(self.problem, start, Vec::new())?;
        // Limits a search that cycles.
        for _ in 0..ROUNDS * self.candidates.len() {
            let next = match self.exchanged(&fit)? {
                Some(next) => Some(next),
                None => self.entered(&fit)?,
            };
            match next {
                Some(next) => fit = next,
                None => break,
            }
        }
        while let Some(next) = self.smaller(&fit)? {
            fit = next;
        }
        while let Some(next) = self.removed(&fit)? {
            fit = next;
        }
        Ok(fit)
    }

    /// Fit with the parameter of the largest gain, if that is significant.
    fn entered(&self, fit: &Fit) -> Result<Option<Fit>, overact::Error> {
        let free = self.candidates.iter().copied();
        let gains = free.filter_map(|one| Some((one, self.gain(fit, one)?)));
        let Some((best, gain)) = gains.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Ok(None);
        };
        if gain < self.least_gain(fit) {
            return Ok(None);
        }
        let selected = [fit.selected.as_slice(), &[best]].concat();
        let next = Fit::new(self.problem, fit.state.clone(), selected)?;
        let better = next.normal.square < fit.normal.square - self.least_gain(fit);
        Ok((next.converged && better).then_some(next))
    }

    /// Fit without the least significant parameter, if that is insignificant.
    fn removed(&self, fit: &Fit) -> Result<Option<Fit>, overact::Error> {
        let Some(ratios) = self.ratios(fit) else {
            return Ok(None);
        };
        let least = ratios.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
        let Some((place, _)) = least.filter(|(_, ratio)| **ratio < 1.0) else {
            return Ok(None);
        };
        let set = without(&fit.selected, fit.selected[place]);
        self.of_set(fit, set).map(Some)
    }

    /// Fit with one parameter exchanged for a better one, or without a useless one.
    fn exchanged(&self, fit: &Fit) -> Result<Option<Fit>, overact::Error> {
        let model = LinearModel::new(fit);
        if let Some(useless) = self.useless(fit, &model) {
            let next = self.of_set(fit, without(&fit.selected, useless))?;
            let as_good = next.normal.square < self.as_good(fit);
            return Ok((next.converged && as_good).then_some(next));
        }
        let mut best: Option<(f64, usize, usize)> = None;
        for &out in &fit.selected {
            for &other in self.candidates {
                if fit.selected.contains(&other) {
                    continue;
                }
                let set = exchanged(&fit.selected, out, other);
                let Some(square) = model.square(&set) else {
                    continue;
                };
                if best.is_none_or(|(least, ..)| square < least) {
                    best = Some((square, out, other));
                }
            }
        }
        let limit = fit.normal.square - self.least_gain(fit);
        let Some((_, out, other)) = best.filter(|(square, ..)| *square < limit) else {
            return Ok(None);
        };
        let next = self.of_set(fit, exchanged(&fit.selected, out, other))?;
        let better = next.converged && next.normal.square < limit;
        Ok(better.then_some(next))
    }

    /// Fit with one parameter removed and another one exchanged, if it is as good.
    ///
    /// One parameter may explain alone what two explain together.
    fn smaller(&self, fit: &Fit) -> Result<Option<Fit>, overact::Error> {
        let model = LinearModel::new(fit);
        let mut best: Option<(f64, Vec<usize>)> = None;
        for &useless in &fit.selected {
            let rest = without(&fit.selected, useless);
            for (&out, &other) in rest
                .iter()
                .flat_map(|out| self.candidates.iter().map(move |c| (out, c)))
            {
                if fit.selected.contains(&other) {
                    continue;
                }
                let set = exchanged(&rest, out, other);
                let square = model.square(&set).unwrap_or(f64::INFINITY);
                if best.as_ref().is_none_or(|(least, _)| square < *least) {
                    best = Some((square, set));
                }
            }
        }
        let limit = self.as_good(fit);
        let Some((_, set)) = best.filter(|(square, _)| *square < limit) else {
            return Ok(None);
        };
        let next = self.of_set(fit, set)?;
        Ok((next.converged && next.normal.square < limit).then_some(next))
    }

    /// Fit of another set, starting from a fit.
    fn of_set(&self, fit: &Fit, set: Vec<usize>) -> Result<Fit, overact::Error> {
        let mut state = fit.state.clone();
        for (place, change) in state.changes.iter_mut().enumerate() {
            if !set.contains(&place) {
                *change = 0.0;
            }
        }
        Fit::new(self.problem, state, set)
    }

    /// Sum of squares up to which a smaller set is as good.
    ///
    /// It allows half of the gain that a parameter needs to enter, which prevents cycles.
    fn as_good(&self, fit: &Fit) -> f64 {
        fit.normal.square + 0.5 * self.least_gain(fit)
    }

    /// A parameter that the others make useless.
    fn useless(&self, fit: &Fit, model: &LinearModel<'_>) -> Option<usize> {
        let limit = self.as_good(fit);
        fit.selected.iter().copied().find(|&out| {
            let square = model.square(&without(&fit.selected, out));
            square.is_some_and(|square| square < limit)
        })
    }

    /// Decrease of the sum of squares with one more parameter; `None` if selected or dependent.
    fn gain(&self, fit: &Fit, one: usize) -> Option<f64> {
        if fit.selected.contains(&one) {
            return None;
        }
        let own = independent_part(&fit.normal, &fit.selected, one)?;
        Some(fit.normal.right[one].powi(2) / own)
    }

    /// Smallest significant decrease of the sum of squares.
    pub(super) fn least_gain(&self, fit: &Fit) -> f64 {
        let count = self.problem.samples.count() * self.redundancy;
        let variance = variance(fit.normal.square, count, fit.selected.len());
        let quantile = student_quantile(self.level(), count as f64);
        variance * quantile * quantile
    }

    /// Probability that one right parameter enters.
    fn level(&self) -> f64 {
        FALSE_ALARM / self.candidates.len().max(1) as f64
    }

    /// Change of each fitted parameter, divided by the largest insignificant one.
    fn ratios(&self, fit: &Fit) -> Option<Vec<f64>> {
        let of_runs = &self.problem.samples.of_runs;
        let deviations = Deviations::new(fit, of_runs, self.redundancy)?;
        let values = fit.values().into_iter().enumerate();
        let ratio =
            |(place, value): (usize, f64)| value.abs() / deviations.half(place, self.level());
        Some(values.map(ratio).collect())
    }

    /// Parameters that explain the samples as well instead of `out`, in the linearised equations.
    pub(super) fn alternatives(&self, fit: &Fit, out: usize) -> Vec<usize> {
        let model = LinearModel::new(fit);
        let limit = fit.normal.square + self.least_gain(fit);
        let free = self.candidates.iter().copied();
        let others = free.filter(|one| !fit.selected.contains(one));
        others
            .filter(|&other| {
                let square = model.square(&exchanged(&fit.selected, out, other));
                square.is_some_and(|square| square <= limit)
            })
            .collect()
    }
}

/// The set with `other` instead of `out`.
fn exchanged(selected: &[usize], out: usize, other: usize) -> Vec<usize> {
    let one = |&own: &usize| if own == out { other } else { own };
    let mut set: Vec<usize> = selected.iter().map(one).collect();
    set.sort_unstable();
    set
}

/// The set without `out`.
fn without(selected: &[usize], out: usize) -> Vec<usize> {
    selected.iter().copied().filter(|one| *one != out).collect()
}

/// Squared part of a parameter's effect outside the selected ones; `None` if there is none.
pub(super) fn independent_part(normal: &Normal, selected: &[usize], one: usize) -> Option<f64> {
    let whole = normal.matrix[(one, one)];
    let mut own = whole;
    if !selected.is_empty() {
        let among = normal.matrix.column(one).select_rows(selected);
        let explained = solved(&restricted(&normal.matrix, selected), &among)?;
        own -= among.dot(&explained);
    }
    (whole > 0.0 && own > INDEPENDENT * whole).then_some(own)
}

/// Sum of squares as a function of all parameters, linearised at a fit.
struct LinearModel<'a> {
    normal: &'a Normal,
    /// N p + g, with the changes p of the fit: right-hand side for total changes.
    right: DVector<f64>,
    /// Sum of squares without any change.
    square: f64,
}

impl<'a> LinearModel<'a> {
    fn new(fit: &'a Fit) -> Self {
        let normal = &fit.normal;
        let changes = DVector::from_column_slice(&fit.state.changes);
        let along = &normal.matrix * &changes;
        Self {
            square: normal.square + changes.dot(&along) + 2.0 * normal.right.dot(&changes),
            right: along + &normal.right,
            normal,
        }
    }

    /// Smallest sum of squares for changes of a set; `None` if the set is undetermined.
    fn square(&self, set: &[usize]) -> Option<f64> {
        if set.is_empty() {
            return Some(self.square);
        }
        let matrix = restricted(&self.normal.matrix, set);
        let right = self.right.select_rows(set);
        let inverse = inverted(&matrix)?;
        // A numerically singular matrix gives no valid model.
        let whole = matrix.diagonal().component_mul(&inverse.diagonal());
        if whole.iter().any(|inflated| *inflated > 1.0 / INDEPENDENT) {
            return None;
        }
        Some(self.square - right.dot(&(inverse * &right)))
    }
}
