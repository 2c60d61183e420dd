//! Consistency of the numeric reference's dynamics.
//!
//! Two derivations of one quantity agree up to conditioning, at most about 1e3 roundings.
//! Tolerances:
//!
//! | quantity | tolerance |
//! |---|---|
//! | usual | 1e-12 |
//! | partitions up to condition 1e4 | 1e-11 |
//! | power from differentiated energies | 1e-9 |

use nalgebra::DVector;
use overact_tests::reference::linear::{null_space, relative_difference};
use overact_tests::reference::states::{frictionless, random_parameters, random_states};
use overact_tests::reference::{Dynamics, Error, energy, parameters, robots, trajectory};

const AGREEMENT: f64 = 1e-12;
const POWER: f64 = 1e-9;

#[test]
fn motor_power_equals_the_energy_rate() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        let mut worst = 0.0_f64;
        for (seed, state) in random_states(&robot, 4, 21)?.iter().enumerate() {
            let chi = frictionless(&robot, &random_parameters(&robot, seed as u64));
            let energy = |s: &_| DVector::from_element(1, energy::total_energy(&robot, s, &chi));
            let (growth, _) = trajectory::derivatives(&robot, state, energy)?;
            let inputs = Dynamics::new(&robot, state)?.platform_inputs(&chi)?;
            let power = state.twist.dot(&inputs);
            let scale = state.twist.component_mul(&inputs).amax().max(1.0);
            worst = worst.max((growth[0] - power).abs() / scale);
        }
        println!("{name}: power {worst:.1e}");
        assert!(worst < POWER, "{name}: {worst:e}");
    }
    Ok(())
}

#[test]
fn multipliers_and_closed_form_give_the_same_case_1() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        let mut worst = 0.0_f64;
        for (seed, state) in random_states(&robot, 4, 22)?.iter().enumerate() {
            let dynamics = Dynamics::new(&robot, state)?;
            let by_multipliers = dynamics.idm_red_platform()?;
            let closed = dynamics.idm_red_platform_closed_form()?;
            worst = worst.max(relative_difference(&by_multipliers, &closed));
            let chi = random_parameters(&robot, seed as u64);
            let direct = dynamics.platform_inputs(&chi)?;
            let product = &closed * &chi;
            worst = worst.max((direct - &product).amax() / product.amax());
        }
        println!("{name}: case 1 {worst:.1e}");
        assert!(worst < AGREEMENT, "{name}: {worst:e}");
    }
    Ok(())
}

#[test]
fn case_2_recovers_the_kept_torques_of_every_partition() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        let (dof, actuators) = (robot.dof(), robot.actuators());
        if actuators == dof {
            continue;
        }
        let mut worst = 0.0_f64;
        for (seed, state) in random_states(&robot, 4, 23)?.iter().enumerate() {
            let chi = random_parameters(&robot, seed as u64);
            let dynamics = Dynamics::new(&robot, state)?;
            // Any admissible torques suffice: least norm plus some internal torques.
            let basis = dynamics.internal_loads();
            let preload = &basis * DVector::from_element(actuators - dof, 3.0);
            let torques = dynamics.least_norm_torques(&chi)? + preload;
            for first in 0..actuators {
                let kept: Vec<usize> = (0..dof).map(|at| (first + at) % actuators).collect();
                let Ok(case) = dynamics.idm_red_actuators(&kept) else {
                    continue;
                };
                if case.condition > 1e4 {
                    continue;
                }
                let projected = torques.select_rows(&case.projected);
                let expected = torques.select_rows(&kept) - &case.projection * projected;
                let found = &case.regressor * &chi;
                worst = worst.max((found - &expected).amax() / expected.amax());
            }
        }
        println!("{name}: case 2 {worst:.1e}");
        assert!(worst < 1e-11, "{name}: {worst:e}");
    }
    Ok(())
}

#[test]
fn torques_of_robots_without_redundancy_are_unique() -> Result<(), Error> {
    for (name, robot) in [
        ("five_bar", robots::five_bar()),
        ("serial_3r", robots::serial_3r()),
        ("delta", robots::delta()),
        ("hexapod", robots::hexapod()),
    ] {
        for (seed, state) in random_states(&robot, 4, 24)?.iter().enumerate() {
            let chi = random_parameters(&robot, seed as u64);
            let dynamics = Dynamics::new(&robot, state)?;
            let by_19 = dynamics.torques(&chi)?;
            for other in [
                dynamics.least_norm_torques(&chi)?,
                dynamics.least_multiplier_torques(&chi),
            ] {
                let error = (other - &by_19).amax() / by_19.amax();
                assert!(error < 1e-10, "{name}: {error:e}");
            }
            assert_eq!(dynamics.internal_loads().ncols(), 0);
        }
    }
    Ok(())
}

#[test]
fn internal_loads_are_orthonormal_and_cause_no_motion() -> Result<(), Error> {
    for robot in [
        robots::dualv(),
        robots::octopod(),
        robots::spherical_4ups(),
        robots::schoenflies_5ups(),
        robots::two_slides(),
    ] {
        for state in random_states(&robot, 4, 25)? {
            let dynamics = Dynamics::new(&robot, &state)?;
            let basis = dynamics.internal_loads();
            let extra = robot.actuators() - robot.dof();
            assert_eq!(basis.ncols(), extra);
            let gram = basis.transpose() * &basis;
            assert!((gram - nalgebra::DMatrix::identity(extra, extra)).amax() < 1e-12);
            let moved = dynamics.jacobians.inverse.transpose() * &basis;
            assert!(moved.amax() < 1e-12 * dynamics.jacobians.inverse.amax());
            assert_eq!(null_space(&dynamics.jacobians.inverse).ncols(), 0);
        }
    }
    Ok(())
}

#[test]
fn mass_matrix_is_symmetric_positive_and_affine() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        for (seed, state) in random_states(&robot, 3, 26)?.iter().enumerate() {
            let chi = random_parameters(&robot, seed as u64);
            let dynamics = Dynamics::new(&robot, state)?;
            let (mass, bias) = dynamics.mass_matrix_and_bias(&chi)?;
            let skew = (&mass - mass.transpose()).amax() / mass.amax();
            assert!(skew < 1e-10, "{name}: {skew:e}");
            let symmetric = 0.5 * (&mass + mass.transpose());
            assert!(symmetric.symmetric_eigenvalues().min() > 0.0, "{name}");
            let inputs = dynamics.platform_inputs(&chi)?;
            let error = (mass * &state.acceleration + bias - &inputs).amax() / inputs.amax();
            assert!(error < 1e-10, "{name}: {error:e}");
        }
    }
    Ok(())
}

#[test]
fn parameter_names_follow_the_columns() {
    for (name, robot) in robots::all() {
        let names = parameters::names(&robot);
        assert_eq!(names.len(), parameters::count(&robot), "{name}");
    }
    let names = parameters::names(&robots::dualv());
    assert_eq!(names.len(), 284);
    assert_eq!(
        names[parameters::leg_start(&robots::dualv(), 2) + parameters::BODY + 5],
        "zz_2_leg3"
    );
    assert_eq!(
        names[parameters::platform_start(&robots::dualv()) + 9],
        "m_platform"
    );
}
