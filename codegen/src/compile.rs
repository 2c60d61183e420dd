//! The stages of the generator, in order.

use crate::derivation::{Columns, Family, From, Selection, Underivable};
use crate::description;
use crate::diagnostic::{Diagnostics, Source};
use crate::lowering::{Effort, Reach};
use crate::mechanism::states::{Spread, spread_states};
use crate::mechanism::{self, Mechanism};
use crate::model::{Function, RobotModel};
use crate::parallel;
use crate::selection::assemble::{cheapest, joints_by};
use crate::selection::columns::{base_parameters, present};
use crate::selection::combine::cheaper_columns;
use crate::selection::formulation::cheapest_formulation;

/// States of each kind by which the search compares the digits of forms.
const STATES: usize = 16;

/// Which functions of a robot a model shall have.
pub type Wanted<'a> = &'a (dyn Fn(&Mechanism, Family, From) -> bool + Sync);

/// What a model shall have, and what work it is worth; by default all functions, quickly.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// How hard fewer operations are searched, whatever the description says.
    pub effort: Option<Effort>,
    /// The same where the description says nothing.
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
}

/// From a description's text to a robot's model: parse, check, derive, choose columns, lower.
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile(source: &Source) -> Result<RobotModel, Diagnostics> {
    compile_with(source, &Request::default())
}

/// [`compile`] of what is asked for.
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile_with(source: &Source, request: &Request<'_>) -> Result<RobotModel, Diagnostics> {
    let description = description::parse(source)?;
    let mechanism = mechanism::check(&description)?;
    let request = Request {
        effort: request.effort.or(description.effort),
        ..*request
    };
    model_with(mechanism, &request).map_err(|e| mechanism::locate(&description, &e))
}

/// The model of a checked mechanism.
///
/// # Errors
/// See [`Underivable`].
pub fn model(mechanism: Mechanism) -> Result<RobotModel, Underivable> {
    model_with(mechanism, &Request::default())
}

/// [`model`] of what is asked for.
///
/// # Errors
/// See [`Underivable`].
pub fn model_with(mechanism: Mechanism, request: &Request<'_>) -> Result<RobotModel, Underivable> {
    let mut selection = Selection {
        kept_actuators: mechanism.kept_actuators.clone(),
        // The form of the model is chosen by what the derivation itself makes of it.
        reach: Reach::Nothing,
        ..Selection::default()
    };
    selection.standard = present(
        &mechanism,
        &selection,
        Family::IdmRedPlatform(Columns::Standard),
    )?;
    selection.payload = present(&mechanism, &selection, Family::IdmRedPayload)?;
    selection.formulation = cheapest_formulation(&mechanism, &selection)?;
    let (base, exact) = base_parameters(&mechanism, &selection)?;
    selection.base = base.iter().map(|b| b.parameter).collect();
    selection.combined = cheaper_columns(&mechanism, &selection, &exact)?;
    let joints = joints_by(&mechanism, &selection)?;
    selection.reach = request.effort.unwrap_or(request.otherwise).reach();
    if selection.reach > Reach::Nothing {
        let of = |&spread: &Spread| spread_states(&mechanism, STATES, 7, spread);
        selection.states = parallel::map(&[Spread::NEAR, Spread::FAR], of);
    }
    let tree = mechanism.platform.is_none();
    let mut all = Family::all(&mechanism, joints);
    all.retain(|&(family, from)| (request.wanted)(&mechanism, family, from));
    let functions = parallel::map(&all, |&(family, from)| {
        let program = cheapest(&mechanism, &selection, family, from, joints)?;
        let name = family.function_name(from, tree);
        Ok(Function {
            name,
            family,
            from,
            program,
        })
    });
    let functions = functions.into_iter().collect::<Result<_, Underivable>>()?;
    Ok(RobotModel {
        mechanism,
        selection,
        base,
        joints,
        functions,
    })
}
