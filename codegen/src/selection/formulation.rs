//! Which of several equal forms of a robot's model takes the fewest operations: derived, lowered without
//! a search, and counted.

use super::assemble::program;
use crate::derivation::{
    Columns, Family, Formulation, From, JointsBy, Selection, Underivable, station_count,
};
use crate::mechanism::Mechanism;
use crate::parallel;
use std::collections::BTreeSet;

/// The cheapest formulation of the standard regressor from joint angles: for each shape of legs the axes
/// of its closure, then whether axes that meet share a moment; the plain form where nothing is better.
///
/// # Errors
/// See [`Underivable`].
pub fn cheapest_formulation(
    mechanism: &Mechanism,
    selection: &Selection,
) -> Result<Formulation, Underivable> {
    let mut best = Best {
        mechanism,
        selection,
        chosen: Formulation {
            stations: vec![0; mechanism.legs.len()],
            meeting: false,
        },
        operations: usize::MAX,
    };
    best.operations = best.count(&best.chosen)?;
    let mut shapes = BTreeSet::new();
    if mechanism.platform.is_some() {
        shapes.extend(mechanism.legs.iter().map(|leg| leg.shape));
    }
    for shape in shapes {
        let of_shape = |l: &usize| mechanism.legs[*l].shape == shape;
        let legs: Vec<usize> = (0..mechanism.legs.len()).filter(of_shape).collect();
        let count = legs.iter().map(|&l| station_count(mechanism, l)).min();
        let trials = (1..count.unwrap_or(0)).map(|station| {
            let mut trial = best.chosen.clone();
            legs.iter().for_each(|&l| trial.stations[l] = station);
            trial
        });
        best.choose(trials.collect());
    }
    best.choose(vec![Formulation {
        meeting: true,
        ..best.chosen.clone()
    }]);
    Ok(best.chosen)
}

/// The best formulation so far.
struct Best<'m> {
    mechanism: &'m Mechanism,
    selection: &'m Selection,
    chosen: Formulation,
    operations: usize,
}

impl Best<'_> {
    fn count(&self, formulation: &Formulation) -> Result<usize, Underivable> {
        let trial = Selection {
            formulation: formulation.clone(),
            ..self.selection.clone()
        };
        let family = Family::IdmRedPlatform(Columns::Standard);
        program(self.mechanism, &trial, family, From::Joints, JointsBy::Rule)
            .map(|p| p.cost().operations())
    }

    /// Takes the best of the trials if it is better.
    fn choose(&mut self, trials: Vec<Formulation>) {
        let counts = parallel::map(&trials, |trial| self.count(trial));
        for (trial, count) in trials.into_iter().zip(counts) {
            // A form in which a leg cannot be written is none to choose.
            if let Some(count) = count.ok().filter(|count| *count < self.operations) {
                (self.chosen, self.operations) = (trial, count);
            }
        }
    }
}
