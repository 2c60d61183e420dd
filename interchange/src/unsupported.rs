//! Removes and reports joint torques that a description cannot express.

use crate::{
    files::Files,
    format::Format,
    model::{Joint, JointType, Model},
};

/// Torque components that a file may give for a joint.
#[derive(Debug, Clone, Copy)]
enum Torque {
    Damping,
    Friction,
    Rotor,
    Spring,
}

/// Removes all torques of ball joints.
pub(crate) fn leave_out(files: &Files, format: Format, model: &mut Model) {
    for joint in &mut model.joints {
        if joint.kind == JointType::Ball {
            let reason = "LEFT OUT: torques of ball joints are not supported";
            for torque in given(joint) {
                report(files, format, joint, torque, reason);
            }
            (joint.damping, joint.friction, joint.armature) = (0.0, 0.0, 0.0);
            joint.spring = None;
        }
    }
}

/// Torque components that a joint has.
fn given(joint: &Joint) -> Vec<Torque> {
    let stiffness = joint.spring.map_or(0.0, |(stiffness, _)| stiffness);
    let all = [
        (Torque::Damping, joint.damping),
        (Torque::Friction, joint.friction),
        (Torque::Rotor, joint.armature),
        (Torque::Spring, stiffness),
    ];
    let given = all.into_iter().filter(|(_, value)| *value != 0.0);
    given.map(|(torque, _)| torque).collect()
}

fn report(files: &Files, format: Format, joint: &Joint, torque: Torque, reason: &str) {
    let (element, attribute) = source(format, torque);
    files.demote(&joint.place, element, attribute, reason);
}

/// Element and attribute of a torque component in a format.
fn source(format: Format, torque: Torque) -> (&'static str, Option<&'static str>) {
    let of = |all: [&'static str; 4]| all[torque as usize];
    match format {
        Format::Mjcf => {
            let name = of(["damping", "frictionloss", "armature", "stiffness"]);
            ("joint", Some(name))
        }
        Format::Urdf => {
            let name = of(["damping", "friction", "armature", "stiffness"]);
            ("dynamics", Some(name))
        }
        Format::Sdf => (
            of(["damping", "friction", "armature", "spring_stiffness"]),
            None,
        ),
        Format::Par => ("par", Some(of(["FV", "FS", "IA", "K"]))),
    }
}
