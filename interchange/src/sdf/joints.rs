//! Splits joints of SDFormat into axes with one degree of freedom each.

use super::{
    contents::{JointItem, SdfContents},
    frames::FrameName,
    value::{flag, limit, number, several, text},
};
use crate::{
    bounds::record_empty_range,
    geometry::exact,
    model::{Joint, JointType},
    xml::Element,
};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// One axis of a joint.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    /// Joint of the model, passive and without a placement on its body.
    pub(super) joint: Joint,
    /// Element that describes it: `axis` or `axis2`.
    pub(super) element: &'static str,
    /// For the slide of a screw joint: displacement for each radian of rotation, m.
    pub(super) lead: Option<f64>,
}

/// Axes of a joint from its parent to its child; empty for a fixed joint, `None` after an error.
///
/// Directions are in the frame of the joint.
pub(super) fn axes(contents: &SdfContents<'_>, item: &JointItem) -> Option<Vec<Axis>> {
    report_unused_axes(contents, item);
    let one = |kind, tag, name: String| axis(contents, item, kind, tag, name);
    let name = || item.name.clone();
    let numbered = |at: usize| format!("{}_{at}", item.name);
    Some(match item.element.get("type").unwrap_or("no type") {
        "fixed" => Vec::new(),
        "revolute" | "continuous" => vec![one(JointType::Revolute, "axis", name())?],
        "prismatic" => vec![one(JointType::Prismatic, "axis", name())?],
        "ball" => {
            let joint = Joint::new(&item.name, JointType::Ball, item.element.place.clone());
            vec![Axis {
                joint,
                element: "axis",
                lead: None,
            }]
        }
        "universal" | "revolute2" => {
            let both = [
                one(JointType::Revolute, "axis", numbered(1))?,
                one(JointType::Revolute, "axis2", numbered(2))?,
            ];
            let [first, second] = both.each_ref().map(|axis| axis.joint.axis);
            if first.cross(&second).norm() < 1e-6 {
                let message = format!("the two axes of the joint `{}` are parallel", item.name);
                let help = "give <axis2> another direction than <axis>";
                contents.files.report(&item.element.place, message, help);
                return None;
            }
            both.into()
        }
        "screw" => {
            let turn = one(JointType::Revolute, "axis", name())?;
            let mut slide = Axis {
                lead: Some(lead(contents, item)?),
                ..turn.clone()
            };
            let place = item.element.place.clone();
            slide.joint = Joint {
                axis: turn.joint.axis,
                ..Joint::new(&format!("{}_slide", item.name), JointType::Prismatic, place)
            };
            // Both motions have the same axis, so their order does not matter; the last one carries
            // the body.
            vec![slide, turn]
        }
        other => {
            let message = format!(
                "the joint `{}` is `{other}`, which is not supported",
                item.name
            );
            let help = "supported are revolute, continuous, prismatic, fixed, universal, revolute2, ball, screw and gearbox joints";
            contents.files.report(&item.element.place, message, help);
            return None;
        }
    })
}

/// Reports axes that a joint's type does not have.
fn report_unused_axes(contents: &SdfContents<'_>, item: &JointItem) {
    let unused: &[&str] = match item.element.get("type") {
        Some("universal" | "revolute2" | "gearbox" | "fixed") => &[],
        Some("ball") => &["axis", "axis2"],
        _ => &["axis2"],
    };
    for tag in unused {
        if let Some(element) = item.element.child(tag) {
            let reason = "not used: joints of this type have no such axis";
            contents.files.demote(&element.place, tag, None, reason);
        }
    }
}

fn axis(
    contents: &SdfContents<'_>,
    item: &JointItem,
    kind: JointType,
    tag: &'static str,
    name: String,
) -> Option<Axis> {
    let files = contents.files;
    let Some(element) = item.element.child(tag) else {
        let message = format!("the joint `{}` has no <{tag}>", item.name);
        let help = format!("write <{tag}><xyz>0 0 1</xyz></{tag}>");
        files.report(&item.element.place, message, help);
        return None;
    };
    let mut joint = Joint::new(&name, kind, item.element.place.clone());
    joint.axis = direction(contents, item, element)?;
    if tag == "axis" {
        // Drake: the inertia of the rotor before its gear.
        let gear = number(files, &item.element, "gear_ratio", 1.0);
        joint.armature = gear * gear * number(files, &item.element, "rotor_inertia", 0.0);
    }
    if let Some(dynamics) = element.child("dynamics") {
        joint.damping = number(files, dynamics, "damping", 0.0);
        joint.friction = number(files, dynamics, "friction", 0.0);
        let stiffness = number(files, dynamics, "spring_stiffness", 0.0);
        let rest = number(files, dynamics, "spring_reference", 0.0);
        joint.spring = (stiffness != 0.0).then_some((stiffness, rest));
    }
    if let Some(own) = element.child("limit") {
        let is_limited = item.element.get("type") != Some("continuous");
        let ends = (limit(files, own, "lower"), limit(files, own, "upper"));
        if let ((Some(low), Some(high)), true) = (ends, is_limited) {
            joint.range = (low < high).then_some([low, high]);
            if joint.range.is_none() {
                record_empty_range(files, own);
            }
        }
        joint.speed = limit(files, own, "velocity").filter(|speed| *speed > 0.0);
    }
    Some(Axis {
        joint,
        element: tag,
        lead: None,
    })
}

/// Direction of an axis in the frame of its joint.
pub(super) fn direction(
    contents: &SdfContents<'_>,
    item: &JointItem,
    element: &Element,
) -> Option<Vector3<f64>> {
    let (files, frames) = (contents.files, &contents.frames);
    let scope = &frames.scopes[item.scope];
    let given = element.child("xyz");
    let xyz = given.map_or(Some([0.0, 0.0, 1.0]), |xyz| several(files, xyz))?;
    let Some(own) = exact::direction(xyz) else {
        let place = given.map_or(&element.place, |xyz| &xyz.text.1);
        files.report(
            place,
            "the axis has no direction",
            "write for instance <xyz>0 0 1</xyz>",
        );
        return None;
    };
    let named = given.and_then(|xyz| xyz.attribute("expressed_in"));
    // Up to 1.4 all axes are expressed in the model frame; in 1.5 and 1.6 only those with
    // `use_parent_model_frame`.
    let in_model = scope.version <= (1, 4) || flag(files, element, "use_parent_model_frame");
    let frame = match named.filter(|(name, _)| !name.is_empty()) {
        Some((name, place)) => {
            let name = FrameName {
                scope: item.scope,
                text: name.to_owned(),
                place: place.clone(),
            };
            Some(frames.find_or_report(files, &name)?)
        }
        None => in_model.then_some(scope.model),
    };
    Some(frame.map_or(own, |frame| {
        let turned = exact::cleaned(&frames.relative_pose(frame, item.frame).rotation);
        turned * own
    }))
}

/// Lead of a screw, m/rad; positive for a right-handed thread.
fn lead(contents: &SdfContents<'_>, item: &JointItem) -> Option<f64> {
    let files = contents.files;
    let read = |tag: &str| {
        item.element
            .child(tag)
            .map(|own| (several(files, own), own))
    };
    let (value, element) = match (read("screw_thread_pitch"), read("thread_pitch")) {
        (Some((value, own)), _) => (value.map(|[pitch]| pitch / TAU), own),
        // The deprecated `thread_pitch` is in rad/m and positive for a left-handed thread.
        (None, Some((value, own))) => (value.map(|[pitch]| -1.0 / pitch), own),
        (None, None) => {
            let message = format!("the screw `{}` has no pitch", item.name);
            let help = "write <screw_thread_pitch>, in m for a turn";
            files.report(&item.element.place, message, help);
            return None;
        }
    };
    let lead = value?;
    if !lead.is_finite() || lead == 0.0 {
        let message = format!("the pitch of the screw `{}` is zero", item.name);
        let help = "write <screw_thread_pitch>, in m for a turn, other than 0";
        files.report(&element.text.1, message, help);
        return None;
    }
    Some(lead)
}

/// Whether a joint only couples two other joints.
pub(super) fn is_coupling(item: &JointItem) -> bool {
    item.element.get("type") == Some("gearbox")
}

/// Reference body of a gearbox.
pub(super) fn reference_body(contents: &SdfContents<'_>, item: &JointItem) -> Option<FrameName> {
    let found = text(&item.element, "gearbox_reference_body");
    if found.is_none() {
        let message = format!("the gearbox `{}` has no reference body", item.name);
        let help = "write <gearbox_reference_body>: the link that carries both of its axes";
        contents.files.report(&item.element.place, message, help);
    }
    let (text, place) = found?;
    Some(FrameName {
        scope: item.scope,
        text: text.to_owned(),
        place: place.clone(),
    })
}
