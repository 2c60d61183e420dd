//! Draws the fixed parts: plates, pivots and feet.

use super::paper::{Sheet, flat, hull, n, polygon};
use super::scene::{DrawnPart, Point, Scene};
use super::view::View;
use overact_codegen::mechanism::Mechanism;
use std::fmt::Write;

/// Draws a plate (spatial), a hatched pivot below each base (planar), or a foot (serial).
pub(super) fn grounds(mechanism: &Mechanism, scene: &Scene, view: &View, sheet: &Sheet) -> String {
    // Chains that start on a moving body have no ground.
    let legs = scene.bases.iter().zip(&mechanism.legs).enumerate();
    let grounded = legs.filter(|(_, (_, leg))| leg.base_body.is_none());
    let places: Vec<(usize, [f64; 2])> = grounded
        .map(|(leg, (place, _))| (leg, flat(place, view, sheet)))
        .collect();
    if let Some(radius) = scene.sphere {
        let [x, y] = flat(&Point::zeros(), view, sheet);
        let radius = radius / sheet.pixel();
        return format!(
            "<circle class=\"ov-globe\" cx=\"{}\" cy=\"{}\" r=\"{}\" stroke-width=\"1\"/>\n",
            n(x),
            n(y),
            n(radius)
        );
    }
    let mut text = String::new();
    let rails = scene
        .parts
        .iter()
        .any(|(_, part)| matches!(part, DrawnPart::Rail { .. }));
    if !view.planar && places.len() > 2 && !rails {
        text = polygon(
            "base",
            &hull(places.into_iter().map(|(_, place)| place).collect()),
        );
    } else {
        for (leg, place) in &places {
            let slides = scene
                .parts
                .iter()
                .any(|(l, part)| l == leg && matches!(part, DrawnPart::Rail { .. }));
            let serial = mechanism.is_tree() && !view.planar;
            match (slides, serial) {
                (true, _) => {}
                (false, true) => text.push_str(&foot(place)),
                (false, false) => text.push_str(&pivot(place)),
            }
        }
    }
    text
}

/// The foot of a serial robot: a disc on the ground.
fn foot(place: &[f64; 2]) -> String {
    let [x, y] = place;
    format!(
        "<ellipse class=\"ov-base\" cx=\"{}\" cy=\"{}\" rx=\"40\" ry=\"15\" stroke-width=\"1.5\"/>\n",
        n(*x),
        n(y + 14.0)
    )
}

/// A fixed pivot: a triangle on hatched ground.
fn pivot(place: &[f64; 2]) -> String {
    let [x, y] = place;
    let bottom = y + 26.0;
    let mut hatch = String::new();
    for step in 0..5 {
        let at = x - 15.0 + 8.0 * f64::from(step);
        let _ = write!(hatch, "M{} {}l-6 7", n(at), n(bottom));
    }
    format!(
        "<path class=\"ov-base\" d=\"M{0} {1}L{2} {3}H{4}Z\" stroke-width=\"1.5\" stroke-linejoin=\"round\"/>\
         <path class=\"ov-rail\" d=\"M{5} {3}H{6}{hatch}\" stroke-width=\"1.5\" stroke-linecap=\"round\"/>\n",
        n(*x),
        n(*y),
        n(x - 14.0),
        n(bottom),
        n(x + 14.0),
        n(x - 21.0),
        n(x + 21.0)
    )
}
