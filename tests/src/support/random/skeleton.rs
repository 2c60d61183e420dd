//! Random robots without a platform: a tree of joints, and chains between any bodies.
//!
//! Every joint of the skeleton has a motor, so the actuators determine the motion; some chains also
//! have motors. A chain is a drive of two crossing axes and a slide, an arm of three revolute
//! joints, or three slides. Its three joints follow from its end point. It starts near its home and
//! may fail to close; the caller rejects open and nearly singular draws. Some bodies of chains
//! carry a branch, whose joints are independent coordinates too, and where later chains may start.

use super::Dice;
use std::fmt::Write;

/// Description of a seed.
#[must_use]
pub fn skeleton(seed: u64) -> String {
    let mut dice = Dice::new(seed);
    let mut text = String::from("name = \"Random\"\ngravity = [1.0, -2.0, -9.0]\n");
    let mut places = String::new();
    let mut bodies = tree(&mut dice, &mut text, &mut places);
    let chains = 1 + dice.below(3);
    for index in 0..chains {
        let own = chain(&mut dice, &mut text, &mut places, index, &bodies);
        if dice.chance(0.4) {
            let carrier = &own[dice.below(own.len())];
            bodies.extend(branch(&mut dice, &mut text, &mut places, index, carrier));
        }
        bodies.extend(own);
    }
    text + &places
}

/// Writes the skeleton; returns the names of its bodies.
fn tree(dice: &mut Dice, text: &mut String, places: &mut String) -> Vec<String> {
    let count = 2 + dice.below(3);
    write(text, format_args!("[leg.tree]\n{}", base(dice, None)));
    let mut home = Vec::new();
    for index in 0..count {
        let slides = dice.chance(0.25);
        let antecedent = match index {
            0 => String::new(),
            _ => format!("antecedent = \"j{}\"\n", dice.below(index)),
        };
        joint(
            text,
            dice,
            "tree",
            &format!("j{index}"),
            slides,
            Some(antecedent),
        );
        let unit = if slides { "m" } else { "rad" };
        home.push(format!("j{index} = \"{:?} {unit}\"", dice.angle(0.8)));
    }
    place(places, "tree", &home);
    (0..count).map(|index| format!("j{index}")).collect()
}

/// Writes a branch of one or two joints on a body of a chain; returns the names of its bodies.
fn branch(
    dice: &mut Dice,
    text: &mut String,
    places: &mut String,
    index: usize,
    carrier: &str,
) -> Vec<String> {
    let name = format!("branch{index}");
    write(
        text,
        format_args!("[leg.{name}]\n{}", base(dice, Some(carrier))),
    );
    let mut home = Vec::new();
    let count = 1 + dice.below(2);
    for joint_index in 0..count {
        let slides = dice.chance(0.25);
        joint(text, dice, &name, &format!("j{joint_index}"), slides, None);
        let unit = if slides { "m" } else { "rad" };
        home.push(format!("j{joint_index} = \"{:?} {unit}\"", dice.angle(0.8)));
    }
    place(places, &name, &home);
    (0..count).map(|joint| format!("{name}.j{joint}")).collect()
}

/// Writes a chain between two bodies; returns the names of its own.
fn chain(
    dice: &mut Dice,
    text: &mut String,
    places: &mut String,
    index: usize,
    bodies: &[String],
) -> Vec<String> {
    let name = format!("chain{index}");
    let (from, to) = loop {
        let from = dice.chance(0.75).then(|| dice.below(bodies.len()));
        let to = dice.below(bodies.len());
        if from != Some(to) {
            break (from, to);
        }
    };
    let on = base(dice, from.map(|body| bodies[body].as_str()));
    write(text, format_args!("[leg.{name}]\n{on}"));
    let home = match dice.below(3) {
        0 => drive(dice, text, &name),
        1 => arm(dice, text, &name),
        _ => slides(dice, text, &name),
    };
    let at = [0; 3].map(|_| dice.length(0.3));
    write(
        text,
        format_args!(
            "[leg.{name}.end]\ntype = \"point\"\nbody = \"{}\"\nat = {at:?}\n",
            bodies[to]
        ),
    );
    place(places, &name, &home);
    (0..3).map(|joint| format!("{name}.j{joint}")).collect()
}

/// Two crossing axes and a slide.
fn drive(dice: &mut Dice, text: &mut String, name: &str) -> Vec<String> {
    let motor = if dice.chance(0.5) {
        "actuated = true\n"
    } else {
        ""
    };
    let fixed = "alpha = \"90 deg\"\ntheta = \"q + 90 deg\"\n";
    for joint in 0..2 {
        write(
            text,
            format_args!("[[leg.{name}.joint]]\nname = \"j{joint}\"\ntype = \"revolute\"\n{fixed}"),
        );
    }
    write(
        text,
        format_args!(
            "[[leg.{name}.joint]]\nname = \"j2\"\ntype = \"prismatic\"\nalpha = \"90 deg\"\n{motor}"
        ),
    );
    let turns = [0, 1].map(|joint| format!("j{joint} = {:?}", dice.angle(1.5)));
    let mut home: Vec<String> = turns.into();
    home.push(format!("j2 = {:?}", dice.distance(0.4, 0.9)));
    home
}

/// Three revolute joints: a shoulder of two axes, and an elbow.
fn arm(dice: &mut Dice, text: &mut String, name: &str) -> Vec<String> {
    let motor = if dice.chance(0.5) {
        "actuated = true\n"
    } else {
        ""
    };
    let (d, upper, fore) = (
        dice.length(0.1),
        dice.distance(0.6, 0.9),
        dice.distance(0.6, 0.9),
    );
    let joints = [
        format!("j0\"\ntype = \"revolute\"\n{motor}"),
        format!("j1\"\ntype = \"revolute\"\nalpha = \"90 deg\"\nd = {d:?}\n"),
        format!("j2\"\ntype = \"revolute\"\nd = {upper:?}\n"),
        format!("tip\"\ntype = \"fixed\"\nd = {fore:?}\n"),
    ];
    for joint in joints {
        write(text, format_args!("[[leg.{name}.joint]]\nname = \"{joint}"));
    }
    (0..3)
        .map(|joint| format!("j{joint} = {:?}", dice.angle(1.5)))
        .collect()
}

/// Three slides that are not parallel.
fn slides(dice: &mut Dice, text: &mut String, name: &str) -> Vec<String> {
    for joint in 0..3 {
        let twist = dice.distance(1.0, 2.0);
        let (alpha, theta) = match joint {
            0 => (0.0, dice.angle(0.5)),
            _ => (twist, dice.distance(0.8, 1.4)),
        };
        write(
            text,
            format_args!(
                "[[leg.{name}.joint]]\nname = \"j{joint}\"\ntype = \"prismatic\"\nalpha = {alpha:?}\ntheta = {theta:?}\n"
            ),
        );
    }
    (0..3)
        .map(|joint| format!("j{joint} = {:?}", dice.length(0.4)))
        .collect()
}

/// Writes a joint with any placement.
fn joint(
    text: &mut String,
    dice: &mut Dice,
    leg: &str,
    name: &str,
    slides: bool,
    antecedent: Option<String>,
) {
    let kind = if slides { "prismatic" } else { "revolute" };
    let (gamma, alpha) = (dice.angle(1.5), dice.twist());
    let (b, d, r) = (dice.length(0.2), dice.length(0.3), dice.length(0.2));
    let turn = if slides {
        format!("theta = {:?}\n", dice.angle(1.0))
    } else {
        format!("r = {r:?}\n")
    };
    let before = antecedent.unwrap_or_default();
    write(
        text,
        format_args!(
            "[[leg.{leg}.joint]]\nname = \"{name}\"\ntype = \"{kind}\"\n{before}gamma = {gamma:?}\nalpha = {alpha:?}\nb = {b:?}\nd = {d:?}\n{turn}actuated = true\n"
        ),
    );
}

/// Base frame on the ground or on a body.
fn base(dice: &mut Dice, body: Option<&str>) -> String {
    let at = [0; 3].map(|_| dice.length(0.4));
    let rotation = [0; 3].map(|_| dice.angle(1.0));
    let body = body.map_or_else(String::new, |body| format!("body = \"{body}\", "));
    format!("base = {{ {body}at = {at:?}, rotation = {rotation:?} }}\n")
}

fn place(places: &mut String, name: &str, home: &[String]) {
    write(
        places,
        format_args!(
            "[[place]]\nname = \"{name}\"\nshape = \"{name}\"\nhome = {{ {} }}\n",
            home.join(", ")
        ),
    );
}

pub(super) fn write(text: &mut String, what: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = text.write_fmt(what);
}
