//! Features of drawn mechanisms, to check the coverage of a run.

use super::{Attachment, Shape, Sketch};
use crate::reference::{JointKind, Motion};
use std::collections::BTreeSet;

/// All features that a run of some hundred mechanisms must cover.
pub const ALL: [&str; 44] = [
    "motion: slide",
    "motion: hinge",
    "motion: point",
    "motion: planar",
    "motion: translation",
    "motion: schoenflies",
    "motion: spherical",
    "motion: spatial",
    "motion: none",
    "leg: Serial",
    "leg: Arm",
    "leg: Slot",
    "leg: InPlane",
    "leg: Parallelograms",
    "leg: Wrist",
    "leg: Drive",
    "leg: Tree",
    "end: rigid",
    "end: point",
    "end: along one axis",
    "end: along two axes",
    "redundancy 0",
    "redundancy 1",
    "redundancy 2",
    "redundancy 3",
    "several actuators in a leg",
    "leg without actuator",
    "actuated revolute",
    "actuated prismatic",
    "passive revolute",
    "passive prismatic",
    "dependent joint in the chain",
    "dependent joint off the chain",
    "joint that follows one of another kind",
    "fixed joint",
    "branching tree",
    "leg placed several times",
    "legs that differ",
    "payload",
    "chosen actuators",
    "no gravity",
    "friction towards standstill",
    "friction by direction",
    "friction under a load",
];

impl Sketch {
    /// Features of the mechanism in [`ALL`].
    #[must_use]
    pub fn features(&self) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        let mut note = |is_there: bool, what: String| {
            if is_there {
                found.insert(what);
            }
        };
        let motion = match self.motion {
            Motion::None | Motion::Joints(_) => "none",
            Motion::Slide { .. } => "slide",
            Motion::Hinge { .. } => "hinge",
            Motion::Point(_) => "point",
            Motion::Planar(_) => "planar",
            Motion::Translation => "translation",
            Motion::Schoenflies(_) => "schoenflies",
            Motion::Spherical => "spherical",
            Motion::Spatial | Motion::Parasitic(_) => "spatial",
        };
        note(true, format!("motion: {motion}"));
        note(self.shapes.len() > 1, "legs that differ".to_owned());
        note(self.payload.is_some(), "payload".to_owned());
        note(self.kept.is_some(), "chosen actuators".to_owned());
        note(self.gravity == [0.0; 3], "no gravity".to_owned());
        if self.motion != Motion::None {
            let redundancy = self.actuators() - self.motion.dof();
            note(true, format!("redundancy {redundancy}"));
        }
        for shape in &self.shapes {
            shape.features(&mut note);
        }
        found
    }
}

impl Shape {
    fn features(&self, note: &mut impl FnMut(bool, String)) {
        let name = format!("{:?}", self.structure);
        let name = name.split('(').next().unwrap_or_default();
        note(true, format!("leg: {name}"));
        let end = match self.places[0].end {
            Attachment::Free => "free",
            Attachment::Rigid(_) => "rigid",
            Attachment::Point(_, along) => ["", "along one axis", "along two axes", "point"]
                [along.iter().filter(|a| **a).count()],
        };
        note(true, format!("end: {end}"));
        note(self.places.len() > 1, "leg placed several times".to_owned());
        let is_tree = matches!(self.places[0].end, Attachment::Free);
        note(
            !is_tree && self.actuators() > 1,
            "several actuators in a leg".to_owned(),
        );
        note(self.actuators() == 0, "leg without actuator".to_owned());
        let path = self.path();
        for (at, member) in self.members.iter().enumerate() {
            let joint = &member.joint;
            let branches = at > 0 && joint.antecedent != Some(at - 1);
            note(is_tree && branches, "branching tree".to_owned());
            if joint.kind == JointKind::Fixed {
                note(true, "fixed joint".to_owned());
                continue;
            }
            note(
                joint.stribeck.is_some(),
                "friction towards standstill".to_owned(),
            );
            let directed = |symbol: &&str| symbol.ends_with("_pos") || symbol.ends_with("_neg");
            note(
                member.parameters.iter().any(directed),
                "friction by direction".to_owned(),
            );
            note(member.load.is_some(), "friction under a load".to_owned());
            let kind = match joint.kind {
                JointKind::Revolute => "revolute",
                _ => "prismatic",
            };
            if joint.terms.iter().any(|t| t.0 == at) {
                let driven = if joint.actuated {
                    "actuated"
                } else {
                    "passive"
                };
                note(true, format!("{driven} {kind}"));
                continue;
            }
            let place = if path.contains(&at) { "in" } else { "off" };
            note(!is_tree, format!("dependent joint {place} the chain"));
            let other = |t: &(usize, f64)| self.members[t.0].joint.kind != joint.kind;
            let mixed = joint.terms.iter().any(other);
            note(mixed, "joint that follows one of another kind".to_owned());
        }
    }

    /// Joints from the base to the last one.
    fn path(&self) -> Vec<usize> {
        let mut path = Vec::new();
        let mut at = self.members.len().checked_sub(1);
        while let Some(joint) = at {
            path.push(joint);
            at = self.members[joint].joint.antecedent;
        }
        path
    }
}
