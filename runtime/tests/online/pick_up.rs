//! A mass picked up by a vertical two-link arm: false alarms, detection, and the mass found.
//!
//! The arm is known. Measured positions have the resolution of an encoder, torques have noise.
//! State-variable filters give q, q̇, q̈ and torques with equal delay. Every tenth sample enters a
//! payload estimator, whose whitened innovations are tested for changes, joint by joint.

use super::random::Random;
use overact::StandardParameter::{M, Mx, My, Zz};
use overact::online::{
    ChangeTest, Forgetting, PayloadEstimator, PayloadSize, StateVariableFilter, Whitening,
};
use overact_tier::by_tier;

const GRAVITY: f64 = 9.81;
/// Length of the first link, m.
const LENGTH: f64 = 0.4;
/// Sampling, Hz; and samples per estimation.
const SAMPLING: f64 = 1000.0;
const SAMPLES_PER_ESTIMATE: usize = 10;
/// Encoder steps per turn, and noise of a torque, N m.
const STEPS: f64 = 65_536.0;
const NOISE: f64 = 0.3;
/// Time after a change until which the filters settle, and until which there is no test, s.
const SETTLING_TIME: f64 = 0.1;
const LEARNING_TIME: f64 = 1.5;
/// Mass picked up, kg; its place on the second link, m; its inertia about its centre.
const MASS: f64 = 1.5;
const MASS_POSITION: f64 = 0.3;
const INERTIA: f64 = 0.004;

/// Joint rows of zz, mx, my, m of a body on the second link, whose frame is at the elbow.
fn rows(q: [f64; 2], v: [f64; 2], a: [f64; 2]) -> [[f64; 4]; 2] {
    let (s2, c2) = q[1].sin_cos();
    let (s12, c12) = (q[0] + q[1]).sin_cos();
    let (w, dw) = (v[0] + v[1], a[0] + a[1]);
    // Acceleration of the elbow minus gravity, in axes of the second link.
    let (ex, ey) = (-LENGTH * v[0] * v[0], LENGTH * a[0]);
    let x = c2 * ex + s2 * ey + GRAVITY * s12;
    let y = -s2 * ex + c2 * ey + GRAVITY * c12;
    // Moment about the elbow, and force in its axes, of each parameter.
    let moments = [dw, y, -x, 0.0];
    let forces = [[0.0, 0.0], [-w * w, dw], [-dw, -w * w], [x, y]];
    let lever = [LENGTH * s2, LENGTH * c2];
    let first =
        std::array::from_fn(|k| moments[k] + lever[0] * forces[k][0] + lever[1] * forces[k][1]);
    [first, moments]
}

/// Torques of the arm itself: two rods, and viscous friction.
fn arm(q: [f64; 2], v: [f64; 2], a: [f64; 2]) -> [f64; 2] {
    // 3 kg on the first link at half its length, 2 kg on the second.
    let second = [0.06, 0.3, 0.0, 2.0];
    let rows = rows(q, v, a).map(|row| row.iter().zip(second).map(|(a, b)| a * b).sum::<f64>());
    let own = 0.16 * a[0] + 3.0 * 0.2 * GRAVITY * q[0].cos();
    [rows[0] + own + 2.0 * v[0], rows[1] + v[1]]
}

/// Position, velocity and acceleration of a joint at a time: three harmonics.
fn motion(joint: usize, t: f64, phases: &[f64; 6]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for harmonic in 0..3 {
        let rate = 0.8 + 1.1 * harmonic as f64 + 0.3 * joint as f64;
        let (s, c) = (rate * t + phases[3 * joint + harmonic]).sin_cos();
        let size = 0.5 / (1.0 + harmonic as f64);
        sums[0] += size * s;
        sums[1] += size * rate * c;
        sums[2] -= size * rate * rate * s;
    }
    sums
}

/// Outcome of a run.
#[derive(Debug)]
struct Outcome {
    /// Times of changes, s.
    changes: Vec<f64>,
    /// Estimated mass at the end, and its standard deviation, kg.
    mass: f64,
    deviation: f64,
    /// Time from which the interval of the mass contains the truth and is narrower than ±5 %, s.
    known: Option<f64>,
    centre: f64,
}

/// Runs the arm for a duration (s), with the mass from a time on (s).
fn run(seed: u64, duration: f64, picked_up: f64) -> Outcome {
    let mut random = Random(seed);
    let phases: [f64; 6] = std::array::from_fn(|_| std::f64::consts::TAU * random.uniform());
    let filter = StateVariableFilter::<3>::new(20.0, SAMPLING).unwrap();
    let (mut positions, mut torques) = ([filter; 2], [filter; 2]);
    let size = PayloadSize {
        mass: 5.0,
        length: 0.5,
    };
    // White noise of this deviation in every tenth sample has the spectral density of the torque's
    // noise within the filter's band.
    let sigma = NOISE / (SAMPLES_PER_ESTIMATE as f64).sqrt();
    let mut estimator = PayloadEstimator::<4>::new([Zz, Mx, My, M], size)
        .unwrap()
        .with_forgetting(Forgetting::Directional(0.9995))
        .unwrap();
    let mut whitening = [Whitening::new(); 2];
    let mut tests = [ChangeTest::new(1.0, 1e6).unwrap(); 2];
    let mut outcome = Outcome {
        changes: Vec::new(),
        mass: 0.0,
        deviation: 0.0,
        known: None,
        centre: 0.0,
    };
    let mut changed = f64::NEG_INFINITY;
    let step = std::f64::consts::TAU / STEPS;
    for sample in 0..(duration * SAMPLING) as usize {
        let t = sample as f64 / SAMPLING;
        let [one, two] = [0, 1].map(|joint| motion(joint, t, &phases));
        let (q, v, a) = ([one[0], two[0]], [one[1], two[1]], [one[2], two[2]]);
        let mut tau = arm(q, v, a);
        if t >= picked_up {
            let body = [
                INERTIA + MASS * MASS_POSITION * MASS_POSITION,
                MASS * MASS_POSITION,
                0.0,
                MASS,
            ];
            for (tau, row) in tau.iter_mut().zip(rows(q, v, a)) {
                *tau += row.iter().zip(body).map(|(a, b)| a * b).sum::<f64>();
            }
        }
        let (mut state, mut measured) = ([[0.0; 2]; 3], [0.0; 2]);
        for joint in 0..2 {
            let q = (q[joint] / step).round() * step;
            let signal = positions[joint].update(q).unwrap();
            for (own, number) in
                state
                    .iter_mut()
                    .zip([signal.value, signal.velocity, signal.acceleration])
            {
                own[joint] = number;
            }
            let noisy = tau[joint] + NOISE * random.normal();
            measured[joint] = torques[joint].update(noisy).unwrap().value;
        }
        if sample < 200 || sample % SAMPLES_PER_ESTIMATE != 0 {
            continue;
        }
        let [q, v, a] = state;
        let known = arm(q, v, a);
        let residuals = [measured[0] - known[0], measured[1] - known[1]];
        let innovations = estimator
            .update(&rows(q, v, a), &residuals, &[sigma; 2])
            .unwrap();
        let mut has_changed = false;
        for ((whitening, test), one) in whitening.iter_mut().zip(&mut tests).zip(innovations) {
            has_changed |= test.update(whitening.update(one.normalised)).is_some();
        }
        if t < changed + SETTLING_TIME {
            // Rows until then contain torques from before the change.
            estimator.discount(1e-2).unwrap();
        }
        if t < changed + LEARNING_TIME {
            tests.iter_mut().for_each(ChangeTest::reset);
        } else if has_changed {
            outcome.changes.push(t);
            changed = t;
        }
        let mass = estimator.filter().estimate().unwrap()[3];
        let deviation = estimator.filter().standard_deviations().unwrap()[3];
        let half = 1.96 * deviation;
        if t >= picked_up && (mass - MASS).abs() <= half && half < 0.05 * MASS {
            outcome.known = outcome.known.or(Some(t - picked_up));
        }
        (outcome.mass, outcome.deviation) = (mass, deviation);
    }
    let payload = estimator.payload().unwrap();
    outcome.centre = payload.centre[0];
    outcome
}

#[test]
fn clean_runs_raise_few_false_alarms() {
    let (runs, mut alarms) = (by_tier([4, 100]), 0);
    for seed in 0..runs {
        let outcome = run(seed, 20.0, f64::INFINITY);
        alarms += outcome.changes.len();
        assert!(
            outcome.mass.abs() < 6.0 * outcome.deviation + 0.02,
            "{outcome:?}"
        );
    }
    println!("{alarms} false alarms in {runs} clean runs of 20 s");
    // Two tests of 1980 samples with one alarm in 10⁶: 0.4 alarms are expected in 100 runs.
    assert!(alarms <= 4, "{alarms}");
}

#[test]
fn a_picked_up_mass_is_detected_and_estimated() {
    let runs = by_tier([4, 100]);
    let mut repeated = 0;
    let (mut delays, mut known, mut errors) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..runs {
        let outcome = run(1000 + seed, 20.0, 10.0);
        let mut later = outcome.changes.iter().filter(|time| **time > 10.0);
        let delay = later.next().expect("a detection") - 10.0;
        repeated += later.count();
        assert!(delay > 0.0 && delay < 1.0, "{outcome:?}");
        assert!((outcome.mass / MASS - 1.0).abs() < 0.02, "{outcome:?}");
        assert!((outcome.centre - MASS_POSITION).abs() < 0.02, "{outcome:?}");
        delays.push(delay);
        known.push(outcome.known.expect("a narrow interval"));
        errors.push(outcome.mass - MASS);
    }
    let sorted = |mut all: Vec<f64>| {
        all.sort_by(f64::total_cmp);
        (all[all.len() / 2], all[all.len() - 1])
    };
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    println!(
        "{runs} runs: delay of detection (median, largest) {:.3?} s; interval good after {:.2?} s; error of the mass {rms:.4} kg; {repeated} later alarms",
        sorted(delays),
        sorted(known),
    );
}
