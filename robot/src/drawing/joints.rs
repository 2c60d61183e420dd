//! Symbols of joints.

use super::paper::{Sheet, flat, n};
use super::scene::{DrawnPart, Point};
use super::view::View;

/// Symbol of a joint; `carries`: whether another joint is at the middle of a slider.
pub(super) fn symbol(
    part: &DrawnPart,
    carries: bool,
    colour: usize,
    view: &View,
    sheet: &Sheet,
) -> String {
    match part {
        DrawnPart::Universal { at } => universal(flat(at, view, sheet)),
        DrawnPart::Revolute { at, axis, actuated } => {
            let place = flat(at, view, sheet);
            if view.planar {
                disc(place, colour, *actuated)
            } else {
                drum(place, view.project(axis), colour, *actuated)
            }
        }
        DrawnPart::Slider { at, axis, actuated } => {
            let direction = view.project(axis);
            block(flat(at, view, sheet), direction, colour, *actuated, carries)
        }
        DrawnPart::Telescope { from, to, actuated } => {
            telescope(from, to, colour, *actuated, view, sheet)
        }
        DrawnPart::Ball { at } => ball(flat(at, view, sheet), colour),
        DrawnPart::Link { .. } | DrawnPart::Stub { .. } | DrawnPart::Rail { .. } => String::new(),
    }
}

/// Letter on a motor.
fn motor(place: [f64; 2]) -> String {
    let [x, y] = place;
    format!(
        "<text class=\"ov-motor\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">M</text>",
        n(x),
        n(y + 4.5)
    )
}

/// Joint seen along its axis.
pub(super) fn disc(place: [f64; 2], colour: usize, actuated: bool) -> String {
    let [cx, cy] = place.map(n);
    if actuated {
        let letter = motor(place);
        return format!(
            "<circle class=\"ov-case ov-f{colour}\" cx=\"{cx}\" cy=\"{cy}\" r=\"14\" stroke-width=\"2.5\"/>{letter}\n"
        );
    }
    format!("<circle class=\"ov-ink\" cx=\"{cx}\" cy=\"{cy}\" r=\"6\" stroke-width=\"2.5\"/>\n")
}

/// Joint seen from any direction: a cylinder about its axis.
fn drum(place: [f64; 2], axis: [f64; 3], colour: usize, actuated: bool) -> String {
    // The visible cap is at the nearer end.
    let [right, up, near] = if axis[2] < 0.0 {
        axis.map(|a| -a)
    } else {
        axis
    };
    let (radius, half) = if actuated { (13.0, 13.0) } else { (7.0, 9.0) };
    let long = right.hypot(up);
    let angle = if long < 1e-3 {
        0.0
    } else {
        (-up).atan2(right).to_degrees()
    };
    let (reach, flat) = (half * long, radius * near.abs().max(0.02));
    let (reach_text, flat_text, radius_text) = (n(reach), n(flat), n(radius));
    let sides = format!(
        "M{reach_text} -{radius_text}H{0}A{flat_text} {radius_text} 0 0 0 {0} {radius_text}H{reach_text}",
        n(-reach)
    );
    let (body, cap, width) = if actuated {
        (
            format!("ov-case ov-f{colour}"),
            format!("ov-case ov-g{colour}"),
            "2",
        )
    } else {
        ("ov-ink".to_owned(), "ov-ink".to_owned(), "2")
    };
    let letter = if actuated {
        motor(place)
    } else {
        String::new()
    };
    format!(
        "<g transform=\"translate({} {}) rotate({})\"><path class=\"{body}\" d=\"{sides}\" stroke-width=\"{width}\"/>\
         <ellipse class=\"{cap}\" cx=\"{reach_text}\" cy=\"0\" rx=\"{flat_text}\" ry=\"{radius_text}\" stroke-width=\"{width}\"/></g>{letter}\n",
        n(place[0]),
        n(place[1]),
        n(angle)
    )
}

/// Slider on a rail.
pub(super) fn block(
    place: [f64; 2],
    axis: [f64; 3],
    colour: usize,
    actuated: bool,
    carries: bool,
) -> String {
    let [x, y] = place;
    let angle = (-axis[1]).atan2(axis[0]);
    // Move the letter away from the joint on the slider.
    let (left, width, aside) = if carries {
        (-32.0, 50.0, -18.0)
    } else {
        (-19.0, 38.0, 0.0)
    };
    let (class, letter) = if actuated {
        let place = [x + aside * angle.cos(), y + aside * angle.sin()];
        (format!("ov-case ov-f{colour}"), motor(place))
    } else {
        ("ov-ink".to_owned(), String::new())
    };
    format!(
        "<rect class=\"{class}\" x=\"{}\" y=\"-12\" width=\"{}\" height=\"24\" rx=\"5\" stroke-width=\"2.5\" \
         transform=\"translate({} {}) rotate({})\"/>{letter}\n",
        n(left),
        n(width),
        n(x),
        n(y),
        n(angle.to_degrees())
    )
}

/// Two passive joints whose axes cross.
pub(super) fn universal(place: [f64; 2]) -> String {
    let [x, y] = place;
    let (cx, cy) = (n(x), n(y));
    format!(
        "<circle class=\"ov-ink\" cx=\"{cx}\" cy=\"{cy}\" r=\"8\" stroke-width=\"2.2\"/>\
         <path class=\"ov-ink\" d=\"M{} {cy}h9M{cx} {}v9\" stroke-width=\"2.2\"/>\n",
        n(x - 4.5),
        n(y - 4.5)
    )
}

/// A cylinder with its rod.
fn telescope(
    from: &Point,
    to: &Point,
    colour: usize,
    actuated: bool,
    view: &View,
    sheet: &Sheet,
) -> String {
    let (start, end) = (flat(from, view, sheet), flat(to, view, sheet));
    let at = |share: f64| [0, 1].map(|i| start[i] + share * (end[i] - start[i]));
    let line =
        |a: [f64; 2], b: [f64; 2]| format!("M{} {}L{} {}", n(a[0]), n(a[1]), n(b[0]), n(b[1]));
    let (rod, cylinder) = (line(start, end), line(at(0.12), at(0.58)));
    let letter = if actuated {
        motor(at(0.35))
    } else {
        String::new()
    };
    format!(
        "<path class=\"ov-case\" d=\"{rod}\" stroke-width=\"10\"/>\
         <path class=\"ov-b{colour}\" d=\"{rod}\" stroke-width=\"6\" stroke-linecap=\"round\"/>\
         <path class=\"ov-case\" d=\"{cylinder}\" stroke-width=\"21\"/>\
         <path class=\"ov-a{colour}\" d=\"{cylinder}\" stroke-width=\"17\"/>{letter}\n"
    )
}

/// End of a leg with a point closure.
pub(super) fn ball(place: [f64; 2], colour: usize) -> String {
    let [cx, cy] = place.map(n);
    format!(
        "<circle class=\"ov-case ov-f{colour}\" cx=\"{cx}\" cy=\"{cy}\" r=\"7.5\" stroke-width=\"2\"/>\n"
    )
}
