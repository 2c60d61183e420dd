//! Values are finite: every function of every robot, at configurations with exact zeros.
//!
//! Random states never have these. Here coordinates are zero, at home or mirrored, rotations are
//! right angles, platform points are on the legs' bases, and joints are at zero or right angles. A
//! function may reject these as singular or unreachable but must not return 0/0.

use overact::Model;
use overact_codegen::RobotModel;
use overact_codegen::lowering::Program;
use overact_codegen::mechanism::End;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, Sample, backend};
use overact_tier::by_tier;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

overact_tests::library!(check);

fn check(stem: &str, _: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let drawn = samples(&expected.mechanism, &expected.parameters(), 1, 3, false)?;
    let moving = drawn.first().ok_or("no sample")?;
    let limit = by_tier([16, 2000]);
    let states: Vec<Sample> = poses(model)
        .into_iter()
        .map(|pose| with(moving, |sample| sample.state.pose = pose))
        .take(limit)
        .chain(joints(model).into_iter().take(limit).map(|q| {
            with(moving, |sample| {
                sample.state.q.copy_from_slice(&q);
                sample.state.pose.clone_from(&model.mechanism.home.pose);
                let actuated = model.mechanism.actuated();
                sample.actuators = actuated.iter().map(|&at| q[at]).collect();
            })
        }))
        .collect();
    let mut answered = 0;
    for function in &model.functions {
        for state in &states {
            answered += usize::from(
                is_finite(&function.program, state)
                    .map_err(|wrong| format!("{stem}: {}: {wrong}", function.name))?,
            );
        }
    }
    assert!(answered > 0, "{stem}: nothing has a value anywhere");
    Ok(())
}

/// Whether the function has a value; an error if that is not finite.
fn is_finite(program: &Program, state: &Sample) -> Result<bool, Failure> {
    let Ok(output) = backend::evaluate(program, &|name| state.input(name).ok()) else {
        return Ok(false);
    };
    match output.iter().position(|value| !value.is_finite()) {
        None => Ok(true),
        Some(at) => Err(format!(
            "number {at} is {} at pose {:?}, joints {:?}",
            output[at],
            state.state.pose,
            state.state.q.as_slice()
        )
        .into()),
    }
}

fn with(sample: &Sample, change: impl FnOnce(&mut Sample)) -> Sample {
    let mut sample = sample.clone();
    change(&mut sample);
    sample
}

/// All combinations of values for each coordinate.
///
/// The combination of all first values comes first, and neighbours differ in many coordinates.
fn choices(values: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let count: usize = values.iter().map(Vec::len).product::<usize>().min(4096);
    // A step that is coprime to the count visits every number below it once.
    let step = (count / 3..)
        .find(|step| common(*step, count) == 1)
        .unwrap_or(1);
    let choice = |number: usize| {
        let mut rest = number * step % count;
        let pick = |of: &Vec<f64>| {
            let value = of[rest % of.len()];
            rest /= of.len();
            value
        };
        values.iter().map(pick).collect()
    };
    (0..count).map(choice).collect()
}

/// Greatest common divisor.
const fn common(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common(b, a % b) }
}

/// Poses on axes, at home, and with platform points on leg bases.
fn poses(model: &RobotModel) -> Vec<Vec<f64>> {
    let mechanism = &model.mechanism;
    let home = &mechanism.home.pose;
    let Some(platform) = &mechanism.platform else {
        return joints(model);
    };
    let names = mechanism.pose_coordinates();
    let turns = if platform.motion.has_quaternion() {
        quaternions()
    } else {
        vec![Vec::new()]
    };
    let count = names.len() - turns[0].len();
    let values = |at: usize| match ["x", "y", "z"].iter().position(|name| names[at] == *name) {
        Some(axis) => {
            let mut values = vec![0.0, home[at], -home[at]];
            values.extend(mechanism.legs.iter().filter_map(|leg| {
                let end = leg.end.as_ref().map(End::point)?;
                Some(leg.base.at[axis].value() - end[axis].value())
            }));
            values
        }
        None => vec![0.0, home[at], FRAC_PI_2, -FRAC_PI_2, PI],
    };
    let mut all = choices(&(0..count).map(values).map(distinct).collect::<Vec<_>>());
    all.insert(0, home[..count].to_vec());
    let turned = |turn: &Vec<f64>| -> Vec<Vec<f64>> {
        let pose = |at: &Vec<f64>| [&at[..], &turn[..]].concat();
        all.iter().map(pose).collect()
    };
    turns.iter().flat_map(turned).collect()
}

/// Unit quaternions of right-angle rotations about the axes, the identity first.
fn quaternions() -> Vec<Vec<f64>> {
    let mut all = vec![vec![1.0, 0.0, 0.0, 0.0]];
    for axis in 1..4 {
        for (w, v) in [(FRAC_1_SQRT_2, FRAC_1_SQRT_2), (0.0, 1.0)] {
            let mut turn = vec![w, 0.0, 0.0, 0.0];
            turn[axis] = v;
            all.push(turn);
        }
    }
    all
}

/// Joints at zero, at right angles and at home.
fn joints(model: &RobotModel) -> Vec<Vec<f64>> {
    let home = &model.mechanism.home.joints;
    let values = |at: usize| distinct(vec![0.0, home[at], FRAC_PI_2, -FRAC_PI_2, PI]);
    let mut all = vec![home.clone(), vec![0.0; home.len()]];
    for at in 0..home.len() {
        for value in values(at) {
            let mut joints = home.clone();
            joints[at] = value;
            all.push(joints);
        }
    }
    all.extend(choices(&(0..home.len()).map(values).collect::<Vec<_>>()));
    all
}

fn distinct(values: Vec<f64>) -> Vec<f64> {
    let mut distinct: Vec<f64> = Vec::new();
    for value in values {
        if !distinct.contains(&value) {
            distinct.push(value);
        }
    }
    distinct
}
