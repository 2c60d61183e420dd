//! Coupled joints of SDFormat: `<mimic>` of an axis, and joints of type `gearbox`, which couple two
//! angles.

use super::{
    contents::{JointItem, SdfContents},
    frames::FrameName,
    joints,
    tree::{self, Axes, Edge},
    value::number,
};
use crate::{
    couplings::{Coupling, Couplings},
    model::{JointType, Model},
};

pub(super) fn read(contents: &SdfContents<'_>, edges: &[Edge], axes: &Axes, model: &mut Model) {
    let mut all = Vec::new();
    for edge in edges {
        for axis in &edge.axes {
            if axis.lead.is_none() {
                all.extend(mimic(contents, edge.item, axis.element, axes, model));
            }
        }
    }
    for item in &contents.joints {
        if item.owner == super::contents::Owner::Robot && joints::is_coupling(item) {
            all.extend(gearbox(contents, item, edges, axes));
        }
    }
    let mut couplings = Couplings::default();
    all.into_iter().for_each(|coupling| couplings.add(coupling));
    couplings.resolve(contents.files, model);
}

/// Reads `<mimic>` of an axis: position = multiplier · (leader − reference) + offset.
fn mimic(
    contents: &SdfContents<'_>,
    item: usize,
    tag: &'static str,
    axes: &Axes,
    model: &Model,
) -> Option<Coupling> {
    let files = contents.files;
    let own = &contents.joints[item];
    let mimic = own.element.child(tag)?.child("mimic")?;
    let name = mimic.required(files, "joint")?;
    let leading = match mimic.keyword(files, "axis", &["axis", "axis2"]) {
        Some("axis2") => "axis2",
        _ => "axis",
    };
    let prefix = |scope: usize| &contents.frames.scopes[scope].prefix;
    let is_meant = |other: &JointItem| {
        let frame = contents.frames.find(own.scope, name);
        let is_frame = frame == Some(other.frame);
        // Up to SDFormat 1.6, the frame may belong to a link with the joint's name.
        is_frame
            || prefix(other.scope) == prefix(own.scope) && other.element.get("name") == Some(name)
    };
    let leader = contents.joints.iter().position(is_meant);
    let leader = leader.and_then(|leader| axes.get(&(leader, leading)).copied());
    let follower = axes.get(&(item, tag)).copied()?;
    let kind = leader.map(|leader| model.joints[leader].kind);
    let (Some(leader), Some(JointType::Revolute | JointType::Prismatic)) = (leader, kind) else {
        let message = format!("there is no axis `{leading}` of a joint `{name}` to couple to");
        files.report(&mimic.place, message, "name another joint that moves");
        return None;
    };
    // `<drake:mimic>` has attributes.
    let value = |tag: &str, default: f64| {
        let given = mimic.number(files, tag, default);
        number(files, mimic, tag, given)
    };
    let factor = value("multiplier", 1.0);
    let reference = number(files, mimic, "reference", 0.0);
    let offset = value("offset", 0.0) - factor * reference;
    Some(Coupling {
        follower,
        leader,
        factor,
        offset,
        place: mimic.place.clone(),
    })
}

/// Couples the two angles of a gearbox: θ_child = −ratio · θ_parent.
///
/// Both angles are measured from the reference body.
fn gearbox(
    contents: &SdfContents<'_>,
    item: &JointItem,
    edges: &[Edge],
    axes: &Axes,
) -> Option<Coupling> {
    let files = contents.files;
    let reference = joints::reference_body(contents, item)?;
    let base = tree::end(contents, &reference)?;
    let angle = |name: &FrameName, tag: &str| {
        let link = tree::end(contents, name)?;
        let found = turn(contents, item, edges, [base, link], tag);
        if found.is_none() {
            let message = format!(
                "the gearbox `{}` needs a revolute joint between `{}` and `{}` along its <{tag}>",
                item.name, reference.text, name.text
            );
            let help = "write both joints of the gears as separate joints";
            files.report(&item.element.place, message, help);
        }
        found
    };
    let first = angle(&item.parent, "axis");
    let second = angle(&item.child, "axis2");
    let ((first, first_sign), (second, second_sign)) = (first?, second?);
    let ratio = number(files, &item.element, "gearbox_ratio", 1.0);
    let joint = |edge: usize| axes.get(&(edges[edge].item, "axis")).copied();
    Some(Coupling {
        follower: joint(second)?,
        leader: joint(first)?,
        factor: -ratio * first_sign * second_sign,
        offset: 0.0,
        place: item.element.place.clone(),
    })
}

/// Finds the revolute joint between two links along a gearbox axis.
///
/// The sign is positive if the joint and the gearbox count the angle in the same direction, from
/// the first link to the second.
fn turn(
    contents: &SdfContents<'_>,
    item: &JointItem,
    edges: &[Edge],
    links: [Option<usize>; 2],
    tag: &str,
) -> Option<(usize, f64)> {
    let wanted = joints::direction(contents, item, item.element.child(tag)?)?;
    let found = edges.iter().position(|edge| {
        let is_turn = edge.axes.len() == 1 && edge.axes[0].joint.kind == JointType::Revolute;
        is_turn && (edge.ends == links || edge.ends == [links[1], links[0]])
    })?;
    let edge = &edges[found];
    let frame = contents.joints[edge.item].frame;
    let own = contents.frames.relative_pose(frame, item.frame).rotation * edge.axes[0].joint.axis;
    let along = own.dot(&wanted);
    let from = if edge.ends == links { 1.0 } else { -1.0 };
    (along.abs() > 1.0 - 1e-6).then_some((found, from * along.signum()))
}
