//! A robot without loops with other lengths: what its torques say of them is all that is known of them.

use crate::{calibration::of_tree, interpreted::InterpretedRobot, robot::Robot};
use overact::{Columns, Function, Model};
use overact_codegen::{Effort, Request, derivation::MotionInput, mechanism::Mechanism, model_with};
use overact_identification::Variant;
use rayon::prelude::*;

/// Part of a length by which it is changed. Torques are quadratic in a length, so that a difference over
/// this step is off by as small a part.
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
    /// As an identification takes them ([`overact_identification::Dataset`]).
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
    /// This robot with each of its lengths changed in turn; none of a robot with loops, whose closure tells
    /// more of them.
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
            // A length that makes columns appear or vanish, as two that cancel do, is left out.
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

/// What an identification asks of a mechanism for its columns.
pub(crate) fn regressor(mechanism: Mechanism) -> Option<InterpretedRobot> {
    let wanted = |mechanism: &Mechanism, function: Function, from: MotionInput| {
        let asked = match function {
            Function::IdmRedPlatform(columns) => columns == Columns::Standard,
            Function::IdmRedPayload => true,
            Function::JointVelocities | Function::JointAccelerations => true,
            // Where no rule finds the joints, these do.
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
