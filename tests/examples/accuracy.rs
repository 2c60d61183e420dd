//! Writes how many digits the regressors keep near singular configurations, as a table in Markdown:
//! `cargo run --release -p overact-tests --example accuracy [ROBOT ...]`.

use overact_codegen::Effort;
use overact_tests::support::{Failure, accuracy, library};

fn main() -> Result<(), Failure> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    println!("| robot | regressor | distance | states | as derived | searched |");
    println!("|---|---|---|---|---|---|");
    for stem in library::stems()? {
        if !asked.is_empty() && !asked.contains(&stem) {
            continue;
        }
        for row in accuracy::study(&stem, Effort::Thorough)? {
            let distance = row
                .distance
                .map_or_else(|| "regular".to_owned(), |d| format!("{d:.0e}"));
            println!(
                "| {stem} | {} | {distance} | {} | {:.1e} | {:.1e} |",
                row.function, row.states, row.derived, row.searched
            );
        }
    }
    Ok(())
}
