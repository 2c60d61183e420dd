//! Springs, known torques and load-dependent friction on all joints of robots with loops, and
//! springs and dampers between points of all robots.
//!
//! The elements are added to robots of `robots/` and to random mechanisms, on actuated and passive
//! joints of legs, chains, skeletons and branches. All dynamic functions are compared with the
//! numeric reference, and the power of the motors with the change of the energy, whose potential of
//! springs is found by quadrature.

use nalgebra::{DMatrix, DVector};
use overact::Function;
use overact_codegen::derivation::{JointsBy, MotionInput};
use overact_codegen::mechanism::Mechanism;
use overact_codegen::{Effort, Request, RobotModel, Source};
use overact_tests::reference::energy::total_energy;
use overact_tests::reference::states::frictionless;
use overact_tests::reference::trajectory;
use overact_tests::support::conversion::reference;
use overact_tests::support::elements::{with_point_springs, with_springs};
use overact_tests::support::expected::{Expected, has_masses};
use overact_tests::support::library::workspace;
use overact_tests::support::random::{Sketch, parasitic_motion, skeleton};
use overact_tests::support::sample::samples;
use overact_tests::support::{
    Backend, Comparison, Evaluated, Failure, Sample, description, model_with,
};
use overact_tier::{by_tier, by_tiers, drawn, of_many};

/// Tolerances of functions of base parameters, whose regroupings may be numeric, and of others.
const TOLERANCES: [f64; 2] = [1e-6, 1e-9];
/// Tolerance of the power, in units of the largest power of a motor.
const POWER: f64 = 1e-9;
/// Rounding of the energy in its differences, in units of the last place.
const ROUNDING: f64 = 64.0;
/// States in the default, full and nightly tier.
const STATES: [usize; 3] = [2, 4, 10];
/// Words of the reasons for which a draw is refused.
const REFUSED: [&str; 7] = [
    "never reaches",
    "does not close",
    "singular",
    "regular",
    "stretched",
    "independent",
    "do not restrict",
];
/// Largest number of draws for each random robot.
const DRAWS: u64 = 20;

/// Robots of the default tier: planar and redundant platforms, parasitic motion, chains.
const ROBOTS: [&str; 4] = ["dualv", "excavator", "five_bar", "spatial_3prs"];
/// Further robots of the full tier.
const MORE: [&str; 15] = [
    "ankle",
    "delta",
    "exechon",
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
    "three_leg_point",
    "tricept",
];

/// Robots without loops of the default tier and of the full one.
const SERIAL: [&[&str]; 2] = [
    &["rx90", "emps"],
    &["rx90", "emps", "dvrk_mtm", "kuka_lwr", "stanford", "tx40"],
];

/// Model of a description with the functions that contain forces, and J_p^inv.
fn model_of(name: &str, text: &str) -> Result<RobotModel, Failure> {
    let wanted = |_: &Mechanism, function: Function, _: MotionInput| {
        matches!(
            function,
            Function::IdmRedPlatform(_)
                | Function::IdmRedActuators(_)
                | Function::InverseDynamics(_)
                | Function::Bias(_)
                | Function::ForwardDynamics(_)
                | Function::InverseJacobian
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
    assert!(others.lines.len() >= 4, "{name}: {:?}", others.lines);
    let failures = of_base.failures.into_iter().chain(others.failures);
    Ok(failures.map(|line| format!("{name}: {line}")).collect())
}

/// Compares all functions of a description.
fn compare(name: &str, text: &str) -> Result<(), Failure> {
    let failures = differences(name, text)?;
    assert!(failures.is_empty(), "{}\n{text}", failures.join("\n"));
    Ok(())
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

/// Names of the robots of the tier.
fn robots() -> Vec<&'static str> {
    by_tier([ROBOTS.to_vec(), [&ROBOTS[..], &MORE].concat()])
}

/// Robots with the seeds of their springs; of [`MORE`] only many.
fn seeded(all: impl IntoIterator<Item = &'static str>) -> Vec<(u64, &'static str)> {
    let many = of_many(MORE);
    let is_kept = |(_, stem): &(u64, &str)| !MORE.contains(stem) || many.contains(stem);
    (0..).zip(all).filter(is_kept).collect()
}

#[test]
fn robots_of_the_library_agree_with_springs_on_all_joints() -> Result<(), Failure> {
    for (seed, stem) in seeded(robots()) {
        let text = with_springs(&description(stem)?.text, seed);
        compare(stem, &text)?;
        println!("{stem}");
    }
    Ok(())
}

#[test]
fn motor_power_is_the_energy_rate_with_springs() -> Result<(), Failure> {
    for (seed, stem) in seeded(robots()) {
        let text = with_springs(&description(stem)?.text, 100 + seed);
        balance(stem, &text)?;
    }
    Ok(())
}

#[test]
fn robots_of_the_library_agree_with_springs_between_points() -> Result<(), Failure> {
    let all = robots().into_iter().chain(by_tier(SERIAL).iter().copied());
    for (seed, stem) in seeded(all) {
        let text = with_point_springs(&description(stem)?.text, seed, true)?;
        compare(stem, &text)?;
        println!("{stem}");
    }
    Ok(())
}

#[test]
fn motor_power_is_the_energy_rate_with_springs_between_points() -> Result<(), Failure> {
    let all = robots().into_iter().chain(by_tier(SERIAL).iter().copied());
    for (seed, stem) in seeded(all) {
        let text = with_point_springs(&description(stem)?.text, 100 + seed, false)?;
        balance(stem, &text)?;
    }
    Ok(())
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
        let text = with_springs(&draw(seed), seed);
        let text = with_point_springs(&text, seed, true)?;
        if own.is_some() {
            println!("{text}");
        }
        match differences(&format!("random{seed}"), &text) {
            Ok(found) => {
                compared += 1;
                failures.extend(found);
            }
            Err(error) => {
                let words = error.to_string();
                let is_expected = REFUSED.iter().any(|part| words.contains(part));
                assert!(is_expected && own.is_none(), "seed {seed}: {words}\n{text}");
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
fn random_mechanisms_agree_with_springs() -> Result<(), Failure> {
    random(|seed| Sketch::draw(seed).text(), drawn([4, 12, 104]))
}

#[test]
fn random_chains_agree_with_springs() -> Result<(), Failure> {
    random(skeleton, drawn([1, 4, 25]))
}

#[test]
fn random_platforms_with_parasitic_motion_agree_with_springs() -> Result<(), Failure> {
    random(parasitic_motion, drawn([1, 2, 10]))
}

/// The sine of half a passive angle does not follow from the angle's sine and cosine alone.
#[test]
fn a_fraction_of_a_passive_angle_needs_newtons_method() -> Result<(), Failure> {
    let bar = description("five_bar")?.text;
    let spring = |formula: &str| {
        let link = "d = \"l_1\"\n";
        assert_eq!(bar.matches(link).count(), 1, "{bar}");
        bar.replace(link, &format!("{link}spring = \"{formula}\"\n"))
    };
    for (formula, by) in [
        ("sin(q/2)", JointsBy::Newton),
        ("sin(2*q)", JointsBy::Rule),
        ("q", JointsBy::Rule),
    ] {
        let text = spring(formula);
        let model = model_of("five_bar", &text)?;
        assert_eq!(model.selection.joints, by, "{formula}");
        compare("five_bar", &text)?;
    }
    Ok(())
}

/// A force between points that coincide has no direction.
#[test]
fn springs_between_coincident_points_are_rejected() -> Result<(), Failure> {
    let spring = "\n[[spring]]\nname = \"gas\"\nfrom = { body = \"ground\", at = [\"-half\", 0, 0] }\n\
                  to = { body = \"left.1\" }\nforce = \"l\"\n";
    let text = description("five_bar")?.text + spring;
    let line = text.lines().position(|line| line == "name = \"gas\"");
    let line = line.ok_or("no spring")? + 1;
    let error = model_of("five_bar", &text).err().ok_or("accepted")?;
    let error = error.to_string();
    let message = "the points of the spring `gas` coincide at the home configuration";
    assert!(error.contains(message), "{error}");
    assert!(error.contains(&format!("five_bar.toml:{line}")), "{error}");
    Ok(())
}
