//! Transmissions: the joints that motors drive.

use crate::{files::Files, model::Model, xml::Element};

/// Types of transmissions that drive one joint each, without the package name.
const SINGLE: [&str; 3] = [
    "SimpleTransmission",
    "SimpleGazeboTransmission",
    "simple_transmission",
];

/// Marks the joints that transmissions drive; rejects transmissions that couple several joints.
pub(super) fn read(files: &Files, root: &Element, model: &mut Model) {
    let nested = root.all("ros2_control");
    let nested = nested.flat_map(|control| control.all("transmission"));
    for transmission in root.all("transmission").chain(nested) {
        let joints: Vec<&Element> = transmission.all("joint").collect();
        let actuators = transmission.all("actuator").count();
        if joints.len() > 1 || actuators > 1 || !is_single(transmission) {
            reject(files, transmission);
            continue;
        }
        for joint in joints {
            drive(transmission, joint, model);
        }
    }
}

/// The type of a transmission, without its package.
fn kind(transmission: &Element) -> Option<&str> {
    let text = |tag: &str| {
        let (text, _) = &transmission.child(tag)?.text;
        Some(text.as_str())
    };
    let found = text("type")
        .or_else(|| text("plugin"))
        .or_else(|| transmission.get("type"))?;
    found.rsplit(['/', ':']).next()
}

fn is_single(transmission: &Element) -> bool {
    let kind = kind(transmission).filter(|kind| !kind.is_empty());
    kind.is_none_or(|kind| SINGLE.contains(&kind) || kind.ends_with("JointTransmission"))
}

fn reject(files: &Files, transmission: &Element) {
    let kind = kind(transmission).unwrap_or("several joints");
    let message = format!("a transmission of type `{kind}` couples joints, which is not supported");
    let help = "remove it and name the driven joints, `--actuated JOINT,JOINT`; without loops the motors can be \
                described in the TOML, [[leg.NAME.motor]] with `turns`";
    files.report(&transmission.place, message, help);
}

fn drive(transmission: &Element, joint: &Element, model: &mut Model) {
    let Some(at) = joint.get("name").and_then(|name| model.joint_named(name)) else {
        return;
    };
    let reduction = |of: &Element| {
        let tags = ["mechanicalReduction", "mechanical_reduction"];
        tags.iter().any(|tag| of.child(tag).is_some())
    };
    let has_gear =
        reduction(transmission) || reduction(joint) || transmission.all("actuator").any(reduction);
    model.says_motors = true;
    model.joints[at].actuated = true;
    if has_gear {
        "through a gear, see its <transmission>".clone_into(&mut model.joints[at].drive);
    }
}
