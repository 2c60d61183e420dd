//! Platform projection and all actuator projections of a robot with r = 2 and n = 3.
//!
//! Its Jacobian depends on the pose.

mod common;
#[path = "common/point.rs"]
mod point;

use std::{collections::BTreeMap, f64::consts::PI};

use nalgebra::DMatrix;
use overact::{Function, Model};
use overact_identification::{
    Dataset, Log, ModelKind, Motion, Projection, Settings, Stage, estimate_projection, identify,
    motion, prepare, study,
};
use point::{Point, column, leg};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// ia, fv, fs, off of each leg, then the mass.
const TRUTH: [f64; 13] = [
    0.5, 4.0, 1.0, 0.2, 0.6, 5.0, 1.5, -0.3, 0.4, 3.0, 0.7, 0.1, 6.0,
];

fn settings() -> Settings {
    let mut settings = Settings::for_bandwidth(2.0, 500.0, &Point.info());
    settings.decimation = 5;
    settings.skip_start = 100;
    settings.skip_end = 100;
    settings
}

/// A run with torques of the true parameters on the filtered motion.
///
/// It has a preload in the null space of Jᵀ, and noise of size `noise` (N).
fn run(name: &str, seed: f64, noise: f64) -> Log {
    let (frequency, samples) = (500.0, 5000);
    let wave = |t: f64, phase: f64| -> f64 {
        (1..=4)
            .map(|k| {
                let k = f64::from(k);
                0.15 / k
                    * (2.0 * PI * (0.25 * k + 0.05 * seed + 0.03 * phase) * t + phase * k).sin()
            })
            .sum()
    };
    let positions: Vec<f64> = (0..samples)
        .flat_map(|k| {
            let t = f64::from(k) / frequency;
            let x = [wave(t, seed), 0.1 + wave(t, seed + 1.3)];
            [0, 1, 2].map(|index| leg(index, x, [0.0; 2], [0.0; 2]).q)
        })
        .collect();
    let idle = vec![0.0; positions.len()];
    let idle = Log::new(name, frequency, 3, positions.clone(), idle, false).expect("a run");
    let whole = Settings {
        skip_start: 0,
        skip_end: 0,
        ..settings()
    };
    let motion = motion(&Point, &idle, &whole, &|_, _| {}).expect("a motion");
    // The filter acts on each leg separately, and reflects its ends, so the loops nearly close.
    println!("{name}: closure residual {:.1e} m", motion.closure_residual);
    assert!(motion.closure_residual < 1e-3);
    let mut generator = Pcg64::seed_from_u64(seed as u64);
    let torques = (0..motion.samples).flat_map(|k| {
        let pair = |values: &[f64]| [values[2 * k], values[2 * k + 1]];
        let (x, v, a) = (
            pair(&motion.pose),
            pair(&motion.twist),
            pair(&motion.acceleration),
        );
        let mut gamma = [0.0; 2];
        for (index, value) in TRUTH.iter().enumerate() {
            let column = column(index, x, v, a);
            gamma[0] += value * column[0];
            gamma[1] += value * column[1];
        }
        // Leg 3 is given; legs 1 and 2 balance the rest.
        let third = 2.0 + (0.01 * k as f64).sin();
        let [u1, u2, u3] = [0, 1, 2].map(|index| leg(index, x, v, a).u);
        let rest = [gamma[0] - third * u3[0], gamma[1] - third * u3[1]];
        let determinant = u1[0] * u2[1] - u1[1] * u2[0];
        let first = (rest[0] * u2[1] - rest[1] * u2[0]) / determinant;
        let second = (u1[0] * rest[1] - u1[1] * rest[0]) / determinant;
        let mut random = || noise * generator.random_range(-1.0..1.0);
        [first + random(), second + random(), third + random()]
    });
    let torques = torques.collect();
    Log::new(name, frequency, 3, positions, torques, false).expect("a run")
}

fn truth() -> BTreeMap<String, f64> {
    let info = Point.info();
    info.parameters
        .iter()
        .map(|parameter| parameter.name.to_owned())
        .zip(TRUTH)
        .collect()
}

#[test]
fn every_partition_recovers_the_truth() {
    let runs = [run("one", 1.0, 0.0), run("two", 2.0, 0.0)];
    let mut projections = vec![Projection::Platform];
    projections.extend([vec![0, 1], vec![0, 2], vec![2, 1]].map(Projection::Actuators));
    let prepared = prepare(&Point, &runs, &projections, &settings(), &|_| {}).expect("prepared");
    let truth = truth();
    let motions = runs
        .each_ref()
        .map(|run| motion(&Point, run, &settings(), &|_, _| {}).expect("a motion"));
    for (number, projection) in projections.iter().enumerate() {
        let outcome =
            estimate_projection(&prepared, number, &settings(), Some(&truth)).expect("an estimate");
        // The symmetric order: platform, then each symbol of all legs.
        let names: Vec<&str> = outcome
            .base
            .parameters
            .iter()
            .map(|p| p.name.as_str())
            .collect();
        assert_eq!(
            names[..5],
            [
                "m_platform",
                "ia_1_leg1",
                "ia_1_leg2",
                "ia_1_leg3",
                "fv_1_leg1"
            ]
        );
        for parameter in &outcome.base.parameters {
            let known = parameter.true_value.expect("known");
            let error = (parameter.value - known).abs();
            // The actuator projection multiplies before the decimation filter, so it is exact, too.
            assert!(
                error < 1e-8 * known.abs(),
                "{projection:?} {}: {error:e}",
                parameter.name
            );
        }
        assert_eq!(outcome.base.equations, 2 * 2 * 960);
        if let Some(partition) = &outcome.base.partition {
            let expected = worst_condition(&motions, projection);
            assert!((partition.largest / expected - 1.0).abs() < 1e-10);
        }
    }
}

/// Largest condition number of the kept rows, with columns of J_p^inv scaled by norms at home.
fn worst_condition(motions: &[Motion], projection: &Projection) -> f64 {
    let Projection::Actuators(kept) = projection else {
        return 1.0;
    };
    let mut home = [0.0; 6];
    Point
        .evaluate(
            Function::InverseJacobian,
            &[Point.info().home_pose],
            &mut home,
        )
        .expect("a Jacobian");
    let norms = [0, 1].map(|j| (0..3).map(|i| home[2 * i + j].powi(2)).sum::<f64>().sqrt());
    let mut worst = 0.0_f64;
    for motion in motions {
        let mut jacobians = vec![0.0; motion.samples * 6];
        Point
            .evaluate(Function::InverseJacobian, &[&motion.pose], &mut jacobians)
            .expect("a Jacobian");
        for jacobian in jacobians.chunks_exact(6) {
            let rows = DMatrix::from_fn(2, 2, |i, j| jacobian[2 * kept[i] + j] / norms[j]);
            let values = rows.svd(false, false).singular_values;
            worst = worst.max(values.max() / values.min());
        }
    }
    worst
}

#[test]
fn standard_deviations_cover_the_noise() {
    let runs = [run("one", 1.0, 0.5), run("two", 2.0, 0.5)];
    let validation = [run("three", 3.0, 0.5)];
    let truth = truth();
    let dataset = Dataset {
        runs: &runs,
        validation: &validation,
        true_values: Some(&truth),
        variants: &[],
        scales: None,
    };
    let result = identify(&Point, &dataset, &settings(), &|_| {}).expect("a result");
    println!("{:#?}", result.estimates);
    assert_eq!(result.estimates[3].kept_actuators, ["leg1", "leg3"]);
    for estimate in result
        .estimates
        .iter()
        .filter(|estimate| estimate.stage == Stage::Base)
    {
        for parameter in &estimate.parameters {
            let error = parameter.value - parameter.true_value.expect("known");
            // Five standard deviations: the decimation filter colours the noise a little.
            assert!(
                error.abs() < 5.0 * parameter.standard_deviation,
                "{}: {error} against {}",
                parameter.name,
                parameter.standard_deviation
            );
        }
        let mass = &estimate.parameters[0];
        assert!(mass.relative_standard_deviation_percent < 0.1);
    }
    // The cross-validation error has the size of the noise, like that of the training run.
    let estimated = result.cross_validation.iter();
    for cross in estimated.filter(|one| one.stage != Stage::Consistent) {
        let own = result
            .estimates
            .iter()
            .find(|estimate| (estimate.model, estimate.stage) == (cross.model, cross.stage))
            .expect("its estimate");
        assert!(cross.relative_error_percent < 1.5 * own.relative_error_percent);
        assert_eq!(cross.torques.len(), 3);
    }
}

/// ||Y - W χ|| and ||Y|| of a run for the platform's equations, with χ from another run.
fn predicted(run: &Log, from: &Log) -> (f64, f64) {
    let dataset = Dataset {
        runs: std::slice::from_ref(from),
        validation: std::slice::from_ref(run),
        true_values: None,
        variants: &[],
        scales: None,
    };
    let result = identify(&Point, &dataset, &settings(), &|_| {}).expect("a result");
    let mut all = result.cross_validation.iter();
    let one = all
        .find(|one| (one.model, one.stage) == (ModelKind::Platform, Stage::Base))
        .expect("case 1");
    let measured = 100.0 * one.residual_norm / one.relative_error_percent;
    (one.residual_norm, measured)
}

#[test]
fn partitions_are_compared_on_held_out_runs() {
    let runs = [run("one", 1.0, 0.5), run("two", 2.0, 0.5)];
    let folds = [predicted(&runs[0], &runs[1]), predicted(&runs[1], &runs[0])];
    let norm = |part: fn(&(f64, f64)) -> f64| {
        let squares = folds.iter().map(|fold| part(fold).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let expected = 100.0 * norm(|fold| fold.0) / norm(|fold| fold.1);
    let dataset = Dataset {
        runs: &runs,
        validation: &[],
        true_values: None,
        variants: &[],
        scales: None,
    };
    let choices = [vec![0, 1], vec![0, 2], vec![1, 2]];
    let study = study(&Point, &dataset, &choices, &settings(), &|_| {}).expect("a study");
    let platform = study.platform.held_out_percent.expect("folds");
    // The line weights come from both runs, those of `predicted` from one.
    assert!(
        (platform / expected - 1.0).abs() < 0.01,
        "{platform} {expected}"
    );
    assert_eq!(study.partitions.len(), 3);
    for choice in &study.partitions {
        // Tested on the platform, where its own projection predicts best, if only just.
        let held_out = choice.held_out_percent.expect("folds");
        assert!(
            held_out > 0.99 * platform && held_out < 1.5 * platform,
            "{held_out} {platform}"
        );
    }
}
