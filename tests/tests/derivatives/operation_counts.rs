//! Operation counts of the derivatives of standard parameters, after a quick search.

use super::Failure;
use overact_codegen::{Effort, Request};
use overact_tests::support::{description, model_with};
use std::fmt::Write as _;

#[test]
fn operation_counts_of_four_robots_match_the_snapshot() -> Result<(), Failure> {
    let mut table = String::new();
    for stem in ["rx90", "five_bar", "dualv", "ankle"] {
        let request = Request {
            wanted: &|_, function, _| function.is_derivative() && !function.is_of_base_parameters(),
            side_by_side: false,
            ..Request::with_effort(Effort::Quick)
        };
        let model = model_with(&description(stem)?, &request)?;
        for function in &model.functions {
            let operations = function.program.cost().operations();
            writeln!(table, "{stem:8} {:32} {operations:5}", function.name)?;
        }
    }
    insta::assert_snapshot!("operation_counts", table);
    Ok(())
}
