//! Converts the scene to SVG elements, ordered from far to near.

use super::ground::grounds;
use super::joints;
use super::labels;
use super::paper::{Sheet, WIDTH, flat, hull, n, path, polygon};
use super::scene::{DrawnPart, NOTHING, Point, Scene};
use super::style::{COLOURS, css};
use super::view::View;
use overact_codegen::mechanism::Mechanism;
use std::collections::BTreeMap;

/// SVG elements with their depth.
struct SvgElement {
    near: f64,
    text: String,
}

/// The whole SVG text.
pub(super) fn document(mechanism: &Mechanism, scene: &Scene, view: &View, sheet: &Sheet) -> String {
    let mut pieces = pieces(mechanism, scene, view, sheet);
    // Rounded, so that pieces of equal depth keep their order on all machines.
    pieces.sort_by_key(|piece| (piece.near * 100.0).round() as i64);
    let (title, subtitle) = labels::title(mechanism);
    let (width, height) = (n(WIDTH), n(sheet.height));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"ov-drawing\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{title}: {subtitle}\">\n\
         <style>{}</style>\n\
         <rect class=\"ov-sheet\" width=\"{width}\" height=\"{height}\" rx=\"10\"/>\n\
         <text class=\"ov-name\" x=\"28\" y=\"40\">{title}</text>\n\
         <text class=\"ov-text\" x=\"28\" y=\"61\">{subtitle}</text>\n",
        css()
    );
    for piece in &pieces {
        text.push_str(&piece.text);
    }
    text.push_str(&labels::frames(scene, view, sheet));
    text.push_str(&labels::names(mechanism, scene, view, sheet));
    text.push_str(&labels::legend(scene, sheet));
    text.push_str("</svg>\n");
    text
}

/// All elements except text.
///
/// Planar robots have a fixed order: grounds and rails, the platform, bodies, joints.
fn pieces(mechanism: &Mechanism, scene: &Scene, view: &View, sheet: &Sheet) -> Vec<SvgElement> {
    let mut pieces = vec![SvgElement {
        near: f64::from(-1_000_000_000),
        text: grounds(mechanism, scene, view, sheet),
    }];
    let shades = shades(scene);
    for (leg, part) in &scene.parts {
        let (near, layer) = nearness(part, view, sheet);
        let near = match part.place() {
            _ if view.planar => layer,
            Some(at) => before_its_bodies(scene, *leg, at, near, view, sheet) + layer,
            None => near + layer,
        };
        let colour = leg % COLOURS;
        let path = |points: &[Point]| path(points, view, sheet);
        let text = match part {
            DrawnPart::Link { body, path: points } => {
                let shade = shades.get(&(*leg, *body)).copied().unwrap_or(0);
                link(&path(points), colour, shade, view.planar)
            }
            DrawnPart::Stub { body, path: points } => {
                let shade = shades.get(&(*leg, *body)).copied().unwrap_or(0);
                let class = ["a", "b"][shade];
                format!(
                    "<path class=\"ov-{class}{colour}\" d=\"{}\" stroke-width=\"7\" stroke-dasharray=\"9 7\"/>\n",
                    path(points)
                )
            }
            DrawnPart::Rail { from, to } => format!(
                "<path class=\"ov-rail\" d=\"{}\" stroke-width=\"5\" stroke-linecap=\"round\"/>\n",
                path(&[*from, *to])
            ),
            joint => {
                let carries = carries(scene, *leg, joint);
                joints::symbol(joint, carries, colour, view, sheet)
            }
        };
        pieces.push(SvgElement { near, text });
    }
    pieces.push(platform(scene, view, sheet));
    pieces
}

/// Whether a slider carries another joint of its leg.
fn carries(scene: &Scene, leg: usize, slider: &DrawnPart) -> bool {
    let Some(at) = slider.place() else {
        return false;
    };
    scene.parts.iter().any(|(l, part)| {
        let other = matches!(
            part,
            DrawnPart::Revolute { .. } | DrawnPart::Universal { .. }
        );
        let here = part.place().is_some_and(|p| (p - at).norm() < NOTHING);
        *l == leg && other && here
    })
}

/// Depth of a part, and an offset that draws joints before the bodies that they connect.
fn nearness(part: &DrawnPart, view: &View, sheet: &Sheet) -> (f64, f64) {
    let at = |p: &Point| sheet.place(view, p)[2];
    match part {
        DrawnPart::Rail { from, to } => ((at(from) + at(to)) / 2.0, -20.0),
        DrawnPart::Link { path, .. } | DrawnPart::Stub { path, .. } => {
            let sum: f64 = path.iter().map(&at).sum();
            (sum / path.len().max(1) as f64, 5.0)
        }
        DrawnPart::Telescope { from, to, .. } => ((at(from) + at(to)) / 2.0, 8.0),
        DrawnPart::Slider { at: p, .. } => (at(p), 15.0),
        DrawnPart::Revolute { at: p, .. } | DrawnPart::Universal { at: p } => (at(p), 20.0),
        DrawnPart::Ball { at: p } => (at(p), 25.0),
    }
}

/// Depth that puts a joint in front of its bodies, even where these are nearer.
fn before_its_bodies(
    scene: &Scene,
    leg: usize,
    joint: &Point,
    near: f64,
    view: &View,
    sheet: &Sheet,
) -> f64 {
    let bodies = scene.parts.iter().filter(|(l, part)| {
        let passes = match part {
            DrawnPart::Link { path, .. } | DrawnPart::Stub { path, .. } => {
                path.windows(2).any(|p| between(&p[0], &p[1], joint))
            }
            DrawnPart::Telescope { from, to, .. } => between(from, to, joint),
            _ => false,
        };
        *l == leg && passes
    });
    bodies.fold(near, |near, (_, body)| {
        let (own, layer) = nearness(body, view, sheet);
        near.max(own + layer - 15.0)
    })
}

/// Whether a point is on the segment between two others.
fn between(a: &Point, b: &Point, point: &Point) -> bool {
    let (whole, part) = (b - a, point - a);
    let share = (part.dot(&whole) / whole.norm_squared()).clamp(0.0, 1.0);
    (part - whole * share).norm() < 1e-6 * whole.norm()
}

/// Assigns the two colours of a leg to its bodies alternately.
fn shades(scene: &Scene) -> BTreeMap<(usize, usize), usize> {
    let mut shades = BTreeMap::new();
    for (leg, part) in &scene.parts {
        if let DrawnPart::Link { body, .. } | DrawnPart::Stub { body, .. } = part {
            shades.insert((*leg, *body), 0);
        }
    }
    let mut rank = 0;
    let mut last = None;
    for (key, shade) in &mut shades {
        rank = if last == Some(key.0) { rank + 1 } else { 0 };
        last = Some(key.0);
        *shade = rank % 2;
    }
    shades
}

/// Body with a wider outline in the colour of the sheet.
fn link(path: &str, colour: usize, shade: usize, planar: bool) -> String {
    let class = ["a", "b"][shade];
    let width = match (shade, planar) {
        (0, true) => 11.0,
        (_, true) => 8.5,
        (0, false) => 9.0,
        (_, false) => 6.5,
    };
    format!(
        "<path class=\"ov-case\" d=\"{path}\" stroke-width=\"{}\" stroke-linejoin=\"round\"/>\
         <path class=\"ov-{class}{colour}\" d=\"{path}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"/>\n",
        n(width + 4.0),
        n(width)
    )
}

/// Platform: a plate through the attachments, a bar between two, or a ring around one.
fn platform(scene: &Scene, view: &View, sheet: &Sheet) -> SvgElement {
    let Some(frame) = &scene.platform else {
        return SvgElement {
            near: 0.0,
            text: String::new(),
        };
    };
    let middle = frame.translation.vector;
    let places = scene.attachments.iter().map(|p| flat(p, view, sheet));
    let outline = hull(places.collect());
    let near = |p: &Point| sheet.place(view, p)[2];
    let sum: f64 = scene.attachments.iter().map(near).sum();
    let mean = sum / scene.attachments.len().max(1) as f64;
    let text = match outline.as_slice() {
        [] | [_] => {
            let [x, y] = flat(&middle, view, sheet);
            format!(
                "<circle class=\"ov-plate\" cx=\"{}\" cy=\"{}\" r=\"15\" stroke-width=\"2.5\"/>\n",
                n(x),
                n(y)
            )
        }
        [a, b] => format!(
            "<path class=\"ov-plate\" d=\"M{} {}L{} {}\" stroke-width=\"15\" stroke-linecap=\"round\"/>\n",
            n(a[0]),
            n(a[1]),
            n(b[0]),
            n(b[1])
        ),
        _ => polygon("plate", &outline),
    };
    let near = if view.planar { 6.0 } else { mean };
    SvgElement { near, text }
}
