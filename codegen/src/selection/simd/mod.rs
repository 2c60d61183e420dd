//! Programs of one leg that run for several equal legs in SIMD lanes.
//!
//! Straight code of many equal legs exceeds the instruction cache, and compilers hardly vectorise
//! it. So if legs differ by numbers only, one of them is derived with array elements in place of
//! these numbers ([`template`]). The algebra keeps their relations ([`placeholders`]): the squares
//! of a cosine and a sine that differ between legs still sum to one, and values that are equal or
//! opposite in all legs stay so. If legs are in several working modes, the signs of the roots in
//! their closed forms are such numbers, too. All legs run the same program with their own numbers.
//!
//! The result is columns of a regressor ([`columns`]), or contributions to sums that determine
//! inverse and forward dynamics ([`sums`]). Special values of a leg, such as a point on an axis,
//! save no operations then, and symmetric legs share nothing. So there are more operations than in
//! the straight program, which interpreted robots and other languages use. Both are compared at
//! random states before this one is accepted ([`outcome`]).

mod columns;
mod draft;
mod fields;
mod kept;
mod outcome;
mod placeholders;

mod sums;
mod template;

use super::assemble::Assembler;
use crate::derivation::MotionInput;
use crate::lowering::{Condition, Lanes, Profitable, Program};
use draft::Draft;
use overact_core::Function;
use template::Template;

/// Operations of a straight program above which its code exceeds an instruction cache of 32 kB.
///
/// An operation takes 19 bytes, as measured on x86-64 with regressors.
const TOO_LONG: usize = 32 * 1024 / 19;

/// Operations of a straight program, times legs, above which four lanes are faster.
const FEW: usize = 960;

/// The same above which two lanes are faster for sums, with four legs and more.
const FEW_OF_SUMS: usize = 1440;

/// The same for a mass matrix, in which two lanes lose most of what legs share.
const MANY_OF_MASSES: usize = 1000;

/// The same for a step of forward kinematics, which ends with dependent roots and quotients.
const FEW_OF_STEPS: usize = 480;

/// The smallest number of legs for which lanes are used.
const LEGS: usize = 3;

/// Largest operation counts of all legs for two and four lanes, in percent of the straight
/// program's.
const MOST: [usize; 2] = [125, 180];

/// The program of a function in lanes, if it is faster.
pub(crate) fn lane_program(
    assembler: &Assembler<'_>,
    function: Function,
    from: MotionInput,
    straight: &Program,
) -> Option<Lanes> {
    let legs = assembler.mechanism.legs.len();
    if legs < LEGS || assembler.selection.values.is_some() {
        return None;
    }
    // Motors that drive joints of several legs belong to none of them, and payloads to one.
    let mechanism = assembler.mechanism;
    if !mechanism.motors.is_empty() || !mechanism.payloads.is_empty() {
        return None;
    }
    let operations = straight.cost().operations();
    let pays = pays(function, from, legs, operations)?;
    let template = Template::of(assembler.mechanism)?;
    let draft = Draft {
        assembler,
        template: &template,
        function,
        from,
        straight,
    };
    let lanes = match function {
        Function::IdmRedPlatform(columns) => columns::lanes(&draft, columns),
        _ => sums::lanes(&draft),
    }?;
    let (shared, own) = lanes.operations();
    let [is_cheap, is_worth_four] =
        MOST.map(|most| (shared + own * legs) * 100 <= operations * most);
    let is_right = has_lanes_guards(&lanes)
        && outcome::is_regular_at_home(assembler, &lanes)
        && outcome::agrees(assembler, &lanes, straight);
    let pays = match pays {
        Profitable::Always if is_cheap => Profitable::Always,
        _ => Profitable::WithFour,
    };
    (is_worth_four && is_right).then_some(Lanes { pays, ..lanes })
}

/// The numbers of lanes that are faster than a straight program of so many operations.
///
/// `None` if none is, or if the function has no legs of its own. Two lanes lose the savings of
/// sharing between legs. With three legs they also waste half a batch and, from joints, the sines
/// of all legs at once. Four and more lanes are nearly always faster. The numbers were measured on
/// x86-64.
fn pays(
    function: Function,
    from: MotionInput,
    legs: usize,
    operations: usize,
) -> Option<Profitable> {
    let from_joints = from == MotionInput::Joints;
    let (always, with_four) = match function {
        Function::IdmRedPlatform(_) if from_joints => (TOO_LONG, 680),
        Function::IdmRedPlatform(_) => (TOO_LONG, FEW / legs),
        Function::MassMatrix(_) if !from_joints => (MANY_OF_MASSES, FEW / legs),
        Function::InverseDynamics(_)
        | Function::MassMatrix(_)
        | Function::Bias(_)
        | Function::ForwardDynamics(_) => match (from_joints, legs) {
            (true, _) => (TOO_LONG, 680),
            (false, 3) => (600, FEW / legs),
            (false, _) => (FEW_OF_SUMS / legs, FEW / legs),
        },
        Function::PoseStep => (TOO_LONG, FEW_OF_STEPS),
        _ => return None,
    };
    match operations {
        _ if operations >= always => Some(Profitable::Always),
        _ if operations >= with_four => Some(Profitable::WithFour),
        _ => None,
    }
}

/// Whether lanes support all guards that belong to legs.
fn has_lanes_guards(lanes: &Lanes) -> bool {
    let of_legs = lanes.of_legs();
    let mut own = lanes.program.guards.iter();
    own.all(|guard| {
        let is_of_leg = matches!(
            guard.condition,
            Condition::Reach { .. } | Condition::Leg { .. } | Condition::Closed { .. }
        );
        is_of_leg || !lanes.is_of_leg(guard.operand, &of_legs)
    })
}
