//! Choice of the form and the columns of a robot's model, before its functions are written.
//!
//! The standard regressor of the platform projection, eq. (30), has one column per standard
//! parameter without those that are identically zero. It is derived once for each form of the
//! closures, eq. (9), and of the moments about axes that meet ([`formulation`]). For the form with
//! the fewest operations, the independent columns are found over random states in the symmetric
//! order (43) ([`columns`], [`base`]). Every other column is a constant combination of them, and is
//! written so if that takes fewer operations ([`combine`]).
//!
//! All choices have one criterion: the operations of the program that [`assemble`] makes of a
//! function in the cheapest of its [`forms`], with the search extent of [`search`]. If parameters
//! are known, [`values`] gives their numbers. Equal legs may run in SIMD lanes ([`simd`]).

mod assemble;
mod base;
mod candidate;
mod candidates;
mod columns;
mod combine;
mod formulation;
mod regressor;
mod search;
mod simd;
mod values;

pub use assemble::Assembler;
pub use base::BaseParameter;
pub(crate) use candidates::Forms;
pub use columns::sample;
pub use formulation::formulations;
pub use search::Search;
pub(crate) use simd::lane_program;
pub(crate) use values::regrouped;

use crate::cas::Arena;
use crate::derivation::{BodyParameter, DerivationError, MotionInput, Selection, derive};
use crate::mechanism::Mechanism;
use overact_core::Function;

/// Chooses form and columns of a robot's model.
///
/// # Errors
/// See [`DerivationError`].
pub(crate) fn select(
    mechanism: &Mechanism,
) -> Result<(Selection, Vec<BaseParameter>), DerivationError> {
    let mut selection = Selection {
        standard: BodyParameter::all(mechanism),
        payload: payload_columns(mechanism)?,
        kept_actuators: mechanism.kept_actuators.clone(),
        ..Selection::default()
    };
    let (formulation, regressor) = formulation::cheapest_formulation(mechanism, &selection)?;
    selection.formulation = formulation;
    selection.standard = regressor.parameters().to_vec();
    let (base, exact) = columns::base_parameters(mechanism, &selection, &regressor)?;
    selection.base = base.iter().map(|b| b.parameter).collect();
    selection.combined = combine::cheaper_columns(mechanism, &selection, &regressor, &exact)?;
    selection.joints = assemble::joints(mechanism, &selection)?;
    Ok((selection, base))
}

/// The payload's parameters whose columns are not identically zero.
fn payload_columns(mechanism: &Mechanism) -> Result<Vec<BodyParameter>, DerivationError> {
    let selection = Selection {
        payload: BodyParameter::of_payload(mechanism),
        ..Selection::default()
    };
    let arena = Arena::new();
    let derived = derive(
        &arena,
        mechanism,
        &selection,
        Function::IdmRedPayload,
        MotionInput::Joints,
    )?;
    let present = derived.present_columns();
    Ok(present.iter().map(|&c| selection.payload[c]).collect())
}
