//! Common steps of programs in lanes: lowering, constants, and the owner of each input.

use super::kept::kept_columns;
use super::outcome::{at_home, of_leg, value_of};
use super::template::{ARRAY, Template};
use crate::cas::{Arena, InputElement};
use crate::derivation::{BodyParameter, Derived, MotionInput, Selection, rounded_magnitude};
use crate::lowering::{
    Column, Condition, Elements, Guard, LaneOutput, Lanes, Operand, Operation, Profitable, Program,
    fold, scatter,
};
use crate::selection::assemble::Assembler;
use overact_core::{Columns, Function, Input};

/// Input of a program in lanes.
pub(super) struct Draft<'m> {
    pub(super) assembler: &'m Assembler<'m>,
    pub(super) template: &'m Template,
    pub(super) function: Function,
    pub(super) from: MotionInput,
    /// The straight program with all legs.
    pub(super) straight: &'m Program,
}

/// A program of the template's first leg.
pub(super) struct Lowered {
    pub(super) program: Program,
    /// Index of the input with the numbers of a leg.
    array: usize,
}

impl Draft<'_> {
    /// The robot's selection, without columns of legs that are combinations of other legs' columns.
    pub(super) fn selection(&self) -> Selection {
        Selection {
            combined: Vec::new(),
            ..self.assembler.selection.clone()
        }
    }

    /// Lowers a derivation of the template.
    pub(super) fn lowered<'a>(
        &self,
        arena: &'a Arena,
        mut derived: Derived<'a>,
    ) -> Option<Lowered> {
        let first = &self.template.mechanism.legs[0].name;
        for guards in [&mut derived.guards, &mut derived.divisors] {
            guards.retain(|guard| guard.leg.is_empty() || guard.leg == *first);
        }
        let array = derived.inputs.len();
        derived.inputs.push((ARRAY, self.template.len()));
        let numbers = self.template.values(0);
        let standing = |element: InputElement| match element.array {
            ARRAY => numbers.get(element.index).copied(),
            _ => None,
        };
        let (search, mechanism) = (self.assembler.search, self.assembler.mechanism);
        let program = search.lower_with(arena, mechanism, self.function, &derived, &standing);
        let program = program.ok()?;
        Some(Lowered { program, array })
    }

    /// The program in lanes; values that depend on a leg's constants only become constants
    /// themselves.
    pub(super) fn lanes(&self, lowered: Lowered, gathered: LaneOutput) -> Option<Lanes> {
        let Lowered { program, array } = lowered;
        let mechanism = self.assembler.mechanism;
        let folded = fold(&program, array);
        let of_leg = |leg| {
            let given = |name: &str| (name == ARRAY).then(|| self.template.values(leg));
            value_of(&program, &folded.elements, &given)
        };
        let names = folded.elements.iter();
        let names = names.map(|element| said(&program, *element, &|at| self.template.name(at)));
        let names: Vec<String> = names.collect();
        let constants: Option<Vec<Vec<f64>>> = (0..mechanism.legs.len()).map(of_leg).collect();
        let mut program = folded.program;
        name_guards(&mut program, &mechanism.legs[0].name);
        let inputs = self.elements(&mut program, array)?;
        let mut lanes = Lanes {
            program,
            output: self.straight.output.clone(),
            gathered,
            pays: Profitable::Always,
            legs: mechanism.legs.iter().map(|l| l.name.clone()).collect(),
            inputs,
            constants: constants?,
            names,
            homes: Vec::new(),
        };
        lanes.homes = self.homes(&lanes)?;
        Some(lanes)
    }

    /// The owner of the elements of each input. `None` if the program reads elements of a leg other
    /// than the first.
    fn elements(&self, program: &mut Program, array: usize) -> Option<Vec<Elements>> {
        let mechanism = self.assembler.mechanism;
        let legs = mechanism.legs.len();
        let joints = mechanism.legs[0].independent().count();
        let of = |at: usize, name: &str| match name {
            _ if at == array => Elements::Constants,
            "joints" => Elements::InTurn(joints),
            "torques" | "actuators" => Elements::InTurn(mechanism.actuator_count() / legs),
            _ => Elements::Shared,
        };
        let inputs = program.inputs.iter().enumerate();
        let mut inputs: Vec<Elements> = inputs.map(|(at, input)| of(at, &input.name)).collect();
        for columns in [Columns::Standard, Columns::Base] {
            let name = input_of(columns).name();
            if let Some(at) = program.inputs.iter().position(|input| input.name == name) {
                inputs.push(self.own_parameters(program, at, columns)?);
            }
        }
        let is_own = |operand| match operand {
            Operand::Input { array, index } => match inputs[array] {
                Elements::InTurn(count) => index < count,
                _ => true,
            },
            _ => true,
        };
        program.operands().all(is_own).then_some(inputs)
    }

    /// Moves the first leg's elements of the parameter input `at` to an input of their own.
    ///
    /// `None` if the program reads those of another leg.
    fn own_parameters(
        &self,
        program: &mut Program,
        at: usize,
        columns: Columns,
    ) -> Option<Elements> {
        let parameters = self.parameters(columns);
        let (kept, columns) = kept_columns(&parameters, self.assembler.mechanism.legs.len())?;
        let mut places = vec![None; parameters.len()];
        for (at, column) in kept.into_iter().zip(columns) {
            if let Column::OfLegs(place) = column {
                places[at] = Some(place);
            }
        }
        let elements = scatter(program, at, &places);
        let is_of_another = |operand| match operand {
            Operand::Input { array, index } if array == at => {
                matches!(parameters[index], BodyParameter::Leg { .. })
            }
            _ => false,
        };
        (!program.operands().any(is_of_another)).then_some(elements)
    }

    /// The parameters in a function's parameter input.
    fn parameters(&self, columns: Columns) -> Vec<BodyParameter> {
        let selection = self.assembler.selection;
        let chosen = match columns {
            Columns::Standard => &selection.standard,
            Columns::Base => &selection.base,
        };
        [&chosen[..], &selection.payload].concat()
    }

    /// Magnitudes of guarded values at home, for each leg.
    fn homes(&self, lanes: &Lanes) -> Option<Vec<Vec<f64>>> {
        let guards: Vec<Operand> = lanes.program.guards.iter().map(|g| g.operand).collect();
        let given = |name: &str| at_home(self.assembler, name);
        let of_legs: Option<Vec<Vec<f64>>> = (0..lanes.legs.len())
            .map(|leg| {
                value_of(&lanes.program, &guards, &|name| {
                    of_leg(lanes, leg, name, &given)
                })
            })
            .collect();
        let of_legs = of_legs?;
        let of_guard = |(at, guard): (usize, &Guard)| match guard.condition {
            // Only the sign of this value matters.
            Condition::Reach { home: 0.0, .. } => vec![0.0; lanes.legs.len()],
            _ => {
                let magnitudes = of_legs.iter().map(|values| values[at].abs());
                magnitudes.map(rounded_magnitude).collect()
            }
        };
        Some(
            lanes
                .program
                .guards
                .iter()
                .enumerate()
                .map(of_guard)
                .collect(),
        )
    }
}

/// Describes an operand that depends on the numbers of a leg only.
fn said<'n>(program: &Program, operand: Operand, name: &dyn Fn(usize) -> &'n str) -> String {
    let of = |operand| said(program, operand, name);
    let inside = |operand: Operand| match operand {
        Operand::Step(_) => format!("({})", of(operand)),
        _ => of(operand),
    };
    let at = match operand {
        Operand::Constant(number) => return number.to_string(),
        Operand::Input { index, .. } => return name(index).to_owned(),
        Operand::Step(at) => at,
    };
    match program.steps[at].operation {
        Operation::Add(a, b) => format!("{} + {}", of(a), of(b)),
        Operation::Sub(a, b) => format!("{} - {}", of(a), inside(b)),
        Operation::Mul(a, b) => format!("{} * {}", inside(a), inside(b)),
        Operation::Div(a, b) => format!("{} / {}", inside(a), inside(b)),
        Operation::Neg(a) => format!("-{}", inside(a)),
        Operation::Sqrt(a) => format!("sqrt({})", of(a)),
        Operation::Sine(a) => format!("sin({})", of(a)),
        Operation::Cosine(a) => format!("cos({})", of(a)),
        Operation::Sign(a) => format!("sign({})", of(a)),
        Operation::Signed(a, b) => format!("{} * sign({})", inside(a), of(b)),
        Operation::Atan2(a, b) => format!("atan2({}, {})", of(a), of(b)),
    }
}

const fn input_of(columns: Columns) -> Input {
    match columns {
        Columns::Standard => Input::Parameters,
        Columns::Base => Input::BaseParameters,
    }
}

/// Assigns shared guards to the first leg; the leg of other guards is known at run time.
fn name_guards(program: &mut Program, first: &str) {
    for guard in &mut program.guards {
        if let Condition::Reach { leg, .. }
        | Condition::Leg { leg, .. }
        | Condition::Closed { leg, .. } = &mut guard.condition
        {
            first.clone_into(leg);
        }
    }
}
