//! Actuators: the joints that they drive, and their gears.

use super::{
    Reader,
    bodies::first,
    defaults::{ACTUATOR, MAIN},
    tendons::Tendons,
};
use crate::{
    model::{JointType, Model, Motor},
    xml::Element,
};

pub(super) fn read(reader: &Reader<'_>, root: &Element, tendons: &mut Tendons, model: &mut Model) {
    for section in root.all("actuator") {
        // Adhesion acts on contacts.
        for element in section.children.iter().filter(|own| own.name != "adhesion") {
            model.says_motors = true;
            let whole = reader
                .defaults
                .apply_as(ACTUATOR, reader.files, element, MAIN);
            actuator(reader, &whole, tendons, model);
        }
    }
}

fn actuator(reader: &Reader<'_>, element: &Element, tendons: &mut Tendons, model: &mut Model) {
    let files = reader.files;
    let name = element.get("name").unwrap_or(&element.name).to_owned();
    let gear = element
        .list(files, "gear")
        .and_then(|gear| gear.first().copied())
        .unwrap_or(1.0);
    // Rotor inertia and damping of the actuator, at the joint.
    let armature = gear * gear * element.number(files, "armature", 0.0);
    let damping = gear * gear * first(files, element, "damping");
    if let Some((tendon, place)) = element.attribute("tendon") {
        let Some(tendon) = tendons.find(files, tendon, place) else {
            return;
        };
        let Some(joints) = tendon.joints.clone() else {
            let message =
                format!("the actuator `{name}` pulls at a spatial tendon, which is not supported");
            files.report(place, message, "let it act on a joint or a fixed tendon");
            return;
        };
        let mut motor = tendon.motor(&joints, &element.place);
        motor.armature += armature;
        motor.damping += damping;
        (motor.name, motor.ratio) = (name, gear);
        model.motors.push(motor);
        return;
    }
    let Some((joint, place)) = element
        .attribute("joint")
        .or_else(|| element.attribute("jointinparent"))
    else {
        // The table rejects other transmission targets.
        if files.is_clean() {
            let message = format!("the actuator `{name}` has neither joint nor tendon");
            files.report(&element.place, message, "write joint=\"…\"");
        }
        return;
    };
    let Some(at) = model.joint_named(joint) else {
        let all = model.joints.iter().map(|joint| joint.name.as_str());
        let help = files.joint_help(joint, all);
        files.report(place, format!("there is no joint `{joint}`"), help);
        return;
    };
    let own = &mut model.joints[at];
    if own.kind == JointType::Ball {
        let message = format!(
            "the actuator `{name}` drives the ball joint `{joint}`, which is not supported"
        );
        files.report(place, message, "write the ball joint as three hinges");
        return;
    }
    own.actuated = true;
    own.armature += armature;
    own.damping += damping;
    model.motors.push(Motor {
        name,
        turns: vec![(at, 1.0)],
        ratio: gear,
        ..Motor::new(element.place.clone())
    });
}
