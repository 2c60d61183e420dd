//! Requests for derivatives that a robot does not have: each error has its place and a way out.

use overact_codegen::derivation::MotionInput;
use overact_codegen::{Choice, Effort, Request, compile_with};
use overact_tests::support::{Failure, description};
use std::collections::BTreeMap;

/// The errors of a robot with these functions.
fn errors(stem: &str, choice: &Choice, known: bool) -> Result<String, Failure> {
    let source = description(stem)?;
    let parameters = BTreeMap::new();
    let request = Request {
        functions: Some(choice),
        parameters: known.then_some(&parameters),
        ..Request::with_effort(Effort::None)
    };
    let found = compile_with(&source, &request);
    Ok(found
        .err()
        .map_or_else(String::new, |errors| errors.render_plain(&source)))
}

fn named(name: &str) -> Result<Choice, Failure> {
    Choice::new([name]).map_err(|unknown| format!("{unknown:?}").into())
}

#[test]
fn similar_names_are_suggested() {
    let unknown = Choice::new(["inverse_dynamics_by_twis"]).expect_err("no name");
    let help: Vec<String> = unknown.iter().map(|one| one.help.clone()).collect();
    assert!(help[0].contains("`inverse_dynamics_by_twist`"), "{help:?}");
}

#[test]
fn derivatives_are_evaluated_from_the_pose() -> Result<(), Failure> {
    let choice = named("forward_dynamics_by_twist")?.evaluated_from([MotionInput::Joints]);
    let found = errors("five_bar", &choice, false)?;
    for part in [
        "five_bar.toml",
        "`forward_dynamics_by_twist` from joints",
        "evaluated from pose",
    ] {
        assert!(found.contains(part), "no `{part}` in\n{found}");
    }
    Ok(())
}

#[test]
fn known_parameters_leave_no_base_parameters() -> Result<(), Failure> {
    let choice = named("inverse_dynamics_by_twist_base")?;
    let found = errors("rx90", &choice, true)?;
    for part in ["rx90.toml", "inverse_dynamics_by_twist_base"] {
        assert!(found.contains(part), "no `{part}` in\n{found}");
    }
    assert!(errors("rx90", &named("inverse_dynamics_by_twist")?, true)?.is_empty());
    Ok(())
}
