//! Which parameters are changed.
//!
//! The loops tell the difference of what the sensors show and what the geometry allows, n - r numbers a
//! sample; many sets of parameters explain it equally well when all may change, for nothing but the
//! description says where the base frame, the platform frame and the unit of length are. So the smallest
//! set that explains it is looked for: parameters enter one after the other, each time the one that explains
//! most, as long as it explains more than chance would under white noise; after each, parameters are
//! exchanged for others that explain more in their place, and leave where the others have made them useless.
//! At the end those leave that are not significant by their honest deviations. All others stay as described.

use nalgebra::DVector;

use super::{
    deviations::{Deviations, variance},
    elimination::{Normal, Problem, State},
    fit::{Fit, inverted, restricted, solved},
};
use crate::estimation::intervals::distributions::student_quantile;

/// Probability that any parameter enters although the description is right.
pub(super) const FALSE_ALARM: f64 = 1e-3;

/// Part of a parameter's effect outside of those of others, squared, below which it can't be told from
/// them: the root of what rounding leaves of sums of squares.
pub(super) const INDEPENDENT: f64 = 1e-10;

/// Entries and exchanges, at most, for each parameter that may be changed.
const ROUNDS: usize = 4;

/// What a choice is made from.
#[derive(Clone, Copy)]
pub(super) struct Choice<'a> {
    pub(super) problem: &'a Problem<'a>,
    /// Parameters that may be changed.
    pub(super) candidates: &'a [usize],
    /// n - r.
    pub(super) redundancy: usize,
}

impl Choice<'_> {
    /// The fit of the smallest set that explains the samples.
    pub(super) fn smallest(&self, start: State) -> Result<Fit, overact::Error> {
        let mut fit = Fit::new(self.problem, start, Vec::new())?;
        // As often as this a search that goes round in circles may turn.
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

    /// The fit with the parameter that explains most of what is left, if it is significant.
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

    /// The fit without the least significant parameter, if that is not significant at all.
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

    /// The fit with one parameter exchanged for another that explains more in its place, or without one
    /// that the others have made useless.
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

    /// The fit of one parameter less that explains as much, with one of the others exchanged: what two
    /// parameters explain together, one may explain alone.
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

    /// The fit of another set, from where a fit is.
    fn of_set(&self, fit: &Fit, set: Vec<usize>) -> Result<Fit, overact::Error> {
        let mut state = fit.state.clone();
        for (place, change) in state.changes.iter_mut().enumerate() {
            if !set.contains(&place) {
                *change = 0.0;
            }
        }
        Fit::new(self.problem, state, set)
    }

    /// The sum of squares up to which a smaller set is as good: half of what a parameter has to explain to
    /// enter, so that none enters and leaves for ever.
    fn as_good(&self, fit: &Fit) -> f64 {
        fit.normal.square + 0.5 * self.least_gain(fit)
    }

    /// A parameter without which the others explain as much.
    fn useless(&self, fit: &Fit, model: &LinearModel<'_>) -> Option<usize> {
        let limit = self.as_good(fit);
        fit.selected.iter().copied().find(|&out| {
            let square = model.square(&without(&fit.selected, out));
            square.is_some_and(|square| square < limit)
        })
    }

    /// By how much the sum of squares falls with one more parameter; none where it is selected or can't
    /// be told from those that are.
    fn gain(&self, fit: &Fit, one: usize) -> Option<f64> {
        if fit.selected.contains(&one) {
            return None;
        }
        let own = independent_part(&fit.normal, &fit.selected, one)?;
        Some(fit.normal.right[one].powi(2) / own)
    }

    /// The fall of the sum of squares that is more than chance.
    pub(super) fn least_gain(&self, fit: &Fit) -> f64 {
        let count = self.problem.samples.count() * self.redundancy;
        let variance = variance(fit.normal.square, count, fit.selected.len());
        let quantile = student_quantile(self.level(), count as f64);
        variance * quantile * quantile
    }

    /// The probability that one parameter which is right enters.
    fn level(&self) -> f64 {
        FALSE_ALARM / self.candidates.len().max(1) as f64
    }

    /// For each fitted parameter its change in units of the one that chance would allow.
    fn ratios(&self, fit: &Fit) -> Option<Vec<f64>> {
        let of_runs = &self.problem.samples.of_runs;
        let deviations = Deviations::new(fit, of_runs, self.redundancy)?;
        let values = fit.values().into_iter().enumerate();
        let ratio =
            |(place, value): (usize, f64)| value.abs() / deviations.half(place, self.level());
        Some(values.map(ratio).collect())
    }

    /// The parameters that explain the samples as well in the place of the parameter `out`, as far as
    /// the equations at the solution tell.
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

/// A set with one parameter in the place of another.
fn exchanged(selected: &[usize], out: usize, other: usize) -> Vec<usize> {
    let one = |&own: &usize| if own == out { other } else { own };
    let mut set: Vec<usize> = selected.iter().map(one).collect();
    set.sort_unstable();
    set
}

/// A set without one of its parameters.
fn without(selected: &[usize], out: usize) -> Vec<usize> {
    selected.iter().copied().filter(|one| *one != out).collect()
}

/// The part of a parameter's effect that no change of the selected ones has, as a sum of squares; none
/// where there is no such part.
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

/// The sum of squares as a function of all parameters, linear about a fit.
struct LinearModel<'a> {
    normal: &'a Normal,
    /// N p + g, with p the changes that the fit has made: the right-hand side for the whole changes.
    right: DVector<f64>,
    /// The sum of squares without any change.
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

    /// The least sum of squares that changes of a set of parameters reach; none for one that is not
    /// determined.
    fn square(&self, set: &[usize]) -> Option<f64> {
        if set.is_empty() {
            return Some(self.square);
        }
        let matrix = restricted(&self.normal.matrix, set);
        let right = self.right.select_rows(set);
        let inverse = inverted(&matrix)?;
        // What rounding leaves of a singular matrix is no model.
        let whole = matrix.diagonal().component_mul(&inverse.diagonal());
        if whole.iter().any(|inflated| *inflated > 1.0 / INDEPENDENT) {
            return None;
        }
        Some(self.square - right.dot(&(inverse * &right)))
    }
}
