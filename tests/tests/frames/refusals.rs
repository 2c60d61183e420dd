//! Frames that cannot be: each error has its place and a way out.

use overact_codegen::{Choice, Effort, Request, Source, compile_with};
use overact_tests::support::{Failure, description};

/// The errors of a robot with this text after its description.
fn errors(stem: &str, more: &str) -> Result<String, Failure> {
    let Source { name, text } = description(stem)?;
    let source = Source::new(name, format!("{text}\n{more}"));
    let found = compile_with(&source, &Request::with_effort(Effort::None));
    Ok(found
        .err()
        .map_or_else(String::new, |errors| errors.render_plain(&source)))
}

fn assert_rejected(stem: &str, more: &str, all: &[&str]) -> Result<(), Failure> {
    let found = errors(stem, more)?;
    for part in all {
        assert!(found.contains(part), "{stem}: no `{part}` in\n{found}");
    }
    Ok(())
}

#[test]
fn unknown_bodies_are_rejected_with_the_available_ones() -> Result<(), Failure> {
    let text = "[frame.tool]\nbody = \"hand\"\n";
    assert_rejected(
        "rx90",
        text,
        &[
            "the robot has no body `hand`",
            "body = \"hand\"",
            "bodies are 1, 2, 3, 4, 5, 6",
        ],
    )?;
    let text = "[frame.tool]\nbody = \"leg1.9\"\n";
    assert_rejected("dualv", text, &["the robot has no body `leg1.9`", "leg1."])?;
    let text = "[frame.tool]\nbody = \"platform\"\n";
    assert_rejected("rx90", text, &["the robot has no body `platform`"])
}

#[test]
fn frame_names_that_clash_with_functions_are_rejected() -> Result<(), Failure> {
    for (name, taken) in [
        ("inverse", "inverse_jacobian"),
        ("project", "project_torques"),
        ("centre_of_mass", "centre_of_mass_jacobian"),
        ("home", "home_pose"),
    ] {
        let text = format!("[frame.{name}]\n");
        let parts = [
            &format!("a frame cannot be named `{name}`"),
            &format!("the code of every robot already has `{taken}`"),
            "choose another name",
        ];
        assert_rejected("dualv", &text, &parts.map(|part| part as &str))?;
    }
    Ok(())
}

#[test]
fn frame_names_must_be_identifiers() -> Result<(), Failure> {
    let text = "[frame.\"tool tip\"]\n";
    assert_rejected(
        "dualv",
        text,
        &["`tool tip` cannot be the name of a frame", "use letters"],
    )?;
    let text = "[frame.2]\n";
    assert_rejected("dualv", text, &["`2` cannot be the name of a frame"])
}

#[test]
fn unknown_keys_and_wrong_units_are_rejected() -> Result<(), Failure> {
    assert_rejected(
        "dualv",
        "[frame.tool]\nat = [0, 0, \"1 kg\"]\nbdy = \"platform\"\n",
        &["bdy", "1 kg"],
    )
}

#[test]
fn functions_of_missing_frames_are_rejected() -> Result<(), Failure> {
    let source = description("dualv")?;
    let choice = Choice::new(["tool_pose"]).map_err(|unknown| format!("{unknown:?}"))?;
    let request = Request {
        functions: Some(&choice),
        ..Request::with_effort(Effort::None)
    };
    let found = compile_with(&source, &request);
    let found = found
        .err()
        .map_or_else(String::new, |errors| errors.render_plain(&source));
    for part in [
        "has no function `tool_pose`",
        "no frame `tool`",
        "[frame.tool]",
    ] {
        assert!(found.contains(part), "no `{part}` in\n{found}");
    }
    Ok(())
}
