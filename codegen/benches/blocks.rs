//! Evaluation of the DualV's identification model over blocks of samples, per sample.
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use overact_codegen::{
    Source, compile,
    derivation::{Columns, Family, From},
    evaluation::{Rows, Workspace},
};
use std::hint::black_box;

/// Samples of one call: what identification evaluates at once.
const SAMPLES: usize = 512;

fn blocks(criterion: &mut Criterion) {
    let text = include_str!("../../robots/dualv.toml");
    let source = Source::new("dualv.toml", text);
    let Ok(model) = compile(&source) else { return };
    let mut group = criterion.benchmark_group("blocks");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    for (name, from) in [("joints", From::Joints), ("pose", From::Pose)] {
        let family = Family::IdmRedPlatform(Columns::Standard);
        let Some(function) = model.function(family, from) else {
            continue;
        };
        let program = &function.program;
        let values: Vec<Vec<f64>> = program
            .inputs
            .iter()
            .map(|array| {
                let home = match &array.name[..] {
                    "joints" => model.mechanism.home.joints.clone(),
                    _ => vec![0.02; array.len()],
                };
                let drift = |k: usize| 1e-4 * (k as f64).sin();
                (0..SAMPLES)
                    .flat_map(|k| home.iter().map(move |x| x + drift(k)))
                    .collect()
            })
            .collect();
        let inputs: Vec<Rows<'_>> = values
            .iter()
            .map(|values| Rows {
                values,
                shared: false,
            })
            .collect();
        let mut output = vec![0.0; SAMPLES * program.output.len()];
        let mut workspace = Workspace::default();
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let done = program.evaluate(SAMPLES, &inputs, &mut output, &mut workspace);
                black_box((done.is_ok(), &mut output));
            });
        });
    }
    group.finish();
}

criterion_group!(benches, blocks);
criterion_main!(benches);
