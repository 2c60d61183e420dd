//! Parameters of drives at the side of the motor, by the gear ratios of the description.

use overact_codegen::description::{Description, Joint};
use overact_identification::{Estimate, Estimator, MotorParameter, ParameterEstimate, Stage};

/// What base estimates are in front of the gears of the motors that are described. A parameter into which others
/// are regrouped is none of the motor alone and left out.
pub(crate) fn at_motors(description: &Description, estimates: &[Estimate]) -> Vec<MotorParameter> {
    let base =
        |one: &&Estimate| one.stage == Stage::Base && one.estimator == Estimator::LeastSquares;
    let Some(estimate) = estimates.iter().find(base) else {
        return Vec::new();
    };
    let legs = description.legs.iter();
    let motors = legs.flat_map(|leg| leg.joints.iter().map(|joint| (&leg.joints, joint)));
    motors
        .filter_map(|(joints, motor)| Some((joints, motor, motor.motor?.value())))
        .flat_map(|(joints, motor, gear)| {
            let mut all = of(motor, motor, gear, &estimate.parameters);
            // A motor of one joint shares the joint's parameters, behind the gear of that joint.
            if let [(joint, factor)] = motor.variable[..] {
                let turned = gear * factor.value();
                let joint = joints.get(joint);
                let own = joint.map(|joint| of(motor, joint, turned, &estimate.parameters));
                all.extend(own.unwrap_or_default());
            }
            all
        })
        .collect()
}

/// The parameters of a joint or motor as they are in front of a gear of this ratio.
fn of(
    motor: &Joint,
    owner: &Joint,
    ratio: f64,
    estimates: &[ParameterEstimate],
) -> Vec<MotorParameter> {
    let at_motor = |one: &ParameterEstimate| {
        let symbol = { owner.parameters.iter() }
            .find(|symbol| one.name == format!("{}_{}", symbol.name(), owner.name.value))?;
        let (divisor, unit) = match symbol.name() {
            "ia" => (ratio * ratio, "kg m^2"),
            _ if symbol.is_viscous() => (ratio * ratio, "N m s/rad"),
            "off" => (ratio, "N m"),
            "fl" => return None,
            _ if symbol.has_sign() => (ratio.abs(), "N m"),
            _ => return None,
        };
        Some(MotorParameter {
            motor: motor.name.value.clone(),
            name: one.name.clone(),
            ratio,
            value: one.value / divisor,
            deviation: one.correlated_standard_deviation / divisor.abs(),
            unit: unit.to_owned(),
        })
    };
    estimates.iter().filter_map(at_motor).collect()
}
