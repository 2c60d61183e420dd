//! Table of the errors of every drive.

use crate::{
    layout::table,
    line_errors::{ErrorRow, cells, rows},
};
use overact_identification::Identification;

/// Titled table of root mean square, relative error and fit on training and validation runs.
pub(super) fn errors(identification: &Identification) -> String {
    let rows = rows(identification);
    if rows.is_empty() {
        return String::new();
    }
    let is_validated = rows.iter().any(|row| row.validation.is_some());
    let mut header = vec!["residual of", "unit", "rms", "error %", "fit %"];
    if is_validated {
        header.extend(["validation rms", "error %", "fit %"]);
    }
    let row = |one: &ErrorRow<'_>| {
        let name = match one.model {
            Some(model) => format!("{} ({model})", one.name),
            None => one.name.to_owned(),
        };
        let mut row = vec![name, one.unit.to_owned()];
        row.extend(cells(one.training));
        if is_validated {
            row.extend(cells(one.validation));
        }
        row
    };
    let title = if is_validated {
        "Residuals of the training runs and of the worst validation run"
    } else {
        "Residuals of the training runs"
    };
    format!(
        "\n{title}\n{}",
        table(&header, rows.iter().map(row).collect())
    )
}
