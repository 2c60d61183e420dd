//! The search for fewer operations does not cost digits: searched and derived forms compared with
//! 128-bit arithmetic.
//!
//! `docs/accuracy.md` has the numbers of the whole library.

use overact_codegen::Effort;
use overact_tests::support::{Failure, accuracy};
use overact_tier::by_tier;

/// Factor by which the errors of the forms may differ; few states make rounding a matter of chance.
const FACTOR: f64 = 10.0;
/// Relative errors below this are rounding.
const ROUNDING: f64 = 1e-12;

#[test]
fn searched_forms_are_as_accurate_as_derived_ones() -> Result<(), Failure> {
    let robots = [
        ("dualv", by_tier([Effort::Quick, Effort::Thorough])),
        ("five_bar", Effort::Thorough),
        ("rx90", Effort::Quick),
        ("delta", Effort::Quick),
        ("planar_3rrr", Effort::Quick),
        ("spherical_4rrr", Effort::Quick),
    ];
    for &(stem, effort) in by_tier([&robots[..3], &robots]) {
        let rows = accuracy::study(stem, effort)?;
        assert!(rows.len() >= 2, "{stem}: both sets of columns are studied");
        for row in rows {
            let allowed = ROUNDING + row.derived * FACTOR;
            assert!(row.searched <= allowed, "{stem}: {row:?}");
            // Far from singular configurations nearly all digits are right.
            assert!(
                row.distance.is_some() || row.searched < 1e-10,
                "{stem}: {row:?}"
            );
        }
    }
    Ok(())
}
