//! The stages of the generator, in order.

use crate::assemble::{cheapest, cheapest_stations, joints_by};
use crate::columns::{base_parameters, present};
use crate::combine::cheaper_columns;
use crate::derivation::{Columns, Family, From, Selection, Underivable};
use crate::description;
use crate::diagnostic::{Diagnostics, Source};
use crate::lowering::Effort;
use crate::mechanism::{self, Mechanism};
use crate::model::{Function, RobotModel};
use crate::parallel;

/// From a description's text to a robot's model: parse, check, derive, choose columns, lower. Operations
/// are searched as hard as the description says, else [`Effort::Quick`].
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile(source: &Source) -> Result<RobotModel, Diagnostics> {
    compile_with(source, None)
}

/// [`compile`] with another effort than the description's.
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile_with(source: &Source, effort: Option<Effort>) -> Result<RobotModel, Diagnostics> {
    compile_some(source, effort, &|_, _, _| true)
}

/// Which functions of a robot a model shall have.
pub type Wanted<'a> = &'a (dyn Fn(&Mechanism, Family, From) -> bool + Sync);

/// [`compile_with`] with the wanted functions only, in a part of the time.
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile_some(
    source: &Source,
    effort: Option<Effort>,
    wanted: Wanted<'_>,
) -> Result<RobotModel, Diagnostics> {
    let description = description::parse(source)?;
    let mechanism = mechanism::check(&description)?;
    let effort = effort.or(description.effort).unwrap_or_default();
    model_some(mechanism, effort, wanted).map_err(|e| mechanism::locate(&description, &e))
}

/// The model of a checked mechanism.
///
/// # Errors
/// See [`Underivable`].
pub fn model(mechanism: Mechanism, effort: Effort) -> Result<RobotModel, Underivable> {
    model_some(mechanism, effort, &|_, _, _| true)
}

/// [`model`] with the wanted functions only.
///
/// # Errors
/// See [`Underivable`].
pub fn model_some(
    mechanism: Mechanism,
    effort: Effort,
    wanted: Wanted<'_>,
) -> Result<RobotModel, Underivable> {
    let mut selection = Selection {
        kept_actuators: mechanism.kept_actuators.clone(),
        // The form of the model is chosen by what the derivation itself makes of it.
        effort: Effort::None,
        ..Selection::default()
    };
    selection.standard = present(
        &mechanism,
        &selection,
        Family::IdmRedPlatform(Columns::Standard),
    )?;
    selection.payload = present(&mechanism, &selection, Family::IdmRedPayload)?;
    selection.stations = cheapest_stations(&mechanism, &selection)?;
    let (base, exact) = base_parameters(&mechanism, &selection)?;
    selection.base = base.iter().map(|b| b.parameter).collect();
    selection.combined = cheaper_columns(&mechanism, &selection, &exact)?;
    let joints = joints_by(&mechanism, &selection)?;
    selection.effort = effort;
    let tree = mechanism.platform.is_none();
    let mut all = Family::all(&mechanism, joints);
    all.retain(|&(family, from)| wanted(&mechanism, family, from));
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
