//! Which of several equal forms of a robot's model takes the fewest operations: derived, lowered without
//! a search, and counted.

use super::regressor::Regressor;
use crate::derivation::{
    Formulation, Selection, Underivable, is_whole, seat_choices, station_choices,
};
use crate::mechanism::{End, Leg, Mechanism};
use crate::parallel;
use overact_core::Function;
use std::collections::BTreeSet;

/// Operations of a form that a search could make the cheapest one, in hundredths of those of the cheapest before it.
const PROMISING: usize = 106;

/// Of so many such forms a short search tells which is the cheapest.
const TRIED: usize = 4;

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
        own_axes: false,
        weighted: false,
        lends: false,
        by_ends: false,
        by_rows: false,
        masses_at_ends: false,
        over_divisors: false,
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
    for choice in choices(mechanism, false) {
        best.choose(&choice);
    }
    Ok((best.formulation, best.regressor))
}

/// Those of some trials that a search could make the cheapest, the cheapest first: of each number of operations one.
pub(super) fn promising<T>(
    mut trials: Vec<T>,
    least: usize,
    operations: impl Fn(&T) -> usize,
) -> Vec<T> {
    trials.retain(|trial| operations(trial) <= least * PROMISING / 100);
    trials.sort_by_key(&operations);
    trials.dedup_by_key(|trial| operations(trial));
    trials.truncate(TRIED);
    trials
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
    /// The first axes for all legs.
    Plain,
    /// The axes of the closure of legs of one shape.
    Station(Vec<usize>, usize),
    /// The axes in which their closures see what they end on.
    Seat(Vec<usize>, usize, usize),
    /// Whether axes that meet share a moment.
    Meeting(bool),
    /// Whether forces of chains go to the skeleton at their ends.
    AtEnd(bool),
    /// Whether forces on a platform that moves aside meet its coordinates in its own axes.
    OwnAxes(bool),
    /// Whether accelerations of the ends of chains are taken less gravity.
    Weighted(bool),
    /// Whether legs lend masses at their ends to what they end on.
    Lends(bool),
    /// Whether rows of legs on a platform that moves aside share the velocities of the legs' ends.
    ByEnds(bool),
    /// Whether rates of legs are taken by the rows of their reduced Jacobians.
    ByRows(bool),
    /// Whether masses at the ends of legs are masses at points of what the legs end on.
    MassesAtEnds(bool),
    /// Whether sums that are known over a divisor are looked for.
    OverDivisors(bool),
}

impl Change {
    /// Whether it takes the first axes for all legs.
    pub(super) const fn is_plain(&self) -> bool {
        matches!(self, Self::Plain)
    }

    /// Whether it takes the first axes for some legs.
    pub(super) const fn takes_first(&self) -> bool {
        matches!(self, Self::Plain | Self::Station(_, 0))
    }

    /// A selection with the change; `None` where it is written so already.
    pub(super) fn on(&self, selection: &Selection) -> Option<Selection> {
        Some(Selection {
            formulation: self.of(&selection.formulation)?,
            ..selection.clone()
        })
    }

    /// The formulation with the change; `None` where it is written so already.
    pub(super) fn of(&self, formulation: &Formulation) -> Option<Formulation> {
        let mut changed = formulation.clone();
        match self {
            Self::Plain => {
                changed.stations.fill(0);
                changed.seats.fill(0);
            }
            Self::Station(legs, station) => {
                for &leg in legs {
                    (changed.seats[leg], changed.stations[leg]) = (0, *station);
                }
            }
            Self::Seat(legs, seat, station) => {
                for &leg in legs {
                    (changed.seats[leg], changed.stations[leg]) = (*seat, *station);
                }
            }
            Self::Meeting(meeting) => changed.meeting = *meeting,
            Self::AtEnd(at_end) => changed.at_end = *at_end,
            Self::OwnAxes(own_axes) => changed.own_axes = *own_axes,
            Self::Weighted(weighted) => changed.weighted = *weighted,
            Self::Lends(lends) => changed.lends = *lends,
            Self::ByEnds(by_ends) => changed.by_ends = *by_ends,
            Self::ByRows(by_rows) => changed.by_rows = *by_rows,
            Self::MassesAtEnds(at_ends) => changed.masses_at_ends = *at_ends,
            Self::OverDivisors(over) => changed.over_divisors = *over,
        }
        (changed != *formulation).then_some(changed)
    }
}

/// The changes among which one is chosen after the other: for each shape of legs the axes of its closure, then
/// whether axes that meet share a moment. Of legs that are closed in some components alone they are tried for one
/// function, `own`, and not for the robot, for what suits its identification model does not suit the rest.
fn choices(mechanism: &Mechanism, own: bool) -> Vec<Vec<Change>> {
    let mut shapes = BTreeSet::new();
    if !mechanism.is_tree() {
        let closed = mechanism.legs.iter().filter(|leg| leg.end.is_some());
        shapes.extend(closed.map(|leg| leg.shape));
    }
    let of_shape = |shape| {
        let legs = (0..mechanism.legs.len()).filter(|&l| mechanism.legs[l].shape == shape);
        let legs: Vec<usize> = legs.collect();
        // A number counts if it stands for axes of its own in one of the legs.
        let of_all = |choices: fn(&Mechanism, usize) -> Vec<usize>| {
            let all = legs.iter().flat_map(|&leg| choices(mechanism, leg));
            let are_tried = own || legs.iter().all(|&leg| is_whole(mechanism, leg));
            all.filter(|&number| are_tried || number == 0)
                .collect::<BTreeSet<usize>>()
        };
        let stations = of_all(station_choices);
        let unseated = stations
            .iter()
            .map(|&station| Change::Station(legs.clone(), station));
        let seated = of_all(seat_choices).into_iter().skip(1).flat_map(|seat| {
            let legs = &legs;
            let stations = stations.iter();
            stations.map(move |&station| Change::Seat(legs.clone(), seat, station))
        });
        unseated.chain(seated).collect()
    };
    let mut choices: Vec<Vec<Change>> = shapes.into_iter().map(of_shape).collect();
    if mechanism.is_parasitic() {
        choices.insert(0, vec![Change::OwnAxes(true)]);
    }
    choices.push(vec![Change::Meeting(false), Change::Meeting(true)]);
    if mechanism.skeleton().is_some() {
        choices.push(vec![Change::Weighted(false), Change::Weighted(true)]);
    }
    choices
}

/// The changes among which one is chosen after the other for a function on its own. What legs of a platform that moves
/// aside block is told in their axes, as an error and as its derivative, and which leg is out of reach is told where
/// its joints are needed: there only functions of all joints choose the axes of such legs.
pub(super) fn choices_of_function(mechanism: &Mechanism, function: Function) -> Vec<Change> {
    let has_forces = has_forces(function);
    let own = !mechanism.is_parasitic() || has_forces || moves_all_legs(function);
    let has_motion = has_forces || function.columns().is_some();
    let mut all = vec![Change::Plain];
    all.extend(choices(mechanism, own).into_iter().flatten());
    all.retain(|change| has_motion || !matches!(change, Change::Weighted(_) | Change::OwnAxes(_)));
    if has_forces && mechanism.skeleton().is_some() {
        all.extend([Change::AtEnd(true), Change::AtEnd(false)]);
    }
    let ends_in_point = |leg: &Leg| matches!(leg.end, Some(End::Point { .. }));
    if has_forces && mechanism.legs.iter().any(ends_in_point) {
        all.push(Change::Lends(true));
    }
    all
}

/// Whether legs of more than one shape are closed, so that their axes are chosen one after the other.
pub(super) fn has_several_shapes(mechanism: &Mechanism) -> bool {
    let closed = mechanism.legs.iter().filter(|leg| leg.end.is_some());
    closed.map(|leg| leg.shape).collect::<BTreeSet<_>>().len() > 1
}

/// The changes that are tried last, on what the others have made: whether they pay is seen after a search alone.
pub(super) fn last_choices(mechanism: &Mechanism, function: Function) -> Vec<Change> {
    let mut all = Vec::new();
    if mechanism.is_parasitic() {
        all.push(Change::ByEnds(true));
    }
    if has_motion(function) && !mechanism.is_tree() {
        all.push(Change::ByRows(true));
        let ends_in_point = |leg: &Leg| matches!(leg.end, Some(End::Point { .. }));
        if function.columns().is_some() && mechanism.legs.iter().any(ends_in_point) {
            all.push(Change::MassesAtEnds(true));
        }
    }
    all
}

/// The change that is tried on what all others have made: sums over divisors, which closures of legs divide by.
pub(super) fn closing_choice(mechanism: &Mechanism, function: Function) -> Option<Change> {
    let divides = !mechanism.is_tree() && has_motion(function);
    divides.then_some(Change::OverDivisors(true))
}

/// Whether a function is of velocities or accelerations.
const fn has_motion(function: Function) -> bool {
    has_forces(function)
        || function.columns().is_some()
        || matches!(
            function,
            Function::JointVelocities
                | Function::JointAccelerations
                | Function::AccelerationFromActuators
        )
}

/// The formulations of a function that one change makes of that of a robot, and those that all changes so far make
/// together.
#[must_use]
pub fn formulations(
    mechanism: &Mechanism,
    function: Function,
    of: &Formulation,
) -> Vec<Formulation> {
    let mut together = of.clone();
    let mut all = Vec::new();
    let last = last_choices(mechanism, function);
    let closing = closing_choice(mechanism, function);
    let changes = choices_of_function(mechanism, function).into_iter();
    for change in changes.chain(last).chain(closing) {
        all.extend(change.of(of));
        together = change.of(&together).unwrap_or(together);
        if !all.contains(&together) {
            all.push(together.clone());
        }
    }
    all
}

/// Whether a function has columns of all bodies, and so needs the positions of all joints.
const fn moves_all_legs(function: Function) -> bool {
    matches!(
        function,
        Function::IdmRedPlatform(_) | Function::IdmRedActuators(_)
    )
}

/// Whether a function adds up forces of given parameters.
pub(super) const fn has_forces(function: Function) -> bool {
    matches!(
        function,
        Function::Bias(_)
            | Function::ForwardDynamics(_)
            | Function::InverseDynamics(_)
            | Function::InverseDynamicsPreloaded
    )
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
