//! Tests whether validation runs are predicted as well as training runs.
//!
//! The weighted mean square residual of a validation run is compared with those of K parts of the
//! training runs. Their logarithms have mean m and standard deviation s. One more part exceeds m +
//! t s √(1 + 1/K) with the probability of Student's distribution.

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::{Context, level::level},
        evidence::{Axis, Curve, Evidence},
    },
    estimation::intervals::distributions::student_quantile,
    result::{CrossValidation, Estimate},
    thresholds::Thresholds,
};
use overact_logs::{Error, significant};

/// Fewest parts from which the spread is estimated.
const FEWEST_PARTS: usize = 3;

/// Checks all estimates on all validation runs.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let runs = context.dataset.validation.len();
    let of_one = |one: &CrossValidation| {
        let mut estimates = context.least_squares();
        let estimate =
            estimates.find(|other| other.model == one.model && other.stage == one.stage)?;
        of_estimate(context, one, estimate, runs)
    };
    Ok(context.cross_validation.iter().filter_map(of_one).collect())
}

fn of_estimate(
    context: &Context<'_>,
    one: &CrossValidation,
    estimate: &Estimate,
    runs: usize,
) -> Option<Check> {
    let own = parts(context, estimate);
    let weighted = one.lines.iter().zip(&estimate.weights);
    let squares = weighted.map(|(line, weight)| (weight * line.residual_norm).powi(2));
    let equations: usize = one.lines.iter().map(|line| line.equations).sum();
    let held = squares.sum::<f64>() / equations.max(1) as f64;
    if own.len() < FEWEST_PARTS || held <= 0.0 {
        return None;
    }
    let logarithms: Vec<f64> = own.iter().map(|square| square.ln()).collect();
    let count = logarithms.len() as f64;
    let mean = logarithms.iter().sum::<f64>() / count;
    let squares: f64 = logarithms.iter().map(|one| (one - mean).powi(2)).sum();
    let spread = (squares / (count - 1.0) * (1.0 + 1.0 / count)).sqrt();
    // A one-sided level, divided by the number of runs.
    let quantile = student_quantile(2.0 * level(runs), count - 1.0);
    let largest = (mean + quantile * spread).exp();
    let error = one.relative_error_percent;
    let typical = error * (mean.exp() / held).sqrt();
    let beyond = (error * error - typical * typical).max(0.0).sqrt();
    let limit = Thresholds::default().held_out_growth_percent;
    let grows = held > largest && beyond > limit;
    let ratio = (held / mean.exp()).sqrt();
    let words = format!(
        "relative residual of this validation run: {} % with the {} parameters, {} times that of the training runs{}",
        significant(error, 3),
        one.stage.name(),
        significant(ratio, 2),
        if grows {
            ": the model does not generalise. Look for differences of this run, or train on more runs or on similar motions"
        } else {
            ""
        }
    );
    let curve = |name: &str, values: &[f64], first: f64| {
        let x: Vec<f64> = (0..values.len()).map(|k| first + k as f64).collect();
        let y: Vec<f64> = values.iter().map(|one| (one / mean.exp()).sqrt()).collect();
        Curve::new(name, &x, &y)
    };
    Some(
        Check::new(CheckKind::HeldOut, About::Extrapolation, words)
            .in_run(&one.run)
            .of_model(one.model)
            .of_stage(one.stage)
            .measured(ratio, "times the usual residual")
            .against(
                (largest / mean.exp()).sqrt(),
                format!(
                    "Student's test against {count} parts of the training runs, and a growth of {limit} % of the inputs"
                ),
            )
            .shown_by(Evidence {
                title: String::from("Validation run compared with training runs"),
                x: Axis::new("number of the part", ""),
                y: Axis::new("residual / usual residual", ""),
                points: vec![
                    curve("training", &own, 1.0),
                    curve("validation", &[held], count + 1.0),
                ],
                limits: vec![(largest / mean.exp()).sqrt()],
                ..Evidence::default()
            })
            .with_grade(if grows { Grade::DoNotUse } else { Grade::Use }),
    )
}

/// Weighted mean square residual of each part of the training runs.
fn parts(context: &Context<'_>, estimate: &Estimate) -> Vec<f64> {
    let Some(system) = context.system(estimate.model) else {
        return Vec::new();
    };
    let (columns, values) = (estimate.columns(), estimate.values());
    let of_part = |part: &crate::regression::system::RunPart| {
        let lines = part.lines.iter().zip(&estimate.weights);
        let squares =
            lines.map(|(line, weight)| (weight * line.residual_norm(&columns, &values)).powi(2));
        let equations: usize = part.lines.iter().map(|line| line.equations()).sum();
        squares.sum::<f64>() / equations.max(1) as f64
    };
    let all = system.parts.iter().map(of_part);
    all.filter(|square| *square > 0.0).collect()
}
