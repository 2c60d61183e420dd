//! Trajectories: derivatives compared with finite differences, end conditions, text.

use std::f64::consts::PI;

use overact_simulation::{Term, Trajectory, trajectory::Displacement};

const NAMES: [&str; 2] = ["x", "y"];

fn at(trajectory: &Trajectory, t: f64) -> [[f64; 2]; 3] {
    let mut rows = [[0.0; 2]; 3];
    let [position, velocity, acceleration] = &mut rows;
    trajectory.evaluate(
        &NAMES,
        t,
        &mut Displacement {
            position,
            velocity,
            acceleration,
        },
    );
    rows
}

fn term(coordinate: &str, harmonic: u32, amplitude: f64, phase_rad: f64) -> Term {
    Term {
        coordinate: coordinate.into(),
        harmonic,
        amplitude,
        phase_rad,
    }
}

fn examples() -> [Trajectory; 2] {
    [
        Trajectory::Periodic {
            fundamental_hz: 0.4,
            terms: vec![
                term("x", 1, 0.3, 0.2),
                term("y", 3, 0.1, -1.0),
                term("x", 2, -0.2, 1.5),
            ],
        },
        Trajectory::PointToPoint {
            points: vec![vec![0.1, 0.0], vec![0.3, -0.2], vec![0.0, 0.5]],
            times: vec![0.5, 1.25, 2.0],
        },
    ]
}

#[test]
fn derivatives_agree_with_finite_differences() {
    let h = 1e-5;
    for trajectory in examples() {
        for k in 0..40 {
            let t = 0.013 + 0.061 * f64::from(k);
            let [before, here, after] = [t - h, t, t + h].map(|t| at(&trajectory, t));
            for c in 0..2 {
                let velocity = (after[0][c] - before[0][c]) / (2.0 * h);
                let acceleration = (after[1][c] - before[1][c]) / (2.0 * h);
                assert!((here[1][c] - velocity).abs() < 1e-8);
                assert!((here[2][c] - acceleration).abs() < 1e-7);
            }
        }
    }
}

#[test]
fn a_periodic_trajectory_is_its_sum_of_sines() {
    let [periodic, _] = examples();
    let t = 0.7;
    let x = 0.3 * (2.0 * PI * 0.4 * t + 0.2).sin() - 0.2 * (2.0 * PI * 0.8 * t + 1.5).sin();
    assert!((at(&periodic, t)[0][0] - x).abs() < 1e-15);
    // The period is 2.5 s.
    assert!((at(&periodic, t + 2.5)[2][1] - at(&periodic, t)[2][1]).abs() < 1e-12);
}

#[test]
fn point_to_point_motions_rest_at_their_points() {
    let [_, quintic] = examples();
    for (t, point) in [
        (0.0, [0.1, 0.0]),
        (0.5, [0.1, 0.0]),
        (1.25, [0.3, -0.2]),
        (9.0, [0.0, 0.5]),
    ] {
        assert_eq!(at(&quintic, t), [point, [0.0; 2], [0.0; 2]]);
    }
    // At half time it is half way, at the largest velocity, 15/8 of the mean.
    let [position, velocity, _] = at(&quintic, 0.875);
    assert!((position[0] - 0.2).abs() < 1e-15);
    assert!((velocity[0] - 15.0 / 8.0 * 0.2 / 0.75).abs() < 1e-15);
}

#[test]
fn trajectories_round_trip_through_toml() {
    for trajectory in examples() {
        let text = trajectory.to_toml();
        assert_eq!(
            toml::from_str::<Trajectory>(&text).unwrap(),
            trajectory,
            "{text}"
        );
    }
}
