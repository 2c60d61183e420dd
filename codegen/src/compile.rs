//! The stages of the generator, in order.

use crate::assemble::{cheapest, cheapest_stations, joints_by};
use crate::columns::{base_parameters, present};
use crate::combine::cheaper_columns;
use crate::derivation::{Columns, Family, From, Selection, Underivable};
use crate::description;
use crate::diagnostic::{Diagnostics, Source};
use crate::mechanism::{self, Mechanism};
use crate::model::{Function, RobotModel};
use crate::parallel;

/// From a description's text to a robot's model: parse, check, derive, choose columns, lower.
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile(source: &Source) -> Result<RobotModel, Diagnostics> {
    compile_some(source, &|_, _, _| true)
}

/// Which functions of a robot a model shall have.
pub type Wanted<'a> = &'a (dyn Fn(&Mechanism, Family, From) -> bool + Sync);

/// The same with the wanted functions only, in a part of the time.
///
/// # Errors
/// All errors of the description, each at its place.
pub fn compile_some(source: &Source, wanted: Wanted<'_>) -> Result<RobotModel, Diagnostics> {
    let description = description::parse(source)?;
    let mechanism = mechanism::check(&description)?;
    model_some(mechanism, wanted).map_err(|e| mechanism::locate(&description, &e))
}

/// The model of a checked mechanism.
///
/// # Errors
/// See [`Underivable`].
pub fn model(mechanism: Mechanism) -> Result<RobotModel, Underivable> {
    model_some(mechanism, &|_, _, _| true)
}

/// The same with the wanted functions only.
///
/// # Errors
/// See [`Underivable`].
pub fn model_some(mechanism: Mechanism, wanted: Wanted<'_>) -> Result<RobotModel, Underivable> {
    let mut selection = Selection {
        kept_actuators: mechanism.kept_actuators.clone(),
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
