//! Torques, inertias and gains of the joints and motors.

use super::random::Random;
use overact::transmission::{Curvature, Error, Transmission, curvature};

/// Positions of two motors over two joints, their Jacobian and its derivative.
fn ankle(q: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2], Curvature<2, 2>) {
    let [a, b] = q;
    let motor = |side: f64| {
        let (sine, cosine) = (a + side * 0.3 * b).sin_cos();
        let position = 0.8 * sine + side * 0.5 * b + 0.2 * a * b;
        let gradient = [
            0.8 * cosine + 0.2 * b,
            0.24 * side * cosine + side * 0.5 + 0.2 * a,
        ];
        let mixed = -0.24 * side * sine + 0.2;
        let second = [[-0.8 * sine, mixed], [mixed, -0.072 * sine]];
        (position, gradient, second)
    };
    let [left, right] = [1.0, -1.0].map(motor);
    ([left.0, right.0], [left.1, right.1], [left.2, right.2])
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    differences.fold(0.0, f64::max)
}

/// Torques of the joints are the derivatives of the motors' springs, whose second derivatives are
/// the stiffness.
#[test]
fn stiffness_is_the_derivative_of_torques() -> Result<(), Error> {
    let (q, gains, rest) = ([0.3, -0.2], [120.0, 80.0], [0.5, 0.1]);
    let torques = |q: [f64; 2]| {
        let (positions, jacobian, _) = ankle(q);
        let motors: [f64; 2] = std::array::from_fn(|a| gains[a] * (rest[a] - positions[a]));
        let joints = Transmission::new(&jacobian).and_then(|own| own.joint_torques(&motors));
        joints.map(|joints| (motors, joints))
    };
    let (_, jacobian, second) = ankle(q);
    let (motors, _) = torques(q)?;
    let own = Transmission::new(&jacobian)?;
    let stiffness = own.joint_stiffness(&gains, &motors, &second)?;
    let step = 1e-5;
    for i in 0..2 {
        let moved = |by: f64| {
            let mut moved = q;
            moved[i] += by;
            torques(moved).map(|(_, joints)| joints)
        };
        let (after, before) = (moved(step)?, moved(-step)?);
        for (j, row) in stiffness.iter().enumerate() {
            let slope = -(after[j] - before[j]) / (2.0 * step);
            assert!((slope - row[i]).abs() < 1e-6, "{slope} {}", row[i]);
        }
    }
    // The geometric term matters here, and the inverse conversion undoes both terms.
    let plain = own.joint_gains(&gains)?;
    assert!(distance(plain.as_flattened(), stiffness.as_flattened()) > 1.0);
    let again = own.motor_stiffness(&stiffness, &motors, &second)?;
    assert!(distance(again.as_flattened(), &[120.0, 0.0, 0.0, 80.0]) < 1e-10);
    Ok(())
}

#[test]
fn the_curvature_follows_from_accelerations() -> Result<(), Error> {
    let (_, _, second) = ankle([0.3, -0.2]);
    let found = curvature(|v: &[f64; 2]| {
        Ok::<_, Error>(second.map(|h| {
            let rows = h.iter().zip(v);
            rows.map(|(row, x)| x * (row[0] * v[0] + row[1] * v[1]))
                .sum()
        }))
    })?;
    let [found, second] = [found, second].map(|all| all.as_flattened().as_flattened().to_vec());
    assert!(distance(&found, &second) < 1e-15);
    Ok(())
}

#[test]
fn gains_of_independent_drives_are_found_again() -> Result<(), Error> {
    let mut random = Random(5);
    for _ in 0..20 {
        let jacobian: [[f64; 3]; 4] = std::array::from_fn(|_| random.row());
        let own = Transmission::new(&jacobian)?;
        let gains: [f64; 4] = std::array::from_fn(|_| 50.0 + 100.0 * random.uniform());
        let found = own.diagonal_motor_gains(&own.joint_gains(&gains)?)?;
        assert!(
            distance(&gains, &found) < 1e-8 * own.condition(),
            "{found:?}"
        );
        // The full matrix gives the same joint gains.
        let joints = own.joint_gains(&gains)?;
        let full = own.motor_gains(&joints)?;
        for (i, row) in joints.iter().enumerate() {
            for (j, wanted) in row.iter().enumerate() {
                let terms = (0..16).map(|k| (k / 4, k % 4));
                let sum: f64 = terms
                    .map(|(a, b)| jacobian[a][i] * full[a][b] * jacobian[b][j])
                    .sum();
                assert!((sum - wanted).abs() < 1e-9 * (1.0 + wanted.abs()));
            }
        }
    }
    Ok(())
}

#[test]
fn power_is_equal_on_both_sides() -> Result<(), Error> {
    let mut random = Random(6);
    for _ in 0..50 {
        let jacobian: [[f64; 3]; 5] = std::array::from_fn(|_| random.row());
        let own = Transmission::new(&jacobian)?;
        let (torques, rates): ([f64; 5], [f64; 3]) = (random.row(), random.row());
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let motors = dot(&torques, &own.motor_velocities(&rates)?);
        let joints = dot(&own.joint_torques(&torques)?, &rates);
        assert!((motors - joints).abs() < 1e-13 * (1.0 + motors.abs()));
        // Round trips, and the least norm.
        assert!(
            distance(
                &rates,
                &own.joint_velocities(&own.motor_velocities(&rates)?)?
            ) < 1e-13
        );
        let wanted: [f64; 3] = random.row();
        let least = own.motor_torques(&wanted)?;
        assert!(distance(&wanted, &own.joint_torques(&least)?) < 1e-12);
        let same = own.motor_torques(&own.joint_torques(&torques)?)?;
        assert!(dot(&same, &same) <= dot(&torques, &torques) * (1.0 + 1e-12));
        // The kinetic energy of the rotors.
        let rotors: [f64; 5] = std::array::from_fn(|_| random.uniform());
        let inertia = own.reflected_inertia(&rotors)?;
        let speeds = own.motor_velocities(&rates)?;
        let energy: f64 = rotors.iter().zip(&speeds).map(|(i, w)| i * w * w).sum();
        let reflected: f64 = inertia
            .iter()
            .zip(&rates)
            .map(|(row, v)| v * dot(row, &rates))
            .sum();
        assert!((energy - reflected).abs() < 1e-12 * (1.0 + energy));
        // Accelerations, with those of the motors at a constant twist.
        let bias: [f64; 5] = random.row();
        let there = own.motor_accelerations(&rates, &bias)?;
        assert!(distance(&rates, &own.joint_accelerations(&there, &bias)?) < 1e-12);
    }
    Ok(())
}
