//! The numeric reference's kinematics compared with finite differences of positions.
//!
//! Seven-point differences with a step of 0.3 ms: rounding of positions (1e-15) leaves about 1e-11
//! in velocities and 1e-8 in accelerations. The tolerances have a margin of one or two decades.

use nalgebra::DVector;
use overact_tests::reference::kinematics::BodyMotion;
use overact_tests::reference::states::random_states;
use overact_tests::reference::{Error, Mechanism, Motion, State, closure, robots, trajectory};

const VELOCITY: f64 = 1e-9;
const ACCELERATION: f64 = 1e-6;

/// Largest difference, relative to the largest value or to 1.
fn difference(found: &DVector<f64>, expected: &DVector<f64>) -> f64 {
    (found - expected).amax() / expected.amax().max(1.0)
}

#[test]
fn loops_close_in_random_states() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        for state in random_states(&robot, 5, 1)? {
            let ranges = robot.leg_ranges();
            for (leg, range) in robot.legs.iter().zip(ranges) {
                let q = &state.q.as_slice()[range];
                let residual = closure::closure_residual(&robot, leg, &state.pose, q);
                assert!(residual.norm() < 1e-12, "{name}: {residual}");
            }
        }
    }
    Ok(())
}

#[test]
fn joint_rates_and_accelerations_are_derivatives_of_positions() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        let (mut worst_rate, mut worst_acceleration) = (0.0_f64, 0.0_f64);
        for state in random_states(&robot, 5, 2)? {
            let (first, second) = trajectory::derivatives(&robot, &state, |s| s.q.clone())?;
            worst_rate = worst_rate.max(difference(&first, &state.qd));
            worst_acceleration = worst_acceleration.max(difference(&second, &state.qdd));
        }
        println!("{name}: rates {worst_rate:.1e}, accelerations {worst_acceleration:.1e}");
        assert!(worst_rate < VELOCITY, "{name}: {worst_rate:e}");
        assert!(
            worst_acceleration < ACCELERATION,
            "{name}: {worst_acceleration:e}"
        );
    }
    Ok(())
}

/// All bodies' entries of one kind, platform last.
fn gather(
    robot: &Mechanism,
    state: &State,
    kind: impl Fn(&BodyMotion) -> Vec<f64>,
) -> DVector<f64> {
    let mut all: Vec<f64> = state.legs(robot).iter().flatten().flat_map(&kind).collect();
    if robot.motion != Motion::None {
        all.extend(kind(&state.platform(robot)));
    }
    DVector::from_vec(all)
}

/// Rates of the rotation matrix's entries: the cross product of ω with every axis.
fn axes_rates(body: &BodyMotion) -> Vec<f64> {
    let axis = |at: usize| body.frame.rotation.column(at).into_owned();
    (0..3)
        .flat_map(|at| {
            body.angular_velocity
                .cross(&axis(at))
                .iter()
                .copied()
                .collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn body_motions_are_derivatives_of_placements() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        let mut worst = [0.0_f64; 4];
        for state in random_states(&robot, 3, 3)? {
            let position = |s: &State| gather(&robot, s, |b| b.frame.position.as_slice().to_vec());
            let axes = |s: &State| gather(&robot, s, |b| b.frame.rotation.as_slice().to_vec());
            let velocity = gather(&robot, &state, |b| b.velocity.as_slice().to_vec());
            let acceleration = gather(&robot, &state, |b| b.acceleration.as_slice().to_vec());
            let spin = |s: &State| gather(&robot, s, |b| b.angular_velocity.as_slice().to_vec());
            let growth = gather(&robot, &state, |b| {
                b.angular_acceleration.as_slice().to_vec()
            });
            let (first, second) = trajectory::derivatives(&robot, &state, position)?;
            let (turning, _) = trajectory::derivatives(&robot, &state, axes)?;
            let (spin_rate, _) = trajectory::derivatives(&robot, &state, spin)?;
            let found = [
                difference(&first, &velocity),
                difference(&turning, &gather(&robot, &state, axes_rates)),
                difference(&spin_rate, &growth),
                difference(&second, &acceleration),
            ];
            worst = std::array::from_fn(|at| worst[at].max(found[at]));
        }
        println!("{name}: {worst:?}");
        assert!(
            worst[0] < VELOCITY && worst[1] < VELOCITY,
            "{name}: {worst:?}"
        );
        assert!(
            worst[2] < ACCELERATION && worst[3] < ACCELERATION,
            "{name}: {worst:?}"
        );
    }
    Ok(())
}

#[test]
fn reduced_closure_and_inverse_jacobian_agree() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        for state in random_states(&robot, 5, 4)? {
            let jacobians = state.jacobians(&robot)?;
            // a_p v + b_p q̇ = 0 for any v, so A_p + B_p J_p^inv vanishes (11), (20).
            let sum = &jacobians.a_p + &jacobians.b_p * &jacobians.inverse;
            assert!(
                sum.amax() < 1e-12 * jacobians.a_p.amax().max(1.0),
                "{name}: {sum}"
            );
            let rest = &jacobians.legs * &jacobians.joints - &jacobians.platform;
            assert!(rest.amax() < 1e-12, "{name}: {rest}");
        }
    }
    Ok(())
}
