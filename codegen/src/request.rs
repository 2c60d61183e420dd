//! Request to the generator: functions, and the effort of the search for fewer operations.

use crate::choice::Choice;
use crate::derivation::MotionInput;
use crate::float::Float;
use crate::mechanism::Mechanism;
use crate::runtime::Runtime;
use overact_core::Function;
use overact_description::Effort;
use std::collections::BTreeMap;

/// Progress of the work on a model.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Progress<'p> {
    /// The robot.
    pub mechanism: &'p Mechanism,
    /// Number of finished functions.
    pub done: usize,
    /// Total number of functions; zero while form and columns are chosen.
    pub functions: usize,
    /// The work that begins.
    pub work: &'p str,
}

/// Callback for progress; functions report from several threads.
pub(crate) type Watcher<'a> = &'a (dyn Fn(Progress<'_>) + Sync);

/// Predicate for the functions of a model.
pub(crate) type FunctionFilter<'a> = &'a (dyn Fn(&Mechanism, Function, MotionInput) -> bool + Sync);

/// Contents of a model and effort; by default all functions that need no request, with a quick
/// search.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// Effort of the search, overriding the description.
    pub effort: Option<Effort>,
    /// Effort of the search if the description has none.
    pub otherwise: Effort,
    /// The functions that are derived, which takes most of the time, unless they are chosen by
    /// name.
    ///
    /// By default all but those that are [on request](Function::is_on_request) only.
    pub wanted: FunctionFilter<'a>,
    /// Functions chosen by name; called functions are included.
    ///
    /// Generated code is an `overact::Model` if all functions of such a model are included.
    pub functions: Option<&'a Choice>,
    /// Known values of standard parameters by name (SI units).
    ///
    /// The dynamics contain them as constants, missing ones as zero. Identification models are left
    /// out, and the code is no `overact::Model`.
    pub parameters: Option<&'a BTreeMap<String, f64>>,
    /// The floating-point type of generated code.
    pub float: Float,
    /// Whether Rust is generated, in which equal legs may run in SIMD lanes. Only Rust uses these
    /// programs.
    pub side_by_side: bool,
    /// Path of the runtime crate in generated Rust, if it is not `::overact`.
    pub runtime: Option<&'a Runtime>,
    /// Callback for progress: large robots take minutes.
    pub progress: Watcher<'a>,
}

impl Default for Request<'_> {
    fn default() -> Self {
        Self {
            effort: None,
            otherwise: Effort::Quick,
            wanted: &|_, function, _| !function.is_on_request(),
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
    /// A request for all functions with a given effort, which overrides that of the description.
    #[must_use]
    pub fn with_effort(effort: Effort) -> Self {
        Self {
            effort: Some(effort),
            ..Self::default()
        }
    }

    /// The effort for a robot with or without an effort in its description.
    #[must_use]
    pub(crate) fn effort_for(&self, described: Option<Effort>) -> Effort {
        self.effort.or(described).unwrap_or(self.otherwise)
    }
}
