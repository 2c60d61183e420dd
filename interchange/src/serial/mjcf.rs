//! Serial robots as MJCF.

use super::{SerialTree, centred, comment, escaped, number, numbers};
use std::fmt::Write as _;

/// The file.
pub(super) fn text(tree: &SerialTree) -> String {
    let mut out = format!("<mujoco model=\"{}\">\n", escaped(&tree.name));
    out += &comment(tree);
    out += "  <compiler angle=\"radian\" autolimits=\"true\"/>\n";
    let _ = writeln!(
        out,
        "  <option gravity=\"{}\"/>\n  <worldbody>",
        numbers(tree.gravity.as_slice())
    );
    let roots = (0..tree.bodies.len()).filter(|&at| tree.bodies[at].parent.is_none());
    roots.for_each(|root| body(tree, root, 2, &mut out));
    out += "  </worldbody>\n";
    let followers = tree
        .bodies
        .iter()
        .filter_map(|own| Some((own, own.follows?)));
    let followers: Vec<String> = followers
        .map(|(own, (leader, factor))| {
            format!(
                "    <joint joint1=\"{}\" joint2=\"{}\" polycoef=\"0 {} 0 0 0\"/>\n",
                escaped(&own.name),
                escaped(&tree.bodies[leader].name),
                number(factor)
            )
        })
        .collect();
    if !followers.is_empty() {
        let _ = writeln!(out, "  <equality>\n{}  </equality>", followers.concat());
    }
    out += "  <actuator>\n";
    for own in tree.bodies.iter().filter(|own| own.follows.is_none()) {
        let name = escaped(&own.name);
        let _ = writeln!(out, "    <motor name=\"{name}\" joint=\"{name}\"/>");
    }
    out + "  </actuator>\n</mujoco>\n"
}

/// A body with those that it carries.
fn body(tree: &SerialTree, at: usize, depth: usize, out: &mut String) {
    let own = &tree.bodies[at];
    let (indent, name) = ("  ".repeat(depth), escaped(&own.name));
    let turn = own.placement.rotation;
    let (mass, centre, inertia) = centred(&own.inertia);
    let _ = writeln!(
        out,
        "{indent}<body name=\"{name}\" pos=\"{}\" quat=\"{}\">",
        numbers(own.placement.translation.vector.as_slice()),
        numbers(&[turn.w, turn.i, turn.j, turn.k])
    );
    let _ = writeln!(
        out,
        "{indent}  <inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{}\"/>",
        numbers(centre.as_slice()),
        number(mass),
        numbers(&[
            inertia[(0, 0)],
            inertia[(1, 1)],
            inertia[(2, 2)],
            inertia[(0, 1)],
            inertia[(0, 2)],
            inertia[(1, 2)],
        ])
    );
    let kind = if own.is_revolute { "hinge" } else { "slide" };
    let armature = match own.armature {
        0.0 => String::new(),
        inertia => format!(" armature=\"{}\"", number(inertia)),
    };
    let range = if own.follows.is_some() {
        String::new()
    } else {
        format!(" range=\"{}\"", numbers(&own.range))
    };
    let _ = writeln!(
        out,
        "{indent}  <joint name=\"{name}\" type=\"{kind}\" axis=\"0 0 1\"{range}{armature}/>"
    );
    let children = (0..tree.bodies.len()).filter(|&child| tree.bodies[child].parent == Some(at));
    children.for_each(|child| body(tree, child, depth + 1, out));
    let _ = writeln!(out, "{indent}</body>");
}
