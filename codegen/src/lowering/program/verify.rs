//! Invariants of a program.

use super::{Condition, Operand, Program};
use std::collections::HashSet;

impl Program {
    /// Checks the assumptions of all backends.
    ///
    /// Operands precede their users, constants are finite, guards and the output refer to existing
    /// values, shapes fit, and every step is needed.
    ///
    /// # Errors
    /// Describes the first violated invariant.
    pub(crate) fn verify(&self) -> Result<(), String> {
        self.verify_shapes()?;
        for (at, step) in self.steps.iter().enumerate() {
            for operand in step.operation.operands() {
                self.verify_operand(operand, at)
                    .map_err(|broken| format!("step {at} uses {broken}"))?;
            }
        }
        for (at, entry) in self.entries.iter().enumerate() {
            self.verify_operand(entry.operand, self.steps.len())
                .map_err(|broken| format!("entry {at} is {broken}"))?;
        }
        self.verify_guards()?;
        match self.uses().iter().position(|&uses| uses == 0) {
            Some(at) => Err(format!("nothing needs step {at}")),
            None => Ok(()),
        }
    }

    /// Arrays have distinct names, and the output has as many numbers as its shape.
    fn verify_shapes(&self) -> Result<(), String> {
        let mut names = HashSet::new();
        for input in &self.inputs {
            if input.name.is_empty() || !names.insert(&input.name) {
                return Err(format!("two inputs are called `{}`", input.name));
            }
        }
        let arrays = self.inputs.iter().chain([&self.output]);
        for array in arrays {
            if !(1..=2).contains(&array.shape.len()) {
                let (name, axes) = (&array.name, array.shape.len());
                return Err(format!("`{name}` has {axes} axes"));
            }
        }
        let mut wants = self.output.len();
        if !self.least_torques.is_empty() {
            let redundancy = self.entries.len() / wants.max(1);
            wants *= redundancy.max(1);
        }
        let has = self.entries.len();
        if has != wants {
            return Err(format!("there are {has} entries for {wants} numbers"));
        }
        Ok(())
    }

    /// Checks that an operand exists before step `before`; describes it if not.
    fn verify_operand(&self, operand: Operand, before: usize) -> Result<(), String> {
        match operand {
            Operand::Constant(value) if !value.is_finite() => {
                Err(format!("the constant {value}, which is no number"))
            }
            Operand::Step(at) if at >= before => {
                Err(format!("step {at}, which does not come before it"))
            }
            Operand::Input { array, index } => {
                let length = self.inputs.get(array).map(super::Array::len);
                match length.filter(|&length| index < length) {
                    Some(_) => Ok(()),
                    None => Err(format!("element {index} of input {array}, which is none")),
                }
            }
            Operand::Constant(_) | Operand::Step(_) => Ok(()),
        }
    }

    /// Guards refer to steps or inputs, and have a finite magnitude.
    fn verify_guards(&self) -> Result<(), String> {
        for (at, guard) in self.guards.iter().enumerate() {
            self.verify_operand(guard.operand, self.steps.len())
                .map_err(|broken| format!("guard {at} is on {broken}"))?;
            if let Condition::Leg { home, .. }
            | Condition::Platform { home, .. }
            | Condition::Reach { home, .. }
            | Condition::Coordinates { home }
            | Condition::Size { most: home }
            | Condition::Closed { within: home, .. } = guard.condition
                && !home.is_finite()
            {
                return Err(format!("guard {at} compares with {home}"));
            }
        }
        Ok(())
    }
}
