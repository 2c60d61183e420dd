//! Descriptions of a tree and of drives between its bodies.

/// A tree of five joints: a slide and a revolute joint on the first body, two revolute joints on another branch.
pub const SKELETON: &str = r#"name = "Tree"
gravity = ["1 m/s^2", "-2 m/s^2", "-9 m/s^2"]
[leg.tree]
base = { at = ["0.1 m", "-0.2 m", "0.3 m"], rotation = ["20 deg", "-35 deg", "50 deg"] }
[[leg.tree.joint]]
name = "a"
type = "revolute"
alpha = "30 deg"
d = "0.1 m"
actuated = true
[[leg.tree.joint]]
name = "b"
type = "prismatic"
gamma = "40 deg"
alpha = "-70 deg"
d = "0.2 m"
theta = "25 deg"
actuated = true
[[leg.tree.joint]]
name = "c"
type = "revolute"
alpha = "80 deg"
d = "0.15 m"
r = "0.05 m"
actuated = true
[[leg.tree.joint]]
name = "d"
type = "revolute"
antecedent = "a"
gamma = "-100 deg"
b = "0.1 m"
alpha = "60 deg"
d = "0.25 m"
actuated = true
[[leg.tree.joint]]
name = "e"
type = "revolute"
alpha = "-45 deg"
d = "0.2 m"
actuated = true
[[place]]
name = "tree"
shape = "tree"
home = { b = "0.3 m", c = "20 deg", e = "-30 deg" }
"#;

/// A drive between two bodies: two crossing axes, and a third joint with the given keys and home
/// position.
#[must_use]
pub fn drive(name: &str, [from, to]: [&str; 2], [keys, home]: [&str; 2]) -> String {
    format!(
        r#"[leg.{name}]
base = {{ body = "{from}", at = ["0.05 m", "-0.3 m", "0.1 m"], rotation = ["15 deg", "40 deg", "-60 deg"] }}
[[leg.{name}.joint]]
type = "revolute"
alpha = "90 deg"
theta = "q + 90 deg"
[[leg.{name}.joint]]
type = "revolute"
alpha = "90 deg"
theta = "q + 90 deg"
[[leg.{name}.joint]]
alpha = "90 deg"
{keys}
[leg.{name}.end]
type = "point"
body = "{to}"
at = ["0.3 m", "0.2 m", "-0.15 m"]
[[place]]
name = "{name}"
shape = "{name}"
home = {{ 3 = "{home}" }}
"#
    )
}
