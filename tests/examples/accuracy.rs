//! Writes a Markdown table of the digits that the regressors keep near singular configurations.
//!
//! `cargo run --release -p overact-tests --example accuracy [ROBOT ...]`.

use overact_codegen::Effort;
use overact_tests::support::{Failure, accuracy, library};

fn main() -> Result<(), Failure> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    println!("| robot | regressor | regular | 1e-1 | 1e-2 | 1e-4 | 1e-6 | 1e-7 |");
    println!("|---|---|---|---|---|---|---|---|");
    for stem in library::stems()? {
        if !asked.is_empty() && !asked.contains(&stem) {
            continue;
        }
        let rows = accuracy::study(&stem, Effort::Thorough)?;
        for of_function in rows.chunk_by(|a, b| a.function == b.function) {
            let cell = |distance: Option<f64>| {
                let row = of_function.iter().find(|row| row.distance == distance);
                row.map_or_else(
                    || "–".to_owned(),
                    |row| format!("{:.0e} / {:.0e}", row.derived, row.searched),
                )
            };
            let distances = [None, Some(1), Some(2), Some(4), Some(6), Some(7)];
            let cells = distances.map(|k| cell(k.map(|k| 10_f64.powi(-k))));
            println!(
                "| {stem} | {} | {} |",
                of_function[0].function,
                cells.join(" | ")
            );
        }
    }
    Ok(())
}
