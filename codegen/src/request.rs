//! What a user asks of the generator: which functions, and how much work fewer operations are worth.

use crate::derivation::MotionInput;
use crate::effort::Effort;
use crate::mechanism::Mechanism;
use overact_core::Function;

/// Which functions of a robot a model shall have.
pub(crate) type Wanted<'a> = &'a (dyn Fn(&Mechanism, Function, MotionInput) -> bool + Sync);

/// What a model shall have, and what work it is worth; by default all functions, quickly.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// How hard fewer operations are searched, whatever the description says.
    pub effort: Option<Effort>,
    /// How hard they are searched where the description says nothing.
    pub otherwise: Effort,
    /// Which functions are derived: most of the time goes into one after the other.
    pub wanted: Wanted<'a>,
}

impl Default for Request<'_> {
    fn default() -> Self {
        Self {
            effort: None,
            otherwise: Effort::Quick,
            wanted: &|_, _, _| true,
        }
    }
}

impl Request<'_> {
    /// All functions, with an effort that overrules the description's.
    #[must_use]
    pub fn with_effort(effort: Effort) -> Self {
        Self {
            effort: Some(effort),
            ..Self::default()
        }
    }

    /// The effort for a robot whose description asks for one, or for none.
    #[must_use]
    pub(crate) fn effort_for(&self, described: Option<Effort>) -> Effort {
        self.effort.or(described).unwrap_or(self.otherwise)
    }
}
