//! Chooses the start of the search for a closed home configuration.
//!
//! The start is the file's keyframe, its zero configuration, or one within the joint limits: the
//! first from which the loops close within the limits. Home must not be singular for the motors.

use super::motion::{Motion, State, null_space, rank};
use crate::model::{JointType, Model};
use nalgebra::{DMatrix, DVector};

/// Distance beyond a limit that counts as at the limit, rad or m.
const AT_LIMIT: f64 = 1e-3;
/// Largest residual of a start, m or rad; rounded numbers leave one.
const OPEN: f64 = 5e-3;
/// Largest displacement of a joint that closes a loop which rounded numbers leave open, rad or m.
const FAR: f64 = 0.1;
/// Number of random starts within the limits.
const STARTS: usize = 20;
/// Displacements from a singular configuration, rad or m.
const STEPS: [f64; 4] = [0.3, -0.3, 0.1, -0.1];
/// Number of other starts of passive joints, and their range, rad.
const ELSEWHERE: usize = 40;
const TURN: f64 = 3.8;

/// Sets the home positions of a model with loops.
pub(crate) fn choose(model: &mut Model) {
    let motion = Motion::new(model);
    let zero = motion.start();
    let chosen = starts(model, &zero)
        .into_iter()
        .find_map(|(start, reason)| {
            let start = motion.moved_by(&start, &DVector::zeros(motion.coordinates.len()));
            let closed = closed(&motion, &start)?;
            is_within(model, &closed).then_some((start, closed, reason))
        });
    let Some((start, closed, reason)) = chosen else {
        return;
    };
    let regular = regular(&motion, &closed);
    let (home, note) = match (regular, reason) {
        (Some(regular), _) => (regular, SINGULAR),
        (None, Some(note)) => (start, note),
        (None, None) => return,
    };
    for (at, joint) in model.joints.iter_mut().enumerate() {
        joint.home = home.positions[at];
        joint.home_turn = home.turns[at];
    }
    model.notes.push(note.to_owned());
}

const KEYFRAME: &str = "Home is that of the file's keyframe.";
const LIMITS: &str =
    "Home is a configuration within the joint limits, since the file's zero leads beyond them.";
const SINGULAR: &str =
    "Home is moved from the file's configuration, in which the motors do not determine the motion.";

/// Starts in the order of preference, each with the note if it is chosen.
fn starts(model: &Model, zero: &State) -> Vec<(State, Option<&'static str>)> {
    let mut all = Vec::new();
    if model.joints.iter().all(|joint| joint.keyframe.is_some()) && !model.joints.is_empty() {
        let mut state = zero.clone();
        for (at, joint) in model.joints.iter().enumerate() {
            if let Some((position, turn)) = joint.keyframe {
                (state.positions[at], state.turns[at]) = (position, turn);
            }
        }
        all.push((state, Some(KEYFRAME)));
    }
    all.push((zero.clone(), None));
    let mut next = random();
    for attempt in 0..=STARTS {
        let mut state = zero.clone();
        for (at, joint) in model.joints.iter().enumerate() {
            // The first of these starts is in the middle of all ranges.
            let share = if attempt == 0 { 0.5 } else { next() };
            match (joint.range, joint.kind) {
                (Some([low, high]), _) if (high - low).is_finite() => {
                    state.positions[at] = low + share * (high - low);
                }
                (None, JointType::Revolute) if attempt > 0 => {
                    state.positions[at] += 3.0 * (share - 0.5);
                }
                _ => {}
            }
        }
        all.push((state, Some(LIMITS)));
    }
    all
}

/// Deterministic pseudo-random numbers between 0 and 1.
fn random() -> impl FnMut() -> f64 {
    let mut random = 1_u64;
    move || {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(random >> 33).unwrap_or(0)) / f64::from(1_u32 << 31)
    }
}

/// Closed configuration near a start, also if rounded numbers leave the loops slightly open.
///
/// Such loops may close exactly only far from there.
fn closed(motion: &Motion<'_>, start: &State) -> Option<State> {
    let gaps = motion.gaps(start);
    let is_nearly_closed = gaps.iter().all(|gap| gap.abs() < OPEN);
    match motion.closed(start) {
        Ok(state) if is_nearly_closed && distance(start, &state) > FAR => Some(start.clone()),
        Ok(state) => Some(state),
        Err(open) => (open.gap < OPEN).then_some(open.state),
    }
}

/// Whether all joints are within their limits.
fn is_within(model: &Model, state: &State) -> bool {
    let mut joints = model.joints.iter().zip(&state.positions);
    joints.all(|(joint, position)| {
        let [low, high] = joint.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        (low - AT_LIMIT..=high + AT_LIMIT).contains(position)
    })
}

/// Closed configuration near a singular one in which the motors have more independent motions.
///
/// `None` if the given configuration is regular. If no displacement along its motions helps, such
/// as for universal joints whose first rotation has no effect, passive joints start elsewhere.
fn regular(motion: &Motion<'_>, home: &State) -> Option<State> {
    let (free, count) = driven(motion, home);
    for size in STEPS {
        let sum = DVector::from_element(free.ncols(), 1.0);
        let mut step = &free * sum;
        let largest = step.amax();
        if largest < 1e-12 {
            return None;
        }
        step *= size / largest;
        let moved = motion.closed(&motion.moved_by(home, &step)).ok();
        let Some(moved) = moved.filter(|state| is_within(motion.model, state)) else {
            continue;
        };
        if driven(motion, &moved).1 > count {
            return Some(moved);
        }
    }
    let motors = motion.model.joints.iter().filter(|joint| joint.actuated);
    if count >= motors.count().min(free.ncols()) {
        return None;
    }
    let mut next = random();
    let elsewhere = (0..ELSEWHERE).filter_map(|_| {
        let step = motion.coordinates.iter().map(|own| {
            let joint = &motion.model.joints[own.joint];
            let is_turned = joint.kind == JointType::Revolute && !joint.actuated;
            let share = next();
            if is_turned { TURN * (share - 0.5) } else { 0.0 }
        });
        let step = DVector::from_vec(step.collect());
        let moved = motion.closed(&motion.moved_by(home, &step)).ok()?;
        let is_regular = is_within(motion.model, &moved) && driven(motion, &moved).1 > count;
        is_regular.then_some(moved)
    });
    elsewhere.min_by(|a, b| distance(home, a).total_cmp(&distance(home, b)))
}

/// Largest displacement of a joint between two configurations.
fn distance(from: &State, to: &State) -> f64 {
    let pairs = from.positions.iter().zip(&to.positions);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Motions that keep the loops closed, and the number of independent rates of the motors.
fn driven(motion: &Motion<'_>, state: &State) -> (DMatrix<f64>, usize) {
    let (_, closure) = motion.closure(state);
    let free = null_space(&closure);
    let rows: Vec<usize> = motion
        .coordinates
        .iter()
        .enumerate()
        .filter(|(_, own)| motion.model.joints[own.joint].actuated)
        .map(|(at, _)| at)
        .collect();
    let rates = DMatrix::from_fn(rows.len(), free.ncols(), |i, j| free[(rows[i], j)]);
    let count = if rates.amax() < 1e-9 {
        0
    } else {
        rank(&rates).0
    };
    (free, count)
}
