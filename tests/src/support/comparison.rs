//! Compares a robot's functions with the numeric reference, one line of result for each.

use super::agreement::{Agreement, unwound};
use super::backend::{evaluate, matrix};
use super::expected::Truth;
use super::frames::with_sign_of;
use super::served::project;
use super::{Backend, Failure, Sample};
use crate::reference::linear::relative_difference;
use nalgebra::DMatrix;
use overact::Error;
use overact::{Columns, FrameFunction, FrameQuantity, Function};
use overact_codegen::derivation::{DerivationError, MotionInput, Selection};
use overact_codegen::internals::{Assembler, Search};
use overact_codegen::lowering::Program;
use overact_codegen::{CompiledFunction, RobotModel};

/// Condition number of a partition above which the tolerance is this number of roundings times the
/// condition number.
const PLAIN_CONDITION: f64 = 1e3;
const ROUNDING: f64 = 1e-12;

/// Results so far.
#[derive(Debug)]
pub struct Comparison {
    tolerance: f64,
    /// A line per function.
    pub lines: Vec<String>,
    /// Lines of functions that exceed the tolerance.
    pub failures: Vec<String>,
}

impl Comparison {
    /// No comparisons yet.
    #[must_use]
    pub const fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            lines: Vec::new(),
            failures: Vec::new(),
        }
    }

    fn line(&mut self, is_good: bool, line: String) {
        if !is_good {
            self.failures.push(line.clone());
        }
        self.lines.push(line);
    }

    /// Compares a function of one backend at all samples.
    ///
    /// # Errors
    ///
    /// If the reference cannot compute it, or the backend has no value.
    pub fn function(
        &mut self,
        function: &CompiledFunction,
        backend: &dyn Backend,
        all: &[Sample],
        truths: &[Truth<'_>],
    ) -> Result<(), Failure> {
        let mut agreement = Agreement::new();
        for (sample, truth) in all.iter().zip(truths) {
            let wanted = truth.output(function.computes, function.from)?;
            let called = backend.call(&function.name, sample);
            let mut found = called.map_err(|error| format!("`{}`: {error}", function.name))?;
            if matches!(
                function.computes,
                Function::Joints | Function::ActuatorPositions | Function::PoseInClosedForm
            ) {
                found.zip_apply(&wanted, |q, wanted| *q = unwound(*q, wanted));
            }
            if let Function::Frame(FrameFunction {
                quantity: FrameQuantity::Pose,
                ..
            }) = function.computes
            {
                with_sign_of(&mut found, &wanted);
            }
            agreement.compare(&found, &wanted);
        }
        let line = format!("{} ({}): {agreement}", function.name, backend.label());
        self.line(agreement.within(self.tolerance), line);
        Ok(())
    }

    /// Compares the actuator projection of one partition.
    ///
    /// It is computed by the runtime from the backend's J_p^inv and Γ¹, and on request by a program
    /// of its own.
    ///
    /// # Errors
    ///
    /// If a function has no value, or the partition is regular where the runtime says that it is
    /// not.
    pub fn partition(
        &mut self,
        (kept, as_program): (&[usize], bool),
        model: &RobotModel,
        backend: &dyn Backend,
        all: &[Sample],
        truths: &[Truth<'_>],
    ) -> Result<(), Failure> {
        let program = if as_program {
            program_of(model, kept)?
        } else {
            None
        };
        let mut found = [Agreement::new(), Agreement::new()];
        let (mut worst, mut singular) = (0.0_f64, 0);
        for (sample, truth) in all.iter().zip(truths) {
            let jacobian = backend.call("inverse_jacobian", sample)?;
            let regressor = backend.call("idm_red_platform", sample)?;
            let (projected, condition) = match project(&jacobian, kept, &regressor) {
                Ok(projected) => projected,
                Err(Error::SingularPartition { .. }) if truth.partition(kept).is_err() => {
                    singular += 1;
                    continue;
                }
                Err(error) => return Err(format!("kept {kept:?}: {error}").into()),
            };
            let wanted = truth.partition(kept)?.regressor;
            let wanted = wanted.select_columns(truth.standard());
            let own = program.as_ref().map(|program| own_output(program, sample));
            for (agreement, found) in found.iter_mut().zip([Some(projected), own.transpose()?]) {
                let Some(found) = found else { continue };
                if condition < PLAIN_CONDITION {
                    agreement.compare(&found, &wanted);
                } else {
                    worst = worst.max(relative_difference(&found, &wanted) / condition);
                }
            }
        }
        let [by_runtime, by_program] = &found;
        let tolerable = |a: &Agreement| a.is_empty() || a.within(self.tolerance);
        let is_good = tolerable(by_runtime) && tolerable(by_program) && worst < ROUNDING;
        let own = match (as_program, program.is_some()) {
            (true, true) => by_program.to_string(),
            (true, false) => "singular".to_owned(),
            (false, _) => "not derived".to_owned(),
        };
        self.line(
            is_good,
            format!(
                "case 2, kept {kept:?}: {by_runtime}; by its own program: {own}; ill-conditioned: \
                 {worst:.1e} times the condition number; singular at {singular} states"
            ),
        );
        Ok(())
    }
}

fn own_output(program: &Program, sample: &Sample) -> Result<DMatrix<f64>, Failure> {
    let output = evaluate(program, &|name| sample.input(name).ok())?;
    Ok(matrix(program, &output))
}

/// Program of the actuator projection for other kept actuators; `None` if these are singular at
/// home.
fn program_of(model: &RobotModel, kept: &[usize]) -> Result<Option<Program>, Failure> {
    let selection = Selection {
        kept_actuators: kept.to_vec(),
        ..model.selection.clone()
    };
    let function = Function::IdmRedActuators(Columns::Standard);
    let assembler = Assembler {
        mechanism: &model.mechanism,
        selection: &selection,
        search: &Search::none(),
    };
    match assembler.program(function, MotionInput::Joints) {
        Ok(program) => Ok(Some(program)),
        Err(DerivationError::SingularPartition) => Ok(None),
        Err(error) => Err(format!("{error:?}").into()),
    }
}
