//! The table in Markdown.

use crate::Cell;
use std::fmt::Write as _;

/// The rows of all cells.
#[must_use]
pub fn markdown(cells: &[Cell]) -> String {
    let mut text = String::from(
        "| robot | model | stage | torque noise | encoder noise | draws | parameters | coverage, % | its 99.9 % interval | width by base | spread | least covered |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for cell in cells {
        let [low, high] = cell.coverage_interval_percent;
        // Writing into a string does not fail.
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {:.1} | {:.1} | {low:.1} to {high:.1} | {:.2} | {:.2} | `{}` {:.0} % |",
            cell.robot,
            cell.model.case(),
            cell.stage.name(),
            cell.noise.torque,
            cell.noise.encoder,
            cell.draws,
            cell.parameters,
            cell.coverage_percent,
            cell.relative_width,
            cell.spread,
            cell.worst.0,
            cell.worst.1,
        );
    }
    text
}
