//! Serial robots with changed lengths; only their torques contain information on lengths.

use crate::{calibration::of_tree, interpreted::InterpretedRobot, robot::Robot};
use overact::{Columns, Function, Model};
use overact_codegen::{Effort, Request, derivation::MotionInput, mechanism::Mechanism, model_with};
use overact_identification::Variant;
use rayon::prelude::*;

/// Relative change of a length.
///
/// Torques are quadratic in a length, so the relative error of the difference quotient is of the
/// same order.
const STEP: f64 = 1e-5;

/// A robot with each of its lengths changed in turn.
#[derive(Debug)]
pub struct Variants(Vec<Own>);

#[derive(Debug)]
struct Own {
    length: String,
    step: f64,
    model: InterpretedRobot,
}

impl Variants {
    /// Variants as an identification takes them ([`overact_identification::Dataset`]).
    #[must_use]
    pub fn lent(&self) -> Vec<Variant<'_>> {
        let lent = self.0.iter().map(|own| Variant {
            length: &own.length,
            step: own.step,
            model: &own.model,
        });
        lent.collect()
    }
}

impl Robot {
    /// This robot with each of its lengths changed in turn.
    ///
    /// Empty for robots with loops, whose closures determine lengths better.
    #[must_use]
    pub fn variants(&self) -> Variants {
        let described = self.model();
        let mechanism = &described.model().mechanism;
        let changed = of_tree(mechanism).into_par_iter();
        let changed = changed.filter_map(|(place, length, value)| {
            let step = STEP * value.abs();
            let mut mechanism = mechanism.clone();
            place.length.add(mechanism.legs.get_mut(place.leg)?, step);
            let model = regressor(mechanism)?;
            // Omit a length whose change adds or removes columns, as for lengths that cancel.
            let same = model.info().parameters == described.info().parameters;
            same.then_some(Own {
                length,
                step,
                model,
            })
        });
        Variants(changed.collect())
    }
}

/// Compiles only the functions that an identification needs for its columns.
pub(crate) fn regressor(mechanism: Mechanism) -> Option<InterpretedRobot> {
    let wanted = |mechanism: &Mechanism, function: Function, from: MotionInput| {
        let asked = match function {
            Function::IdmRedPlatform(columns) => columns == Columns::Standard,
            Function::IdmRedPayload => true,
            Function::JointVelocities | Function::JointAccelerations => true,
            // Joints without a closed form need these.
            Function::ClosureError | Function::LegsJacobian => true,
            _ => false,
        };
        asked && InterpretedRobot::serves(mechanism, function, from)
    };
    let request = Request {
        wanted: &wanted,
        side_by_side: false,
        ..Request::with_effort(Effort::None)
    };
    Some(InterpretedRobot::new(model_with(mechanism, &request).ok()?))
}
