//! Drive parameters on the motor side, from the gear ratios of the description.

use overact::{Effect, StandardParameter};
use overact_codegen::description::{Description, Joint};
use overact_identification::{Estimate, Estimator, MotorParameter, ParameterEstimate, Stage};

/// Base estimates of the described motors, on the motor side.
///
/// Parameters into which others are regrouped do not belong to the motor alone and are omitted.
pub(crate) fn at_motors(description: &Description, estimates: &[Estimate]) -> Vec<MotorParameter> {
    let base =
        |one: &&Estimate| one.stage == Stage::Base && one.estimator == Estimator::LeastSquares;
    let Some(estimate) = estimates.iter().find(base) else {
        return Vec::new();
    };
    let legs = description.legs.iter();
    let motors = legs.flat_map(|leg| leg.joints.iter().map(|joint| (&leg.joints, joint)));
    let of_tree = motors
        .filter_map(|(joints, motor)| Some((joints, motor, motor.motor?.value())))
        .flat_map(|(joints, motor, gear)| {
            let owner = Owner::of(motor);
            let mut all = of(&motor.name.value, &owner, gear, &estimate.parameters);
            // A motor of one joint shares the parameters of that joint, which are on the joint side
            // of its gear.
            if let [(joint, factor)] = motor.variable[..] {
                let turned = gear * factor.value();
                let joint = joints.get(joint);
                let own = joint.map(|joint| {
                    let owner = Owner::of(joint);
                    of(&motor.name.value, &owner, turned, &estimate.parameters)
                });
                all.extend(own.unwrap_or_default());
            }
            all
        });
    let of_loops = description.motors.iter().flat_map(|motor| {
        let leg = motor.leg.and_then(|leg| description.legs.get(leg));
        let name = &motor.name.value;
        let name = leg.map_or_else(|| name.clone(), |leg| format!("{name}_{}", leg.name.value));
        let owner = Owner {
            name: &name,
            parameters: &motor.parameters,
        };
        of(&name, &owner, motor.ratio.value(), &estimate.parameters)
    });
    of_tree.chain(of_loops).collect()
}

/// The joint or motor whose name parameters have.
struct Owner<'d> {
    name: &'d str,
    parameters: &'d [StandardParameter],
}

impl<'d> Owner<'d> {
    fn of(joint: &'d Joint) -> Self {
        Self {
            name: &joint.name.value,
            parameters: &joint.parameters,
        }
    }
}

/// Parameters of a joint or motor, converted to the motor side of a gear.
fn of(
    motor: &str,
    owner: &Owner<'_>,
    ratio: f64,
    estimates: &[ParameterEstimate],
) -> Vec<MotorParameter> {
    let at_motor = |one: &ParameterEstimate| {
        let symbol = { owner.parameters.iter() }
            .find(|symbol| one.name == format!("{}_{}", symbol.name(), owner.name))?;
        let divisor = match symbol.effect() {
            _ if *symbol == StandardParameter::Fl => return None,
            Effect::Rotor => ratio * ratio,
            Effect::Friction { exponent } => ratio.abs().powi(1 + i32::from(exponent)),
            Effect::Offset => ratio,
            Effect::Body | Effect::Spring => return None,
        };
        Some(MotorParameter {
            motor: motor.to_owned(),
            name: one.name.clone(),
            ratio,
            value: one.value / divisor,
            deviation: one.correlated_standard_deviation / divisor.abs(),
            unit: symbol.unit(false).to_owned(),
        })
    };
    estimates.iter().filter_map(at_motor).collect()
}
