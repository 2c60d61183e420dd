//! Tests whether all cables are taut: a slack cable has no tension, and its length says nothing.

use crate::assessment::{
    check::{About, Check, CheckKind, Grade},
    checks::Context,
};
use overact_logs::{Error, significant};

/// Tension, relative to the largest of the cable, below which the cable may be slack.
///
/// Load cells have zero errors of up to one percent of their range.
const SLACK: f64 = 0.01;

/// Checks the cables in all runs.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let pulls = context.model.pulls();
    let mut checks = Vec::new();
    if pulls.is_empty() {
        return Ok(checks);
    }
    let names = context.model.info().actuators;
    let mut lowest = f64::INFINITY;
    for (log, watched) in context.runs() {
        let (least, peaks) = (
            watched.monitor.least_torques(),
            watched.monitor.torque_peaks(),
        );
        let tensions = least.into_iter().zip(peaks).zip(pulls).zip(names);
        for (((least, peak), _), name) in tensions.filter(|(((_, _), pulls), _)| **pulls) {
            lowest = lowest.min(least);
            if least > SLACK * peak {
                continue;
            }
            let words = format!(
                "the tension of the cable `{name}` falls to {} N, at most 1 % of its largest, {} N: the cable is slack there, or its load cell has a wrong zero or sign. Keep all cables taut by a higher `minimum` of the controller, tare the cells, or leave out these times",
                significant(least, 2),
                significant(peak, 2)
            );
            let check = Check::new(CheckKind::SlackCable, About::Data, words)
                .in_run(log.name())
                .of_actuator(name)
                .measured(least, "N")
                .against(SLACK * peak, "zero error of a load cell");
            checks.push(check.with_grade(Grade::DoNotUse));
        }
    }
    if checks.is_empty() {
        let words = format!(
            "all cables are taut: no tension is below {} N",
            significant(lowest, 2)
        );
        checks.push(Check::new(CheckKind::SlackCable, About::Data, words));
    }
    Ok(checks)
}
