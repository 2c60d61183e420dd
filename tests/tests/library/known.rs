//! With known parameters, the dynamics have base parameters as constants.
//!
//! They give the same numbers as with parameters as inputs, in fewer operations.

use overact::{Columns, Function};
use overact_codegen::{Effort, Request, compile_with};
use overact_compiled::{Rx90, known};
use overact_tests::support::backend::{evaluate, matrix};
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::{Agreement, Failure, description};
use overact_tier::by_tier;
use std::collections::BTreeMap;
use std::fmt::Write as _;

const TOLERANCE: f64 = 1e-9;
const STATES: usize = 5;
const DYNAMICS: [Function; 4] = [
    Function::InverseDynamics(Columns::Standard),
    Function::MassMatrix(Columns::Standard),
    Function::Bias(Columns::Standard),
    Function::ForwardDynamics(Columns::Standard),
];

/// Robots of the default and full tier.
const ROBOTS: [&[&str]; 2] = [
    &["dualv", "emps", "rx90"],
    &[
        "delta_4",
        "dualv",
        "dvrk_mtm",
        "emps",
        "five_bar",
        "hexapod",
        "kuka_lwr",
        "rx90",
        "scotch_yoke",
        "spherical_4rrr",
        "tx40",
    ],
];

#[test]
fn constant_parameters_give_the_same_motion_in_fewer_operations() -> Result<(), Failure> {
    let mut table = String::new();
    for stem in by_tier(ROBOTS) {
        let (model, expected) = described(stem)?;
        let all = samples(
            &expected.mechanism,
            &expected.parameters(),
            STATES,
            31,
            false,
        )?;
        let values = &all.first().ok_or("no state")?.parameters;
        let selection = &model.selection;
        let parameters = selection.standard.iter().chain(&selection.payload);
        let names = parameters.map(|&one| model.parameter_name(one));
        let given: BTreeMap<String, f64> = names.zip(values.iter().copied()).collect();
        let request = Request {
            wanted: &|_, function, _| DYNAMICS.contains(&function),
            parameters: Some(&given),
            ..Request::with_effort(by_tier([Effort::None, Effort::Quick]))
        };
        let source = description(stem)?;
        let known = compile_with(&source, &request).map_err(|e| e.render_plain(&source))?;
        write!(table, "{stem}:")?;
        for function in DYNAMICS {
            let plain = &model.plain(function).ok_or("no such function")?.program;
            let own = &known
                .model
                .plain(function)
                .ok_or("no such function")?
                .program;
            assert!(own.inputs.iter().all(|input| input.name != "parameters"));
            let mut agreement = Agreement::new();
            for sample in &all {
                let input = |name: &str| match name {
                    "parameters" => Some(&values[..]),
                    _ => sample.input(name).ok(),
                };
                let wanted = matrix(plain, &evaluate(plain, &input)?);
                agreement.compare(&matrix(own, &evaluate(own, &input)?), &wanted);
            }
            assert!(
                agreement.within(TOLERANCE),
                "{stem} {function:?}: {agreement}"
            );
            let (before, after) = (plain.cost().operations(), own.cost().operations());
            assert!(after <= before, "{stem} {function:?}: {after} for {before}");
            write!(table, " {} {before} -> {after}", function.name())?;
        }
        writeln!(table)?;
    }
    println!("{table}");
    Ok(())
}

#[test]
fn compiled_constant_parameters_give_the_same_dynamics() -> Result<(), overact::Error> {
    let values: Vec<f64> = Rx90::PARAMETERS
        .iter()
        .map(|parameter| {
            let given = known::PARAMETERS
                .iter()
                .find(|(name, _)| *name == parameter.name);
            given.map_or(0.0, |&(_, value)| value)
        })
        .collect();
    let values = &values.try_into().expect("all parameters");
    let (q, v) = (
        [0.3, -0.4, 0.9, 0.2, -0.8, 0.5],
        [0.7, -0.2, 0.4, 1.1, 0.6, -0.9],
    );
    let (a, torques) = (
        [1.0, 2.0, -3.0, 0.5, 4.0, -2.0],
        [20.0, -90.0, 30.0, 2.0, -3.0, 1.0],
    );
    let close = |own: &[f64], plain: &[f64]| {
        let size = plain.iter().fold(1.0, |most: f64, one| most.max(one.abs()));
        for (own, plain) in own.iter().zip(plain) {
            assert!((own - plain).abs() < TOLERANCE * size, "{own} for {plain}");
        }
    };
    close(
        &known::Rx90::inverse_dynamics(&q, &v, &a)?,
        &Rx90::inverse_dynamics(&q, &v, &a, values)?,
    );
    close(&known::Rx90::bias(&q, &v)?, &Rx90::bias(&q, &v, values)?);
    close(
        known::Rx90::mass_matrix(&q)?.as_flattened(),
        Rx90::mass_matrix(&q, values)?.as_flattened(),
    );
    close(
        &known::Rx90::forward_dynamics(&q, &v, &torques)?,
        &Rx90::forward_dynamics(&q, &v, &torques, values)?,
    );
    assert_eq!(
        known::Rx90::PARAMETER_VALUES.len(),
        Rx90::BASE_PARAMETERS.len()
    );
    Ok(())
}
