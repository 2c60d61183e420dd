//! The two forms of the forces of given parameters give the same numbers: that which a robot's functions are
//! not written in, because the other needs fewer operations, is seen nowhere else.

use overact::{Columns, Function, Model};
use overact_codegen::derivation::{DynamicsBy, Selection};
use overact_codegen::internals::{Assembler, Search};
use overact_tests::support::backend::{evaluate, matrix};
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::{Agreement, Failure};

const TOLERANCE: f64 = 1e-10;
const STATES: usize = 10;

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
    Ok(())
}
