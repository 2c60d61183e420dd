//! Legs that are alike, side by side: the program of one leg, to be run in the lanes of vectors.
//!
//! Straight code of many equal legs is longer than an instruction cache, and the compiler finds hardly any vectors
//! in it. So where legs differ in nothing but numbers, one of them is derived with elements of an array in the
//! place of these numbers ([`template`]), which keeps all that the algebra knows of them: a cosine and a sine
//! that differ from leg to leg still have squares that add up to one, and what is equal or opposite in all legs stays so
//! ([`stands`]). Where legs are in several working modes, the signs of the roots in their closed forms are such numbers, too.
//! The other legs are the same program with their numbers. What it gives are columns of a regressor ([`columns`]), or what a leg adds to sums from which inverse
//! and forward dynamics follow ([`sums`]). Special values of a leg, a point on an axis for instance, bring nothing
//! then, and nothing is shared between legs that lie symmetrically, so there are more operations than in the
//! straight program, which interpreted robots and other languages keep. Both are compared at random states
//! before this one is taken ([`outcome`]).

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
use crate::lowering::{Condition, Lanes, Pays, Program};
use draft::Draft;
use overact_core::Function;
use template::Template;

/// Operations of a straight program from which its code is longer than an instruction cache of 32 kB: it has 19 bytes
/// for each, as measured on x86-64 with regressors.
const TOO_LONG: usize = 32 * 1024 / 19;

/// Operations of a straight program, times legs, from which four lanes win.
const FEW: usize = 960;

/// Those from which two lanes win where sums are what is computed, with four legs and more.
const FEW_OF_SUMS: usize = 1440;

/// Those of a mass matrix, of which two lanes lose most of what legs share.
const MANY_OF_MASSES: usize = 1000;

/// Those of a step of forward kinematics, at whose end roots and quotients wait for each other.
const FEW_OF_STEPS: usize = 480;

/// The fewest legs that are worth it.
const LEGS: usize = 3;

/// Operations of all legs with which two lanes are still worth it, in hundredths of the straight program's; and four.
const MOST: [usize; 2] = [125, 180];

/// The program of a function in lanes, where that is the faster one.
pub(crate) fn beside(
    assembler: &Assembler<'_>,
    function: Function,
    from: MotionInput,
    straight: &Program,
) -> Option<Lanes> {
    let legs = assembler.mechanism.legs.len();
    if legs < LEGS || assembler.selection.values.is_some() {
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
        Pays::Always if is_cheap => Pays::Always,
        _ => Pays::WithFour,
    };
    (is_worth_four && is_right).then_some(Lanes { pays, ..lanes })
}

/// Which lanes are faster than a straight program of so many operations. None if none are, or if the function has no legs
/// of its own.
///
/// Two lanes lose what sharing between legs saves, with three legs also a half of a turn, and from joints the sines of all
/// legs at once; four and more win nearly always. The numbers are measured, on x86-64.
fn pays(function: Function, from: MotionInput, legs: usize, operations: usize) -> Option<Pays> {
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
        _ if operations >= always => Some(Pays::Always),
        _ if operations >= with_four => Some(Pays::WithFour),
        _ => None,
    }
}

/// Whether all guards that belong to legs are such that lanes have.
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
