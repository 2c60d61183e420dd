//! Scene of a mechanism at its home configuration.

use super::scene::{DrawnPart, NOTHING, Point, Scene};
use super::{sphere, walk};
use nalgebra::Vector3;
use overact_codegen::mechanism::{
    BodyIndex, End, Mechanism, numeric::platform_frame, placement_isometry,
};

/// Scene of a mechanism; `pixel` is the length of one pixel in m, if known.
pub(super) fn scene(mechanism: &Mechanism, pixel: f64) -> Scene {
    let pose = &mechanism.home.pose;
    let frame = mechanism
        .platform
        .as_ref()
        .map(|p| platform_frame(p.motion, pose));
    if sphere::has_no_lengths(mechanism) {
        return sphere::scene(mechanism, frame);
    }
    let mut scene = Scene {
        parts: Vec::new(),
        bases: Vec::new(),
        attachments: Vec::new(),
        platform: frame,
        sphere: None,
    };
    for (index, leg) in mechanism.legs.iter().enumerate() {
        let positions = &mechanism.home.joints[mechanism.leg_range(index)];
        // Chains start from the body that carries them.
        let ground = mechanism.ground_of(index, pose, &mechanism.home.joints);
        if leg.cable.is_some() {
            cable(&mut scene, mechanism, index);
            continue;
        }
        let (mut parts, mut base) = walk::parts(leg, positions, pixel, mechanism.is_tree());
        if leg.base_body.is_some() {
            parts.iter_mut().for_each(|part| part.carry(&ground));
            base = (ground * nalgebra::Point3::from(base)).coords;
        }
        scene
            .parts
            .extend(parts.into_iter().map(|part| (index, part)));
        scene.parts.extend(branch(mechanism, leg.base_body, base));
        scene.bases.push(base);
        if let (Some(end), Some(target)) = (
            &leg.end,
            mechanism.target(index, pose, &mechanism.home.joints),
        ) {
            let target = ground * target;
            let at = target.translation.vector;
            scene.parts.extend(branch(mechanism, leg.end_body, at));
            scene.attachments.push(at);
            if matches!(end, End::Point { .. }) {
                scene.parts.push((index, DrawnPart::Ball { at }));
            }
        }
    }
    part_sliders(&mut scene, pixel);
    scene
}

/// Adds a cable: a line from its exit point to its platform point.
fn cable(scene: &mut Scene, mechanism: &Mechanism, leg: usize) {
    let home = &mechanism.home;
    let base = placement_isometry(&mechanism.legs[leg].base)
        .translation
        .vector;
    scene.bases.push(base);
    let Some(target) = mechanism.target(leg, &home.pose, &home.joints) else {
        return;
    };
    let at = target.translation.vector;
    let path = vec![base, at];
    scene.parts.push((leg, DrawnPart::Link { body: 0, path }));
    scene.parts.push((leg, DrawnPart::Ball { at }));
    scene.attachments.push(at);
}

/// Segment of a body between its joint and the base of a chain, with the number of its leg.
fn branch(mechanism: &Mechanism, body: Option<BodyIndex>, to: Point) -> Option<(usize, DrawnPart)> {
    let BodyIndex { leg, joint } = body?;
    let home = &mechanism.home;
    let frame = mechanism.body_frame(BodyIndex { leg, joint }, &home.pose, &home.joints);
    let from = frame.translation.vector;
    let path = vec![from, to];
    ((to - from).norm() > NOTHING).then_some((leg, DrawnPart::Link { body: joint, path }))
}

/// Separates coincident sliders of several legs.
fn part_sliders(scene: &mut Scene, pixel: f64) {
    let sliders: Vec<(usize, Point, Point)> = scene
        .parts
        .iter()
        .filter_map(|(leg, part)| match part {
            DrawnPart::Slider { at, axis, .. } => Some((*leg, *at, *axis)),
            _ => None,
        })
        .collect();
    for (leg, at, axis) in &sliders {
        let together = |(_, other, _): &&(usize, Point, Point)| (other - at).norm() < NOTHING;
        let crowd: Vec<usize> = sliders.iter().filter(together).map(|s| s.0).collect();
        let rank = crowd.iter().position(|l| l == leg).unwrap_or(0);
        let place = (crowd.len() as f64 - 1.0) / 2.0 - rank as f64;
        if place == 0.0 {
            continue;
        }
        let upright = Vector3::z() - axis * axis.z;
        let across = upright
            .try_normalize(1e-6)
            .unwrap_or_else(|| (Vector3::x() - axis * axis.x).normalize());
        shift(scene, *leg, &(across * (place * 72.0 * pixel)));
    }
}

/// Translates the parts of a leg.
fn shift(scene: &mut Scene, leg: usize, by: &Point) {
    for (_, part) in scene.parts.iter_mut().filter(|(l, _)| *l == leg) {
        match part {
            DrawnPart::Link { path, .. } | DrawnPart::Stub { path, .. } => {
                path.iter_mut().for_each(|p| *p += by);
            }
            DrawnPart::Revolute { at, .. }
            | DrawnPart::Slider { at, .. }
            | DrawnPart::Universal { at }
            | DrawnPart::Ball { at } => *at += by,
            DrawnPart::Rail { from, to } | DrawnPart::Telescope { from, to, .. } => {
                *from += by;
                *to += by;
            }
        }
    }
    let places = [scene.bases.get_mut(leg), scene.attachments.get_mut(leg)];
    places.into_iter().flatten().for_each(|p| *p += by);
}
