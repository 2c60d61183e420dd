//! What a user asks of the generator: which functions, and how much work fewer operations are worth.

use crate::choice::Choice;
use crate::derivation::MotionInput;
use crate::float::Float;
use crate::mechanism::Mechanism;
use crate::runtime::Runtime;
use overact_core::Function;
use overact_description::Effort;
use std::collections::BTreeMap;

/// How far the work on a model is.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Progress<'p> {
    /// The robot.
    pub mechanism: &'p Mechanism,
    /// Functions that are done.
    pub done: usize,
    /// Functions in all; none as long as form and columns are chosen.
    pub functions: usize,
    /// What is begun.
    pub work: &'p str,
}

/// Who is told how far the work is; functions are told from several threads.
pub(crate) type Watcher<'a> = &'a (dyn Fn(Progress<'_>) + Sync);

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
    /// Functions that are chosen by name, where not all are wanted; what they call comes along. Generated code is
    /// an `overact::Model` where all functions are among them that such a model is asked for.
    pub functions: Option<&'a Choice>,
    /// Values of standard parameters by name (SI units), where they are known: the dynamics have them as
    /// constants, those that are missing as zero. Identification models, which tell them, are left out, and
    /// the code is no `overact::Model`.
    pub parameters: Option<&'a BTreeMap<String, f64>>,
    /// The numbers that generated code computes with.
    pub float: Float,
    /// Whether Rust is generated, in which legs that are alike may run side by side. Nothing else needs their
    /// programs.
    pub side_by_side: bool,
    /// Under which path generated Rust finds the runtime crate, where it is not `::overact`.
    pub runtime: Option<&'a Runtime>,
    /// Is told how far the work is: large robots take minutes.
    pub progress: Watcher<'a>,
}

impl Default for Request<'_> {
    fn default() -> Self {
        Self {
            effort: None,
            otherwise: Effort::Quick,
            wanted: &|_, _, _| true,
            functions: None,
            parameters: None,
            float: Float::F64,
            side_by_side: true,
            runtime: None,
            progress: &|_| {},
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
