//! Writes the platform of a robot as TOML.

use super::comment;
use crate::{
    geometry::digits::{decimal, is_zero},
    plan::PlanPlatform,
};
use std::fmt::Write as _;

/// Writes the table of the platform.
pub(super) fn toml(text: &mut String, platform: &PlanPlatform) {
    text.push('\n');
    comment(text, &platform.comment);
    let names = platform.independent.iter();
    let names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
    let _ = writeln!(
        text,
        "[platform]\nmotion = \"spatial\"\nindependent = [{}]",
        names.join(", ")
    );
    let at = ["x", "y", "z"]
        .into_iter()
        .zip(platform.home.translation.vector.iter());
    let at = at.filter(|(_, value)| !is_zero(**value));
    let at: Vec<String> = at
        .map(|(name, value)| format!("{name} = {}", decimal(*value)))
        .collect();
    if !at.is_empty() {
        let _ = writeln!(text, "home = {{ {} }}", at.join(", "));
    }
    if !platform.has_inertia {
        text.push_str("parameters = []\n");
    }
}
