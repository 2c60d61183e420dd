//! The descriptions of the repository.

use super::good;
use crate::*;
use overact_exact::{Angle, Number, Ratio};

const DUALV: &str = include_str!("../../../robots/dualv.toml");
const EMPS: &str = include_str!("../../../robots/emps.toml");

fn degrees(text: &str) -> Angle {
    Angle::degrees(Ratio::decimal(text).unwrap()).unwrap()
}

fn decimal(text: &str) -> Number {
    Number::ratio(Ratio::decimal(text).unwrap())
}

#[test]
fn the_dualv_has_the_geometry_of_table_1() {
    let robot = good(DUALV);
    assert_eq!(robot.type_name(), "DualV");
    assert_eq!(robot.gravity[2], decimal("-9.81"));
    assert_eq!(robot.legs.len(), 4);
    assert_eq!(robot.actuators(), [(0, 0), (1, 0), (2, 0), (3, 0)]);
    for (leg, gamma) in robot
        .legs
        .iter()
        .zip(["15.52", "164.48", "-164.48", "-15.52"])
    {
        let [first, second, third] = leg.joints.as_slice() else {
            panic!("three joints")
        };
        assert_eq!(first.gamma.value, degrees(gamma));
        assert_eq!(first.theta.value, degrees(gamma).negative());
        assert_eq!(first.variable, [(0, Ratio::ONE)]);
        assert_eq!(first.d.value, decimal("0.41"));
        assert_eq!(second.d.value, decimal("0.28"));
        assert_eq!(third.antecedent, Some(1));
        assert_eq!(third.parameters, StandardParameter::FRICTION);
        assert_eq!((first.parameters.len(), second.parameters.len()), (14, 13));
        assert_eq!(leg.shape_name, "arm");
    }
    let Some(End::Rigid(end)) = robot.legs[3].end.as_ref().map(|end| &end.value) else {
        panic!("a rigid end")
    };
    assert_eq!(end.at[1], decimal("-0.11"));
    let Some(End::Rigid(end)) = robot.legs[0].end.as_ref().map(|end| &end.value) else {
        panic!("a rigid end")
    };
    assert_eq!(end.rotation[2], degrees("180"));
}

/// At home every leg has to reach its platform point roughly.
#[test]
fn the_dualv_home_nearly_closes_all_legs() {
    for (index, leg) in good(DUALV).legs.iter().enumerate() {
        let gamma = leg.joints[0].gamma.value.value();
        let q: Vec<f64> = leg.joints.iter().map(|j| j.home.value()).collect();
        let x = 0.41 * gamma.cos() + 0.28 * (q[0].cos() + (q[0] + q[1]).cos());
        let y = 0.41 * gamma.sin() + 0.28 * (q[0].sin() + (q[0] + q[1]).sin());
        let (target, turn) = if index < 2 {
            (0.11, std::f64::consts::PI)
        } else {
            (-0.11, 0.0)
        };
        assert!(
            x.abs() < 0.01 && (y - target).abs() < 0.01,
            "leg {index}: {x} {y}"
        );
        let angle = q.iter().sum::<f64>() - turn;
        assert!(
            angle.sin().abs() < 0.02 && angle.cos() > 0.0,
            "leg {index}: {angle}"
        );
    }
}

#[test]
fn the_dualv_experiment_is_read() {
    let robot = good(DUALV);
    let experiment = robot.experiment.unwrap();
    assert_eq!(experiment.sampling, 5000.0);
    assert_eq!(experiment.torque_limit, Some(vec![127.0; 4]));
    let payloads = |validation: bool| -> Vec<bool> {
        let runs = experiment.runs.iter();
        let runs = runs.filter(|run| run.validation == validation);
        runs.map(|run| run.payload).collect()
    };
    assert_eq!(payloads(false), [false, false, true, true]);
    assert_eq!(payloads(true), [false, true]);
    let mass = experiment
        .parameters
        .iter()
        .find(|p| p.name.value == "m_payload")
        .unwrap();
    assert_eq!((mass.body, mass.value), (Body::Payload, 5.42));
    assert_eq!(robot.identification.kept_actuators, Some(vec![0, 1, 2]));
}

#[test]
fn the_emps_is_a_horizontal_prismatic_joint() {
    let robot = good(EMPS);
    assert!(robot.platform.is_none() && robot.legs.len() == 1);
    let joint = &robot.legs[0].joints[0];
    assert_eq!(joint.kind.value, JointKind::Prismatic);
    assert_eq!(joint.alpha.value, degrees("90"));
    use StandardParameter::{Fs, Fv, Ia, M, Off};
    assert_eq!(joint.parameters, [M, Ia, Fv, Fs, Off]);
    let data = robot.data.unwrap();
    assert_eq!(data.torque_gain, [Factor::Variable("gtau".to_owned())]);
    assert_eq!(data.position_scale, [1.0]);
    let settings = robot.identification;
    assert_eq!(
        (settings.decimation, settings.skip_start),
        (Some(10), Some(49))
    );
    assert_eq!(settings.normalisation, Normalisation::MinusOne);
    assert!(!settings.weighted && !settings.essential);
}
