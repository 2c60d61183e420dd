//! Accuracy of a model before and after the search for fewer operations.
//!
//! Evaluations in double precision are compared with 128-bit arithmetic on the way to
//! configurations with a singular leg.

use super::precise::{Precise, difference, rounded};
use super::{Failure, description};
use overact::{Columns, Function};
use overact_codegen::derivation::MotionInput;
use overact_codegen::internals::{Stream, pose_towards, random_states};
use overact_codegen::interpreter::Rows;
use overact_codegen::lowering::Program;
use overact_codegen::mechanism::Mechanism;
use overact_codegen::{Effort, Request, RobotModel, compile_with};

/// Number of rays from home towards singular configurations.
const RAYS: usize = 24;
/// Steps along a ray until its end is bracketed.
const STEPS: usize = 400;

/// Errors of two forms of one function at a distance from singular configurations.
#[derive(Debug, Clone)]
pub struct Errors {
    /// Name of the function.
    pub function: &'static str,
    /// Distance from the end of the ray, as a fraction of its length; `None` for regular states.
    pub distance: Option<f64>,
    /// Number of states.
    pub states: usize,
    /// Largest error of the derived form, relative to the largest entry of its column.
    pub derived: f64,
    /// Largest error of the searched form.
    pub searched: f64,
}

/// State as program inputs by name.
struct State {
    pose: Vec<f64>,
    joints: Vec<f64>,
    twist: Vec<f64>,
    acceleration: Vec<f64>,
}

/// Errors of a robot's regressors, as derived and as searched, from joints and from the pose.
///
/// # Errors
///
/// The description's errors as text.
pub fn study(stem: &str, effort: Effort) -> Result<Vec<Errors>, Failure> {
    let (derived, searched) = (model(stem, Effort::None)?, model(stem, effort)?);
    let mechanism = &derived.mechanism;
    let mut groups = vec![(None, regular(mechanism))];
    let guarded = derived.plain(Function::IdmRedPlatform(Columns::Standard));
    let by_rule = guarded.filter(|f| !derived.is_tree() && !derived.finds_joints(f));
    if let (Some(guarded), Some(joints)) = (by_rule, derived.plain(Function::Joints)) {
        groups.extend(towards_singular(
            mechanism,
            &guarded.program,
            &joints.program,
        ));
    }
    let mut precise = Precise::new()?;
    let mut errors = Vec::new();
    for function in &derived.functions {
        let other = searched.function(function.computes, function.from);
        let (Function::IdmRedPlatform(columns), Some(other)) = (function.computes, other) else {
            continue;
        };
        if derived.finds_joints(function) || function.from == MotionInput::Actuators {
            continue;
        }
        for (distance, states) in &groups {
            let mut worst = Errors {
                function: name(columns, function.from),
                distance: *distance,
                states: states.len(),
                derived: 0.0,
                searched: 0.0,
            };
            for state in states {
                let inputs = inputs(&function.program, state);
                let exact = precise.evaluate(&function.program, &inputs);
                let exact = Exact {
                    columns: function.program.output.shape.get(1).copied().unwrap_or(1),
                    sizes: exact.iter().map(|e| rounded(e).abs()).collect(),
                    difference: &|at, value| difference(&exact[at], value),
                };
                worst.derived = worst.derived.max(exact.error(&function.program, &inputs));
                worst.searched = worst.searched.max(exact.error(&other.program, &inputs));
            }
            errors.push(worst);
        }
    }
    Ok(errors)
}

fn name(columns: Columns, from: MotionInput) -> &'static str {
    match (columns, from) {
        (Columns::Standard, MotionInput::Joints) => "standard columns, from joints",
        (Columns::Base, MotionInput::Joints) => "base columns, from joints",
        (Columns::Standard, _) => "standard columns, from pose",
        (Columns::Base, _) => "base columns, from pose",
    }
}

fn model(stem: &str, effort: Effort) -> Result<RobotModel, Failure> {
    let source = description(stem)?;
    let wanted = |_: &Mechanism, function: Function, from: MotionInput| {
        from != MotionInput::Actuators
            && matches!(function, Function::IdmRedPlatform(_) | Function::Joints)
    };
    let request = Request {
        wanted: &wanted,
        ..Request::with_effort(effort)
    };
    match compile_with(&source, &request) {
        Ok(compiled) => Ok(compiled.model),
        Err(errors) => Err(errors.render_plain(&source).into()),
    }
}

fn regular(mechanism: &Mechanism) -> Vec<State> {
    let states = random_states(mechanism, RAYS, 5).into_iter();
    let state = states.map(|s| State {
        pose: s.pose,
        joints: s.joints,
        twist: s.twist,
        acceleration: s.acceleration,
    });
    state.collect()
}

/// States near the ends of rays from home, by their distance from the end.
///
/// A ray ends where a guard of the function fails: a leg is stretched, folded or otherwise
/// singular.
fn towards_singular(
    mechanism: &Mechanism,
    guarded: &Program,
    joints: &Program,
) -> Vec<(Option<f64>, Vec<State>)> {
    let Some(platform) = &mechanism.platform else {
        return Vec::new();
    };
    let mut stream = Stream::new(11);
    let dof = mechanism.dof();
    let distances: Vec<f64> = (1..=7).map(|k| 10_f64.powi(-k)).collect();
    let mut groups: Vec<Vec<State>> = distances.iter().map(|_| Vec::new()).collect();
    for _ in 0..RAYS {
        let direction: Vec<f64> = (0..mechanism.pose_len()).map(|_| stream.number()).collect();
        let mut rates =
            |scale: f64| -> Vec<f64> { (0..dof).map(|_| scale * stream.number()).collect() };
        let (twist, acceleration) = (rates(1.0), rates(10.0));
        let state = |length: f64| {
            let mut state = State {
                pose: pose_towards(mechanism, platform.motion, &direction, length),
                joints: Vec::new(),
                twist: twist.clone(),
                acceleration: acceleration.clone(),
            };
            state.joints = value(joints, &inputs(joints, &state))?;
            value(guarded, &inputs(guarded, &state)).map(|_| state)
        };
        let Some(end) = end_of_ray(&|length| state(length).is_some()) else {
            continue;
        };
        for (distance, group) in distances.iter().zip(&mut groups) {
            group.extend(state(end * (1.0 - distance)));
        }
    }
    let groups = distances.into_iter().map(Some).zip(groups);
    groups.filter(|(_, states)| !states.is_empty()).collect()
}

/// Position where a ray leaves the possible states, exact to rounding; `None` if it does not.
fn end_of_ray(is_possible: &dyn Fn(f64) -> bool) -> Option<f64> {
    let mut inside = 0.0;
    let mut outside = (1..=STEPS)
        .map(|k| 4.0 * k as f64 / STEPS as f64)
        .find(|length| {
            let possible = is_possible(*length);
            if possible {
                inside = *length;
            }
            !possible
        })?;
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if is_possible(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    (inside > 0.0).then_some(inside)
}

fn inputs(program: &Program, state: &State) -> Vec<Vec<f64>> {
    let of = |name: &str| match name {
        "pose" => state.pose.clone(),
        "joints" => state.joints.clone(),
        "twist" | "joint_velocities" => state.twist.clone(),
        _ => state.acceleration.clone(),
    };
    program.inputs.iter().map(|input| of(&input.name)).collect()
}

/// Output of a program in double precision; `None` if a guard fails.
fn value(program: &Program, inputs: &[Vec<f64>]) -> Option<Vec<f64>> {
    let rows: Vec<Rows<'_>> = inputs
        .iter()
        .map(|values| Rows {
            values,
            shared: false,
        })
        .collect();
    let mut output = vec![0.0; program.output.len()];
    let evaluated = program.evaluate(1, &rows, &mut output);
    evaluated.ok().map(|()| output)
}

/// Exact entries.
struct Exact<'e> {
    columns: usize,
    sizes: Vec<f64>,
    difference: &'e dyn Fn(usize, f64) -> f64,
}

impl Exact<'_> {
    /// Largest error of a program relative to the largest entry of its column; zero if a guard
    /// rejects the state.
    fn error(&self, program: &Program, inputs: &[Vec<f64>]) -> f64 {
        let Some(values) = value(program, inputs) else {
            return 0.0;
        };
        let mut scales = vec![0.0_f64; self.columns];
        for (at, size) in self.sizes.iter().enumerate() {
            let scale = &mut scales[at % self.columns];
            *scale = scale.max(*size);
        }
        let relative = |(at, value): (usize, &f64)| {
            let scale = scales[at % self.columns];
            let error = (self.difference)(at, *value).abs();
            if scale > 0.0 { error / scale } else { error }
        };
        values.iter().enumerate().map(relative).fold(0.0, f64::max)
    }
}
