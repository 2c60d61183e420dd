//! Time to write the HTML report of the EMPS's virtual experiment.

use criterion::{Criterion, criterion_group, criterion_main};
use overact::Model;
use overact_report::{Contents, Units, page};
use overact_robot::{Identifier, Robot};
use std::{hint::black_box, path::Path};

fn pages(criterion: &mut Criterion) {
    let emps = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/emps.toml");
    let robot = Robot::from_toml(emps).expect("a robot");
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment
        .runs(&robot.held_out(), &|_, _| {})
        .expect("runs");
    let result = Identifier::new(&robot).data(&runs).run().expect("a result");
    let units = Units::new(&robot.model().info());
    criterion.bench_function("the page of the report", |bench| {
        bench.iter(|| {
            page(&Contents {
                identification: black_box(&result),
                units: &units,
                summary: None,
                source: None,
                drawing: None,
                published: None,
                attachments: &[],
            })
        });
    });
}

criterion_group!(benches, pages);
criterion_main!(benches);
