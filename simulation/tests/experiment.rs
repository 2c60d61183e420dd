//! Complete experiments compared with analytic solutions and the expected log.

mod support;

use std::f64::consts::TAU;

use overact::{Columns, Function, Model};
use overact_simulation::{
    Cause, Error, Experiment, Record, Run, Stage, Term, Trajectory, simulate, write_csv,
};
use support::{
    Robot,
    mechanisms::{DualV, Kinematics, Shaft, Tripod, TwoMotors},
};

fn term(coordinate: &str, harmonic: u32, amplitude: f64, phase_rad: f64) -> Term {
    Term {
        coordinate: coordinate.into(),
        harmonic,
        amplitude,
        phase_rad,
    }
}

fn run(name: &str, payload: bool, fundamental_hz: f64, terms: Vec<Term>) -> Run {
    let trajectory = Trajectory::Periodic {
        fundamental_hz,
        terms,
    };
    Run {
        name: name.into(),
        payload,
        duration_s: None,
        trajectory,
    }
}

fn records(model: &dyn Model, experiment: &Experiment) -> Vec<Record> {
    simulate(model, experiment, &|_, _| ()).unwrap_or_else(|error| panic!("{error}"))
}

/// The tripod with friction, two runs.
fn tripod() -> Experiment {
    let circle = |r: f64| {
        vec![
            term("x", 1, r, 0.0),
            term("y", 1, r, 1.6),
            term("x", 2, 0.3 * r, 1.0),
        ]
    };
    Experiment {
        duration_s: 1.0,
        parameters: vec![0.8, 2.0, 0.5, 1.3, 1.0, 0.3, 0.4, 3.0, 0.4, 2.0, 0.7],
        runs: vec![
            run("free", false, 2.0, circle(0.1)),
            run("loaded", true, 1.0, circle(0.2)),
        ],
        ..Experiment::default()
    }
}

#[test]
fn pd_control_has_the_error_of_its_transfer_function() {
    // e / x_d = s² / (s² + 2ξω_c s F + ω_c²) with F = 1 / (1 + s / ω_f), for a frictionless mass.
    let model = Robot::new(TwoMotors);
    let experiment = Experiment {
        feed_forward: false,
        parameters: vec![0.3, 0.0, 0.0, 0.7, 0.0, 0.0, 1.0, 0.5],
        duration_s: 2.0,
        runs: vec![run("sine", true, 5.0, vec![term("x", 1, 0.01, 0.0)])],
        ..Experiment::default()
    };
    let record = &records(&model, &experiment)[0];
    let (rate, natural) = (TAU * 5.0, TAU * 70.0);
    // With s = j rate and u = rate / ω_c = rate / ω_f: F = (1 - j u) / (1 + u²).
    let u = rate / natural;
    let real = 1.0 - u * u + 1.4 * u * u / (1.0 + u * u);
    let imaginary = 1.4 * u / (1.0 + u * u);
    let expected = 0.01 * u * u / real.hypot(imaginary);
    // The last second, long after the transient; the sampling delay changes it by less than 1 %.
    let error = (5000..10_000)
        .map(|k| (0.01 * (rate * record.time[k]).sin() - record.positions[2 * k]).abs())
        .fold(0.0, f64::max);
    assert!(
        (error / expected - 1.0).abs() < 0.01,
        "{error:e} {expected:e}"
    );
    // The initial transient is small too, because the run starts in the trajectory's state.
    assert!(record.tracking_error[0] < 3.0 * expected);
}

#[test]
fn feed_forward_reduces_the_tracking_error() {
    let model = Robot::new(Tripod);
    let experiment = tripod();
    let plain = Experiment {
        feed_forward: false,
        ..experiment.clone()
    };
    for (with, without) in records(&model, &experiment)
        .iter()
        .zip(records(&model, &plain))
    {
        for (with, without) in with.tracking_error.iter().zip(without.tracking_error) {
            assert!(*with < 0.1 * without, "{with:e} {without:e}");
            assert!(without < 5e-3, "{without:e}");
        }
    }
}

/// Largest component of the torques in the null space of J^T at the desired pose.
fn internal_torque(model: &Robot<Tripod>, experiment: &Experiment) -> f64 {
    let record = &records(model, experiment)[0];
    let home = model.kinematics.home();
    let mut largest = 0.0_f64;
    for k in 1..record.time.len() {
        let mut rows = [[0.0; 2]; 3];
        let [position, velocity, acceleration] = &mut rows;
        let mut out = overact_simulation::trajectory::Displacement {
            position,
            velocity,
            acceleration,
        };
        experiment.runs[0]
            .trajectory
            .evaluate(&["x", "y"], record.time[k], &mut out);
        let pose = [home[0] + rows[0][0], home[1] + rows[0][1]];
        let torques = &record.torques[3 * k..3 * k + 3];
        let mut projected = [0.0; 3];
        model
            .evaluate(Function::ProjectTorques, &[&pose, torques], &mut projected)
            .unwrap();
        for (a, b) in torques.iter().zip(projected) {
            largest = largest.max((a - b).abs());
        }
    }
    largest
}

#[test]
fn projection_removes_internal_torques_caused_by_encoders() {
    let model = Robot::new(Tripod);
    let with = Experiment {
        encoder_resolution: vec![1e-5; 3],
        ..tripod()
    };
    let without = Experiment {
        project_internal: false,
        ..with.clone()
    };
    let (with, without) = (
        internal_torque(&model, &with),
        internal_torque(&model, &without),
    );
    // The recorded torque is the mean over two samples, so a small part remains with projection.
    assert!(with < 0.02 * without, "{with:e} {without:e}");
    assert!(without > 0.5);
}

#[test]
fn sensors_have_the_stated_resolution_and_noise() {
    let model = Robot::new(Tripod);
    let ideal = Experiment {
        encoder_resolution: vec![1e-5, 0.0, 1e-4],
        ..tripod()
    };
    let noisy = Experiment {
        torque_noise: vec![0.3, 0.0, 2.0],
        seed: 5,
        ..ideal.clone()
    };
    let (ideal, noisy) = (records(&model, &ideal), records(&model, &noisy));
    for (ideal, noisy) in ideal.iter().zip(&noisy) {
        // Noise of the torque measurement does not affect the robot.
        assert_eq!(ideal.positions, noisy.positions);
        for (i, resolution) in [(0, 1e-5), (2, 1e-4)] {
            let steps = noisy
                .positions
                .iter()
                .skip(i)
                .step_by(3)
                .map(|q| q / resolution);
            assert!(steps.into_iter().all(|s| (s - s.round()).abs() < 1e-9));
        }
        for (i, deviation) in [0.3, 0.0, 2.0].into_iter().enumerate() {
            let noise = noisy.torques.iter().zip(&ideal.torques).skip(i).step_by(3);
            let n = ideal.time.len() as f64;
            let square = noise.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / n;
            assert!((square.sqrt() - deviation).abs() <= 4.0 * deviation / (2.0 * n).sqrt());
        }
    }
}

#[test]
fn results_do_not_depend_on_threads_or_run_order() {
    let model = Robot::new(Tripod);
    let noisy = Experiment {
        torque_noise: vec![0.3; 3],
        encoder_resolution: vec![1e-5; 3],
        ..tripod()
    };
    let mut swapped = noisy.clone();
    swapped.runs.reverse();
    let mut again = records(&model, &swapped);
    again.reverse();
    let first = records(&model, &noisy);
    assert_eq!(first, again);
    let other = records(&model, &Experiment { seed: 1, ..noisy });
    assert_ne!(first[0].torques, other[0].torques);
}

#[test]
fn progress_reaches_one_and_reports_the_runs() {
    let progress_calls = std::cell::RefCell::new(Vec::new());
    simulate(&Robot::new(Tripod), &tripod(), &|fraction, run| {
        progress_calls
            .borrow_mut()
            .push((fraction, run.to_string()));
    })
    .unwrap();
    let progress_calls = progress_calls.into_inner();
    assert!(progress_calls.windows(2).all(|w| w[0].0 < w[1].0));
    assert_eq!(progress_calls.last().unwrap().0, 1.0);
    assert!(
        ["free", "loaded"]
            .iter()
            .all(|name| progress_calls.iter().any(|(_, run)| run == name))
    );
}

/// Least-squares parameters (ia of the legs, m, mx, my, zz) from the log, on the desired motion.
#[test]
fn a_simulated_dualv_log_gives_the_true_parameters() {
    let model = Robot::new(DualV);
    let truth = [4.45e-2, 4.81e-2, 4.81e-2, 5.07e-2, 1.92, 0.0, 0.0, 2.06e-2];
    let mut parameters = vec![0.0; 20];
    for leg in 0..4 {
        parameters[3 * leg] = truth[leg];
    }
    parameters[12..16].copy_from_slice(&truth[4..]);
    let terms = vec![
        term("x", 1, 0.05, 0.3),
        term("y", 2, 0.03, 1.0),
        term("x", 3, 0.02, -1.0),
        term("phi", 1, 0.2, 2.0),
        term("phi", 4, 0.03, 0.0),
        term("y", 3, 0.02, 0.5),
    ];
    let experiment = Experiment {
        parameters,
        duration_s: 1.0,
        runs: vec![run("excite", false, 1.0, terms)],
        ..Experiment::default()
    };
    let record = &records(&model, &experiment)[0];
    assert!(
        record.tracking_error.iter().all(|e| *e < 2e-5),
        "{:?}",
        record.tracking_error
    );
    let columns = [0, 3, 6, 9, 12, 13, 14, 15];
    let (mut normal, mut right) = ([0.0; 64], [0.0; 8]);
    for k in 500..record.time.len() {
        let mut rows = [[0.0; 3]; 3];
        let [position, velocity, acceleration] = &mut rows;
        let mut out = overact_simulation::trajectory::Displacement {
            position,
            velocity,
            acceleration,
        };
        experiment.runs[0]
            .trajectory
            .evaluate(&["x", "y", "phi"], record.time[k], &mut out);
        let (mut w, mut force) = ([0.0; 48], [0.0; 3]);
        let inputs: [&[f64]; 3] = [&rows[0], &rows[1], &rows[2]];
        model
            .evaluate(Function::IdmRedPlatform(Columns::Standard), &inputs, &mut w)
            .unwrap();
        let torques = &record.torques[4 * k..4 * k + 4];
        model
            .evaluate(Function::ProjectPlatform, &[&rows[0], torques], &mut force)
            .unwrap();
        for row in 0..3 {
            for (a, ca) in columns.iter().enumerate() {
                right[a] += w[16 * row + ca] * force[row];
                for (b, cb) in columns.iter().enumerate() {
                    normal[8 * a + b] += w[16 * row + ca] * w[16 * row + cb];
                }
            }
        }
    }
    overact::forward::solve_positive_definite(&mut normal, &mut right).unwrap();
    for (found, truth) in right.iter().zip(truth) {
        assert!(
            (found - truth).abs() < 5e-5 * truth.abs().max(0.02),
            "{right:?}"
        );
    }
}

#[test]
fn non_additive_poses_are_tracked() {
    // The chart is not the angle, so twist and feed-forward come from the actuators' motion. The
    // second actuator passes half a turn.
    let model = Robot::new(Shaft);
    let experiment = Experiment {
        parameters: vec![0.1, 0.2, 0.0, 0.2, 0.1, 0.0, 0.1, 0.3],
        duration_s: 1.0,
        runs: vec![run("swing", false, 1.0, vec![term("phi", 1, 1.5, 0.4)])],
        ..Experiment::default()
    };
    let record = &records(&model, &experiment)[0];
    assert!(
        record.tracking_error.iter().all(|e| *e < 1e-4),
        "{:?}",
        record.tracking_error
    );
    let largest = record
        .positions
        .iter()
        .skip(1)
        .step_by(2)
        .fold(0.0_f64, |m, q| m.max(q.abs()));
    assert!(
        (largest - 3.0 * 2.0 * 0.75_f64.atan()).abs() < 1e-3,
        "{largest}"
    );
}

#[test]
fn all_invalid_settings_are_reported_together() {
    let mut bad = Experiment {
        sampling_hz: 600.0,
        duration_s: -1.0,
        encoder_resolution: vec![1e-5],
        torque_noise: vec![f64::NAN, 0.0, 0.0],
        torque_limit: Some(vec![]),
        parameters: vec![1.0; 4],
        integration_steps: 0,
        ..tripod()
    };
    bad.runs[0].trajectory = Trajectory::Periodic {
        fundamental_hz: 1.0,
        terms: vec![term("z", 0, 1.0, 0.0)],
    };
    bad.runs[1].name = "free".into();
    bad.runs[1].trajectory = Trajectory::PointToPoint {
        points: vec![vec![0.0; 2], vec![0.0; 3]],
        times: vec![1.0, 0.5],
    };
    let Err(Error::Experiment(problems)) = simulate(&Robot::new(Tripod), &bad, &|_, _| ()) else {
        panic!("the experiment is bad");
    };
    let fields: Vec<&str> = problems.iter().map(|p| p.field.as_str()).collect();
    assert_eq!(
        fields,
        [
            "duration_s",
            "bandwidth_hz",
            "integration_steps",
            "encoder_resolution",
            "torque_noise[0]",
            "torque_limit",
            "parameters",
            "runs[0].trajectory.terms[0].coordinate",
            "runs[0].trajectory.terms[0].harmonic",
            "runs[1].name",
            "runs[1].trajectory.points[1]",
            "runs[1].trajectory.times[1]",
        ]
    );
    let text = Error::Experiment(problems).to_string();
    assert!(
        text.contains("`parameters`: has 4 numbers; give 11: 10 of the robot and 1 of the payload")
    );
    assert!(text.contains("`z` is none of x, y"));
}

#[test]
fn failing_runs_are_reported_with_their_time() {
    let model = Robot::new(Tripod);
    let mut far = tripod();
    far.runs[1].trajectory = Trajectory::PointToPoint {
        points: vec![vec![0.0, 0.0], vec![-1.5, 0.0]],
        times: vec![0.0, 1.0],
    };
    let Err(Error::Runs(errors)) = simulate(&model, &far, &|_, _| ()) else {
        panic!("out of reach")
    };
    assert_eq!((errors.len(), errors[0].run.as_str()), (1, "loaded"));
    assert_eq!(errors[0].stage, Stage::Trajectory);
    // The leg from (1, 0) is 2 m long at x = -1: u³(10 - 15 u + 6 u²) = 0.7 at u = 0.6106...
    assert!(
        (errors[0].time_s - 0.61).abs() < 0.02,
        "{}",
        errors[0].time_s
    );
    let text = errors[0].to_string();
    assert!(
        text.starts_with("run `loaded`, the desired trajectory at t = 0.6"),
        "{text}"
    );

    let mut fast = tripod();
    fast.runs.truncate(1);
    fast.runs[0].trajectory = Trajectory::PointToPoint {
        points: vec![vec![0.0, 0.0], vec![0.7, 0.0]],
        times: vec![0.0, 0.3],
    };
    fast.torque_limit = Some(vec![1.0; 3]);
    let limited = records(&model, &fast);
    assert!(limited[0].torques.iter().all(|tau| tau.abs() <= 1.0));
    assert!(limited[0].tracking_error.iter().any(|e| *e > 0.1));

    let massless = Experiment {
        parameters: vec![0.0; 11],
        ..tripod()
    };
    let Err(Error::Runs(errors)) = simulate(&model, &massless, &|_, _| ()) else {
        panic!("no mass")
    };
    assert_eq!(errors.len(), 2);
    assert!(errors.iter().all(|e| e.cause == Cause::MassMatrix));
}

#[test]
fn the_csv_log_round_trips_exactly() {
    let model = Robot::new(Tripod);
    let mut experiment = Experiment {
        torque_noise: vec![0.1; 3],
        ..tripod()
    };
    experiment.runs[0].duration_s = Some(0.01);
    let record = &records(&model, &experiment)[0];
    let mut bytes = Vec::new();
    write_csv(record, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time,q_a,q_b,q_c,tau_a,tau_b,tau_c"));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 50);
    for (k, row) in rows.iter().enumerate() {
        assert_eq!(row[0], record.time[k]);
        assert_eq!(row[1..4], record.positions[3 * k..3 * k + 3]);
        assert_eq!(row[4..7], record.torques[3 * k..3 * k + 3]);
    }
}

#[test]
fn an_experiment_is_read_from_toml() {
    let text = r#"
        parameters = [1.0, 2.0]
        torque_limit = [127.0, 127.0]
        [[runs]]
        name = "a"
        payload = true
        [runs.trajectory]
        kind = "periodic"
        fundamental_hz = 0.2
        terms = [{ coordinate = "x", harmonic = 1, amplitude = 0.1 }]
    "#;
    let experiment: Experiment = toml::from_str(text).unwrap();
    assert_eq!(experiment.bandwidth_hz, 70.0);
    assert!(experiment.runs[0].payload && experiment.torque_limit.is_some());
    let again = toml::to_string(&experiment).unwrap();
    assert_eq!(toml::from_str::<Experiment>(&again).unwrap(), experiment);
    assert!(toml::from_str::<Experiment>("bandwith_hz = 60.0").is_err());
    assert!(toml::from_str::<Experiment>(&text.replace("fundamental_hz", "basis_hz")).is_err());
    assert!(toml::from_str::<Experiment>(&text.replace("terms", "x = 1\nterms")).is_err());
}
