//! Number of base parameters of the DualV, and their regroupings.
//!
//! The ranks are those of the numeric reference:
//!
//! | parameters | rank |
//! |---|---|
//! | all | 57 |
//! | without rotors of passive joints | 49 |
//! | inertial parameters only | 16 |
//!
//! The regrouping relations are exact constants of the geometry.

use overact::{Columns, Function};
use overact_codegen::derivation::{BodyParameter, MotionInput};
use overact_codegen::mechanism::{Mechanism, StandardParameter};
use overact_codegen::{Effort, Request, RobotModel, Source};
use overact_tests::reference::robots;
use overact_tests::reference::robots::{DUALV_LINK as D, DUALV_PLATFORM_RADIUS as RP};
use overact_tests::support::expected::Expected;
use overact_tests::support::rank::{Rank, regressor};
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, dualv, model_with};
use overact_tier::by_tier;

const FULL: &str = include_str!("../../fixtures/dualv_full.toml");
/// States in the default and full tier; with four rows each, more than the 88 columns.
const STATES: [usize; 2] = [50, 120];

/// The full fixture with other parameters of the three links.
fn variant(parameters: [&str; 3]) -> Result<RobotModel, Failure> {
    let mut pieces = FULL.split("parameters = [\"all\"]");
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for (own, rest) in parameters.iter().zip(pieces) {
        text += &format!("parameters = {own}{rest}");
    }
    let source = Source::new("fixtures/dualv_full.toml", text);
    // Only the regressor from joints is derived, whose rank is tested.
    let is_regressor = |_: &Mechanism, function: Function, from: MotionInput| {
        function == Function::IdmRedPlatform(Columns::Standard) && from == MotionInput::Joints
    };
    // Ranks do not depend on the search for operations.
    let request = Request {
        wanted: &is_regressor,
        ..Request::with_effort(by_tier([Effort::None, Effort::Quick]))
    };
    model_with(&source, &request)
}

/// Checks that the rank has a clear gap and equals the model's number of base parameters.
fn check(what: &str, model: &RobotModel, expected: usize) -> Result<(), Failure> {
    let mechanism = robots::dualv();
    let columns = Expected::new(model, mechanism.clone())?.parameters();
    let all = samples(&mechanism, &columns, by_tier(STATES), 61, false)?;
    let rank = Rank::of(&regressor(model, &all)?);
    println!("{what}: {rank}");
    assert!(rank.is_clear(), "{what}: no clear gap: {rank}");
    assert_eq!(rank.rank, expected, "{what}: {rank}");
    assert_eq!(model.base.len(), expected, "{what}: base parameters");
    Ok(())
}

#[test]
fn all_parameters_have_rank_57() -> Result<(), Failure> {
    let model = variant(["[\"all\"]"; 3])?;
    // Ten inertial parameters of a body have four columns in the plane, those of the first body
    // one. With rotor and friction there are 5 + 8 + 8 for a leg, and the platform's four.
    assert_eq!(model.selection.standard.len(), 4 * (5 + 8 + 8) + 4);
    check("all parameters", &model, 57)
}

#[test]
fn without_passive_rotors_the_rank_is_49() -> Result<(), Failure> {
    let passive = "[\"inertia\", \"friction\"]";
    check(
        "no passive rotors",
        &variant(["[\"all\"]", passive, passive])?,
        49,
    )?;
    check("the description", dualv()?, 49)
}

#[test]
fn inertial_parameters_have_rank_16() -> Result<(), Failure> {
    check("inertia alone", &variant(["[\"inertia\"]"; 3])?, 16)?;
    let rotors = variant(["[\"inertia\", \"ia\"]", "[\"inertia\"]", "[]"])?;
    check("inertia and motors", &rotors, 16)
}

/// Coefficient of a parameter in a base parameter; zero if it is not part of it.
fn coefficient(model: &RobotModel, base: &str, regrouped: &str) -> f64 {
    let found = model
        .base
        .iter()
        .find(|b| model.parameter_name(b.parameter) == base);
    let within = found.and_then(|b| {
        let mut all = b.regrouped.iter();
        all.find(|(p, _)| model.parameter_name(*p) == regrouped)
    });
    within.map_or(0.0, |(_, coefficient)| *coefficient)
}

#[test]
fn regrouping_coefficients_are_geometric_constants() -> Result<(), Failure> {
    let model = dualv()?;
    // r_p^2/d3 is recognised as 121/2800 and correctly rounded.
    let squared = 121.0 / 2800.0;
    assert!((squared - RP * RP / D).abs() < 1e-16);
    for leg in 1..=4 {
        let side = if leg < 3 { 1.0 } else { -1.0 };
        let of = |name: &str| format!("{name}_leg{leg}");
        let relations = [
            ("zz_platform".to_owned(), of("mx_2"), squared),
            ("my_platform".to_owned(), of("mx_2"), side * 11.0 / 28.0),
            ("m_platform".to_owned(), of("mx_2"), 25.0 / 7.0),
            ("mx_platform".to_owned(), of("mx_2"), 0.0),
            (of("zz_1"), of("mx_2"), -7.0 / 25.0),
            (of("zz_2"), of("mx_2"), -7.0 / 25.0),
            (of("zz_1"), of("m_2"), 49.0 / 625.0),
            (of("zz_1"), of("ia_1"), 1.0),
        ];
        for (base, regrouped, expected) in relations {
            let found = coefficient(model, &base, &regrouped);
            assert_eq!(found, expected, "{regrouped} in {base}");
        }
    }
    // Constants and geometry: r_p/d3, 1/d3, d2^2/d3 with d2 = d3, and d2^2.
    for (constant, geometry) in [
        (11.0 / 28.0, RP / D),
        (25.0 / 7.0, 1.0 / D),
        (7.0 / 25.0, D * D / D),
        (49.0 / 625.0, D * D),
    ] {
        assert!((constant - geometry).abs() < 1e-15);
    }
    Ok(())
}

#[test]
fn kept_and_regrouped_parameters_partition_all_parameters() -> Result<(), Failure> {
    let model = dualv()?;
    let mut accounted: Vec<BodyParameter> = model.base.iter().map(|b| b.parameter).collect();
    for base in &model.base {
        accounted.extend(base.regrouped.iter().map(|(p, _)| *p));
    }
    accounted.sort();
    accounted.dedup();
    let mut all = model.selection.standard.clone();
    all.sort();
    assert_eq!(accounted, all);
    // Parameters of a leg that are dropped are those that (43) puts last.
    let is_dropped = |p: &BodyParameter| !model.selection.base.contains(p);
    let dropped: Vec<String> = all
        .iter()
        .filter(|p| is_dropped(p))
        .filter(|p| matches!(p, BodyParameter::Leg { leg: 0, symbol, .. } if *symbol != StandardParameter::Off))
        .map(|p| model.parameter_name(*p))
        .collect();
    assert_eq!(dropped, ["ia_1_leg1", "mx_2_leg1", "m_2_leg1"]);
    Ok(())
}
