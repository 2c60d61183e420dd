//! Operation counts of identification models, which must be below those of other generators.
//!
//! `generated/manifest.toml` has the counts of all robots' functions. An operation is an addition,
//! a subtraction, a multiplication (also with a sign) or a division. Square roots and trigonometric
//! pairs are counted separately.

use overact::{Columns, Function};
use overact_codegen::derivation::MotionInput;
use overact_codegen::mechanism::{JointKind, Mechanism, StandardParameter};
use overact_codegen::{Effort, Request, Source, description, mechanism, model_with};
use overact_tests::support::{Failure, repository};
use overact_tier::by_tier;
use std::fmt::Write as _;
use std::fs;

/// A benchmark: description, whether it has all fourteen parameters of each joint, columns, and the
/// best known count.
struct Work {
    file: &'static str,
    full: bool,
    columns: Columns,
    best_known: usize,
}

const fn work(file: &'static str, full: bool, columns: Columns, best_known: usize) -> Work {
    Work {
        file,
        full,
        columns,
        best_known,
    }
}

/// Benchmarks, evaluated from joint angles.
///
/// The best known count is the smallest of CasADi, SymPy, SymForce, OpenSYMORO, SymPyBotics, or a
/// hand-written model.
const WORKS: [Work; 14] = [
    work("robots/dualv.toml", false, Columns::Standard, 421),
    work("robots/dualv.toml", false, Columns::Base, 357),
    work("robots/rx90.toml", true, Columns::Base, 769),
    work("tests/fixtures/puma560.toml", true, Columns::Base, 824),
    work("robots/stanford.toml", true, Columns::Base, 670),
    work("robots/kuka_lwr.toml", true, Columns::Base, 1175),
    work("robots/five_bar.toml", true, Columns::Standard, 181),
    work("robots/three_leg_point.toml", true, Columns::Standard, 231),
    work("robots/planar_3prr.toml", true, Columns::Standard, 356),
    work("robots/planar_4prr.toml", true, Columns::Standard, 457),
    work("robots/delta.toml", true, Columns::Standard, 763),
    work("robots/delta_4.toml", true, Columns::Standard, 1061),
    work("robots/hexapod.toml", true, Columns::Standard, 3343),
    work("robots/octopod.toml", true, Columns::Standard, 4377),
];

/// Mechanism with all parameters of all joints and of the platform.
fn with_all_parameters(mut mechanism: Mechanism) -> Mechanism {
    let joints = mechanism.legs.iter_mut().flat_map(|leg| &mut leg.joints);
    for joint in joints.filter(|joint| joint.kind != JointKind::Fixed) {
        joint.parameters = StandardParameter::ALL.to_vec();
    }
    if let Some(platform) = &mut mechanism.platform {
        platform.parameters = StandardParameter::INERTIA.to_vec();
        platform.payload = None;
    }
    mechanism
}

fn line(work: &Work, effort: Effort) -> Result<(String, usize), Failure> {
    let source = Source::new(work.file, fs::read_to_string(repository(work.file))?);
    let rendered = |errors: overact_codegen::Diagnostics| errors.render_plain(&source);
    let described = description::parse(&source).map_err(rendered)?;
    let mut robot = mechanism::check(&described).map_err(rendered)?;
    if work.full {
        robot = with_all_parameters(robot);
    }
    let function = Function::IdmRedPlatform(work.columns);
    let request = Request {
        wanted: &|_, f, from| f == function && from == MotionInput::Joints,
        ..Request::with_effort(effort)
    };
    let model = model_with(robot, &request).map_err(|error| format!("{error:?}"))?;
    let cost = model.functions.first().ok_or("no function")?.program.cost();
    let columns = match work.columns {
        Columns::Standard => model.selection.standard.len(),
        Columns::Base => model.selection.base.len(),
    };
    let text = format!(
        "{:28} {:>8} {columns:>4} columns {:>5} operations {:>2} pairs, best known {:>5}",
        work.file,
        format!("{:?}", work.columns).to_lowercase(),
        cost.operations(),
        cost.trigonometric_pairs,
        work.best_known,
    );
    Ok((text, cost.operations()))
}

#[test]
fn no_other_tool_takes_fewer_operations() -> Result<(), Failure> {
    let mut table = String::new();
    // The three largest take as long as all others together.
    for work in by_tier([&WORKS[..11], &WORKS[..]]) {
        let (line, operations) = line(work, Effort::Quick)?;
        assert!(operations < work.best_known, "{line}");
        writeln!(table, "{line}")?;
    }
    let name = by_tier([
        "no_other_tool_takes_fewer_operations_for_small_works",
        "no_other_tool_takes_fewer_operations",
    ]);
    insta::assert_snapshot!(name, table);
    Ok(())
}

#[test]
fn quick_search_is_within_five_percent_of_the_thorough_one() -> Result<(), Failure> {
    let mut table = String::new();
    // A thorough search of all takes most of a minute; the default tier searches three small ones.
    let works = by_tier([&WORKS[6..9], &WORKS[..]]);
    for work in works {
        let (_, quick) = line(work, Effort::Quick)?;
        let (line, operations) = line(work, Effort::Thorough)?;
        assert!(operations <= quick, "{line}");
        assert!(100 * quick <= 105 * operations, "quick {quick}; {line}");
        writeln!(table, "{line}")?;
    }
    if works.len() == WORKS.len() {
        insta::assert_snapshot!(table);
    }
    Ok(())
}
