//! Which of several equal forms of a robot's model takes the fewest operations: derived, lowered without
//! a search, and counted.

use super::regressor::Regressor;
use crate::derivation::{Formulation, Selection, Underivable, seat_count, station_count};
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
        seats: vec![0; mechanism.legs.len()],
        meeting: false,
        at_end: false,
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
    for choice in choices(mechanism) {
        best.choose(&choice);
    }
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
    /// Takes the best of the changes if one is better.
    fn choose(&mut self, changes: &[Change]) {
        let trials = changes
            .iter()
            .filter_map(|change| change.of(&self.formulation));
        let trials: Vec<Formulation> = trials.collect();
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

/// What of a formulation may be written otherwise.
#[derive(Debug, Clone)]
pub(super) enum Change {
    /// The axes of the closure of legs of one shape.
    Station(Vec<usize>, usize),
    /// The axes in which their closures see what they end on.
    Seat(Vec<usize>, usize),
    /// Whether axes that meet share a moment.
    Meeting(bool),
    /// Whether forces of chains go to the skeleton at their ends.
    AtEnd(bool),
}

impl Change {
    /// The formulation with the change; `None` where it is written so already.
    pub(super) fn of(&self, formulation: &Formulation) -> Option<Formulation> {
        let mut changed = formulation.clone();
        match self {
            Self::Station(legs, station) => {
                legs.iter().for_each(|&l| changed.stations[l] = *station);
            }
            Self::Seat(legs, seat) => {
                for &leg in legs {
                    (changed.seats[leg], changed.stations[leg]) = (*seat, 0);
                }
            }
            Self::Meeting(meeting) => changed.meeting = *meeting,
            Self::AtEnd(at_end) => changed.at_end = *at_end,
        }
        (changed != *formulation).then_some(changed)
    }
}

/// The changes among which one is chosen after the other: for each shape of legs the axes of its closure, then
/// whether axes that meet share a moment.
pub(super) fn choices(mechanism: &Mechanism) -> Vec<Vec<Change>> {
    let mut shapes = BTreeSet::new();
    if !mechanism.is_tree() {
        let closed = mechanism.legs.iter().filter(|leg| leg.end.is_some());
        shapes.extend(closed.map(|leg| leg.shape));
    }
    let of_shape = |shape| {
        let legs = (0..mechanism.legs.len()).filter(|&l| mechanism.legs[l].shape == shape);
        let legs: Vec<usize> = legs.collect();
        let least = |count: fn(&Mechanism, usize) -> usize| {
            0..legs.iter().map(|&l| count(mechanism, l)).min().unwrap_or(0)
        };
        let station = |station| Change::Station(legs.clone(), station);
        let seat = |seat| Change::Seat(legs.clone(), seat);
        let stations: Vec<Change> = least(station_count).map(station).collect();
        let seats: Vec<Change> = least(seat_count).map(seat).collect();
        match seats.len() > 1 {
            true => vec![stations.clone(), seats, stations],
            false => vec![stations],
        }
    };
    let mut choices: Vec<Vec<Change>> = shapes.into_iter().flat_map(of_shape).collect();
    choices.push(vec![Change::Meeting(false), Change::Meeting(true)]);
    choices
}

/// The changes among which one is chosen after the other for a function on its own.
pub(super) fn choices_of_function(mechanism: &Mechanism) -> Vec<Change> {
    let mut all: Vec<Change> = choices(mechanism).into_iter().flatten().collect();
    if mechanism.skeleton().is_some() {
        all.extend([Change::AtEnd(true), Change::AtEnd(false)]);
    }
    all
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
