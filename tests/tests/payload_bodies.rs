//! Payloads on bodies of legs, chains, skeletons and serial robots agree with the numeric reference.
//!
//! The reference has each payload as one more body on two fixed joints.

use overact::Function;
use overact_codegen::derivation::MotionInput;
use overact_codegen::mechanism::Mechanism;
use overact_codegen::{Effort, Request, RobotModel, Source};
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::workspace;
use overact_tests::support::motors::mechanism_only;
use overact_tests::support::sample::samples;
use overact_tests::support::{Comparison, Evaluated, Failure, description, model_with};
use overact_tier::by_tier;

const TOLERANCE: f64 = 1e-9;
/// States in the default tier and in the full one.
const STATES: [usize; 2] = [2, 10];

/// Robots with payloads on two bodies each, one of them turned.
const ROBOTS: [(&str, [&str; 2]); 5] = [
    ("five_bar", ["left.2", "right.1"]),
    ("palletiser", ["elbow", "linkage.rod"]),
    ("ankle", ["roll", "left.rod"]),
    ("rx90", ["6", "3"]),
    ("dualv", ["leg1.3", "leg3.2"]),
];

/// The description with two payloads.
fn loaded(stem: &str, bodies: [&str; 2]) -> Result<String, Failure> {
    let text = mechanism_only(&description(stem)?.text);
    let text = text.replace("[platform.payload]\n", "");
    let [first, second] = bodies;
    Ok(format!(
        "{text}\n[payload.tool]\nbody = \"{first}\"\nat = [\"0.05 m\", \"-0.02 m\", \"0.03 m\"]\n\
         rotation = [\"20 deg\", \"-35 deg\", \"50 deg\"]\n\
         [payload.box]\nbody = \"{second}\"\nparameters = [\"xx\", \"zz\", \"mx\", \"m\"]\n"
    ))
}

fn model_of(stem: &str, text: &str) -> Result<RobotModel, Failure> {
    let wanted = |_: &Mechanism, function: Function, _: MotionInput| {
        matches!(
            function,
            Function::IdmRedPayload
                | Function::IdmRedPayloadActuators
                | Function::IdmRedPlatform(_)
                | Function::InverseDynamics(_)
                | Function::MassMatrix(_)
                | Function::Bias(_)
                | Function::ForwardDynamics(_)
        )
    };
    let source = Source::new(format!("{stem}.toml"), text);
    let request = Request {
        wanted: &wanted,
        ..Request::with_effort(Effort::None)
    };
    model_with(&source, &request)
}

#[test]
fn payloads_on_bodies_agree_with_bodies_of_the_reference() -> Result<(), Failure> {
    for (stem, bodies) in ROBOTS {
        let model = model_of(stem, &loaded(stem, bodies)?)?;
        let names: Vec<String> = { model.selection.payload.iter() }
            .map(|&parameter| model.parameter_name(parameter))
            .collect();
        let has = |name: &str| names.iter().any(|own| own == name);
        assert!(
            has("m_payload_tool") || has("mx_payload_tool"),
            "{stem}: {names:?}"
        );
        assert!(!has("yy_payload_box"), "{stem}: {names:?}");
        let mechanism = reference(&model.mechanism, workspace(&model));
        let expected = Expected::by_position(&model, mechanism);
        let parameters = expected.parameters();
        let all = samples(&expected.mechanism, &parameters, by_tier(STATES), 11, false)?;
        let truths = all.iter().map(|sample| expected.at(sample));
        let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
        let mut comparison = Comparison::new(TOLERANCE);
        for function in &model.functions {
            let tolerated = function.name.contains("_base");
            if !tolerated {
                comparison.function(function, &Evaluated(&model), &all, &truths)?;
            }
        }
        assert!(
            comparison.lines.len() >= 4,
            "{stem}: {:?}",
            comparison.lines
        );
        assert!(
            comparison.failures.is_empty(),
            "{stem}: {}",
            comparison.failures.join("\n")
        );
        println!("{stem}");
    }
    Ok(())
}

/// Payloads on the ground, on missing bodies, and next to another description of a payload.
#[test]
fn invalid_payloads_are_rejected() -> Result<(), Failure> {
    let bar = mechanism_only(&description("five_bar")?.text);
    for (tables, words) in [
        (
            "[payload.box]\nbody = \"ground\"\n",
            "a payload on the ground does not move",
        ),
        (
            "[payload.box]\nbody = \"left.5\"\n",
            "the robot has no body `left.5`",
        ),
        (
            "[payload.box]\n[platform.payload]\n",
            "payloads with tables of their own are described twice",
        ),
    ] {
        let error = model_of("five_bar", &format!("{bar}\n{tables}"));
        let error = error.err().ok_or("accepted")?.to_string();
        assert!(error.contains(words), "{tables}: {error}");
    }
    Ok(())
}
