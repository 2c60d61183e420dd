//! Skeletons with dependent joints agree with the numeric reference in all functions.
//!
//! The reference cuts every loop, keeps all joints of the tree free and closes the cuts by Lagrange
//! multipliers.

use overact_codegen::Source;
use overact_tests::support::dependent::{branch, rigid, slider, spatial, stephenson};
use overact_tests::support::{Failure, all_functions::against_reference};
use overact_tier::by_tiers;

const TOLERANCE: f64 = 1e-9;
/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [3, 20, 60];

/// Compares all functions of a description with the reference.
fn compare(text: String) -> Result<(), Failure> {
    let source = Source::new("dependent.toml", text);
    let failures = against_reference(source, by_tiers(STATES), [TOLERANCE; 2])?;
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    Ok(())
}

#[test]
fn stephensons_six_bar_agrees() -> Result<(), Failure> {
    compare(stephenson(""))
}

#[test]
fn a_redundant_motor_on_a_rod_agrees() -> Result<(), Failure> {
    compare(stephenson("actuated = true"))
}

#[test]
fn a_dependent_slide_agrees() -> Result<(), Failure> {
    compare(slider())
}

#[test]
fn a_rigid_end_that_blocks_agrees() -> Result<(), Failure> {
    compare(rigid())
}

#[test]
fn a_dependent_branch_on_a_chain_agrees() -> Result<(), Failure> {
    compare(branch())
}

#[test]
fn a_link_on_three_rods_in_space_agrees() -> Result<(), Failure> {
    compare(spatial())
}
