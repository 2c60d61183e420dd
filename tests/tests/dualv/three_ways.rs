//! Macro, build script, `overact generate` and `generated/` give the same robot.
//!
//! The command line writes the text of `emission::file`, as its own tests check.

use overact::{Columns, Function, Model, redundant_robot};
use overact_codegen::{Effort, Request, backends::rust, compile_with};
use overact_compiled::partitions;
use overact_tests::support::sample::samples;
use overact_tests::support::{Backend, Failure, dualv, expected::Expected, repository};
use overact_tests::{redundant_backend, reference::robots};
use overact_tier::{by_tier, is_full};
use proc_macro2::{Delimiter, Ident, Span, TokenStream, TokenTree};
use std::fs;

#[redundant_robot("../robots/dualv.toml", effort = "thorough")]
struct DualV;

redundant_backend!(ByMacro, "macro", DualV);
redundant_backend!(ByBuildScript, "build script", partitions::kept_123::DualV);
redundant_backend!(Generated, "generated", overact_compiled::DualV);

/// Tokens as text, without commas before closing delimiters and braces around single match
/// expressions, which only the file printer adds.
fn normalised(tokens: TokenStream) -> String {
    let is = |token: &TokenTree, c: char| matches!(token, TokenTree::Punct(p) if p.as_char() == c);
    let mut texts: Vec<String> = Vec::new();
    let mut rest = tokens.into_iter().peekable();
    while let Some(token) = rest.next() {
        let is_arm = texts.ends_with(&["=".to_owned(), ">".to_owned()]);
        let last = rest.peek().is_none_or(|next| is(next, '>'));
        match &token {
            comma if is(comma, ',') && last => {}
            TokenTree::Group(group) if is_arm && group.delimiter() == Delimiter::Brace => {
                texts.push(normalised(group.stream()));
                if rest.peek().is_some_and(|next| !is(next, ',')) {
                    texts.push(",".to_owned());
                }
            }
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::Brace => ("{", "}"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::None => ("", ""),
                };
                texts.push(format!("{open} {} {close}", normalised(group.stream())));
            }
            other => texts.push(other.to_string()),
        }
    }
    texts.join(" ")
}

fn parsed(text: &str) -> Result<String, Failure> {
    let tokens: TokenStream = text.parse().map_err(|e| format!("{e}"))?;
    Ok(normalised(tokens))
}

/// First difference of two texts, with its context.
fn first_difference(a: &str, b: &str) -> Option<String> {
    let at = a.bytes().zip(b.bytes()).position(|(a, b)| a != b);
    let at = at.or_else(|| (a.len() != b.len()).then(|| a.len().min(b.len())))?;
    let around = |text: &str| -> String {
        let bytes = &text.as_bytes()[at.saturating_sub(60)..(at + 60).min(text.len())];
        String::from_utf8_lossy(bytes).into_owned()
    };
    Some(format!("...{}...\n...{}...", around(a), around(b)))
}

/// Uses the emission of the build script, because a thorough search takes long.
#[test]
fn build_script_and_checked_in_file_equal_the_emitted_code() -> Result<(), Failure> {
    let built = parsed(partitions::KEPT_123)?;
    let checked_in = parsed(&fs::read_to_string(repository("generated/src/dualv.rs"))?)?;
    let mut others = vec![("generated/", checked_in)];
    if is_full() {
        others.push(("the emission", normalised(rust::module(dualv()?))));
    }
    for (which, tokens) in others {
        let difference = first_difference(&built, &tokens);
        assert!(
            difference.is_none(),
            "{which}: {}",
            difference.unwrap_or_default()
        );
    }
    Ok(())
}

#[test]
fn macro_and_module_have_equal_items() -> Result<(), Failure> {
    // The macro adds these items to the user's struct, whose name they have.
    let items = normalised(rust::items(
        dualv()?,
        &Ident::new("DualV", Span::call_site()),
    ));
    assert!(normalised(rust::module(dualv()?)).ends_with(&items));
    let other = rust::items(dualv()?, &Ident::new("Mine", Span::call_site()));
    assert_eq!(normalised(other).replace("Mine", "DualV"), items);
    Ok(())
}

#[test]
fn macro_build_script_and_module_give_identical_bits() -> Result<(), Failure> {
    let model = dualv()?;
    let expected = Expected::new(model, robots::dualv())?;
    let all = samples(
        &robots::dualv(),
        &expected.parameters(),
        by_tier([20, 100]),
        71,
        true,
    )?;
    let names = model.functions.iter().map(|f| f.name.as_str());
    for function in names.chain(["pose_from_actuators"]) {
        for sample in &all {
            let by_macro = ByMacro.call(function, sample)?;
            for other in [&ByBuildScript as &dyn Backend, &Generated] {
                let found = other.call(function, sample)?;
                let same = found.shape() == by_macro.shape()
                    && found
                        .iter()
                        .zip(&by_macro)
                        .all(|(a, b)| a.to_bits() == b.to_bits());
                assert!(same, "{function}: macro and {} differ", other.label());
            }
        }
    }
    Ok(())
}

#[test]
fn macro_build_script_and_module_give_equal_robot_info() {
    let made = DualV.info();
    for info in [
        partitions::kept_123::DualV.info(),
        overact_compiled::DualV.info(),
    ] {
        assert_eq!(format!("{made:?}"), format!("{info:?}"));
    }
    assert_eq!(
        DualV::BASE_PARAMETERS,
        overact_compiled::DualV::BASE_PARAMETERS
    );
}

#[test]
fn model_trait_and_functions_give_equal_numbers() -> Result<(), Failure> {
    let expected = Expected::new(dualv()?, robots::dualv())?;
    let all = samples(&robots::dualv(), &expected.parameters(), 20, 72, true)?;
    let sizes = DualV.info().sizes;
    let functions = [
        Function::Joints,
        Function::ActuatorPositions,
        Function::InverseJacobian,
        Function::JointVelocities,
        Function::JointAccelerations,
        Function::TwistFromActuators,
        Function::AccelerationFromActuators,
        Function::IdmRedPlatform(Columns::Standard),
        Function::IdmRedPayload,
        Function::ProjectPlatform,
        Function::InverseDynamics(Columns::Standard),
        Function::MassMatrix(Columns::Standard),
        Function::Bias(Columns::Standard),
        Function::ForwardDynamics(Columns::Standard),
        Function::ProjectTorques,
        Function::NullSpace,
    ];
    for function in functions {
        let (rows, columns) = function.shape(&sizes);
        for sample in &all {
            let inputs = function
                .inputs()
                .iter()
                .map(|input| sample.input(input.name()));
            let inputs = inputs.collect::<Result<Vec<_>, _>>()?;
            let mut output = vec![0.0; rows * columns];
            DualV.evaluate(function, &inputs, &mut output)?;
            let direct = ByMacro.call(function.name(), sample)?;
            assert_eq!(output, direct.transpose().as_slice(), "{}", function.name());
        }
    }
    Ok(())
}

/// Small modules only; `cargo xtask freshness` checks all.
#[test]
fn small_generated_modules_are_fresh() -> Result<(), Failure> {
    for stem in ["emps", "five_bar"] {
        let source = overact_tests::support::description(stem)?;
        let searched = Request::with_effort(Effort::Thorough);
        let compiled = compile_with(&source, &searched).map_err(|e| e.render_plain(&source))?;
        let file = rust::file(&compiled.model, &source.name);
        let module = repository(&format!("generated/src/{stem}.rs"));
        let difference = first_difference(&file, &fs::read_to_string(module)?);
        assert!(
            difference.is_none(),
            "generated/src/{stem}.rs is stale, run `cargo xtask generated`:\n{}",
            difference.unwrap_or_default()
        );
    }
    Ok(())
}
