//! Tendons: fixed ones are linear combinations of joints.
//!
//! As targets of actuators they become motors of several joints, in equalities couplings of joints.
//! Forces that tendons exert by themselves are supported for those of a single joint.

use super::{Reader, bodies::first, defaults::MAIN};
use crate::{
    files::{Files, Place},
    model::{JointType, Model, Motor},
    motors::independent,
    xml::Element,
};

/// Tag of tendon defaults.
const TENDON: &str = "tendon";

/// A tendon.
#[derive(Debug)]
pub(super) struct Tendon {
    pub(super) name: String,
    /// Joints and their coefficients in its length; `None` for a path in space.
    pub(super) joints: Option<Vec<(usize, f64)>>,
    stiffness: f64,
    damping: f64,
    friction: f64,
    armature: f64,
    tag: String,
    place: Place,
    /// Whether an actuator has taken over its inertia and friction, or an equality uses it.
    is_used: bool,
}

/// All tendons of a file.
#[derive(Debug, Default)]
pub(super) struct Tendons(Vec<Tendon>);

impl Tendons {
    pub(super) fn read(reader: &Reader<'_>, root: &Element, model: &Model) -> Self {
        let mut all = Vec::new();
        for section in root.all("tendon") {
            for element in &section.children {
                let whole = reader
                    .defaults
                    .apply_as(TENDON, reader.files, element, MAIN);
                all.push(tendon(reader.files, &whole, model));
            }
        }
        Self(all)
    }

    /// Tendon with a name; reports an error if there is none.
    pub(super) fn find(&mut self, files: &Files, name: &str, place: &Place) -> Option<&mut Tendon> {
        let Some(at) = self.0.iter().position(|own| own.name == name) else {
            let near = files.did_you_mean(name, self.0.iter().map(|own| own.name.as_str()));
            let help = near.unwrap_or_else(|| "name a tendon".to_owned());
            files.report(place, format!("there is no tendon `{name}`"), help);
            return None;
        };
        self.0[at].is_used = true;
        Some(&mut self.0[at])
    }

    /// Adds inertia and friction of tendons without an actuator to their joints.
    ///
    /// Rejects tendons that exert other forces, and reports those without a use.
    pub(super) fn finish(self, files: &Files, model: &mut Model) {
        for own in self.0 {
            if own.stiffness != 0.0 {
                let message = format!("the spring of the tendon `{}` is not supported", own.name);
                let help =
                    "write `stiffness` and `springref` at a joint, or remove the `stiffness`";
                files.report(&own.place, message, help);
                continue;
            }
            let has_forces = [own.damping, own.friction, own.armature] != [0.0; 3];
            let turns = own.joints.map(|joints| independent(model, &joints));
            match turns.as_deref() {
                Some([(joint, factor)]) if has_forces => {
                    let joint = &mut model.joints[*joint];
                    joint.damping += factor * factor * own.damping;
                    joint.friction += factor.abs() * own.friction;
                    joint.armature += factor * factor * own.armature;
                }
                _ if has_forces => {
                    let message = format!(
                        "the tendon `{}` exerts forces, which is not supported without a motor of its joints",
                        own.name
                    );
                    let help = "remove its damping, frictionloss and armature";
                    files.report(&own.place, message, help);
                }
                _ if !own.is_used => {
                    let reason = "exerts no force; its limits are not used";
                    files.demote(&own.place, &own.tag, None, reason);
                }
                _ => {}
            }
        }
    }
}

impl Tendon {
    /// Motor that pulls at the tendon, with the tendon's own inertia and friction.
    ///
    /// Later motors of the same tendon do not have them again.
    pub(super) fn motor(&mut self, joints: &[(usize, f64)], place: &Place) -> Motor {
        let taken = std::mem::take;
        Motor {
            turns: joints.to_vec(),
            armature: taken(&mut self.armature),
            damping: taken(&mut self.damping),
            friction: taken(&mut self.friction),
            ..Motor::new(place.clone())
        }
    }
}

fn tendon(files: &Files, element: &Element, model: &Model) -> Tendon {
    let joints = (element.name == "fixed").then(|| {
        let joints = element.all("joint");
        joints.filter_map(|own| term(files, own, model)).collect()
    });
    let [stiffness, damping, friction, armature] =
        ["stiffness", "damping", "frictionloss", "armature"].map(|key| first(files, element, key));
    Tendon {
        name: element.get("name").unwrap_or("").to_owned(),
        joints,
        stiffness,
        damping,
        friction,
        armature,
        tag: element.name.clone(),
        place: element.place.clone(),
        is_used: false,
    }
}

/// Joint and coefficient of a fixed tendon.
fn term(files: &Files, element: &Element, model: &Model) -> Option<(usize, f64)> {
    let name = element.required(files, "joint")?;
    let Some(joint) = model.joint_named(name) else {
        let near = files.did_you_mean(name, model.joints.iter().map(|own| own.name.as_str()));
        let help = near.unwrap_or_else(|| "name a joint".to_owned());
        files.report(&element.place, format!("there is no joint `{name}`"), help);
        return None;
    };
    if model.joints[joint].kind == JointType::Ball {
        let message = format!("`{name}` is a ball joint, of which no tendon can consist");
        files.report(&element.place, message, "name hinges and slides");
        return None;
    }
    Some((joint, element.number(files, "coef", 0.0)))
}
