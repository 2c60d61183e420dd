//! Random mechanisms compared with the numeric reference, and defective ones with expected
//! diagnostics.
//!
//! Every mechanism has its own seed. `OVERACT_RANDOM_SEED=17` repeats one of them and prints its
//! description and results; `OVERACT_RANDOM_COUNT=2000` sets their number. Functions of the
//! platform's pose and identification models are compared for every mechanism, one sixth of the
//! others each time.

use nalgebra::{DMatrix, DVector};
use overact::{Columns, Function};
use overact_codegen::Effort;
use overact_codegen::compile_with;
use overact_codegen::derivation::{MotionInput, function_name};
use overact_codegen::diagnostic::{Diagnostic, DiagnosticKind};
use overact_codegen::mechanism::Mechanism;
use overact_codegen::{Diagnostics, Request, RobotModel, Source};
use overact_tests::reference::energy::total_energy;
use overact_tests::reference::states::frictionless;
use overact_tests::reference::{Motion, State, trajectory};
use overact_tests::support::expected::{Expected, has_masses};
use overact_tests::support::library::workspace;
use overact_tests::support::random::{Defect, Sketch, features};
use overact_tests::support::sample::samples;
use overact_tests::support::served::{partitions, project};
use overact_tests::support::{Backend, Comparison, Evaluated, Failure, Sample};
use overact_tier::drawn;
use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

const TOLERANCE: f64 = 1e-9;
/// Tolerance of functions of base parameters.
///
/// Regroupings that are not exact are computed numerically and lose digits if columns are nearly
/// dependent.
const OF_BASE: f64 = 1e-8;
const STATES: usize = 3;
/// Mechanisms in the default and full tier; the latter must cover every feature and defect.
const COUNT: [u64; 3] = [16, 208, 208];
/// Largest condition number of the model's own partition for the plain comparison.
const PLAIN_CONDITION: f64 = 1e3;
/// Largest joint rate on the path for differentiating the energy, rad/s and m/s.
const RATE: f64 = 2.0;
/// Largest error of the power: that of seven-point differences of the energy.
const DIFFERENCES: f64 = 1e-7;

/// Increment of the seed of a mechanism whose legs do not constrain the platform to its motion;
/// also the limit for redrawing.
const REDRAW_INCREMENT: u64 = 8_000_000;
const REDRAW_LIMIT: u64 = 30 * REDRAW_INCREMENT;

/// Number from the environment.
fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

fn seeds() -> std::ops::Range<u64> {
    match setting("OVERACT_RANDOM_SEED") {
        Some(seed) => seed..seed + drawn([1; 3]),
        None => 0..drawn(COUNT),
    }
}

/// Runs `check` for every seed on all processors; results by seed. A panic is a failure.
fn for_each_seed<T: Send>(
    check: impl Fn(u64) -> Result<T, Failure> + Sync,
) -> BTreeMap<u64, Result<T, String>> {
    let results = Mutex::new(BTreeMap::new());
    let next = AtomicU64::new(seeds().start);
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if !seeds().contains(&seed) {
                break;
            }
            let result = catch_unwind(AssertUnwindSafe(|| check(seed)));
            let result = match result {
                Ok(result) => result.map_err(|error| error.to_string()),
                Err(_) => Err("a panic".to_owned()),
            };
            if let Ok(mut results) = results.lock() {
                results.insert(seed, result);
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    results.into_inner().unwrap_or_default()
}

/// Union of the features of all seeds; prints every failure.
fn all_met<T: Ord + Clone>(results: &BTreeMap<u64, Result<BTreeSet<T>, String>>) -> BTreeSet<T> {
    let failed = |(seed, result): (&u64, &Result<BTreeSet<T>, String>)| {
        let error = result.as_ref().err()?;
        Some(format!("OVERACT_RANDOM_SEED={seed}: {error}"))
    };
    let failures: Vec<String> = results.iter().filter_map(failed).collect();
    let (count, all) = (failures.len(), results.len());
    assert!(
        failures.is_empty(),
        "{count} of {all}:\n{}",
        failures.join("\n")
    );
    results.values().flatten().flatten().cloned().collect()
}

#[test]
fn random_mechanisms_agree_with_the_reference() {
    let results = for_each_seed(|seed| agree(&Sketch::draw(seed)));
    let met = all_met(&results);
    if results.len() as u64 >= COUNT[1] {
        let missing: Vec<&str> = features::ALL
            .into_iter()
            .filter(|f| !met.contains(*f))
            .collect();
        assert!(missing.is_empty(), "no mechanism had: {missing:?}");
    }
}

/// Compares one mechanism; returns its features.
fn agree(sketch: &Sketch) -> Result<BTreeSet<String>, Failure> {
    let source = sketch.source();
    let alone = seeds().count() == 1;
    if alone {
        println!("{}", source.text);
    }
    let model = match model_of(&source, sketch.seed) {
        Ok(model) => model,
        Err(errors) => {
            // Legs that allow the platform further motions make another robot; draw a new one.
            let is_not_held = |error: &Diagnostic| error.kind == DiagnosticKind::NotHeld;
            if errors.iter().any(is_not_held) && sketch.seed < REDRAW_LIMIT {
                return agree(&Sketch::draw(sketch.seed + REDRAW_INCREMENT));
            }
            return Err(format!("refused:\n{}", errors.render_plain(&source)).into());
        }
    };
    // The reference uses the numbers as drawn, not as read by the generator.
    let mut plain = sketch.mechanism();
    plain.workspace = workspace(&model);
    let mut expected = Expected::by_position(&model, plain);
    // The mechanism as drawn has the description's base frame, also with a platform on an axis.
    expected.frames.origin.fill(0.0);
    let parameters = expected.parameters();
    let all = samples(&expected.mechanism, &parameters, STATES, sketch.seed, false)?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let [mut comparison, mut of_base] = [TOLERANCE, OF_BASE].map(Comparison::new);
    let evaluated = Evaluated(&model);
    let is_well_conditioned = is_well_conditioned(&model, &evaluated, &all)?;
    let has_masses = has_masses(&truths)?;
    for function in &model.functions {
        let is_moved = has_masses || !matches!(function.computes, Function::ForwardDynamics(_));
        if is_moved && (is_well_conditioned || !depends_on_kept(function.computes)) {
            let own = if function.name.contains("dynamics_base")
                || function.name.contains("matrix_base")
                || function.name.contains("bias_base")
            {
                &mut of_base
            } else {
                &mut comparison
            };
            own.function(function, &evaluated, &all, &truths)?;
        }
    }
    if !model.is_tree() {
        let all_kept = partitions(model.mechanism.actuated().len(), model.mechanism.dof());
        // A program has one partition, which the seed chooses.
        let own = sketch.seed as usize / 8 % all_kept.len();
        for (at, kept) in all_kept.iter().enumerate() {
            comparison.partition((kept, at == own), &model, &evaluated, &all, &truths)?;
        }
    }
    if alone {
        println!(
            "{}\n{}",
            comparison.lines.join("\n"),
            of_base.lines.join("\n")
        );
    }
    let mut failures = comparison.failures;
    failures.extend(of_base.failures);
    if !failures.is_empty() {
        return Err(failures.join("\n    ").into());
    }
    balance(&expected, &evaluated, &all)?;
    let mut found = sketch.features();
    found.insert(format!("joints by {:?}", model.selection.joints));
    Ok(found)
}

/// Model with the functions for this seed; for one in seventeen, operations are searched.
///
/// Motions repeat every eight seeds, so all of them are searched at times.
fn model_of(source: &Source, seed: u64) -> Result<RobotModel, Diagnostics> {
    let wanted = |mechanism: &Mechanism, function: Function, from: MotionInput| {
        let always = match function {
            // The closure error only has to vanish. The closed-form pose has the assembly mode of
            // home, which a state may have left.
            Function::ClosureError | Function::PoseInClosedForm | Function::BlockedJacobian => {
                return false;
            }
            // Differences of the reference need states whose surroundings are within reach; the
            // tests of derivatives choose them.
            derivative if derivative.is_derivative() => return false,
            Function::Joints
            | Function::InverseJacobian
            | Function::JointVelocities
            | Function::JointAccelerations
            | Function::InverseDynamics(Columns::Standard)
            | Function::IdmRedPlatform(_)
            | Function::IdmRedActuators(Columns::Standard) => from != MotionInput::Actuators,
            _ => false,
        };
        let name = function_name(function, from, mechanism.is_tree());
        let turn = name.bytes().map(u64::from).sum::<u64>() + seed / 8;
        always || turn.is_multiple_of(6)
    };
    let searched = seed % 17 == 3;
    let effort = if searched {
        Effort::Quick
    } else {
        Effort::None
    };
    let request = Request {
        effort: Some(effort),
        wanted: &wanted,
        ..Request::default()
    };
    compile_with(source, &request).map(|compiled| compiled.model)
}

/// Whether a function depends on the kept actuators.
const fn depends_on_kept(function: Function) -> bool {
    matches!(
        function,
        Function::IdmRedActuators(_)
            | Function::IdmRedPayloadActuators
            | Function::ProjectActuators
            | Function::InverseDynamicsPreloaded
            | Function::NullSpace
    )
}

/// Whether the model's kept actuators are well conditioned at all samples.
///
/// Otherwise the partition is compared with a tolerance for its condition number.
fn is_well_conditioned(
    model: &RobotModel,
    evaluated: &Evaluated<'_>,
    all: &[Sample],
) -> Result<bool, Failure> {
    let kept = &model.selection.kept_actuators;
    for sample in all.iter().filter(|_| !model.is_tree()) {
        let jacobian = evaluated.call("inverse_jacobian", sample)?;
        let still = DMatrix::zeros(kept.len(), 1);
        if project(&jacobian, kept, &still)
            .map_or(true, |(_, condition)| condition > PLAIN_CONDITION)
        {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The power of the motors without friction is the rate of change of the energy.
fn balance(expected: &Expected, evaluated: &Evaluated<'_>, all: &[Sample]) -> Result<(), Failure> {
    let (mechanism, sample) = (&expected.mechanism, all.first().ok_or("no state")?);
    let chi = frictionless(mechanism, &sample.all_parameters);
    // The same path, slow enough for the step of the differences.
    let State { pose, q, .. } = &sample.state;
    let slower = (RATE / sample.state.qd.amax()).min(1.0);
    let twist = &sample.state.twist * slower;
    let acceleration = &sample.state.acceleration * (slower * slower);
    let sample = Sample {
        parameters: expected.parameters().iter().map(|&at| chi[at]).collect(),
        state: State::with_joints(mechanism, pose, q, &twist, &acceleration)?,
        ..sample.clone()
    };
    let energy = |state: &_| DVector::from_element(1, total_energy(mechanism, state, &chi));
    let (change, _) = trajectory::derivatives(mechanism, &sample.state, energy)?;
    let rates = evaluated.call("inverse_jacobian", &sample)?
        * DMatrix::from_column_slice(twist.len(), 1, twist.as_slice());
    let powers = evaluated
        .call("inverse_dynamics", &sample)?
        .component_mul(&rates);
    let scale = powers.abs().sum().max(change[0].abs()).max(1e-3);
    let error = (powers.sum() - change[0]).abs() / scale;
    if error < DIFFERENCES {
        Ok(())
    } else {
        Err(format!("power and energy differ by {error:e}").into())
    }
}

#[test]
fn damaged_mechanisms_are_rejected_with_a_reason() {
    let results = for_each_seed(|seed| {
        let sketch = Sketch::draw(seed);
        let defects = Defect::ALL.into_iter();
        let mut refused = BTreeSet::new();
        for defect in defects {
            let Some(damaged) = defect.apply(&sketch) else {
                continue;
            };
            let source = damaged.source();
            let Err(errors) = overact_codegen::compile(&source) else {
                return Err(format!("accepted with {defect:?}:\n{}", source.text).into());
            };
            if errors.is_empty() || errors.render_plain(&source).is_empty() {
                return Err(format!("refused without a reason: {defect:?}").into());
            }
            refused.insert(defect);
        }
        Ok(refused)
    });
    let met = all_met(&results);
    if results.len() as u64 >= COUNT[1] {
        assert_eq!(met.len(), Defect::ALL.len(), "only {met:?}");
    }
}

#[test]
fn the_same_seed_draws_the_same_mechanism() {
    for seed in 0..16 {
        assert_eq!(Sketch::draw(seed).text(), Sketch::draw(seed).text());
    }
    assert!(matches!(Sketch::draw(7).motion, Motion::None));
}
