//! Which of several equal forms of a robot's model takes the fewest operations: derived, lowered without
//! a search, and counted.

use super::regressor::Regressor;
use crate::derivation::{Formulation, Selection, Underivable, station_count};
use crate::mechanism::Mechanism;
use crate::parallel;
use std::collections::BTreeSet;

/// The cheapest formulation of the standard regressor from joint angles, with the regressor: for each shape
/// of legs the axes of its closure, then whether axes that meet share a moment; the plain form where nothing
/// is better.
///
/// # Errors
/// See [`Underivable`].
pub(super) fn cheapest_formulation(
    mechanism: &Mechanism,
    selection: &Selection,
) -> Result<(Formulation, Regressor), Underivable> {
    let plain = Formulation {
        stations: vec![0; mechanism.legs.len()],
        meeting: false,
    };
    let regressor = regressor(mechanism, selection, &plain)?;
    let mut best = Best {
        mechanism,
        // Columns that are zero in one form are zero in all.
        selection: &Selection {
            standard: regressor.parameters().to_vec(),
            ..selection.clone()
        },
        regressor,
        formulation: plain,
    };
    let mut shapes = BTreeSet::new();
    if !mechanism.is_tree() {
        let closed = mechanism.legs.iter().filter(|leg| leg.end.is_some());
        shapes.extend(closed.map(|leg| leg.shape));
    }
    for shape in shapes {
        let of_shape = |l: &usize| mechanism.legs[*l].shape == shape;
        let legs: Vec<usize> = (0..mechanism.legs.len()).filter(of_shape).collect();
        let count = legs.iter().map(|&l| station_count(mechanism, l)).min();
        let trials = (1..count.unwrap_or(0)).map(|station| {
            let mut trial = best.formulation.clone();
            legs.iter().for_each(|&l| trial.stations[l] = station);
            trial
        });
        best.choose(trials.collect());
    }
    best.choose(vec![Formulation {
        meeting: true,
        ..best.formulation.clone()
    }]);
    Ok((best.formulation, best.regressor))
}

/// The best formulation so far.
struct Best<'m> {
    mechanism: &'m Mechanism,
    selection: &'m Selection,
    formulation: Formulation,
    regressor: Regressor,
}

impl Best<'_> {
    /// Takes the best of the trials if it is better.
    fn choose(&mut self, trials: Vec<Formulation>) {
        let of = |trial: &Formulation| regressor(self.mechanism, self.selection, trial);
        let regressors = parallel::map(&trials, of);
        for (formulation, regressor) in trials.into_iter().zip(regressors) {
            // A form in which a leg cannot be written is none to choose.
            let Ok(regressor) = regressor else { continue };
            if regressor.operations() < self.regressor.operations() {
                (self.formulation, self.regressor) = (formulation, regressor);
            }
        }
    }
}

/// The regressor in a formulation.
fn regressor(
    mechanism: &Mechanism,
    selection: &Selection,
    formulation: &Formulation,
) -> Result<Regressor, Underivable> {
    let trial = Selection {
        formulation: formulation.clone(),
        ..selection.clone()
    };
    Regressor::new(mechanism, &trial)
}
