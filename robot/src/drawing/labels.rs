//! Text of the drawing: title, names, frames and legend.

use super::joints::{ball, block, disc, universal};
use super::paper::{Sheet, WIDTH, flat, n};
use super::scene::{DrawnPart, Scene};
use super::style::COLOURS;
use super::view::View;
use crate::counted::counted;
use overact_codegen::mechanism::Mechanism;

/// Title: the robot's name, degrees of freedom and motors.
pub(super) fn title(mechanism: &Mechanism) -> (String, String) {
    let freedoms = counted(mechanism.dof(), "degree of freedom", "degrees of freedom");
    let motors = counted(mechanism.actuator_count(), "motor", "motors");
    let Some(platform) = &mechanism.platform else {
        return (mechanism.name.clone(), format!("{freedoms}, {motors}"));
    };
    let legs = counted(mechanism.legs.len(), "leg", "legs");
    let coordinates = platform.motion.coordinates().join(", ");
    let coordinates = coordinates.replace("phi", "φ");
    let subtitle = format!("{freedoms} ({coordinates}), {motors}, {legs}");
    (mechanism.name.clone(), subtitle)
}

/// Rectangle on the sheet: left, top, right, bottom.
type Area = [f64; 4];

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Upper estimate of a name's width, pixels.
fn text_width(text: &str) -> f64 {
    text.chars().count() as f64 * 8.0
}

/// Names of the legs, or of the joints if there is one leg.
pub(super) fn names(mechanism: &Mechanism, scene: &Scene, view: &View, sheet: &Sheet) -> String {
    let mut wanted: Vec<(usize, String, [f64; 2])> = Vec::new();
    if mechanism.is_tree() {
        for (leg, of_leg) in mechanism.legs.iter().enumerate() {
            let moving = of_leg.joints.iter().filter(|j| !j.variable.is_empty());
            let symbols = scene.parts.iter().filter_map(|(l, part)| match part {
                _ if *l != leg => None,
                DrawnPart::Revolute { at, .. } | DrawnPart::Slider { at, .. } => Some(*at),
                DrawnPart::Telescope { from, to, .. } => Some((from + to) / 2.0),
                _ => None,
            });
            wanted.extend(
                moving
                    .zip(symbols)
                    .map(|(joint, at)| (leg, joint.name.clone(), flat(&at, view, sheet))),
            );
        }
    } else {
        for (index, (leg, base)) in mechanism.legs.iter().zip(&scene.bases).enumerate() {
            let slider = scene.parts.iter().find_map(|(l, part)| match part {
                DrawnPart::Slider { at, .. } if *l == index => Some(*at),
                _ => None,
            });
            let at = slider.unwrap_or(*base);
            wanted.push((index, leg.name.clone(), flat(&at, view, sheet)));
        }
    }
    let obstacles = obstacles(scene, view, sheet);
    let mut taken: Vec<Area> = Vec::new();
    let mut text = String::new();
    for (leg, name, at) in wanted {
        let area = best_area(&name, at, &obstacles, &taken, sheet);
        text.push_str(&format!(
            "<text class=\"ov-tag ov-n{}\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{name}</text>\n",
            leg % COLOURS,
            n((area[0] + area[2]) / 2.0),
            n(area[3] - 4.5)
        ));
        taken.push(area);
    }
    text
}

/// Area around a place where a name covers least; outer positions are tried first.
fn best_area(
    name: &str,
    at: [f64; 2],
    obstacles: &[[f64; 2]],
    taken: &[Area],
    sheet: &Sheet,
) -> Area {
    let (half, tall) = (text_width(name) / 2.0 + 2.0, 9.0);
    let outwards = [at[0] - WIDTH / 2.0, at[1] - sheet.height / 2.0];
    let outwards = outwards[1].atan2(outwards[0]);
    let mut best: Option<(f64, Area)> = None;
    for distance in [20.0, 27.0, 36.0] {
        for step in 0..24 {
            let turn = f64::from((step + 1) / 2) * if step % 2 == 0 { 15.0 } else { -15.0 };
            let angle = outwards + f64::to_radians(turn);
            let x = at[0] + angle.cos() * (distance + half);
            let y = at[1] + angle.sin() * (distance + tall * 0.6);
            let area = [x - half, y - tall, x + half, y + tall];
            let inside = |p: &&[f64; 2]| {
                let margin = 3.0;
                p[0] > area[0] - margin
                    && p[0] < area[2] + margin
                    && p[1] > area[1] - margin
                    && p[1] < area[3] + margin
            };
            let covered = obstacles.iter().filter(inside).count() as f64;
            let crossed = taken.iter().filter(|t| overlap(t, &area)).count() as f64;
            let sheet_area = [6.0, 72.0, WIDTH - 6.0, sheet.height - 44.0];
            let outside = area[0] < sheet_area[0]
                || area[1] < sheet_area[1]
                || area[2] > sheet_area[2]
                || area[3] > sheet_area[3];
            let score = covered * 3.0
                + crossed * 60.0
                + if outside { 80.0 } else { 0.0 }
                + turn.abs() / 60.0
                + distance / 20.0;
            if best.as_ref().is_none_or(|(known, _)| score < known - 1e-6) {
                best = Some((score, area));
            }
        }
    }
    best.map_or([0.0; 4], |(_, area)| area)
}

/// Points that names should not cover: along bodies and around joints.
fn obstacles(scene: &Scene, view: &View, sheet: &Sheet) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    let mut line = |a: [f64; 2], b: [f64; 2]| {
        let steps = ((a[0] - b[0]).hypot(a[1] - b[1]) / 7.0).ceil().max(1.0) as usize;
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            points.push([0, 1].map(|i| a[i] + share * (b[i] - a[i])));
        }
    };
    let mut around = Vec::new();
    for (_, part) in &scene.parts {
        let on_paper = |p| flat(p, view, sheet);
        match part {
            DrawnPart::Link { path, .. } | DrawnPart::Stub { path, .. } => {
                path.windows(2)
                    .for_each(|pair| line(on_paper(&pair[0]), on_paper(&pair[1])));
            }
            DrawnPart::Rail { from, to } | DrawnPart::Telescope { from, to, .. } => {
                line(on_paper(from), on_paper(to));
            }
            DrawnPart::Revolute { at, actuated, .. } | DrawnPart::Slider { at, actuated, .. } => {
                around.push((on_paper(at), if *actuated { 15.0 } else { 8.0 }));
            }
            DrawnPart::Universal { at } | DrawnPart::Ball { at } => {
                around.push((on_paper(at), 8.0))
            }
        }
    }
    for ([x, y], radius) in around {
        for step in 0..12 {
            let angle = f64::from(step) * std::f64::consts::PI / 6.0;
            points.push([x + radius * angle.cos(), y + radius * angle.sin()]);
        }
    }
    if view.planar {
        // The hatched ground below each base.
        for base in &scene.bases {
            let [x, y] = flat(base, view, sheet);
            points.extend((-2..=2).map(|i| [x + 8.0 * f64::from(i), y + 26.0]));
        }
    }
    points
}

/// Frame of the platform, and directions of the base frame in a corner.
pub(super) fn frames(scene: &Scene, view: &View, sheet: &Sheet) -> String {
    let units = nalgebra::Matrix3::identity();
    let column = |m: &nalgebra::Matrix3<f64>, i: usize| m.column(i).into_owned();
    let project = |m: &nalgebra::Matrix3<f64>| [0, 1, 2].map(|i| view.project(&column(m, i)));
    let corner = free_corner(scene, view, sheet);
    let mut text = triad(corner, &project(&units), 32.0, true);
    text.push_str(&format!(
        "<text class=\"ov-text\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">base</text>\n",
        n(corner[0]),
        n(corner[1] + 42.0)
    ));
    if let Some(frame) = &scene.platform {
        let axes = frame.rotation.to_rotation_matrix().into_inner();
        let at = flat(&frame.translation.vector, view, sheet);
        text.push_str(&triad(at, &project(&axes), 26.0, false));
    }
    text
}

/// First corner for the base frame that the robot leaves free.
fn free_corner(scene: &Scene, view: &View, sheet: &Sheet) -> [f64; 2] {
    let (low, high) = (sheet.height - 88.0, 112.0);
    let corners = [
        [64.0, low],
        [WIDTH - 64.0, low],
        [WIDTH - 64.0, high],
        [64.0, high],
    ];
    let obstacles = obstacles(scene, view, sheet);
    let covered = |c: &[f64; 2]| {
        let near = |p: &&[f64; 2]| (p[0] - c[0]).abs() < 62.0 && (p[1] - c[1]).abs() < 56.0;
        obstacles.iter().filter(near).count()
    };
    let free = corners.iter().min_by_key(|c| covered(c));
    free.copied().unwrap_or(corners[0])
}

/// Axes of a frame; an axis towards the reader is a dot.
fn triad(at: [f64; 2], axes: &[[f64; 3]; 3], size: f64, letters: bool) -> String {
    let mut text = String::new();
    let colours = ["#ef4444", "#22a55b", "#3b82f6"];
    for (axis, ([right, up, _], colour)) in axes.iter().zip(colours).enumerate() {
        let long = right.hypot(*up);
        if long < 0.05 {
            continue;
        }
        let tip = [at[0] + right * size, at[1] - up * size];
        let (along, across) = ([right / long, -up / long], [up / long, right / long]);
        let barb = |side: f64| {
            let place = |i: usize| tip[i] - along[i] * 6.5 + across[i] * 3.4 * side;
            format!("{} {}", n(place(0)), n(place(1)))
        };
        text.push_str(&format!(
            "<path d=\"M{} {}L{} {}M{}L{} {}L{}\" stroke=\"{colour}\" fill=\"none\" stroke-width=\"2\" stroke-linecap=\"round\" stroke-linejoin=\"round\"/>\n",
            n(at[0]),
            n(at[1]),
            n(tip[0]),
            n(tip[1]),
            barb(1.0),
            n(tip[0]),
            n(tip[1]),
            barb(-1.0)
        ));
        if letters {
            let place = [tip[0] + along[0] * 9.0, tip[1] + along[1] * 9.0 + 4.0];
            text.push_str(&format!(
                "<text class=\"ov-letter\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                n(place[0]),
                n(place[1]),
                ["x", "y", "z"][axis]
            ));
        }
    }
    text
}

/// Legend of the symbols that occur.
pub(super) fn legend(scene: &Scene, sheet: &Sheet) -> String {
    let y = sheet.height - 22.0;
    let mut text = String::new();
    let mut x = 40.0;
    for (symbol, meaning) in symbols(scene) {
        text.push_str(&match symbol {
            Symbol::Joint(symbol) => format!(
                "<g transform=\"translate({} {}) scale(.72)\">{symbol}</g>\n",
                n(x),
                n(y)
            ),
            Symbol::Plate => format!(
                "<rect class=\"ov-plate\" x=\"{}\" y=\"{}\" width=\"20\" height=\"14\" rx=\"3\" stroke-width=\"2\"/>\n",
                n(x - 10.0),
                n(y - 7.0)
            ),
        });
        text.push_str(&format!(
            "<text class=\"ov-text\" x=\"{}\" y=\"{}\">{meaning}</text>\n",
            n(x + 17.0),
            n(y + 4.5)
        ));
        x += 17.0 + meaning.chars().count() as f64 * 6.6 + 28.0;
    }
    text
}

/// A symbol of the legend.
enum Symbol {
    /// Joint at the origin.
    Joint(String),
    /// Plate of the platform.
    Plate,
}

/// The symbols of a scene, each with its meaning.
fn symbols(scene: &Scene) -> Vec<(Symbol, &'static str)> {
    let has = |is: fn(&DrawnPart) -> bool| scene.parts.iter().any(|(_, part)| is(part));
    let slide = |actuated| block([0.0, 0.0], [1.0, 0.0, 0.0], 7, actuated, false);
    let turns = |part: &DrawnPart, driven: bool| matches!(part, DrawnPart::Revolute { actuated, .. } if *actuated == driven);
    let slides = |part: &DrawnPart, driven: bool| {
        matches!(
            part,
            DrawnPart::Slider { actuated, .. } | DrawnPart::Telescope { actuated, .. } if *actuated == driven
        )
    };
    let any = |is: &dyn Fn(&DrawnPart, bool) -> bool, driven| {
        scene.parts.iter().any(|(_, part)| is(part, driven))
    };
    let joints = [
        (
            any(&turns, true),
            disc([0.0, 0.0], 7, true),
            "revolute motor",
        ),
        (any(&slides, true), slide(true), "linear motor"),
        (
            any(&turns, false),
            disc([0.0, 0.0], 7, false),
            "passive revolute joint",
        ),
        (
            has(|p| matches!(p, DrawnPart::Universal { .. })),
            universal([0.0, 0.0]),
            "universal joint",
        ),
        (any(&slides, false), slide(false), "passive slide"),
        (
            has(|p| matches!(p, DrawnPart::Ball { .. })),
            ball([0.0, 0.0], 7),
            "point end",
        ),
    ];
    let joints = joints.into_iter().filter(|(occurs, ..)| *occurs);
    let joints = joints.map(|(_, symbol, meaning)| (Symbol::Joint(symbol), meaning));
    let plate = scene
        .platform
        .is_some()
        .then_some((Symbol::Plate, "platform"));
    joints.chain(plate).collect()
}
