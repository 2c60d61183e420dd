//! A joint's table, read without evaluating its expressions.

use super::model::{JointKind, Spanned};
use super::reader::Item;
use super::word::Word;
use crate::diagnostic::Span;
use overact_core::StandardParameter;

/// A joint's table.
pub(super) struct JointShape<'c, 't> {
    pub(super) name: Spanned<String>,
    pub(super) kind: Spanned<JointKind>,
    pub(super) antecedent: Option<usize>,
    /// γ, b, α, d, θ, r where they are given.
    pub(super) steps: [Option<Item<'c, 't>>; 6],
    /// Whether γ and α are right angles instead: an axis within a joint of several.
    pub(super) turned: bool,
    pub(super) actuated: bool,
    pub(super) parameters: Vec<StandardParameter>,
    pub(super) spring: Option<Item<'c, 't>>,
    pub(super) known: Option<Item<'c, 't>>,
    pub(super) stribeck: Option<Item<'c, 't>>,
    pub(super) load: Option<Item<'c, 't>>,
    /// Of the slide of a helical joint, which follows the turn behind it, what it goes along for a turn.
    pub(super) pitch: Option<Item<'c, 't>>,
    /// The word of the table that it is an axis of, and the name of the table's joint.
    pub(super) word: Word,
    pub(super) called: String,
    pub(super) span: Span,
}

/// Keys of a joint's geometry, in the order of the MDH step.
pub(super) const STEPS: [&str; 6] = ["gamma", "b", "alpha", "d", "theta", "r"];

impl JointShape<'_, '_> {
    /// Name of the joint's variable in expressions of the leg: `q1`, `q_elbow`.
    pub(super) fn variable(&self) -> String {
        let name = &self.name.value;
        let numbered = name.starts_with(|c: char| c.is_ascii_digit());
        if numbered {
            format!("q{name}")
        } else {
            format!("q_{name}")
        }
    }
}
