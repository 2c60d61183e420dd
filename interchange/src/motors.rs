//! Motors: which joint leads coupled ones, and motors that turn several joints.

use crate::{
    account::Use,
    files::Files,
    model::{Follow, Model, Motor},
};
use std::collections::{BTreeMap, BTreeSet};

/// Makes driven joints the leaders of the joints that they are coupled to.
///
/// From q_f = a q_l + b follows q_l = (q_f - b) / a. Two driven joints of one coupling stay as they
/// are; validation of the description rejects them.
pub(crate) fn lead_by_driven_joints(model: &mut Model) {
    for own in 0..model.joints.len() {
        let Some(follow) = model.joints[own].follow else {
            continue;
        };
        let is_coupled = |other: usize| {
            let joint = &model.joints[other];
            other == follow.joint || joint.follow.is_some_and(|f| f.joint == follow.joint)
        };
        let driven = (0..model.joints.len())
            .filter(|&at| is_coupled(at) && model.joints[at].actuated)
            .count();
        if driven == 1 && model.joints[own].actuated && follow.factor != 0.0 {
            lead_by(model, own, follow);
        }
    }
}

/// Exchanges a follower with its leader; further followers of the leader follow the new one.
fn lead_by(model: &mut Model, new: usize, follow: Follow) {
    let back = Follow {
        joint: new,
        factor: 1.0 / follow.factor,
        offset: -follow.offset / follow.factor,
    };
    for (at, joint) in model.joints.iter_mut().enumerate() {
        if at == new {
            joint.follow = None;
        } else if at == follow.joint {
            joint.follow = Some(back);
        } else if let Some(other) = joint.follow.filter(|other| other.joint == follow.joint) {
            joint.follow = Some(Follow {
                joint: new,
                factor: other.factor * back.factor,
                offset: other.factor * back.offset + other.offset,
            });
        }
    }
}

/// Expresses motors by independent joints, and keeps them only if one turns several joints.
///
/// A motor of a single joint becomes part of the joint. If others are kept in a robot without
/// loops, every driven joint has a motor. In a robot with loops only motors of several joints are
/// kept. With `is_chosen` the user has named the driven joints, and no motor is kept.
pub(crate) fn resolve(files: &Files, model: &mut Model, is_chosen: bool) {
    let mut motors = std::mem::take(&mut model.motors);
    for motor in &mut motors {
        motor.turns = independent(model, &motor.turns);
        if motor.turns.len() == 1 {
            join(motor, model, is_chosen);
        }
    }
    let mut coupled = motors.iter().filter(|motor| motor.turns.len() > 1);
    if is_chosen {
        for motor in coupled.filter(|motor| motor.has_torques()) {
            let reason = "the inertia and friction of a motor of several joints are left out, since `--actuated` names \
                          the driven joints";
            let name = &motor.name;
            files.record(Use::Reported, &motor.place, "motor", Some(name), reason);
        }
        return;
    }
    if coupled.next().is_none() {
        return;
    }
    if !model.closures.is_empty() {
        motors.retain(|motor| motor.turns.len() > 1);
        // Several motors may turn a joint.
        let turned: BTreeSet<usize> = motors.iter().flat_map(joints_of).collect();
        for joint in turned {
            let own = &mut model.joints[joint];
            own.is_turned = !own.actuated;
            own.actuated = true;
        }
        model.motors = motors;
        return;
    }
    // Of several actuators of one joint, such as for position and velocity, one is kept.
    let mut seen = BTreeSet::new();
    motors.retain(|motor| match motor.turns[..] {
        [] => false,
        [(joint, _)] => seen.insert(joint),
        _ => true,
    });
    let turned: BTreeSet<usize> = motors.iter().flat_map(joints_of).collect();
    for (at, joint) in model.joints.iter_mut().enumerate() {
        if turned.contains(&at) {
            joint.actuated = true;
        } else if joint.actuated {
            motors.push(Motor {
                turns: vec![(at, 1.0)],
                ..Motor::new(joint.place.clone())
            });
        }
    }
    model.motors = motors;
}

/// Makes a motor of one joint part of the joint.
fn join(motor: &mut Motor, model: &mut Model, is_chosen: bool) {
    let [(joint, factor)] = motor.turns[..] else {
        return;
    };
    let own = &mut model.joints[joint];
    own.armature += factor * factor * motor.armature;
    own.damping += factor * factor * motor.damping;
    own.friction += factor.abs() * motor.friction;
    (motor.armature, motor.damping, motor.friction) = (0.0, 0.0, 0.0);
    motor.ratio *= factor;
    motor.turns = vec![(joint, 1.0)];
    own.actuated |= !is_chosen;
    if motor.ratio != 1.0 {
        let ratio = motor.ratio;
        let name = match &*motor.name {
            "" => "A motor".to_owned(),
            name => format!("Motor `{name}`"),
        };
        own.gears.push(format!(
            "{name} with gear {ratio}: the joint's torque is {ratio} times its force, `torque_gain` of [data]"
        ));
    }
}

fn joints_of(motor: &Motor) -> impl Iterator<Item = usize> + '_ {
    motor.turns.iter().map(|(joint, _)| *joint)
}

/// A combination of joints in terms of independent ones, without its constant.
pub(crate) fn independent(model: &Model, turns: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
    for &(joint, factor) in turns {
        let (leader, own) = match model.joints[joint].follow {
            Some(follow) => (follow.joint, factor * follow.factor),
            None => (joint, factor),
        };
        *sum.entry(leader).or_default() += own;
    }
    sum.into_iter()
        .filter(|(_, factor)| *factor != 0.0)
        .collect()
}
