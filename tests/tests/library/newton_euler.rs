//! Serial and tree robots agree with the recursive Newton-Euler algorithm, compiled and evaluated.
//!
//! The reference's recursion uses the base frame for all bodies and has no closure, projection or
//! base parameters. Regroupings are checked as well: columns of the base parameters times their
//! regrouped values give the same torques.

use nalgebra::{DMatrix, DVector};
use overact::{Columns, Function};
use overact::{Model, redundant_robot};
use overact_codegen::RobotModel;
use overact_tests::reference::newton_euler::{regressor, tree_torques};
use overact_tests::reference::{Mechanism, State};
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::{described, workspace};
use overact_tests::support::sample::samples;
use overact_tests::support::{
    Agreement, Backend, Evaluated, Failure, Sample, Served, model_of, repository,
};

const TOLERANCE: f64 = 1e-9;
const STATES: usize = 200;

#[redundant_robot("fixtures/branched_arm.toml")]
struct BranchedArm;

#[test]
fn rx90_agrees_with_newton_euler() -> Result<(), Failure> {
    let (model, expected) = described("rx90")?;
    agree(model, expected, &overact_compiled::Rx90)
}

#[test]
fn tx40_agrees_with_newton_euler() -> Result<(), Failure> {
    let (model, expected) = described("tx40")?;
    agree(model, expected, &overact_compiled::Tx40)
}

#[test]
fn dvrk_mtm_agrees_with_newton_euler() -> Result<(), Failure> {
    let (model, expected) = described("dvrk_mtm")?;
    agree(model, expected, &overact_compiled::DvrkMtm)
}

#[test]
fn kuka_lwr_agrees_with_newton_euler() -> Result<(), Failure> {
    let (model, expected) = described("kuka_lwr")?;
    agree(model, expected, &overact_compiled::KukaLwr)
}

#[test]
fn stanford_agrees_with_newton_euler() -> Result<(), Failure> {
    let (model, expected) = described("stanford")?;
    agree(model, expected, &overact_compiled::Stanford)
}

#[test]
fn emps_agrees_with_newton_euler() -> Result<(), Failure> {
    let (model, expected) = described("emps")?;
    agree(model, expected, &overact_compiled::Emps)
}

#[test]
fn branched_arm_agrees_with_newton_euler() -> Result<(), Failure> {
    let name = "tests/fixtures/branched_arm.toml";
    let text = std::fs::read_to_string(repository(name))?;
    let model = model_of(&overact_codegen::Source::new(name, text))?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    agree(&model, &expected, &BranchedArm)
}

/// Names of the compared quantities.
const QUANTITIES: [&str; 6] = [
    "torques",
    "standard regressor",
    "base regressor",
    "base parameters",
    "mass matrix",
    "bias",
];

fn agree(model: &RobotModel, expected: &Expected, compiled: &dyn Model) -> Result<(), Failure> {
    let mechanism = &expected.mechanism;
    let all = samples(mechanism, &expected.parameters(), STATES, 23, false)?;
    let backends: [&dyn Backend; 2] = [&Served(compiled), &Evaluated(model)];
    for backend in backends {
        let mut agreements = QUANTITIES.map(|_| Agreement::new());
        for sample in &all {
            let found = found(model, backend, sample)?;
            let wanted = wanted(expected, sample)?;
            for ((agreement, found), wanted) in agreements.iter_mut().zip(&found).zip(&wanted) {
                // The trait of compiled robots offers the standard columns only.
                if let Some(found) = found {
                    agreement.compare(found, wanted);
                }
            }
        }
        for (name, agreement) in QUANTITIES.iter().zip(&agreements) {
            println!("{name} ({}): {agreement}", backend.label());
            assert!(
                agreement.is_empty() || agreement.within(TOLERANCE),
                "{name}: {agreement}"
            );
        }
    }
    Ok(())
}

/// The robot's results in the order of [`QUANTITIES`].
fn found(
    model: &RobotModel,
    backend: &dyn Backend,
    sample: &Sample,
) -> Result<[Option<DMatrix<f64>>; 6], Failure> {
    let base = model.plain(Function::IdmRedPlatform(Columns::Base));
    let base = base.ok_or("no base regressor")?;
    let base = match backend.label() {
        "evaluation" => Some(backend.call(&base.name, sample)?),
        _ => None,
    };
    let by_base = base
        .as_ref()
        .map(|columns| columns * base_values(model, sample));
    Ok([
        Some(backend.call("inverse_dynamics", sample)?),
        Some(backend.call("idm_red_platform", sample)?),
        base,
        by_base,
        Some(backend.call("mass_matrix", sample)?),
        Some(backend.call("bias", sample)?),
    ])
}

/// Values of the base parameters, including regrouped ones.
fn base_values(model: &RobotModel, sample: &Sample) -> DMatrix<f64> {
    let value = |parameter| {
        let at = model
            .selection
            .standard
            .iter()
            .position(|p| *p == parameter);
        at.map_or(0.0, |at| sample.parameters[at])
    };
    let values = model.base.iter().map(|base| {
        let regrouped = base.regrouped.iter();
        value(base.parameter) + regrouped.map(|(p, c)| c * value(*p)).sum::<f64>()
    });
    DMatrix::from_iterator(model.base.len(), 1, values)
}

/// The recursion's results in the order of [`QUANTITIES`].
fn wanted(expected: &Expected, sample: &Sample) -> Result<[DMatrix<f64>; 6], Failure> {
    let (mechanism, state, chi) = (&expected.mechanism, &sample.state, &sample.all_parameters);
    let joints = mechanism.joints();
    let vector = |v: DVector<f64>| DMatrix::from_column_slice(v.len(), 1, v.as_slice());
    let torques = tree_torques(mechanism, state, chi);
    let columns = regressor(mechanism, state).rows(0, joints).into_owned();
    let still = DVector::zeros(joints);
    let at_rest = tree_torques(mechanism, &moved(mechanism, state, &still, &still)?, chi);
    let mut mass = DMatrix::zeros(joints, joints);
    for joint in 0..joints {
        let mut unit = still.clone();
        unit[joint] = 1.0;
        let pushed = moved(mechanism, state, &still, &unit)?;
        mass.set_column(joint, &(tree_torques(mechanism, &pushed, chi) - &at_rest));
    }
    let coasting = moved(mechanism, state, &state.twist, &still)?;
    Ok([
        vector(torques.clone()),
        columns.select_columns(&expected.standard),
        columns.select_columns(&expected.base),
        vector(torques),
        mass,
        vector(tree_torques(mechanism, &coasting, chi)),
    ])
}

/// The same positions with other velocities and accelerations.
fn moved(
    mechanism: &Mechanism,
    state: &State,
    velocities: &DVector<f64>,
    accelerations: &DVector<f64>,
) -> Result<State, Failure> {
    let State { pose, q, .. } = state;
    Ok(State::with_joints(
        mechanism,
        pose,
        q,
        velocities,
        accelerations,
    )?)
}
