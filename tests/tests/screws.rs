//! Helical joints: power balance, agreement of compiled and evaluated code, and chains with helical
//! joints.

use nalgebra::DVector;
use overact_codegen::{Effort, Request, Source};
use overact_compiled::friction::{SCREW, ScrewArm};
use overact_tests::reference::energy::total_energy;
use overact_tests::reference::states::frictionless;
use overact_tests::reference::trajectory;
use overact_tests::support::all_functions::against_reference;
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::workspace;
use overact_tests::support::sample::samples;
use overact_tests::support::tree::{SKELETON, drive};
use overact_tests::support::{Backend, Evaluated, Failure, Sample, Served, model_with};
use overact_tier::by_tier;

const TOLERANCE: f64 = 1e-9;
/// States of each robot in the default tier and in the full one.
const STATES: [usize; 2] = [4, 60];

/// The power of the motors is the rate of change of the energy from positions and velocities.
#[test]
fn motor_power_is_the_energy_rate_with_screws() -> Result<(), Failure> {
    let text = SCREW.replace("known = \"2 N m * cos(q) + 0.1 N m/rad * q\"\n", "");
    let source = Source::new("screw_arm.toml", text);
    let model = model_with(&source, &Request::with_effort(Effort::None))?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    let columns = expected.parameters();
    for sample in samples(&expected.mechanism, &columns, by_tier(STATES), 17, false)? {
        let chi = frictionless(&expected.mechanism, &sample.all_parameters);
        let energy =
            |state: &_| DVector::from_element(1, total_energy(&expected.mechanism, state, &chi));
        let (change, _) = trajectory::derivatives(&expected.mechanism, &sample.state, energy)?;
        let sample = Sample {
            parameters: columns.iter().map(|&at| chi[at]).collect(),
            ..sample.clone()
        };
        let torques = Evaluated(&model).call("inverse_dynamics", &sample)?;
        let powers: f64 = torques
            .iter()
            .zip(sample.state.twist.iter())
            .map(|(t, v)| t * v)
            .sum();
        let scale = powers.abs().max(change[0].abs()).max(1.0);
        assert!(
            (powers - change[0]).abs() < TOLERANCE * scale,
            "{powers} {change}"
        );
    }
    Ok(())
}

/// Compiled and evaluated robots agree up to rounding: both use the same lead.
#[test]
fn compiled_and_interpreted_screws_agree() -> Result<(), Failure> {
    let source = Source::new("screw_arm.toml", SCREW);
    let model = model_with(&source, &Request::with_effort(Effort::None))?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    let columns = expected.parameters();
    for sample in samples(&expected.mechanism, &columns, by_tier(STATES), 3, false)? {
        let [compiled, evaluated] = [
            Served(&ScrewArm).call("inverse_dynamics", &sample)?,
            Evaluated(&model).call("inverse_dynamics", &sample)?,
        ];
        let scale = evaluated.amax().max(1.0);
        assert!((compiled - evaluated).amax() < 1e-12 * scale);
    }
    Ok(())
}

/// The tree with a screw instead of its slide, and a drive from the ground to the body after it.
fn driven(keys: &str, home: &str) -> String {
    let screw = [
        (
            "type = \"prismatic\"",
            "type = \"helical\"\npitch = \"0.2 m\"",
        ),
        (
            "theta = \"25 deg\"",
            "theta = \"q + 25 deg\"\nr = \"0.1 m\"",
        ),
        ("b = \"0.3 m\", c", "b = \"50 deg\", c"),
    ];
    let tree = screw
        .iter()
        .fold(SKELETON.to_owned(), |text, (slide, screw)| {
            assert_eq!(text.matches(slide).count(), 1, "{slide}");
            text.replace(slide, screw)
        });
    tree + &drive("drive", ["ground", "c"], [keys, home])
}

#[test]
fn chains_on_a_skeleton_with_a_screw_agree() -> Result<(), Failure> {
    let text = driven("type = \"prismatic\"\nactuated = true", "0.6 m");
    let source = Source::new("screws.toml", text);
    let failures = against_reference(source, by_tier(STATES), [TOLERANCE; 2])?;
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    Ok(())
}

/// Two screws that need Newton's method.
///
/// The slide of one follows from a distance, without an equation of sines for its angle. The angle
/// of the other follows from a rod's orientation, without an equation for its slide.
#[test]
fn screws_in_chains_are_solved_by_newtons_method() -> Result<(), Failure> {
    for keys in ["actuated = true", "parameters = [\"fv\", \"m\"]"] {
        let text = driven(
            &format!("type = \"helical\"\npitch = \"0.5 m\"\n{keys}"),
            "430 deg",
        );
        let source = Source::new("screws.toml", text);
        let failures = against_reference(source, by_tier(STATES), [TOLERANCE; 2])?;
        assert!(failures.is_empty(), "{keys}\n{}", failures.join("\n"));
    }
    Ok(())
}
