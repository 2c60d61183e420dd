//! Markdown table of the coverage.

use crate::Cell;
use overact_identification::Estimator;
use std::fmt::Write as _;

/// The rows of all cells.
#[must_use]
pub fn markdown(cells: &[Cell]) -> String {
    let mut text = String::from(
        "| robot | model | stage | estimator | torque noise | encoder noise | draws | parameters | coverage, % | its 99.9 % interval | width by base | spread | flagged, % | least covered |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for cell in cells {
        let [low, high] = cell.coverage_interval_percent;
        let flagged = cell.flagged_percent;
        let flagged = flagged.map_or_else(String::new, |percent| format!("{percent:.0}"));
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {:.1} | {:.1} | {low:.1} to {high:.1} | {:.2} | {:.2} | {} | `{}` {:.0} % |",
            cell.robot,
            cell.model.label(),
            cell.stage.name(),
            match cell.estimator {
                Estimator::LeastSquares => "least squares",
                Estimator::OrdinaryLeastSquares => "ordinary least squares",
                Estimator::InstrumentalVariables => "instruments",
            },
            cell.noise.torque,
            cell.noise.encoder,
            cell.draws,
            cell.parameters,
            cell.coverage_percent,
            cell.relative_width,
            cell.spread,
            flagged,
            cell.worst.0,
            cell.worst.1,
        );
    }
    text
}
