//! A scheduler and three executors, processes each: the answers of one machine.
#![cfg(feature = "distributed")]

mod common;

use arrow::array::AsArray;
use common::Bench;
use overact_fleet::{
    functions::pooled,
    session::{Fleet, Options},
};
use overact_identification::factors::Pooled;
use std::{
    net::TcpListener,
    path::Path,
    process::{Child, Command, Stdio},
    time::Duration,
};

/// A process that ends with its test.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        // One that has ended already needs no end.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn start(arguments: &[&str]) -> Process {
    let mut command = Command::new(env!("CARGO_BIN_EXE_overact-fleet"));
    let child = command
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    Process(child.expect("the program"))
}

/// A port that is free, and the one after it.
fn port() -> u16 {
    loop {
        let own = TcpListener::bind("127.0.0.1:0").expect("a port");
        let port = own.local_addr().expect("an address").port();
        if port < u16::MAX && TcpListener::bind(("127.0.0.1", port + 1)).is_ok() {
            return port;
        }
    }
}

struct Cluster {
    url: String,
    _executors: Vec<Process>,
    _scheduler: Process,
}

fn cluster(folder: &Path) -> Cluster {
    let scheduler_port = port();
    let scheduler = start(&[
        "scheduler",
        "--bind",
        &format!("127.0.0.1:{scheduler_port}"),
    ]);
    std::thread::sleep(Duration::from_secs(2));
    let executors = (0..3).map(|number| {
        let work = folder.join(format!("work-{number}"));
        std::fs::create_dir_all(&work).expect("a folder");
        start(&[
            "executor",
            "--bind",
            &format!("127.0.0.1:{}", port()),
            "--scheduler-port",
            &scheduler_port.to_string(),
            "--folder",
            &work.display().to_string(),
        ])
    });
    let executors = executors.collect();
    std::thread::sleep(Duration::from_secs(4));
    Cluster {
        url: format!("df://127.0.0.1:{scheduler_port}"),
        _executors: executors,
        _scheduler: scheduler,
    }
}

const QUERY: &str =
    "SELECT serial, estimate(factor, 64) AS e FROM factors GROUP BY serial ORDER BY serial";

async fn ask(folder: &Path, scheduler: Option<&str>) -> Vec<Pooled> {
    let options = Options {
        factors: Some(folder.to_owned()),
        scheduler: scheduler.map(str::to_owned),
        partitions: 6,
        ..Options::default()
    };
    let mut fleet = Fleet::open(options).await.expect("a fleet");
    let rows = fleet.sql(QUERY).await.expect("rows");
    let told = rows.iter().flat_map(|batch| {
        let own = batch.column(1).as_struct();
        (0..batch.num_rows()).map(move |row| pooled(own, row).expect("an estimate"))
    });
    told.collect()
}

fn assert_same(a: &[Pooled], b: &[Pooled]) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!(
            (a.runs, a.equations, &a.problem),
            (b.runs, b.equations, &b.problem)
        );
        assert!(a.parameters.len() > 10);
        for (a, b) in a.parameters.iter().zip(&b.parameters) {
            assert!(
                (a.value - b.value).abs() <= 1e-11 * a.value.abs(),
                "{a:?} and {b:?}"
            );
            assert!(
                (a.deviation - b.deviation).abs() <= 1e-10 * a.deviation,
                "{a:?} and {b:?}"
            );
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn three_executors_answer_as_one_machine_does() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let here = ask(&folder, None).await;
    let cluster = cluster(bench.folder.path());
    for _ in 0..2 {
        assert_same(&here, &ask(&folder, Some(&cluster.url)).await);
    }
}
