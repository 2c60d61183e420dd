//! Each fault over many draws of the noise: grades, and errors of the values that may be used.
//!
//! - `row`: sums over the draws, and their row of the table.

mod row;

pub use row::{FaultRow, header};

use crate::{
    Failure, Subject, draw,
    traps::{Trap, identified_logs, physics, traps},
};
use rayon::prelude::*;
use row::Draw;
use std::path::Path;

/// Draws of the noise for each fault.
#[derive(Debug, Clone, Copy)]
pub struct Draws {
    /// Fraction of each run's duration, which the subject has already.
    pub part: f64,
    /// Number of draws.
    pub count: u64,
}

/// Identifies every fault whose name is `wanted`, and the faultless data, in all draws.
///
/// `print` is called for each row.
///
/// # Errors
/// A plant that cannot be simulated.
pub fn rows(
    path: &Path,
    subject: &Subject,
    draws: Draws,
    wanted: &dyn Fn(&str) -> bool,
    print: &dyn Fn(&FaultRow),
) -> Result<Vec<FaultRow>, Failure> {
    let faultless = draw::records(subject, &subject.experiment, 1.0)?;
    let mut all = vec![Trap::none()];
    all.extend(traps(subject.info().name));
    all.extend(physics(subject)?);
    let mut rows = Vec::new();
    for trap in all.iter().filter(|trap| wanted(&trap.name)) {
        let mut records = if trap.plant.is_empty() && trap.plan.is_none() {
            faultless.clone()
        } else {
            let mut plant = Subject::altered(path, &trap.plant)?;
            plant.shorten(draws.part);
            if let Some(change) = &trap.plan {
                change(&mut plant.experiment);
            }
            draw::records(&plant, &plant.experiment, 1.0)?
        };
        (trap.alter)(&mut records);
        let one = |number: u64| {
            let logs = draw::logs(subject, &records, 1.0, number);
            let result = logs.and_then(|logs| identified_logs(subject, &logs));
            result.map_or_else(
                |_| Draw::refused(),
                |one| Draw::new(&one, &trap.known, subject.info().actuators),
            )
        };
        let results: Vec<Draw> = (1..=draws.count).into_par_iter().map(one).collect();
        let row = FaultRow::new(subject.info().name, &trap.name, &results);
        print(&row);
        rows.push(row);
    }
    Ok(rows)
}
