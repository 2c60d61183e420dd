//! Names of bodies and joints that have none in the file.

use crate::xml::Element;
use std::collections::BTreeSet;

/// Name of the ground.
pub(super) const WORLD: &str = "world";

/// Names of the file and those given here, each taken once.
#[derive(Debug, Default)]
pub(super) struct TakenNames {
    bodies: BTreeSet<String>,
    joints: BTreeSet<String>,
}

impl TakenNames {
    /// Names that the file gives to bodies and joints.
    pub(super) fn of_file(root: &Element) -> Self {
        let mut own = Self::default();
        for world in root.all("worldbody") {
            own.gather(world);
        }
        own
    }

    fn gather(&mut self, element: &Element) {
        for child in &element.children {
            let names = match child.name.as_str() {
                "body" => Some(&mut self.bodies),
                "joint" | "freejoint" => Some(&mut self.joints),
                _ => None,
            };
            if let Some(names) = names {
                names.extend(child.get("name").map(str::to_owned));
            }
            self.gather(child);
        }
    }

    /// A new name for a body.
    pub(super) fn body(&mut self, wanted: &str) -> String {
        unused(wanted, &mut self.bodies)
    }

    /// A new name for a joint.
    pub(super) fn joint(&mut self, wanted: &str) -> String {
        unused(wanted, &mut self.joints)
    }
}

/// The wanted name, with a number if it is taken.
fn unused(wanted: &str, taken: &mut BTreeSet<String>) -> String {
    let mut name = wanted.to_owned();
    let mut number = 1;
    while !taken.insert(name.clone()) {
        number += 1;
        name = format!("{wanted}_{number}");
    }
    name
}
