//! All forms of a function give the same numbers.
//!
//! Forms that a robot's functions do not use, because another needs fewer operations, are tested
//! only here. They are the two forms of the forces of given parameters, and the alternative
//! formulations of the generator.

use overact::{Columns, Function, Model};
use overact_codegen::RobotModel;
use overact_codegen::derivation::{DynamicsBy, Formulation, Selection};
use overact_codegen::internals::{Assembler, Search, formulations};
use overact_tests::support::backend::{evaluate, matrix};
use overact_tests::support::library::described;
use overact_tests::support::sample::{Sample, samples};
use overact_tests::support::{Agreement, Failure};

const TOLERANCE: f64 = 1e-10;
const STATES: usize = 10;

/// One in this many formulations of a robot is tested; all for robots with few.
const TESTED_FRACTION: usize = 12;

overact_tests::library!(check);

fn check(stem: &str, _: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let all = samples(
        &expected.mechanism,
        &expected.parameters(),
        STATES,
        29,
        false,
    )?;
    for function in [
        Function::Bias(Columns::Standard),
        Function::InverseDynamics(Columns::Standard),
    ] {
        let from = model.plain(function).ok_or("no such function")?.from;
        let program = |dynamics: DynamicsBy| {
            let selection = Selection {
                dynamics,
                ..model.selection.clone()
            };
            let assembler = Assembler {
                mechanism: &model.mechanism,
                selection: &selection,
                search: &Search::none(),
            };
            let program = assembler.program(function, from);
            program.map_err(|error| format!("{stem}: {error:?}"))
        };
        let by_parameters = program(DynamicsBy::Parameters)?;
        let by_bodies = program(DynamicsBy::Bodies)?;
        let mut agreement = Agreement::new();
        for sample in &all {
            let input = |name: &str| sample.input(name).ok();
            let wanted = evaluate(&by_parameters, &input)?;
            let found = evaluate(&by_bodies, &input)?;
            agreement.compare(
                &matrix(&by_bodies, &found),
                &matrix(&by_parameters, &wanted),
            );
        }
        println!("{function:?}: {agreement}");
        assert!(agreement.within(TOLERANCE), "{function:?}: {agreement}");
    }
    for function in [
        Function::InverseDynamics(Columns::Standard),
        Function::IdmRedPlatform(Columns::Standard),
    ] {
        formulated(stem, model, function, &all)?;
    }
    Ok(())
}

/// Function in other formulations than the robot's.
fn formulated(
    stem: &str,
    model: &RobotModel,
    function: Function,
    all: &[Sample],
) -> Result<(), Failure> {
    let from = model.plain(function).ok_or("no such function")?.from;
    let program = |formulation: &Formulation| {
        let selection = Selection {
            formulation: formulation.clone(),
            dynamics: DynamicsBy::Bodies,
            ..model.selection.clone()
        };
        let assembler = Assembler {
            mechanism: &model.mechanism,
            selection: &selection,
            search: &Search::none(),
        };
        assembler.program(function, from)
    };
    let own = &model.selection.formulation;
    let wanted = program(own).map_err(|error| format!("{stem}: {error:?}"))?;
    let others = formulations(&model.mechanism, function, own);
    let step = others.len().div_ceil(TESTED_FRACTION).max(1);
    // The last ones have the most changes.
    for formulation in others.iter().rev().step_by(step) {
        // A formulation that is impossible for a leg is not a candidate.
        let Ok(found) = program(formulation) else {
            continue;
        };
        let mut agreement = Agreement::new();
        for sample in all {
            let input = |name: &str| sample.input(name).ok();
            let numbers = evaluate(&wanted, &input)?;
            let same = evaluate(&found, &input)?;
            agreement.compare(&matrix(&found, &same), &matrix(&wanted, &numbers));
        }
        let output = format!("{stem}, {function:?}, {formulation:?}: {agreement}");
        assert!(agreement.within(TOLERANCE), "{output}");
    }
    Ok(())
}
