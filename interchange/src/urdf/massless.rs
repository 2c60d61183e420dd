//! Reports links that have a shape but no mass.

use super::Tree;
use crate::{
    account::Use,
    files::{Files, Place},
    model::Model,
    xml::Element,
};
use std::collections::BTreeMap;

/// Links with a shape and without `<inertial>`, with their locations.
pub(super) type Shaped = BTreeMap<String, Place>;

/// Finds such links; must run before the table removes the shapes.
pub(super) fn shaped_links(root: &Element) -> Shaped {
    let has = |link: &Element, tags: &[&str]| {
        let mut parts = link.children.iter();
        parts.any(|part| tags.contains(&part.name.as_str()))
    };
    let links = root.all("link");
    let links =
        links.filter(|link| has(link, &["visual", "collision"]) && !has(link, &["inertial"]));
    let named = links.filter_map(|link| Some((link.get("name")?.to_owned(), link.place.clone())));
    named.collect()
}

/// Reports such links if joints move them.
pub(super) fn report(files: &Files, shaped: &Shaped, tree: &Tree, model: &Model) {
    for (name, place) in shaped {
        let Some(&body) = tree.bodies.get(name) else {
            continue;
        };
        if is_moved(model, body) {
            let reason =
                "absent although the link has a shape: no mass and no inertia in the model";
            files.record(Use::Reported, place, "link", Some("inertial"), reason);
        }
    }
}

/// Whether a joint lies between the ground and a body.
fn is_moved(model: &Model, body: usize) -> bool {
    let mut at = body;
    while at != 0 {
        if model.bodies[at].joint.is_some() {
            return true;
        }
        at = model.bodies[at].parent;
    }
    false
}
