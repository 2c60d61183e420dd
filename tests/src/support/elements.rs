//! Adds springs, known torques and loads of friction to the joints of a description, and springs
//! and dampers between points.

use super::Failure;
use super::random::Dice;
use overact_codegen::Source;
use overact_codegen::description::{Description, parse};

/// A table of joints: its first line and those after it.
const JOINT: &str = "[[leg.";

/// The description with a spring, a known torque and load-dependent friction on every revolute and
/// prismatic joint, drawn by seed.
///
/// Formulas contain the position itself, sines of it or of its multiples, roots and quotients.
#[must_use]
pub fn with_springs(text: &str, seed: u64) -> String {
    let mut dice = Dice::new(seed ^ 0x5b7a_11e5);
    let mut changed = String::new();
    for table in tables(text) {
        let kind = table.lines().find_map(joint_type).filter(|_| {
            let header = table.lines().next().unwrap_or_default();
            header.starts_with(JOINT) && header.contains(".joint]]")
        });
        let (header, rest) = table.split_once('\n').unwrap_or((table, ""));
        changed.push_str(header);
        changed.push('\n');
        if let Some(slides) = kind {
            let turns = !slides;
            let (spring, known, load) = (
                spring(&mut dice, turns),
                known(&mut dice, turns),
                load(&mut dice, turns),
            );
            for (key, value) in [
                ("spring", spring),
                ("known", known),
                ("friction_load", load),
            ] {
                if !rest.lines().any(|line| line.starts_with(key)) {
                    changed.push_str(&format!("{key} = \"{value}\"\n"));
                }
            }
        }
        changed.push_str(rest);
    }
    changed
}

/// The text in pieces that each begin with a table's header.
fn tables(text: &str) -> Vec<&str> {
    let starts = text.match_indices('\n').map(|(at, _)| at + 1);
    let starts = starts.filter(|&at| text[at..].starts_with('['));
    let mut bounds: Vec<usize> = std::iter::once(0).chain(starts).collect();
    bounds.push(text.len());
    let pieces = bounds.windows(2).map(|ends| &text[ends[0]..ends[1]]);
    pieces.filter(|piece| !piece.is_empty()).collect()
}

/// Whether a line makes a joint prismatic; `None` if it makes it neither prismatic nor revolute.
fn joint_type(line: &str) -> Option<bool> {
    let value = line.strip_prefix("type")?.trim_start().strip_prefix('=')?;
    match value.split('#').next().unwrap_or_default().trim() {
        "\"revolute\"" => Some(false),
        "\"prismatic\"" => Some(true),
        _ => None,
    }
}

fn spring(dice: &mut Dice, turns: bool) -> String {
    let a = dice.angle(1.0);
    let forms = if turns {
        [
            format!("q - ({a:?} rad)"),
            format!("sin(q + ({a:?})) + 0.3 * sin(2*q)"),
            format!("(q + ({a:?}))^3"),
            "0.02 m * sin(q) * (1 - 0.09 m / sqrt((0.3 m)^2 + (0.05 m)^2 - 0.03 m^2 * cos(q)))"
                .to_owned(),
            format!("1 / (2 - cos(3*q - ({a:?})))"),
            format!("cos(q + ({a:?}))"),
        ]
    } else {
        [
            format!("q - ({a:?} m)"),
            format!("(q + ({a:?} m))^2"),
            "q / sqrt((0.3 m)^2 + q^2)".to_owned(),
            format!("q^3 + ({a:?} m) * q^2"),
            "1 / ((0.5 m)^2 + q^2)".to_owned(),
            "sqrt((0.3 m)^2 + q^2) - 0.2 m".to_owned(),
        ]
    };
    forms[dice.below(forms.len())].clone()
}

fn known(dice: &mut Dice, turns: bool) -> String {
    let a = dice.angle(3.0);
    let forms = if turns {
        [
            format!("2 N m * cos(q - ({a:?})) + 0.4 N m"),
            format!("({a:?} N m/rad) * (q - 0.2)"),
            format!("({a:?} N m) * sin(2*q)^2"),
        ]
    } else {
        [
            format!("20 N + ({a:?} N/m) * q"),
            format!("({a:?} N)"),
            format!("({a:?} N m^2) / ((0.4 m)^2 + q^2)"),
        ]
    };
    forms[dice.below(forms.len())].clone()
}

fn load(dice: &mut Dice, turns: bool) -> String {
    let a = dice.angle(3.0);
    let forms = if turns {
        [
            format!("4 N m * cos(q + ({a:?}))"),
            format!("3 N m/rad * (q - ({a:?}))"),
        ]
    } else {
        [
            format!("30 N/m * (q - ({a:?} m))"),
            "2 N + 5 N/m^2 * q^2".to_owned(),
        ]
    };
    forms[dice.below(forms.len())].clone()
}

/// Laws of forces between points: the keys of a table, without and with the rate of the length.
const LAWS: [&str; 6] = [
    "force = \"l - 0.1 m\"",
    "force = \"1 / (l + 0.2 m)^2\"\nknown = \"20 N + 30 N/m * l\"",
    "force = \"sqrt((0.3 m)^2 + l^2)\"",
    "known = \"5 N\"",
    "force = \"dl\"\nknown = \"40 N/m * (l - 0.2 m)\"",
    "force = \"l * dl\"\nknown = \"20 N - 3 N s/m * dl\"",
];
/// Number of the laws that do not contain the rate.
const WITHOUT_RATE: usize = 4;

/// The description with three springs between random points of random bodies, drawn by seed.
///
/// Without `dampers` no force depends on a rate.
///
/// # Errors
///
/// An invalid description.
pub fn with_point_springs(text: &str, seed: u64, dampers: bool) -> Result<String, Failure> {
    let source = Source::new("springs.toml", text);
    let robot = parse(&source).map_err(|errors| errors.render_plain(&source))?;
    let bodies = bodies(&robot);
    let mut dice = Dice::new(seed ^ 0x0a11_5b7a);
    let mut changed = text.to_owned();
    for number in 0..3 {
        let (from, to) = loop {
            let (from, to) = (dice.below(bodies.len()), dice.below(bodies.len()));
            if from != to {
                break (&bodies[from], &bodies[to]);
            }
        };
        let [a, b] = [(); 2].map(|()| [0; 3].map(|_| dice.length(0.3)));
        let law = LAWS[dice.below(if dampers { LAWS.len() } else { WITHOUT_RATE })];
        changed.push_str(&format!(
            "\n[[spring]]\nname = \"s{number}\"\nfrom = {{ body = \"{from}\", at = {a:?} }}\n\
             to = {{ body = \"{to}\", at = {b:?} }}\n{law}\n"
        ));
    }
    Ok(changed)
}

/// Names of all bodies, and of the ground.
fn bodies(robot: &Description) -> Vec<String> {
    let mut all = vec!["ground".to_owned()];
    all.extend(robot.platform.as_ref().map(|_| "platform".to_owned()));
    for leg in &robot.legs {
        let joints = leg.joints.iter().filter(|joint| joint.motor.is_none());
        all.extend(joints.map(|joint| format!("{}.{}", leg.name.value, joint.name.value)));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::with_springs;

    #[test]
    fn only_moving_joints_get_springs() {
        let text = "name = \"A\"\n[[leg.a.joint]]\ntype = \"revolute\"   # turns\n\
                    [[leg.a.joint]]\ntype = \"fixed\"\n[leg.a.end]\ntype = \"rigid\"\n";
        let changed = with_springs(text, 1);
        for key in ["spring = ", "known = ", "friction_load = "] {
            assert_eq!(changed.matches(key).count(), 1, "{changed}");
        }
        assert!(
            changed.ends_with("[[leg.a.joint]]\ntype = \"fixed\"\n[leg.a.end]\ntype = \"rigid\"\n")
        );
    }
}
