//! Tests whether the kept actuators of the actuator projection avoid singularities.

use std::fmt::Write as _;

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::Context,
    },
    regression::{projection::ModelKind, system::PartitionCondition},
    result::{Estimate, Stage},
    thresholds::Thresholds,
};
use overact_logs::{Error, significant};

/// Checks the actuator projection.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let case_2 = context
        .estimates_of(Stage::Base)
        .filter(|one| one.model == ModelKind::Actuators);
    Ok(case_2.filter_map(|one| of_case(context, one)).collect())
}

fn of_case(context: &Context<'_>, base: &Estimate) -> Option<Check> {
    let partition = context.system(base.model)?.partition.as_ref()?;
    let limit = Thresholds::default().partition_condition;
    let kept = base.kept_actuators.join(", ");
    let good = partition.crossings == 0 && partition.largest <= limit;
    let words = if good {
        format!(
            "the condition number of the kept actuators {kept} stays below {limit}, at most {}",
            significant(partition.largest, 3)
        )
    } else {
        spoiled(context, partition, &kept, limit)
    };
    Some(
        Check::new(CheckKind::Partition, About::Model, words)
            .of_model(base.model)
            .in_run(&partition.run)
            .measured(partition.largest, "")
            .against(limit, "noise of the torques grows by the condition number")
            .with_grade(if good { Grade::Use } else { Grade::DoNotUse }),
    )
}

/// Describes a partition that comes too close to a singularity.
fn spoiled(
    context: &Context<'_>,
    partition: &PartitionCondition,
    kept: &str,
    limit: f64,
) -> String {
    let mut text = if partition.crossings > 0 {
        format!(
            "the trajectory crosses a singularity of the kept actuators {kept}, {} ({}, t = {:.3} s among them), which is not a singularity of the robot",
            match partition.crossings {
                1 => String::from("once"),
                2 => String::from("twice"),
                count => format!("{count} times"),
            },
            partition.run,
            partition.time
        )
    } else {
        format!(
            "the condition number of the kept actuators {kept} reaches {} ({}, t = {:.3} s), above {limit}",
            significant(partition.largest, 3),
            partition.run,
            partition.time,
        )
    };
    if let Some((case_1, case_2)) = lower_error(context) {
        let _ = write!(
            text,
            "; its relative error of {} % is lower than the {} % of the platform projection only because a few samples near the singularity outweigh all others",
            significant(case_2, 3),
            significant(case_1, 3)
        );
    }
    text
}

/// Relative residuals (percent) of both projections, if that of the actuator projection is lower.
///
/// Of the essential parameters, else of the base parameters.
fn lower_error(context: &Context<'_>) -> Option<(f64, f64)> {
    let error = |model: ModelKind, stage: Stage| {
        let mut all = context.estimates_of(stage);
        all.find(|one| one.model == model)
            .map(|one| one.relative_error_percent)
    };
    [Stage::Essential, Stage::Base]
        .into_iter()
        .filter_map(|stage| {
            Some((
                error(ModelKind::Platform, stage)?,
                error(ModelKind::Actuators, stage)?,
            ))
        })
        .find(|(case_1, case_2)| case_2 < case_1)
}
