//! Every robot of `robots/` agrees with the numeric reference at random regular states, compiled (the
//! modules of `generated/`) and evaluated: joints, rates, Jacobians, both identification models, case 2
//! for every choice of kept actuators, inverse dynamics, mass matrix, internal torques.
//!
//! 1e-9 of each entry is the rounding of states whose legs and inverse Jacobian have condition numbers
//! of up to 60, with room for squared ones: pseudo-inverses come from normal equations.

use overact::{Error, Model};
use overact_codegen::assemble;
use overact_codegen::derivation::{Columns, Family, From, Selection, Underivable};
use overact_codegen::lowering::Program;
use overact_codegen::{Function, RobotModel};
use overact_tests::reference::linear::relative_difference;
use overact_tests::support::agreement::unwound;
use overact_tests::support::backend::{evaluate, matrix};
use overact_tests::support::expected::Truth;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::served::{FUNCTIONS, partitions, project};
use overact_tests::support::{Agreement, Backend, Evaluated, Failure, Sample, Served};

const TOLERANCE: f64 = 1e-9;
const STATES: usize = 200;
/// Condition number of a partition up to which the plain tolerance holds; beyond, case 2 is compared
/// with a tolerance of so many roundings times the condition number.
const PLAIN: f64 = 1e3;
const ROUNDING: f64 = 1e-12;

overact_tests::library!(compare);

fn compare(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let parameters = expected.parameters();
    let all = samples(&expected.mechanism, &parameters, STATES, 7, false)?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut report = Report::default();
    let evaluated = Evaluated(&model);
    for function in &model.functions {
        // The closure error is what Newton's method drives to zero, not a quantity of its own.
        if function.family != Family::ClosureError {
            report.function(function, &evaluated, &all, &truths)?;
        }
    }
    let served = Served(compiled);
    for (name, family) in FUNCTIONS {
        if let Some(function) = model.plain(family) {
            assert_eq!(function.name, name.name());
            report.function(function, &served, &all, &truths)?;
        }
    }
    if !model.is_tree() {
        for kept in partitions(model.mechanism.actuated().len(), model.mechanism.dof()) {
            report.partition(&kept, &model, &served, &all, &truths)?;
        }
    }
    let Report { failures, .. } = report;
    assert!(failures.is_empty(), "{stem}:\n{}", failures.join("\n"));
    Ok(())
}

#[derive(Default)]
struct Report {
    failures: Vec<String>,
}

impl Report {
    fn line(&mut self, is_good: bool, line: String) {
        println!("{line}");
        if !is_good {
            self.failures.push(line);
        }
    }

    fn function(
        &mut self,
        function: &Function,
        backend: &dyn Backend,
        all: &[Sample],
        truths: &[Truth<'_>],
    ) -> Result<(), Failure> {
        let mut agreement = Agreement::new();
        for (sample, truth) in all.iter().zip(truths) {
            let wanted = truth.output(function.family, function.from)?;
            let mut found = backend.call(&function.name, sample)?;
            if matches!(function.family, Family::Joints | Family::ActuatorPositions) {
                found.zip_apply(&wanted, |q, wanted| *q = unwound(*q, wanted));
            }
            agreement.compare(&found, &wanted);
        }
        let line = format!("{} ({}): {agreement}", function.name, backend.label());
        self.line(agreement.within(TOLERANCE), line);
        Ok(())
    }

    /// Case 2 of one partition: from the compiled robot's J_p^inv and case 1 by the runtime, and as a
    /// program of its own.
    fn partition(
        &mut self,
        kept: &[usize],
        model: &RobotModel,
        compiled: &Served<'_>,
        all: &[Sample],
        truths: &[Truth<'_>],
    ) -> Result<(), Failure> {
        let program = program_of(model, kept)?;
        let mut found = [Agreement::new(), Agreement::new()];
        let (mut worst, mut singular) = (0.0_f64, 0);
        for (sample, truth) in all.iter().zip(truths) {
            let jacobian = compiled.evaluate(overact::Function::InverseJacobian, sample)?;
            let platform = compiled.evaluate(overact::Function::IdmRedPlatform, sample)?;
            let (projected, condition) = match project(&jacobian, kept, &platform) {
                Ok(projected) => projected,
                Err(Error::SingularPartition { .. }) => {
                    assert!(truth.partition(kept).is_err(), "kept {kept:?} is regular");
                    singular += 1;
                    continue;
                }
                Err(error) => return Err(error.into()),
            };
            let partition = truth.partition(kept)?;
            let wanted = partition.regressor.select_columns(truth.standard());
            let own = program.as_ref().map(|program| {
                let output = evaluate(program, &|name| sample.input(name).ok());
                output.map(|output| matrix(program, &output))
            });
            let both = [Some(projected), own.transpose()?];
            for (agreement, found) in found.iter_mut().zip(both) {
                let Some(found) = found else { continue };
                if condition < PLAIN {
                    agreement.compare(&found, &wanted);
                } else {
                    let error = relative_difference(&found, &wanted) / condition;
                    worst = worst.max(error);
                }
            }
        }
        let [by_runtime, by_program] = &found;
        let has_program = program.is_some();
        let is_good = by_runtime.within(TOLERANCE)
            && (by_program.within(TOLERANCE) || !has_program)
            && worst < ROUNDING;
        let own = if has_program {
            by_program.to_string()
        } else {
            "singular at home".to_owned()
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

/// The program of case 2 for other kept actuators; none where they are singular at home.
fn program_of(model: &RobotModel, kept: &[usize]) -> Result<Option<Program>, Failure> {
    let selection = Selection {
        kept_actuators: kept.to_vec(),
        ..model.selection.clone()
    };
    let family = Family::IdmRedActuators(Columns::Standard);
    let joints = model.joints;
    match assemble::program(&model.mechanism, &selection, family, From::Joints, joints) {
        Ok(program) => Ok(Some(program)),
        Err(Underivable::SingularPartition) => Ok(None),
        Err(error) => Err(format!("{error:?}").into()),
    }
}
