//! Motors that drive combinations of joints in robots with loops.
//!
//! The actuated joints of robots of `robots/` and of random mechanisms are replaced by motors that
//! turn joints of one leg or several, actuated or passive ones. All functions of actuators are
//! compared with the numeric reference, and the power of the motors with the change of the energy.

use nalgebra::{DMatrix, DVector};
use overact::Function;
use overact_codegen::derivation::MotionInput;
use overact_codegen::mechanism::Mechanism;
use overact_codegen::{Effort, Request, RobotModel, Source};
use overact_tests::reference::energy::total_energy;
use overact_tests::reference::states::frictionless;
use overact_tests::reference::trajectory;
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::{Expected, has_masses};
use overact_tests::support::library::workspace;
use overact_tests::support::motors::{with_motors, with_random_motors};
use overact_tests::support::random::{Sketch, parasitic_motion, skeleton};
use overact_tests::support::sample::samples;
use overact_tests::support::{
    Backend, Comparison, Evaluated, Failure, Sample, description, model_with,
};
use overact_tier::{by_tiers, drawn, of_many};

/// Tolerances of functions of base parameters, whose regroupings may be numeric, and of others.
const TOLERANCES: [f64; 2] = [1e-6, 1e-9];
/// Tolerance of the power, in units of the largest power of a motor.
const POWER: f64 = 1e-9;
/// Rounding of the energy in its differences, in units of the last place.
const ROUNDING: f64 = 64.0;
/// States in the default, full and nightly tier.
const STATES: [usize; 3] = [2, 4, 10];
/// Words of the reasons for which a draw is refused.
const REFUSED: [&str; 11] = [
    "never reaches",
    "does not close",
    "singular",
    "regular",
    "stretched",
    "independent",
    "do not restrict",
    "determine",
    "no joint is actuated",
    "cancel",
    "no loop",
];
/// Largest number of draws for each random robot.
const DRAWS: u64 = 30;

/// Robots of the default tier: planar, spatial and redundant platforms, parasitic motion, chains.
const ROBOTS: [&str; 3] = ["ankle", "dualv", "spatial_3prs"];
/// Further robots of the full tier.
const MORE: [&str; 15] = [
    "delta",
    "excavator",
    "exechon",
    "five_bar",
    "four_bar",
    "hexapod",
    "humanoid_leg",
    "orthoglide",
    "palletiser",
    "planar_3rrr",
    "planar_4prr",
    "reachy_mini",
    "schoenflies_4",
    "spherical_4rrr",
    "tricept",
];

/// Named robots with coupled motors.
const NAMED: [(&str, &str); 5] = [
    // A belt from the base turns the distal link: its motor turns the sum of both angles.
    (
        "five_bar",
        "[motor.left]\nturns = \"left.q1\"\nratio = 50\n\
         [motor.belt]\nturns = \"left.q1 + left.q2\"\nratio = -20\nstribeck = \"0.05 rad/s\"\n",
    ),
    // Sum and difference of two shoulders, and two motors of their own.
    (
        "dualv",
        "[motor.sum]\nturns = \"(leg1.q1 + leg2.q1)/2\"\n\
         [motor.difference]\nturns = \"(leg1.q1 - leg2.q1)/2\"\n\
         [motor.three]\nturns = \"leg3.q1\"\nparameters = [\"ia\", \"friction by direction\"]\n\
         [motor.four]\nturns = \"leg4.q1\"\n",
    ),
    // A differential between the two cranks.
    (
        "ankle",
        "[motor.pitch]\nturns = \"left.q_crank + right.q_crank\"\n\
         [motor.roll]\nturns = \"left.q_crank - right.q_crank\"\n",
    ),
    // Antagonists: three motors for two cranks.
    (
        "ankle",
        "[motor.a]\nturns = \"left.q_crank\"\n[motor.b]\nturns = \"right.q_crank\"\n\
         [motor.c]\nturns = \"-left.q_crank - 0.5*right.q_crank\"\n",
    ),
    // The motor of the forearm turns against the shoulder, over the passive elbow.
    (
        "palletiser",
        "[motor.turret]\nturns = \"q_turret\"\n[motor.shoulder]\nturns = \"arm.q_shoulder\"\n\
         [motor.forearm]\nturns = \"q_elbow + 0.25*q_shoulder + 0.1*linkage.q_rod\"\n",
    ),
];

/// Model of a description with the functions of its actuators.
fn model_of(name: &str, text: &str) -> Result<RobotModel, Failure> {
    let wanted = |_: &Mechanism, function: Function, _: MotionInput| {
        matches!(
            function,
            Function::IdmRedPlatform(_)
                | Function::IdmRedActuators(_)
                | Function::InverseDynamics(_)
                | Function::InverseDynamicsPreloaded
                | Function::MassMatrix(_)
                | Function::Bias(_)
                | Function::ForwardDynamics(_)
                | Function::InverseJacobian
                | Function::Jacobian
                | Function::ClosurePlatformJacobian
                | Function::ClosureActuatorJacobian
                | Function::TwistFromActuators
                | Function::AccelerationFromActuators
                | Function::ProjectPlatform
                | Function::ProjectActuators
                | Function::ProjectTorques
                | Function::NullSpace
        )
    };
    let source = Source::new(format!("{name}.toml"), text);
    let request = Request {
        wanted: &wanted,
        ..Request::with_effort(Effort::None)
    };
    model_with(&source, &request)
}

/// Differences of all functions that exceed the tolerances.
fn differences(name: &str, text: &str) -> Result<Vec<String>, Failure> {
    let model = model_of(name, text)?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    let parameters = expected.parameters();
    let all = samples(&expected.mechanism, &parameters, by_tiers(STATES), 7, false)?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut comparisons = TOLERANCES.map(Comparison::new);
    let has_masses = has_masses(&truths)?;
    for function in &model.functions {
        if !has_masses && matches!(function.computes, Function::ForwardDynamics(_)) {
            continue;
        }
        let at = usize::from(!function.name.contains("_base"));
        comparisons[at].function(function, &Evaluated(&model), &all, &truths)?;
    }
    let [of_base, others] = comparisons;
    assert!(others.lines.len() >= 8, "{name}: {:?}", others.lines);
    let failures = of_base.failures.into_iter().chain(others.failures);
    Ok(failures.map(|line| format!("{name}: {line}")).collect())
}

/// The power of the motors without friction is the change of the energy.
fn balance(name: &str, text: &str) -> Result<(), Failure> {
    let model = model_of(name, text)?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    let (mechanism, columns) = (&expected.mechanism, expected.parameters());
    for sample in samples(mechanism, &columns, by_tiers(STATES), 17, false)? {
        let chi = frictionless(mechanism, &sample.all_parameters);
        let energy = |state: &_| DVector::from_element(1, total_energy(mechanism, state, &chi));
        let (change, _) = trajectory::derivatives(mechanism, &sample.state, energy)?;
        let step = trajectory::step(&sample.state);
        let rounding = ROUNDING * f64::EPSILON * energy(&sample.state)[0].abs() / step;
        let sample = Sample {
            parameters: columns.iter().map(|&at| chi[at]).collect(),
            ..sample.clone()
        };
        let twist = &sample.state.twist;
        let twist = DMatrix::from_column_slice(twist.len(), 1, twist.as_slice());
        let rates = Evaluated(&model).call("inverse_jacobian", &sample)? * twist;
        let torques = Evaluated(&model).call("inverse_dynamics", &sample)?;
        let powers = torques.component_mul(&rates);
        let scale = powers.abs().sum().max(change[0].abs());
        let error = ((powers.sum() - change[0]).abs() - rounding).max(0.0) / scale;
        if error > POWER {
            return Err(format!("{name}: power and energy differ by {error:e}").into());
        }
    }
    Ok(())
}

/// Compares all functions of a description.
fn compare(name: &str, text: &str) -> Result<(), Failure> {
    let failures = differences(name, text)?;
    assert!(failures.is_empty(), "{}\n{text}", failures.join("\n"));
    Ok(())
}

#[test]
fn robots_with_differentials_belts_and_antagonists_agree() -> Result<(), Failure> {
    for (stem, motors) in NAMED {
        let text = with_motors(&description(stem)?.text, motors)?;
        compare(stem, &text)?;
        balance(stem, &text)?;
        println!("{stem}");
    }
    Ok(())
}

#[test]
fn robots_of_the_library_agree_with_random_motors() -> Result<(), Failure> {
    let all = [&ROBOTS[..], &of_many(MORE)].concat();
    for stem in all {
        // The first seed whose motors determine the motion.
        let text = description(stem)?.text;
        let mut seeds = 0..DRAWS;
        let drawn = seeds.find_map(|seed| {
            let text = with_random_motors(&text, seed).ok()?;
            match differences(stem, &text) {
                Err(error) if is_refused(&error) => None,
                other => Some((text, other)),
            }
        });
        let (text, failures) = drawn.ok_or_else(|| format!("{stem}: no regular motors"))?;
        let failures = failures?;
        assert!(failures.is_empty(), "{}\n{text}", failures.join("\n"));
        balance(stem, &text)?;
        println!("{stem}");
    }
    Ok(())
}

fn is_refused(error: &Failure) -> bool {
    let words = error.to_string();
    REFUSED.iter().any(|part| words.contains(part))
}

/// Compares random robots from `draw`; draws that do not close, or are nearly singular, do not
/// count.
fn random(draw: impl Fn(u64) -> String, count: u64) -> Result<(), Failure> {
    let own = std::env::var("OVERACT_RANDOM_SEED").ok();
    let own: Option<u64> = own.and_then(|seed| seed.parse().ok());
    let (mut compared, mut seed) = (0, own.unwrap_or(0));
    let count = if own.is_some() { 1 } else { count };
    let mut failures = Vec::new();
    while compared < count {
        let drawn = with_random_motors(&draw(seed), seed);
        let found = drawn.and_then(|text| {
            if own.is_some() {
                println!("{text}");
            }
            differences(&format!("random{seed}"), &text)
        });
        match found {
            Ok(found) => {
                compared += 1;
                failures.extend(found);
            }
            Err(error) => {
                let is_expected = is_refused(&error) && own.is_none();
                assert!(is_expected, "seed {seed}: {error}");
            }
        }
        seed += 1;
        assert!(
            seed - own.unwrap_or(0) <= DRAWS * count,
            "hardly a draw closes"
        );
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    Ok(())
}

#[test]
fn random_mechanisms_agree_with_motors() -> Result<(), Failure> {
    random(closed_sketch, drawn([3, 10, 80]))
}

/// A random mechanism with a platform.
fn closed_sketch(seed: u64) -> String {
    Sketch::draw(seed).text()
}

#[test]
fn random_chains_agree_with_motors() -> Result<(), Failure> {
    random(skeleton, drawn([1, 3, 20]))
}

#[test]
fn random_platforms_with_parasitic_motion_agree_with_motors() -> Result<(), Failure> {
    random(parasitic_motion, drawn([1, 2, 10]))
}

/// Motors described with a leg belong to each of its placements.
#[test]
fn motors_of_a_leg_are_placed_with_it() -> Result<(), Failure> {
    let bar = description("five_bar")?.text;
    let motor = "\n[[leg.arm.motor]]\nname = \"belt\"\nturns = \"q1 + 0.5*q2\"\n";
    let text = with_motors(&bar, motor)?;
    let model = model_of("five_bar", &text)?;
    assert_eq!(model.mechanism.actuator_names(), ["left", "right"]);
    let names: Vec<String> = { model.selection.standard.iter() }
        .map(|&parameter| model.parameter_name(parameter))
        .collect();
    for name in ["ia_belt_left", "fs_belt_right"] {
        assert!(names.contains(&name.to_owned()), "{names:?}");
    }
    compare("five_bar", &text)
}

/// An actuated joint may have a motor in addition to coupled ones.
#[test]
fn actuated_joints_are_ordered_before_motors() -> Result<(), Failure> {
    let ankle = description("ankle")?.text;
    let text = overact_tests::support::motors::mechanism_only(&ankle)
        + "\n[motor.helper]\nturns = \"left.q_crank + right.q_crank\"\n";
    let model = model_of("ankle", &text)?;
    assert_eq!(
        model.mechanism.actuator_names(),
        ["left", "right", "helper"]
    );
    compare("ankle", &text)
}

/// Motors that leave a motion free are refused, and so are those of unknown joints.
#[test]
fn invalid_motors_are_rejected() -> Result<(), Failure> {
    let bar = description("five_bar")?.text;
    let refused = |motors: &str| -> Result<String, Failure> {
        let text = with_motors(&bar, motors)?;
        let error = model_of("five_bar", &text).err().ok_or("accepted")?;
        Ok(error.to_string())
    };
    let dependent_motors = "[motor.a]\nturns = \"left.q1 + right.q1\"\n\
                 [motor.b]\nturns = \"2*left.q1 + 2*right.q1\"\n";
    let error = refused(dependent_motors)?;
    for words in [
        "the actuators never determine the platform's motion",
        "the motors `a` and `b` have the same effect: let one of them turn another combination",
    ] {
        assert!(error.contains(words), "{error}");
    }
    let error = refused("[motor.a]\nturns = \"left.q1\"\n")?;
    assert!(
        error.contains("2 degrees of freedom, but the robot has 1 actuator"),
        "{error}"
    );
    let error = refused("[motor.a]\nturns = \"left.q3 + left.q1\"\n")?;
    assert!(error.contains("unknown name `left.q3`"), "{error}");
    Ok(())
}
