//! The numeric reference compared with Lagrange's equations, all components at once.
//!
//! Γ¹ = d/dt ∂T/∂ẋ - ∂(T - V)/∂x holds if the twist coordinates are derivatives of the pose's, that
//! is for all motions except free rotations. T is quadratic in ẋ, so its derivative by ẋ is exact.
//! The others are seven-point differences with errors of about 1e-9.

use nalgebra::{DVector, Vector3};
use overact_tests::reference::states::{frictionless, random_parameters, random_states};
use overact_tests::reference::{
    Dynamics, Error, Mechanism, Motion, State, energy, robots, trajectory,
};

const TOLERANCE: f64 = 1e-8;

/// Kinetic energy at the state's position for another twist.
fn kinetic(robot: &Mechanism, state: &State, twist: &DVector<f64>, chi: &DVector<f64>) -> f64 {
    let weightless = Mechanism {
        gravity: Vector3::zeros(),
        ..robot.clone()
    };
    let moved = State::with_joints(robot, &state.pose, &state.q, twist, &state.acceleration)
        .expect("the same position closes for any twist");
    energy::total_energy(&weightless, &moved, chi)
}

fn potential(robot: &Mechanism, state: &State, chi: &DVector<f64>) -> f64 {
    let still = DVector::zeros(robot.dof());
    let rest = State::with_joints(robot, &state.pose, &state.q, &still, &still)
        .expect("the same position closes at rest");
    energy::total_energy(robot, &rest, chi)
}

fn unit(size: usize, at: usize) -> DVector<f64> {
    DVector::from_fn(size, |row, _| f64::from(u8::from(row == at)))
}

/// ∂T/∂ẋ.
fn momentum(robot: &Mechanism, state: &State, chi: &DVector<f64>) -> DVector<f64> {
    let dof = robot.dof();
    DVector::from_fn(dof, |at, _| {
        let side = |sign: f64| kinetic(robot, state, &(&state.twist + unit(dof, at) * sign), chi);
        0.5 * (side(1.0) - side(-1.0))
    })
}

#[test]
fn platform_inputs_satisfy_lagranges_equations() -> Result<(), Error> {
    for (name, robot) in robots::all() {
        if matches!(robot.motion, Motion::Spherical | Motion::Spatial) {
            continue;
        }
        let mut worst = 0.0_f64;
        let dof = robot.dof();
        for (seed, state) in random_states(&robot, 2, 41)?.iter().enumerate() {
            let chi = frictionless(&robot, &random_parameters(&robot, seed as u64));
            let (mut expected, _) =
                trajectory::derivatives(&robot, state, |s| momentum(&robot, s, &chi))?;
            for at in 0..dof {
                // A path along one pose coordinate with a fixed twist in T.
                let along = State {
                    twist: unit(dof, at),
                    acceleration: DVector::zeros(dof),
                    ..state.clone()
                };
                let lagrangian = |s: &State| {
                    let value = kinetic(&robot, s, &state.twist, &chi) - potential(&robot, s, &chi);
                    DVector::from_element(1, value)
                };
                expected[at] -= trajectory::derivatives(&robot, &along, lagrangian)?.0[0];
            }
            let found = Dynamics::new(&robot, state)?.platform_inputs(&chi)?;
            worst = worst.max((found - &expected).amax() / expected.amax().max(1.0));
        }
        println!("{name}: Lagrange {worst:.1e}");
        assert!(worst < TOLERANCE, "{name}: {worst:e}");
    }
    Ok(())
}
