//! Operation counts of the functions of frames and of all masses, after a thorough search.

use super::{Failure, is_tested};
use overact_codegen::{Effort, Request, Source};
use overact_compiled::framed;
use overact_tests::support::{description, model_with};
use std::fmt::Write as _;

#[test]
fn operation_counts_of_four_robots_match_the_snapshot() -> Result<(), Failure> {
    let robots = [
        ("rx90", framed::rx90::FRAMES),
        ("dualv", framed::dualv::FRAMES),
        ("hexapod", framed::hexapod::FRAMES),
        ("delta", framed::delta::FRAMES),
    ];
    let mut table = String::new();
    for (stem, frames) in robots {
        let Source { name, text } = description(stem)?;
        let source = Source::new(name, format!("{text}\n{frames}"));
        let request = Request {
            wanted: &|_, function, _| is_tested(function),
            side_by_side: false,
            ..Request::with_effort(Effort::Thorough)
        };
        let model = model_with(&source, &request)?;
        for function in &model.functions {
            let cost = function.program.cost();
            writeln!(
                table,
                "{stem:8} {:24} {:5} operations {:2} pairs {:2} roots",
                function.name,
                cost.operations(),
                cost.trigonometric_pairs,
                cost.square_roots,
            )?;
        }
    }
    insta::assert_snapshot!("operation_counts", table);
    Ok(())
}
