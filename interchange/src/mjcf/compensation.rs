//! Compensation of weights: `gravcomp` of bodies and `actuatorgravcomp` of joints.
//!
//! It is a force -c m g at a body's centre. If it is the same for all bodies, gravity is scaled by
//! 1 - c. Where it acts through the actuators, it is part of their torques.

use super::{BOOLEAN, adjust::moving};
use crate::{
    files::{Files, Place},
    model::Model,
    xml::Element,
};

/// Compensations of a file.
#[derive(Debug, Default)]
pub(super) struct Compensation {
    /// Bodies with their compensation, one without.
    bodies: Vec<(usize, f64, Place)>,
    /// For each joint whether its actuator compensates.
    is_by_actuator: Vec<bool>,
}

impl Compensation {
    /// Reads a body.
    pub(super) fn body(&mut self, files: &Files, element: &Element, body: usize) {
        let place = element.attribute("gravcomp").map(|(_, place)| place);
        let place = place.unwrap_or(&element.place).clone();
        let own = element.number(files, "gravcomp", 0.0);
        self.bodies.push((body, own, place));
    }

    /// Reads a joint.
    pub(super) fn joint(&mut self, files: &Files, element: &Element) {
        let own = element.keyword(files, "actuatorgravcomp", BOOLEAN);
        self.is_by_actuator.push(own == Some("true"));
    }

    /// Scales gravity, or reports the bodies.
    pub(super) fn apply(self, files: &Files, model: &mut Model) {
        if self.bodies.iter().all(|(_, own, _)| *own == 0.0) {
            return;
        }
        if self.is_by_actuator.iter().all(|own| *own) {
            let note = "Compensation of weights (`gravcomp`) acts through the actuators and is part of their torques.";
            model.notes.push(note.to_owned());
            return;
        }
        let is_moving = moving(model);
        let has_mass = |at: usize| {
            let body = &model.bodies[at];
            is_moving[at]
                && (body.has_unknown_inertia
                    || body.inertia.is_some_and(|inertia| inertia.mass > 0.0))
        };
        let heavy = self.bodies.iter().filter(|(at, ..)| has_mass(*at));
        let mut shares = heavy.map(|(_, own, _)| *own);
        let share = shares.next().unwrap_or(0.0);
        if shares.all(|own| own == share) && self.is_by_actuator.iter().all(|own| !own) {
            model.gravity = model.gravity.map(|own| own * (1.0 - share));
            let note = format!(
                "Gravity is scaled by {}: `gravcomp` compensates this share of all weights.",
                1.0 - share
            );
            model.notes.push(note);
            return;
        }
        let reason = "its compensation of the weight is missing from the model";
        for (_, _, place) in self.bodies.iter().filter(|(_, own, _)| *own != 0.0) {
            files.demote(place, "body", Some("gravcomp"), reason);
        }
    }
}
