//! A joint's table with unevaluated expressions.

pub(crate) mod compound;
pub(crate) mod compound_kind;

use crate::diagnostic::Span;
use crate::robot::joint_shape::compound_kind::CompoundJointKind;
use crate::robot::model::{JointKind, Spanned};
use crate::toml_text::reader::Item;
use overact_core::StandardParameter;

/// A joint's table.
pub(crate) struct JointShape<'c, 't> {
    pub(crate) name: Spanned<String>,
    pub(crate) kind: Spanned<JointKind>,
    pub(crate) antecedent: Option<usize>,
    /// γ, b, α, d, θ, r as far as given.
    pub(crate) steps: [Option<Item<'c, 't>>; 6],
    /// Whether γ and α are right angles instead: for an inner axis of a joint with several axes.
    pub(crate) turned: bool,
    pub(crate) actuated: bool,
    /// `dependent = true`: the chains determine the joint.
    pub(crate) dependent: Option<Item<'c, 't>>,
    pub(crate) parameters: Vec<StandardParameter>,
    pub(crate) spring: Option<Item<'c, 't>>,
    pub(crate) known: Option<Item<'c, 't>>,
    pub(crate) stribeck: Option<Item<'c, 't>>,
    pub(crate) load: Option<Item<'c, 't>>,
    /// Pitch of the slide of a helical joint, which is coupled to the rotation after it.
    pub(crate) pitch: Option<Item<'c, 't>>,
    /// The compound joint of which it is an axis, and the name of the table's joint.
    pub(crate) word: CompoundJointKind,
    pub(crate) called: String,
    pub(crate) span: Span,
}

/// Keys of a joint's geometry, in the order of the modified Denavit-Hartenberg step.
pub(crate) const STEPS: [&str; 6] = ["gamma", "b", "alpha", "d", "theta", "r"];

impl JointShape<'_, '_> {
    /// Name of the joint's variable in expressions of the leg: `q1`, `q_elbow`.
    pub(crate) fn variable(&self) -> String {
        variable_name(&self.name.value)
    }
}

/// Name of the variable of a joint of this name.
pub(crate) fn variable_name(joint: &str) -> String {
    let numbered = joint.starts_with(|c: char| c.is_ascii_digit());
    if numbered {
        format!("q{joint}")
    } else {
        format!("q_{joint}")
    }
}
