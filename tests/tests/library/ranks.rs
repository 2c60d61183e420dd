//! Number of base parameters of ten structures: ranks of the standard regressor over random states.
//!
//! Each structure is a robot of `robots/` with three lists of parameters:
//!
//! - all 14 of every joint and the platform's 10;
//! - those without the inertia of massless bodies and the rotors of passive joints;
//! - those without friction and offsets.
//!
//! The reference's regressor, from Lagrange multipliers, and the generated one must have the
//! expected rank, which is the number of base parameters. Columns are scaled to unit length. The
//! singular value after the last that counts must be at least four decades smaller.

use nalgebra::DMatrix;
use overact::{Columns, Function};
use overact_codegen::Effort;
use overact_codegen::derivation::MotionInput;
use overact_codegen::mechanism::{JointKind, Mechanism, StandardParameter};
use overact_codegen::{Request, model_with};
use overact_codegen::{description, mechanism};
use overact_tests::support::conversion::reference;
use overact_tests::support::description as described;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::{is_of_the_tier, workspace};
use overact_tests::support::rank::{Rank, regressor};
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, Sample};
use overact_tier::is_full;

/// Rows per column; enough to avoid small singular values by chance.
const ROWS: usize = 3;
/// Number of base parameters from which ranks take seconds.
const SLOW_RANK: usize = 60;

/// Parameter lists.
#[derive(Clone, Copy, Debug)]
enum Lists {
    /// All of every joint and of the platform.
    All,
    /// Without massless bodies' inertia and passive joints' rotors.
    Real,
    /// Of these, without friction and offsets.
    Frictionless,
}

/// The mechanism of a description with other lists of parameters.
fn with_lists(stem: &str, lists: Lists) -> Result<Mechanism, Failure> {
    let source = described(stem)?;
    let parsed = description::parse(&source);
    let checked = parsed.and_then(|description| mechanism::check(&description));
    let mut mechanism = checked.map_err(|errors| errors.render_plain(&source))?;
    let joints = mechanism.legs.iter_mut().flat_map(|leg| &mut leg.joints);
    for joint in joints {
        let is_massless = joint.parameters.iter().all(|p| !p.is_inertial());
        let has = |p: StandardParameter| match lists {
            // A frame fixed to a body is not a body of its own.
            _ if joint.kind == JointKind::Fixed => false,
            Lists::All => true,
            _ if p.is_inertial() => !is_massless,
            _ if p == StandardParameter::Ia => joint.actuated,
            Lists::Real => true,
            Lists::Frictionless => false,
        };
        joint.parameters = StandardParameter::ALL
            .into_iter()
            .filter(|p| has(*p))
            .collect();
    }
    if let Some(platform) = &mut mechanism.platform {
        let all = StandardParameter::ALL.into_iter();
        platform.parameters = all.filter(|p| p.is_inertial()).collect();
        platform.payload = None;
    }
    Ok(mechanism)
}

/// Compares the ranks for all three lists; large ones only for real parameters in the default tier.
fn check(stem: &str, expected: [usize; 3]) -> Result<(), Failure> {
    if !is_of_the_tier(stem) {
        return Ok(());
    }
    let lists = [Lists::All, Lists::Real, Lists::Frictionless];
    let is_short = expected[0] < SLOW_RANK;
    let compared = lists.into_iter().zip(expected);
    for (lists, expected) in
        compared.filter(|(lists, _)| is_full() || is_short || matches!(lists, Lists::Real))
    {
        let [by_reference, by_model, chosen] = ranks(stem, lists)?;
        println!("{stem}, {lists:?}: reference {by_reference}");
        println!(
            "{stem}, {lists:?}: generated {by_model}; chosen {}",
            chosen.rank
        );
        for rank in [by_reference, by_model] {
            assert!(rank.is_clear(), "{stem}, {lists:?}: no clear gap: {rank}");
        }
        let found = [by_reference.rank, by_model.rank, chosen.rank];
        assert_eq!(found, [expected; 3], "{stem}, {lists:?}");
    }
    Ok(())
}

/// Rank of the reference's regressor, of the generated one, and number of base parameters.
fn ranks(stem: &str, lists: Lists) -> Result<[Rank; 3], Failure> {
    let mechanism = with_lists(stem, lists)?;
    let wanted = |_: &Mechanism, function: Function, from: MotionInput| {
        function == Function::IdmRedPlatform(Columns::Standard) && from == MotionInput::Joints
    };
    let request = Request {
        effort: Some(Effort::None),
        wanted: &wanted,
        ..Request::default()
    };
    let model = model_with(mechanism, &request).map_err(|error| format!("{error:?}"))?;
    let plain = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, plain);
    let columns = expected.parameters();
    let count = ROWS * columns.len() / expected.mechanism.dof() + 10;
    let all = samples(&expected.mechanism, &columns, count, 71, false)?;
    let observed = observation(&expected, &all)?;
    let generated = Rank::of(&regressor(&model, &all)?);
    let chosen = Rank {
        rank: model.base.len(),
        ..generated
    };
    Ok([Rank::of(&observed), generated, chosen])
}

/// Reference regressor over all samples with all available parameters.
fn observation(expected: &Expected, all: &[Sample]) -> Result<DMatrix<f64>, Failure> {
    let rows = expected.mechanism.dof();
    let mut matrix = DMatrix::zeros(rows * all.len(), expected.standard.len());
    for (at, sample) in all.iter().enumerate() {
        let truth = expected.at(sample)?;
        let block = truth.dynamics().idm_red_platform()?;
        let block = block.select_columns(&expected.standard);
        matrix.rows_mut(rows * at, rows).copy_from(&block);
    }
    Ok(matrix)
}

#[test]
fn vertical_five_bar_has_its_ranks() -> Result<(), Failure> {
    check("five_bar", [25, 23, 11])
}

#[test]
fn horizontal_three_leg_point_has_its_ranks() -> Result<(), Failure> {
    check("three_leg_point", [31, 28, 10])
}

#[test]
fn planar_3prr_has_its_ranks() -> Result<(), Failure> {
    check("planar_3prr", [41, 38, 13])
}

#[test]
fn planar_4prr_has_its_ranks() -> Result<(), Failure> {
    check("planar_4prr", [53, 49, 16])
}

#[test]
fn delta_with_rods_has_its_ranks() -> Result<(), Failure> {
    check("delta", [67, 61, 34])
}

#[test]
fn six_ups_has_its_ranks() -> Result<(), Failure> {
    check("hexapod", [148, 142, 88])
}

#[test]
fn eight_ups_has_its_ranks() -> Result<(), Failure> {
    check("octopod", [194, 186, 114])
}

#[test]
fn six_rus_has_its_ranks() -> Result<(), Failure> {
    check("reachy_mini", [142, 130, 76])
}

#[test]
fn rx90_has_its_ranks() -> Result<(), Failure> {
    check("rx90", [58, 58, 40])
}

#[test]
fn emps_has_its_ranks() -> Result<(), Failure> {
    check("emps", [4, 4, 1])
}
