//! The numeric reference of the DualV against the paper's formulas in their corrected form.
//!
//! Both sides are evaluated in floating point from the same state; 1e-12 relative is rounding.

use nalgebra::{DMatrix, DVector};
use overact_tests::reference::linear::{
    condition, null_space, pseudo_inverse, relative_difference,
};
use overact_tests::reference::newton_euler::{platform_wrench, tree_torques};
use overact_tests::reference::parameters::{BODY, INERTIAL, platform_start};
use overact_tests::reference::robots::{
    DUALV_GAMMA_DEG, DUALV_LINK, DUALV_PLATFORM_RADIUS, DUALV_SHOULDER, dualv,
};
use overact_tests::reference::states::{random_parameters, random_states};
use overact_tests::reference::{Dynamics, Error, State};
use std::f64::consts::PI;

const ROUNDING: f64 = 1e-12;
const D: f64 = DUALV_LINK;
const RP: f64 = DUALV_PLATFORM_RADIUS;

/// φ + k π of (53): k is 0 for legs 1 and 2, 1 for legs 3 and 4.
fn platform_angle(state: &State, leg: usize) -> f64 {
    state.pose[2] + if leg < 2 { 0.0 } else { PI }
}

fn shoulder(leg: usize) -> (f64, f64) {
    let gamma = DUALV_GAMMA_DEG[leg].to_radians();
    (DUALV_SHOULDER * gamma.cos(), DUALV_SHOULDER * gamma.sin())
}

fn joint(state: &State, leg: usize) -> [f64; 3] {
    std::array::from_fn(|at| state.q[3 * leg + at])
}

#[test]
fn closure_equations_and_working_mode_match_the_paper() -> Result<(), Error> {
    for state in random_states(&dualv(), 50, 11)? {
        for leg in 0..4 {
            let [q1, q2, q3] = joint(&state, leg);
            let (angle, (xa, ya)) = (platform_angle(&state, leg), shoulder(leg));
            let turned = if leg < 2 { PI } else { 0.0 };
            let rest = [
                state.pose[0] - RP * angle.sin() - xa - D * q1.cos() - D * (q1 + q2).cos(),
                state.pose[1] + RP * angle.cos() - ya - D * q1.sin() - D * (q1 + q2).sin(),
                state.pose[2] + turned - q1 - q2 - q3,
            ];
            assert!(
                rest.iter().all(|r| r.abs() < ROUNDING),
                "leg {leg}: {rest:?}"
            );
            assert_eq!(q2.sin() > 0.0, leg % 2 == 0, "working mode of leg {leg}");
        }
    }
    Ok(())
}

#[test]
fn jacobians_match_their_corrected_closed_forms() -> Result<(), Error> {
    let robot = dualv();
    for state in random_states(&robot, 50, 12)? {
        let found = state.jacobians(&robot)?;
        let mut expected_legs = DMatrix::zeros(12, 12);
        let mut expected_platform = DMatrix::zeros(12, 3);
        let (mut a_p, mut b_p) = (DMatrix::zeros(4, 3), DMatrix::zeros(4, 4));
        for leg in 0..4 {
            let [q1, q2, _] = joint(&state, leg);
            let ((s12, c12), angle) = ((q1 + q2).sin_cos(), platform_angle(&state, leg));
            #[rustfmt::skip]
            let own = DMatrix::from_row_slice(3, 3, &[
                -D * q1.sin() - D * s12, -D * s12, 0.0,
                D * q1.cos() + D * c12, D * c12, 0.0,
                1.0, 1.0, 1.0,
            ]);
            #[rustfmt::skip]
            let carried = DMatrix::from_row_slice(3, 3, &[
                1.0, 0.0, -RP * angle.cos(),
                0.0, 1.0, -RP * angle.sin(),
                0.0, 0.0, 1.0,
            ]);
            expected_legs
                .view_mut((3 * leg, 3 * leg), (3, 3))
                .copy_from(&own);
            expected_platform.rows_mut(3 * leg, 3).copy_from(&carried);
            let row = [D * c12, D * s12, -D * RP * (angle - q1 - q2).cos()];
            a_p.set_row(leg, &DMatrix::from_row_slice(1, 3, &row).row(0));
            b_p[(leg, leg)] = -D * D * q2.sin();
        }
        assert!(relative_difference(&found.legs, &expected_legs) < ROUNDING);
        assert!(relative_difference(&found.platform, &expected_platform) < ROUNDING);
        assert!(relative_difference(&found.a_p, &a_p) < ROUNDING);
        assert!(relative_difference(&found.b_p, &b_p) < ROUNDING);
    }
    Ok(())
}

#[test]
fn tree_torques_match_the_corrected_equations() -> Result<(), Error> {
    let robot = dualv();
    for (seed, state) in random_states(&robot, 50, 13)?.iter().enumerate() {
        let mut chi = random_parameters(&robot, seed as u64);
        for leg in 0..4 {
            // The third body is massless in (51); passive rotors and offsets are omitted.
            let start = BODY * 3 * leg;
            chi.rows_mut(start + 2 * BODY, INERTIAL).fill(0.0);
            for body in 0..3 {
                // Other kinds of friction are not in (51) either.
                chi.rows_mut(start + BODY * body + 13, BODY - 13).fill(0.0);
                if body > 0 {
                    chi[start + BODY * body + 10] = 0.0;
                }
            }
        }
        let found = tree_torques(&robot, state, &chi);
        for leg in 0..4 {
            let expected = equation_51(state, &chi, leg);
            for (at, torque) in expected.iter().enumerate() {
                let error = (found[3 * leg + at] - torque).abs() / found.amax();
                assert!(error < ROUNDING, "leg {leg}, joint {at}: {error:e}");
            }
        }
    }
    Ok(())
}

/// (51) with zz2 (q̈1 + q̈2) and minus signs before the my2 terms.
fn equation_51(state: &State, chi: &DVector<f64>, leg: usize) -> [f64; 3] {
    let [_, q2, _] = joint(state, leg);
    let [v1, v2, v3]: [f64; 3] = std::array::from_fn(|at| state.qd[3 * leg + at]);
    let [a1, a2, _]: [f64; 3] = std::array::from_fn(|at| state.qdd[3 * leg + at]);
    let of = |body: usize, at: usize| chi[BODY * (3 * leg + body) + at];
    let (zz1, ia1, zz2) = (of(0, 5), of(0, 10), of(1, 5));
    let (mx2, my2, m2) = (of(1, 6), of(1, 7), of(1, 9));
    let (s2, c2) = q2.sin_cos();
    let friction = |body: usize, v: f64| of(body, 11) * v + of(body, 12) * v.signum();
    [
        (zz1 + ia1 + D * D * m2) * a1
            + zz2 * (a1 + a2)
            + D * mx2 * ((2.0 * a1 + a2) * c2 - v2 * (2.0 * v1 + v2) * s2)
            - D * my2 * ((2.0 * a1 + a2) * s2 + v2 * (2.0 * v1 + v2) * c2)
            + friction(0, v1),
        zz2 * (a1 + a2) + D * mx2 * (a1 * c2 + v1 * v1 * s2) - D * my2 * (a1 * s2 - v1 * v1 * c2)
            + friction(1, v2),
        friction(2, v3),
    ]
}

#[test]
fn platform_wrench_matches_equation_52() -> Result<(), Error> {
    let robot = dualv();
    for (seed, state) in random_states(&robot, 50, 14)?.iter().enumerate() {
        let chi = random_parameters(&robot, seed as u64);
        let sum = |at: usize| {
            let first = platform_start(&robot) + at;
            chi[first] + chi[first + INERTIAL]
        };
        let (zz, mx, my, m) = (sum(5), sum(6), sum(7), sum(9));
        let (s, c) = state.pose[2].sin_cos();
        let w2 = state.twist[2] * state.twist[2];
        let [ax, ay, aw]: [f64; 3] = std::array::from_fn(|at| state.acceleration[at]);
        let expected = [
            m * ax - mx * (aw * s + w2 * c) + my * (-aw * c + w2 * s),
            m * ay + mx * (aw * c - w2 * s) - my * (aw * s + w2 * c),
            zz * aw + mx * (ay * c - ax * s) - my * (ay * s + ax * c),
        ];
        let found = platform_wrench(&robot, state, &chi);
        for (row, value) in [0, 1, 5].into_iter().zip(expected) {
            assert!((found[row] - value).abs() < ROUNDING * found.amax());
        }
    }
    Ok(())
}

#[test]
fn partition_is_singular_where_the_robot_is_regular() -> Result<(), Error> {
    let robot = dualv();
    let pose = [-0.10, 0.16, -0.105_792];
    let still = DVector::zeros(3);
    let state = State::solve(&robot, &pose, &still, &still)?;
    let dynamics = Dynamics::new(&robot, &state)?;
    let jacobians = &dynamics.jacobians;
    let kept = jacobians.inverse.rows(0, 3).into_owned();
    let partition = condition(&dynamics.partition_matrix(&[3]));
    // Lengths and angles are comparable after dividing the rotation column by r_p.
    let mut scaled = jacobians.a_p.clone();
    scaled.column_mut(2).scale_mut(1.0 / RP);
    let (a_p, b_p) = (condition(&scaled), condition(&jacobians.b_p));
    println!(
        "A_p {a_p:.3}, B_p {b_p:.3}, kept {:.1e}, (33) {partition:.1e}",
        condition(&kept)
    );
    // The pose has six digits, which gives the singularity to nine.
    assert!(condition(&kept) > 1e8);
    assert!(partition > 1e8);
    assert!(a_p < 2.2 && b_p < 1.7);
    assert!(dynamics.idm_red_platform().is_ok());
    Ok(())
}

#[test]
fn minimum_norm_multipliers_do_not_give_minimum_norm_torques() -> Result<(), Error> {
    let robot = dualv();
    let mut worst = 0.0_f64;
    for (seed, state) in random_states(&robot, 50, 15)?.iter().enumerate() {
        let chi = random_parameters(&robot, seed as u64);
        let dynamics = Dynamics::new(&robot, state)?;
        let (norm, paper) = (
            dynamics.least_norm_torques(&chi)?,
            dynamics.least_multiplier_torques(&chi),
        );
        let gap = dynamics.project_on_platform(&(&norm - &paper)).amax();
        assert!(
            gap < 1e-11 * norm.amax().max(1.0),
            "both satisfy the model: {gap:e}"
        );
        assert!(norm.norm() <= paper.norm() * (1.0 + ROUNDING));
        let projected = dynamics.project_torques(&paper);
        assert!((projected - &norm).amax() < 1e-11 * norm.amax().max(1.0));
        worst = worst.max((&norm - &paper).amax() / norm.amax());
    }
    println!("largest difference of (26) from the least-norm torque {worst:.3}");
    assert!(worst > 1e-3);
    Ok(())
}

#[test]
fn pseudo_inverses_match_equations_22_25_and_27() -> Result<(), Error> {
    let robot = dualv();
    for state in random_states(&robot, 20, 16)? {
        let dynamics = Dynamics::new(&robot, &state)?;
        let (tall, wide) = (&dynamics.jacobians.inverse, dynamics.multiplier_matrix());
        let normal = (tall.transpose() * tall)
            .try_inverse()
            .ok_or(Error::Singular("J"))?;
        let by_22 = normal * tall.transpose();
        assert!(relative_difference(&pseudo_inverse(tall), &by_22) < 1e-10);
        let normal = (&wide * wide.transpose())
            .try_inverse()
            .ok_or(Error::Singular("A"))?;
        let by_27 = wide.transpose() * normal;
        assert!(relative_difference(&pseudo_inverse(&wide), &by_27) < 1e-8);
        let basis = null_space(&tall.transpose());
        assert_eq!(basis.shape(), (4, 1));
        assert!((tall.transpose() * basis).amax() < 1e-12 * tall.amax());
    }
    Ok(())
}
