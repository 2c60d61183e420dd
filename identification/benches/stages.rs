//! Benchmarks of each stage of an identification: a virtual DualV, four runs of 10 s at 5 kHz.
//!
//! The robot is the hand-written one of the tests, so the times exclude generated or interpreted
//! models.

#[path = "../tests/common/dualv.rs"]
mod dualv;

use std::{fs::File, hint::black_box, path::Path};

use criterion::{Criterion, criterion_group, criterion_main};
use dualv::{DualV, experiment, logs, records, truth};
use overact::Model;
use overact_identification::{
    Dataset, Log, Mapping, Motions, Projection, Settings, estimate_projection,
    filters::{Decimator, ZeroPhase, butterworth},
    identify, prepare,
};
use overact_logs::read;

const SAMPLES: usize = 50_000;

fn settings(robot: &DualV) -> Settings {
    Settings {
        filter_cutoff_hz: 100.0,
        decimation: 50,
        ..Settings::for_bandwidth(10.0, 5000.0, &robot.info())
    }
    .trimmed(5000.0)
}

/// The runs, one of them written to a file.
fn data(robot: &DualV, folder: &Path) -> Vec<Log> {
    let mut experiment = experiment(robot, 1.0, 1);
    experiment.sampling_hz = 5000.0;
    experiment.duration_s = 10.0;
    experiment
        .runs
        .retain(|run| !run.name.contains("trajectory"));
    let records = records(robot, &experiment);
    let file = File::create(folder.join("run.csv")).expect("a file");
    overact_simulation::write_csv(&records[0], file).expect("written");
    logs(records)
}

fn stages(criterion: &mut Criterion) {
    let robot = DualV::new();
    let folder = tempfile::tempdir().expect("a folder");
    let runs = data(&robot, folder.path());
    let settings = settings(&robot);
    let projections = [
        Projection::Platform,
        Projection::Actuators(settings.kept_actuators.clone()),
    ];
    let mut group = criterion.benchmark_group("identification");
    group.sample_size(10);

    let (file, mapping) = (
        folder.path().join("run.csv"),
        Mapping::for_robot(&robot.info()),
    );
    group.bench_function("read one run of CSV", |bench| {
        bench.iter(|| read(black_box(&file), &mapping, false).expect("a log"));
    });
    let low_pass = butterworth(4, 0.04).expect("a design");
    let rows: Vec<f64> = (0..4 * SAMPLES).map(|k| (0.01 * k as f64).sin()).collect();
    group.bench_function("low-pass of four positions", |bench| {
        bench.iter(|| {
            let mut filtered = Vec::new();
            let mut stream = ZeroPhase::new(&low_pass, 4, SAMPLES).expect("long enough");
            stream.push(black_box(&rows), &mut filtered);
            filtered
        });
    });
    let decimator = Decimator::new(50).expect("a factor");
    let columns: Vec<f64> = (0..25 * SAMPLES)
        .map(|k| (0.003 * k as f64).cos())
        .collect();
    group.bench_function("decimation of 25 columns", |bench| {
        bench.iter(|| {
            let mut kept = Vec::new();
            let mut stream = decimator.stream(25, SAMPLES).expect("long enough");
            stream.push(black_box(&columns), &mut kept);
            kept
        });
    });
    group.bench_function("motion of one run", |bench| {
        bench.iter(|| {
            let mut motions = Motions::new(&robot, &runs[0], &settings).expect("a run");
            while let Some(motion) = motions.next().expect("inside the workspace") {
                black_box(motion);
            }
        });
    });
    group.bench_function("systems of both cases, four runs", |bench| {
        bench.iter(|| prepare(&robot, &runs, &projections, &settings, &|_| {}).expect("systems"));
    });
    let prepared = prepare(&robot, &runs, &projections, &settings, &|_| {}).expect("systems");
    group.bench_function("base and essential parameters of case 1", |bench| {
        bench.iter(|| estimate_projection(&prepared, 0, &settings, None).expect("an estimate"));
    });
    let truth = truth();
    let dataset = Dataset {
        runs: &runs,
        validation: &runs[3..],
        true_values: Some(&truth),
        variants: &[],
        scales: None,
    };
    group.bench_function("everything, with a held-out run", |bench| {
        bench.iter(|| identify(&robot, &dataset, &settings, &|_| {}).expect("a result"));
    });
    group.finish();
}

criterion_group!(benches, stages);
criterion_main!(benches);
