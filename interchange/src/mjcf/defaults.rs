//! Default classes: attribute values for elements that do not set them.

use super::ROTATIONS;
use crate::{
    files::{Files, Place},
    xml::Element,
};
use std::collections::BTreeMap;

/// Attribute values by tag and name.
type Class = BTreeMap<(String, String), (String, Place)>;

/// All classes; nested classes include the attributes of their parents.
#[derive(Debug)]
pub(super) struct Defaults {
    classes: BTreeMap<String, Class>,
}

/// Largest number of classes.
const MOST_CLASSES: usize = 1_000;
/// Largest number of attributes of a class, more than MJCF has.
const MOST_ATTRIBUTES: usize = 1_000;

/// Default class of elements that name none.
pub(super) const MAIN: &str = "main";

/// Tag of actuator defaults.
pub(super) const ACTUATOR: &str = "general";

/// Tag of equality constraint defaults.
pub(super) const EQUALITY: &str = "equality";

impl Defaults {
    /// Reads the classes of a file; `None` after an error.
    pub(super) fn new(files: &Files, root: &Element) -> Option<Self> {
        let mut own = Self {
            classes: BTreeMap::new(),
        };
        own.classes.insert(MAIN.to_owned(), Class::new());
        for top in root.all("default") {
            // Several outermost sections extend the same class.
            if let Some((name, place)) = top.attribute("class").filter(|(name, _)| *name != MAIN) {
                let message = format!("the outermost default class is `main`, not `{name}`");
                let help = "put the class into another <default>, or remove its name";
                files.report(place, message, help);
                continue;
            }
            let before = own.classes.get(MAIN).cloned().unwrap_or_default();
            own.add(files, top, MAIN, before);
        }
        files.is_clean().then_some(own)
    }

    fn add(&mut self, files: &Files, element: &Element, name: &str, mut class: Class) {
        if self.classes.len() > MOST_CLASSES || class.len() > MOST_ATTRIBUTES {
            let message = format!(
                "more than {MOST_CLASSES} default classes, or {MOST_ATTRIBUTES} attributes in one"
            );
            let help = "no model has so many: remove some";
            files.report(&element.place, message, help);
            return;
        }
        for child in element
            .children
            .iter()
            .filter(|child| child.name != "default")
        {
            for (key, value, place) in &child.attributes {
                let key = (family(&child.name).to_owned(), key.clone());
                class.insert(key, (value.clone(), place.clone()));
            }
        }
        self.classes.insert(name.to_owned(), class.clone());
        for inner in element.all("default") {
            match inner.get("class") {
                Some(own) if self.classes.contains_key(own) => {
                    let message = format!("two default classes have the name `{own}`");
                    files.report(&inner.place, message, "give each class a name of its own");
                }
                Some(own) => self.add(files, inner, own, class.clone()),
                None => {
                    let help = "write class=\"…\" of every <default> inside another";
                    files.report(&inner.place, "a default class has no name", help);
                }
            }
        }
    }

    /// Element with the defaults of its class.
    pub(super) fn apply(&self, files: &Files, element: &Element, around: &str) -> Element {
        self.apply_as(&element.name, files, element, around)
    }

    /// Element with the class defaults of another tag, such as `equality` or `general`.
    pub(super) fn apply_as(
        &self,
        tag: &str,
        files: &Files,
        element: &Element,
        around: &str,
    ) -> Element {
        let mut whole = element.clone();
        let named = element.attribute("class");
        let name = named.map_or(around, |(name, _)| name);
        let Some(class) = self.classes.get(name) else {
            let place = named.map_or(&element.place, |(_, place)| place);
            let near = files.did_you_mean(name, self.classes.keys().map(String::as_str));
            let help = near.unwrap_or_else(|| "name a class of <default>".to_owned());
            files.report(place, format!("there is no default class `{name}`"), help);
            return whole;
        };
        let mut own = element.attributes.iter();
        let is_turned = own.any(|(key, ..)| ROTATIONS.contains(&key.as_str()));
        for ((own, key), (value, place)) in class {
            let is_other_rotation = is_turned && ROTATIONS.contains(&key.as_str());
            if own == tag && element.get(key).is_none() && !is_other_rotation {
                whole
                    .attributes
                    .push((key.clone(), value.clone(), place.clone()));
            }
        }
        whole
    }
}

/// Tag under which defaults are stored; in MuJoCo all actuators share theirs.
fn family(tag: &str) -> &str {
    match tag {
        "general" | "motor" | "position" | "velocity" | "intvelocity" | "orientation" | "pid"
        | "damper" | "cylinder" | "muscle" | "adhesion" | "dcmotor" | "plugin" => ACTUATOR,
        other => other,
    }
}
