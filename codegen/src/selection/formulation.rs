//! Choice of the formulation with the fewest operations: each is derived, lowered without search,
//! and counted.

use super::regressor::Regressor;
use crate::cas::jacobian::Order;
use crate::derivation::{
    DerivationError, Formulation, Selection, closure_frame_choices, may_use_any_axes,
    observer_frame_choices,
};
use crate::mechanism::{End, Leg, Mechanism};
use crate::parallel;
use overact_core::{FrameFunction, FrameQuantity, Function};
use std::collections::BTreeSet;

/// Largest count at which a search could make a form the cheapest, in percent of the smallest.
const PROMISING: usize = 106;

/// Number of such forms that a short search compares.
const TRIED: usize = 4;

/// The cheapest formulation of the standard regressor from joint angles, with the regressor.
///
/// For each shape of legs it chooses the axes of the closure, then whether axes that meet share a
/// moment. The plain form is kept if nothing is better.
///
/// # Errors
/// See [`DerivationError`].
pub(super) fn cheapest_formulation(
    mechanism: &Mechanism,
    selection: &Selection,
) -> Result<(Formulation, Regressor), DerivationError> {
    let plain = Formulation {
        closure_frames: vec![0; mechanism.legs.len()],
        observer_frames: vec![0; mechanism.legs.len()],
        meeting: false,
        at_end: false,
        own_axes: false,
        gravity_as_acceleration: false,
        lump_end_masses: false,
        by_ends: false,
        by_rows: false,
        masses_at_ends: false,
        over_divisors: false,
        elimination: Order::default(),
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

/// Trials that a search could make the cheapest, in ascending order: one of each operation count.
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
    /// Adopts the best of the changes if it is an improvement.
    fn choose(&mut self, changes: &[Change]) {
        let trials = changes
            .iter()
            .filter_map(|change| change.of(&self.formulation));
        let trials: Vec<Formulation> = trials.collect();
        let of = |trial: &Formulation| regressor(self.mechanism, self.selection, trial);
        let regressors = parallel::map(&trials, of);
        for (formulation, regressor) in trials.into_iter().zip(regressors) {
            // Forms in which a leg cannot be written are skipped.
            let Ok(regressor) = regressor else { continue };
            if regressor.operations() < self.regressor.operations() {
                (self.formulation, self.regressor) = (formulation, regressor);
            }
        }
    }
}

/// A change of a formulation.
#[derive(Debug, Clone)]
pub(super) enum Change {
    /// The first axes for all legs.
    Plain,
    /// The axes in which the closures of some legs of one shape are written.
    ClosureFrame {
        /// The legs.
        legs: Vec<usize>,
        /// Index of the axes.
        closure_frame: usize,
    },
    /// The observer's axes of some chains' closures, and the axes in which these are written.
    ObserverFrame {
        /// The chains.
        legs: Vec<usize>,
        /// Index of the observer's axes.
        observer_frame: usize,
        /// Index of the axes in which the closures are written.
        closure_frame: usize,
    },
    /// See [`Formulation::meeting`].
    Meeting(bool),
    /// See [`Formulation::at_end`].
    AtEnd(bool),
    /// See [`Formulation::own_axes`].
    OwnAxes(bool),
    /// See [`Formulation::gravity_as_acceleration`].
    GravityAsAcceleration(bool),
    /// See [`Formulation::lump_end_masses`].
    LumpEndMasses(bool),
    /// See [`Formulation::by_ends`].
    ByEnds(bool),
    /// See [`Formulation::by_rows`].
    ByRows(bool),
    /// See [`Formulation::masses_at_ends`].
    MassesAtEnds(bool),
    /// See [`Formulation::over_divisors`].
    OverDivisors(bool),
    /// See [`Formulation::elimination`].
    Elimination(Order),
}

impl Change {
    /// Whether the change sets the first axes for all legs.
    pub(super) const fn is_plain(&self) -> bool {
        matches!(self, Self::Plain)
    }

    /// Whether the change sets the first axes for some legs.
    pub(super) const fn takes_first(&self) -> bool {
        matches!(
            self,
            Self::Plain
                | Self::ClosureFrame {
                    closure_frame: 0,
                    ..
                }
        )
    }

    /// A selection with the change; `None` if it has no effect.
    pub(super) fn on(&self, selection: &Selection) -> Option<Selection> {
        Some(Selection {
            formulation: self.of(&selection.formulation)?,
            ..selection.clone()
        })
    }

    /// The formulation with the change; `None` if it has no effect.
    pub(super) fn of(&self, formulation: &Formulation) -> Option<Formulation> {
        let mut changed = formulation.clone();
        match self {
            Self::Plain => {
                changed.closure_frames.fill(0);
                changed.observer_frames.fill(0);
            }
            Self::ClosureFrame {
                legs,
                closure_frame,
            } => {
                for &leg in legs {
                    changed.observer_frames[leg] = 0;
                    changed.closure_frames[leg] = *closure_frame;
                }
            }
            Self::ObserverFrame {
                legs,
                observer_frame,
                closure_frame,
            } => {
                for &leg in legs {
                    changed.observer_frames[leg] = *observer_frame;
                    changed.closure_frames[leg] = *closure_frame;
                }
            }
            Self::Meeting(meeting) => changed.meeting = *meeting,
            Self::AtEnd(at_end) => changed.at_end = *at_end,
            Self::OwnAxes(own_axes) => changed.own_axes = *own_axes,
            Self::GravityAsAcceleration(gravity_as_acceleration) => {
                changed.gravity_as_acceleration = *gravity_as_acceleration
            }
            Self::LumpEndMasses(lump_end_masses) => changed.lump_end_masses = *lump_end_masses,
            Self::ByEnds(by_ends) => changed.by_ends = *by_ends,
            Self::ByRows(by_rows) => changed.by_rows = *by_rows,
            Self::MassesAtEnds(at_ends) => changed.masses_at_ends = *at_ends,
            Self::OverDivisors(over) => changed.over_divisors = *over,
            Self::Elimination(order) => changed.elimination = *order,
        }
        (changed != *formulation).then_some(changed)
    }
}

/// Groups of alternative changes, in the order of choice.
///
/// For each shape of legs there are the axes of its closure; then whether axes that meet share a
/// moment. If `for_function`, legs whose closure uses only some components have these choices, too.
/// Axes that suit the identification model do not suit other functions of such legs.
fn choices(mechanism: &Mechanism, for_function: bool) -> Vec<Vec<Change>> {
    let mut shapes = BTreeSet::new();
    if !mechanism.is_tree() {
        let closed = mechanism.legs.iter().filter(|leg| leg.end.is_some());
        shapes.extend(closed.map(|leg| leg.shape));
    }
    let of_shape = |shape| {
        let legs = (0..mechanism.legs.len()).filter(|&l| mechanism.legs[l].shape == shape);
        let legs: Vec<usize> = legs.collect();
        // An index counts if it means different axes in one of the legs.
        let of_all = |choices: fn(&Mechanism, usize) -> Vec<usize>| {
            let all = legs.iter().flat_map(|&leg| choices(mechanism, leg));
            let are_tried =
                for_function || legs.iter().all(|&leg| may_use_any_axes(mechanism, leg));
            all.filter(|&number| are_tried || number == 0)
                .collect::<BTreeSet<usize>>()
        };
        let closure_frames = of_all(closure_frame_choices);
        let observer_frames = of_all(observer_frame_choices);
        let in_own_axes = closure_frames
            .iter()
            .map(|&closure_frame| Change::ClosureFrame {
                legs: legs.clone(),
                closure_frame,
            });
        let in_observer_axes = observer_frames.iter().skip(1).flat_map(|&observer_frame| {
            closure_frames
                .iter()
                .map(move |&closure_frame| (observer_frame, closure_frame))
        });
        let in_observer_axes =
            in_observer_axes.map(|(observer_frame, closure_frame)| Change::ObserverFrame {
                legs: legs.clone(),
                observer_frame,
                closure_frame,
            });
        in_own_axes.chain(in_observer_axes).collect()
    };
    let mut choices: Vec<Vec<Change>> = shapes.into_iter().map(of_shape).collect();
    if mechanism.is_parasitic() {
        choices.insert(0, vec![Change::OwnAxes(true)]);
    }
    choices.push(vec![Change::Meeting(false), Change::Meeting(true)]);
    if mechanism.skeleton().is_some() {
        choices.push(vec![
            Change::GravityAsAcceleration(false),
            Change::GravityAsAcceleration(true),
        ]);
    }
    choices
}

/// The changes that are tried for one function, one after the other.
///
/// Constraints of a platform with parasitic motion are in the axes of the legs, and guards of
/// unreachable poses belong to the legs whose joints are needed. For such platforms, only functions
/// of all joints choose the axes of the legs.
pub(super) fn choices_of_function(mechanism: &Mechanism, function: Function) -> Vec<Change> {
    if function.is_derivative() {
        return orders(function);
    }
    let has_forces = has_forces(function);
    let may_change_axes =
        !mechanism.has_dependent_coordinates() || has_forces || moves_all_legs(function);
    let has_motion = has_forces || function.columns().is_some();
    let mut all = vec![Change::Plain];
    all.extend(choices(mechanism, may_change_axes).into_iter().flatten());
    all.retain(|change| {
        has_motion
            || !matches!(
                change,
                Change::GravityAsAcceleration(_) | Change::OwnAxes(_)
            )
    });
    if has_forces && mechanism.skeleton().is_some() {
        all.extend([Change::AtEnd(true), Change::AtEnd(false)]);
    }
    let ends_in_point = |leg: &Leg| matches!(leg.end, Some(End::Point { .. }));
    if has_forces && mechanism.legs.iter().any(ends_in_point) {
        all.push(Change::LumpEndMasses(true));
    }
    all
}

/// The orders of elimination that are tried for derivatives, also by a quick search.
///
/// Derivatives are several times as long as the functions, so that no other changes are tried.
pub(super) fn orders(function: Function) -> Vec<Change> {
    let all = if function.is_derivative() {
        &Order::ALL[..]
    } else {
        &[]
    };
    all.iter()
        .map(|&order| Change::Elimination(order))
        .collect()
}

/// Whether legs of several shapes are closed, so that their axes are chosen one after the other.
pub(super) fn has_several_shapes(mechanism: &Mechanism) -> bool {
    let closed = mechanism.legs.iter().filter(|leg| leg.end.is_some());
    closed.map(|leg| leg.shape).collect::<BTreeSet<_>>().len() > 1
}

/// The changes that are tried last; only a search shows whether they save operations.
pub(super) fn last_choices(mechanism: &Mechanism, function: Function) -> Vec<Change> {
    let mut all = Vec::new();
    if function.is_derivative() {
        return all;
    }
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

/// The change that is tried after all others: sums over divisors in the legs' closures.
pub(super) fn closing_choice(mechanism: &Mechanism, function: Function) -> Option<Change> {
    let divides = !mechanism.is_tree() && has_motion(function) && !function.is_derivative();
    divides.then_some(Change::OverDivisors(true))
}

/// Whether a function depends on velocities or accelerations.
const fn has_motion(function: Function) -> bool {
    has_forces(function)
        || function.columns().is_some()
        || matches!(
            function,
            Function::JointVelocities
                | Function::JointAccelerations
                | Function::AccelerationFromActuators
                | Function::KineticEnergy
                | Function::Frame(FrameFunction {
                    quantity: FrameQuantity::Velocity | FrameQuantity::AccelerationBias,
                    ..
                })
        )
}

/// The formulations that single changes make of a robot's, and those that all changes so far make
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

/// Whether a function sums forces of given parameters.
pub(super) const fn has_forces(function: Function) -> bool {
    matches!(
        function,
        Function::Bias(_)
            | Function::ForwardDynamics(_)
            | Function::InverseDynamics(_)
            | Function::InverseDynamicsPreloaded
    ) || function.is_derivative()
}

/// The regressor in a formulation.
fn regressor(
    mechanism: &Mechanism,
    selection: &Selection,
    formulation: &Formulation,
) -> Result<Regressor, DerivationError> {
    let trial = Selection {
        formulation: formulation.clone(),
        ..selection.clone()
    };
    Regressor::new(mechanism, &trial)
}
