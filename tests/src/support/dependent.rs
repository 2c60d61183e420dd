//! Descriptions of skeletons with dependent joints.
//!
//! Homes and lengths are rounded, so that the chains close only after Newton's iteration.

/// A revolute joint with lines of its own.
fn joint(leg: &str, name: &str, lines: &str) -> String {
    format!("[[leg.{leg}.joint]]\nname = \"{name}\"\ntype = \"revolute\"\n{lines}\n")
}

/// A rod with a pin at its base and a point end on a body.
fn rod(name: &str, base: &str, end: &str, length: &str) -> String {
    let pin = joint(name, "pin", "");
    format!(
        "[leg.{name}]\nbase = {{ {base} }}\nend = {{ type = \"point\", {end} }}\n{pin}\
         [[leg.{name}.joint]]\nname = \"tip\"\ntype = \"fixed\"\nd = \"{length}\"\nparameters = []\n"
    )
}

/// A placement of a shape of the same name.
fn place(name: &str, home: &str) -> String {
    format!("[[place]]\nname = \"{name}\"\nshape = \"{name}\"\nhome = {{ {home} }}\n")
}

/// The head of a robot in the vertical plane, whose first leg is the skeleton.
fn head(skeleton: &str) -> String {
    format!("name = \"Dependent\"\n[leg.skeleton.base]\nrotation = [\"90 deg\", 0, 0]\n{skeleton}")
}

/// Base of a chain on the ground, in the axes of the plane.
const GROUND: &str = "rotation = [\"90 deg\", 0, 0], at";
const MOTOR: &str = "actuated = true";
const DEPENDENT: &str = "dependent = true";

/// Stephenson's six-bar: a link on three rods of unknown positions.
///
/// `motor` are lines of the pin of the rod on the ground.
#[must_use]
pub fn stephenson(motor: &str) -> String {
    let skeleton = [
        joint("skeleton", "crank", MOTOR),
        joint("skeleton", "coupler", &format!("d = 0.25\n{DEPENDENT}")),
        joint("skeleton", "link", &format!("d = 0.22\n{DEPENDENT}")),
    ];
    let inner = "body = \"crank\", at = [0.14, -0.05, 0]";
    let outer = rod(
        "outer",
        &format!("{GROUND} = [0.36, 0, 0.03]"),
        "body = \"link\", at = [0.08, -0.13, 0]",
        "136 mm",
    );
    let pin = "name = \"pin\"\n";
    [
        head(&skeleton.concat()),
        rod(
            "inner",
            inner,
            "body = \"link\", at = [0.03, -0.09, 0]",
            "222 mm",
        ),
        outer.replace(pin, &format!("{pin}{motor}\n")),
        place(
            "skeleton",
            "crank = \"75 deg\", coupler = \"-57 deg\", link = \"-29 deg\"",
        ),
        place("inner", "pin = \"-50 deg\""),
        place("outer", "pin = \"103 deg\""),
    ]
    .concat()
}

/// A crank with a slider on it, which a rod from the ground moves.
#[must_use]
pub fn slider() -> String {
    let slide = "[[leg.skeleton.joint]]\nname = \"slide\"\ntype = \"prismatic\"\nd = 0.05\n\
                 alpha = \"90 deg\"\ndependent = true\n";
    [
        head(&(joint("skeleton", "crank", MOTOR) + slide)),
        rod(
            "rod",
            &format!("{GROUND} = [0.3, 0, 0.1]"),
            "body = \"slide\", at = [0.02, 0, 0.03]",
            "0.3 m",
        ),
        place("skeleton", "crank = \"40 deg\", slide = 0.2"),
        place("rod", "pin = \"100 deg\""),
    ]
    .concat()
}

/// A crank and a coupler, whose end a chain of two joints with a rigid end guides.
#[must_use]
pub fn rigid() -> String {
    let coupler = format!("d = 0.2\n{DEPENDENT}");
    let chain = format!(
        "[leg.chain]\nbase = {{ {GROUND} = [0.5, 0, 0.05] }}\n\
         end = {{ body = \"coupler\", at = [0.15, 0.02, 0], rotation = [0, 0, \"70 deg\"] }}\n"
    );
    [
        head(&(joint("skeleton", "crank", MOTOR) + &joint("skeleton", "coupler", &coupler))),
        chain,
        joint("chain", "a", ""),
        joint("chain", "b", "d = 0.3"),
        place("skeleton", "crank = \"80 deg\", coupler = \"-50 deg\""),
        place("chain", "a = \"140 deg\", b = \"-40 deg\""),
    ]
    .concat()
}

/// A four-bar whose coupler carries a link on a branch, which a rod from the ground moves.
#[must_use]
pub fn branch() -> String {
    let chain = format!(
        "[leg.bar]\nbase = {{ {GROUND} = [0.4, 0, 0] }}\n\
         end = {{ body = \"crank\", type = \"point\", at = [0.15, 0, 0] }}\n"
    );
    let tip = "[[leg.bar.joint]]\nname = \"tip\"\ntype = \"fixed\"\nd = 0.35\nparameters = []\n";
    [
        head(&joint("skeleton", "crank", MOTOR)),
        chain,
        joint("bar", "rocker", ""),
        joint("bar", "coupler", "d = 0.25"),
        tip.to_owned(),
        "[leg.arm.base]\nbody = \"bar.coupler\"\nat = [0.1, 0.08, 0]\n".to_owned(),
        joint("arm", "swing", DEPENDENT),
        rod(
            "rod",
            &format!("{GROUND} = [0.1, 0, 0.4]"),
            "body = \"arm.swing\", at = [0.12, 0.02, 0]",
            "0.2 m",
        ),
        place("skeleton", "crank = \"70 deg\""),
        place("bar", "rocker = \"110 deg\", coupler = \"80 deg\""),
        place("arm", "swing = \"-60 deg\""),
        place("rod", "pin = \"-20 deg\""),
    ]
    .concat()
}

/// An arm in space whose last link hangs on a ball joint and on three rods with universal joints.
#[must_use]
pub fn spatial() -> String {
    let across = format!("gamma = \"90 deg\"\nalpha = \"90 deg\"\n{DEPENDENT}");
    let mut text = [
        "name = \"Dependent\"\ngravity = [1.0, -2.0, -9.0]\n".to_owned(),
        joint("skeleton", "turn", MOTOR),
        joint("skeleton", "lift", &format!("alpha = \"90 deg\"\n{MOTOR}")),
        joint("skeleton", "yaw", &format!("d = 0.3\n{DEPENDENT}")),
        joint("skeleton", "pitch", &across),
        joint("skeleton", "roll", &across),
    ]
    .concat();
    let rods = [
        ("a", "[0.45, 0.1, -0.35]", "[0.12, 0.02, 0.03]", "0.344 m"),
        ("b", "[0.2, 0.35, -0.25]", "[-0.02, 0.13, -0.05]", "0.326 m"),
        ("c", "[0.35, -0.3, -0.2]", "[0.03, -0.04, 0.14]", "0.428 m"),
    ];
    for (name, base, end, length) in rods {
        let own = rod(
            name,
            &format!("at = {base}"),
            &format!("body = \"roll\", at = {end}"),
            length,
        );
        let swing = joint(name, "swing", "gamma = \"90 deg\"\nalpha = \"90 deg\"");
        let tip = format!("[[leg.{name}.joint]]\nname = \"tip\"");
        text += &own.replace(&tip, &format!("{swing}{tip}"));
    }
    text + &[
        place(
            "skeleton",
            "turn = 0.3, lift = -0.2, yaw = 0.2, pitch = 0.25, roll = -0.15",
        ),
        place("a", "pin = \"135 deg\", swing = \"57 deg\""),
        place("b", "pin = \"-136 deg\", swing = \"26 deg\""),
        place("c", "pin = \"16 deg\", swing = \"39 deg\""),
    ]
    .concat()
}

/// Stephenson's six-bar with springs, a payload, frames, a motor of two joints, and friction.
#[must_use]
pub fn equipped() -> String {
    let spring = "spring = \"q - 20 deg\"\nstribeck = 0.1\n";
    let link = "name = \"link\"\ntype = \"revolute\"\n";
    let text = stephenson(spring).replace(link, &format!("{link}{spring}"));
    text + r#"
[motor.both]
turns = "outer.q_pin - 0.5 * skeleton.q_link"

[payload.box]
body = "link"
at = [0.1, 0.02, 0.03]
rotation = [0.2, 0, "20 deg"]

[frame.tool]
body = "link"
at = [0.05, -0.02, 0.01]
rotation = [0.1, 0, 0]

[frame.rod]
body = "outer.pin"
at = [0.07, 0, 0]

[[spring]]
name = "gas"
from = { body = "inner.pin", at = [0.1, 0.02, 0] }
to = { body = "link", at = [0.1, 0.02, 0] }
force = "l - 0.05 m"
known = "3 N s/m * dl"

[[spring]]
name = "hook"
from = { body = "ground", at = [0.2, 0.1, 0.5] }
to = { body = "link", at = [0.02, 0.03, 0] }
force = "l - 0.1 m"
"#
}
