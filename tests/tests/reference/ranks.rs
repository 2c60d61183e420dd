//! Number of base parameters of the DualV: ranks of the regressor over random states.
//!
//! Twelve viscous and twelve dry friction columns are independent, but only nine offsets: the sum
//! of a leg's three offsets is a moment on the platform, the same for all legs. With sixteen
//! inertial parameters these are 49. The eight rotors of passive joints increase the rank to 57.
//! Singular values of columns scaled to unit length show a gap of many decades.

use nalgebra::DMatrix;
use overact_tests::reference::linear::{normalized_singular_values, rank};
use overact_tests::reference::parameters::{BODY, INERTIAL, names, platform_start};
use overact_tests::reference::robots::dualv;
use overact_tests::reference::states::random_states;
use overact_tests::reference::{Dynamics, Error};

/// Parameters of (2) and (5); a spring and other kinds of friction follow.
const STANDARD_PARAMETERS: usize = 14;

const TOLERANCE: f64 = 1e-9;

/// Platform-projection regressor over random states, without the payload's columns.
fn observation(states: usize) -> Result<DMatrix<f64>, Error> {
    let robot = dualv();
    let columns = platform_start(&robot) + INERTIAL;
    let mut all = DMatrix::zeros(3 * states, columns);
    for (at, state) in random_states(&robot, states, 31)?.iter().enumerate() {
        let block = Dynamics::new(&robot, state)?.idm_red_platform()?;
        all.rows_mut(3 * at, 3)
            .copy_from(&block.columns(0, columns));
    }
    Ok(all)
}

/// Columns of the leg bodies for which `keep(body in the leg, parameter)`, and the platform's.
fn select(all: &DMatrix<f64>, keep: impl Fn(usize, usize) -> bool) -> DMatrix<f64> {
    let first = platform_start(&dualv());
    let chosen: Vec<usize> = (0..all.ncols())
        .filter(|&at| at >= first || keep(at / BODY % 3, at % BODY))
        .collect();
    all.select_columns(&chosen)
}

fn check(what: &str, matrix: &DMatrix<f64>, expected: usize) {
    let values = normalized_singular_values(matrix);
    let (last, next) = (
        values[expected - 1],
        values.get(expected).copied().unwrap_or(0.0),
    );
    println!(
        "{what}: rank {}, gap {last:.1e} to {next:.1e}",
        rank(matrix, TOLERANCE)
    );
    assert_eq!(rank(matrix, TOLERANCE), expected, "{what}");
    assert!(last > 1e4 * next, "{what}: no clear gap");
}

#[test]
fn dualv_parameter_subsets_have_their_ranks() -> Result<(), Error> {
    let all = observation(80)?;
    assert_eq!(all.ncols(), names(&dualv()).len() - INERTIAL);
    let usual = |_, at| at < STANDARD_PARAMETERS;
    check("all parameters", &select(&all, usual), 57);
    let real = |body: usize, at: usize| match at {
        0..INERTIAL => body < 2,
        INERTIAL => body == 0,
        _ => at < STANDARD_PARAMETERS,
    };
    check(
        "no passive rotors, massless third bodies",
        &select(&all, real),
        49,
    );
    let inertial = |body: usize, at: usize| at < INERTIAL || (at == INERTIAL && body == 0);
    check("inertial alone", &select(&all, inertial), 16);
    check(
        "inertial without rotors",
        &select(&all, |_, at| at < INERTIAL),
        16,
    );
    let motors_only =
        |body: usize, at: usize| at < INERTIAL || (body == 0 && at < STANDARD_PARAMETERS);
    check(
        "inertial and actuated joints' drives",
        &select(&all, motors_only),
        28,
    );
    Ok(())
}

#[test]
fn regrouping_relations_of_leg_1_hold() -> Result<(), Error> {
    use overact_tests::reference::robots::{DUALV_LINK as D, DUALV_PLATFORM_RADIUS as RP};
    let all = observation(40)?;
    let names = names(&dualv());
    let column = |name: &str| {
        let at = names.iter().position(|n| n == name).unwrap_or(usize::MAX);
        all.column(at).into_owned()
    };
    let mx2 = column("zz_platform") * (RP * RP / D)
        + column("my_platform") * (RP / D)
        + column("m_platform") / D
        - column("zz_1_leg1") * D
        - column("zz_2_leg1") * D;
    let pairs = [
        (column("mx_2_leg1"), mx2),
        (column("m_2_leg1"), column("zz_1_leg1") * (D * D)),
        (column("ia_1_leg1"), column("zz_1_leg1")),
    ];
    for (found, expected) in pairs {
        let error = (&found - &expected).amax() / expected.amax();
        println!("regrouping {error:.1e}");
        assert!(error < 1e-10, "{error:e}");
    }
    Ok(())
}
