//! Virtual DualV under PD control with and without feed-forward, as in the paper's Table 4.
//!
//! Prints the largest tracking errors of each motor. Run it with `cargo run --release -p
//! overact-simulation --example virtual_dualv`.

#[path = "../tests/support/mod.rs"]
mod support;

use std::time::Instant;

use overact_simulation::{Experiment, Run, Term, Trajectory, simulate};
use support::{Robot, mechanisms::DualV};

/// A smooth motion; `shift` makes each run different.
fn trajectory(shift: f64) -> Trajectory {
    let term = |coordinate: &str, harmonic, amplitude, phase_rad| Term {
        coordinate: coordinate.into(),
        harmonic,
        amplitude,
        phase_rad,
    };
    Trajectory::Periodic {
        fundamental_hz: 0.5,
        terms: vec![
            term("x", 1, 0.05, shift),
            term("x", 5, 0.01, 2.0 * shift),
            term("y", 2, 0.03, 1.0 - shift),
            term("y", 5, 0.01, 0.3),
            term("phi", 1, 0.2, 2.0 + shift),
            term("phi", 6, 0.05, 0.0),
        ],
    }
}

fn main() -> Result<(), overact_simulation::Error> {
    // Parameters of Table 2 (case 1) and motor friction: ia, fv, fs of each leg; m, mx, my, zz.
    let mut parameters = Vec::new();
    for inertia in [4.45e-2, 4.81e-2, 4.81e-2, 5.07e-2] {
        parameters.extend([inertia, 0.02, 0.2]);
    }
    parameters.extend([1.92, 0.0, 0.0, 2.06e-2, 5.42, -1.27e-1, 0.0, 1.61e-2]);
    let runs = (0..4).map(|i| Run {
        name: format!("run{}", i + 1),
        payload: i >= 2,
        duration_s: None,
        trajectory: trajectory(f64::from(i)),
    });
    let experiment = Experiment {
        parameters,
        encoder_resolution: vec![1e-5; 4],
        torque_noise: vec![0.3; 4],
        torque_limit: Some(vec![127.0; 4]),
        runs: runs.collect(),
        ..Experiment::default()
    };
    let model = Robot::new(DualV);
    for feed_forward in [false, true] {
        let start = Instant::now();
        let experiment = Experiment {
            feed_forward,
            ..experiment.clone()
        };
        let records = simulate(&model, &experiment, &|_, _| ())?;
        println!(
            "feed-forward: {feed_forward}; computed in {:.2?}",
            start.elapsed()
        );
        for record in records {
            let errors: Vec<String> = record
                .tracking_error
                .iter()
                .map(|e| format!("{:.3}", 1e3 * e))
                .collect();
            let peak = record.torques.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
            println!(
                "  {}: {} mrad; largest torque {peak:.1} N m",
                record.name,
                errors.join("  ")
            );
        }
    }
    Ok(())
}
