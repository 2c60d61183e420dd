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
    fs,
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
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

/// A port that is free, and the one after it; none where a machine gives none.
fn port() -> Option<u16> {
    for _ in 0..100 {
        let own = TcpListener::bind("127.0.0.1:0").ok()?;
        let port = own.local_addr().ok()?.port();
        if port < u16::MAX && TcpListener::bind(("127.0.0.1", port + 1)).is_ok() {
            return Some(port);
        }
    }
    None
}

/// Waits until something listens.
fn wait_for(port: u16) {
    let begin = Instant::now();
    while TcpStream::connect(("127.0.0.1", port)).is_err() {
        assert!(begin.elapsed() < PATIENCE, "nothing listens at {port}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// How long anything may take on a machine that does much else.
const PATIENCE: Duration = Duration::from_secs(120);

struct Cluster {
    url: String,
    executors: Vec<Process>,
    /// Where each executor puts what others fetch.
    folders: Vec<PathBuf>,
    _scheduler: Process,
}

impl Cluster {
    /// Files of results that an executor has.
    fn results(&self, executor: usize) -> usize {
        let mut folders = vec![self.folders[executor].clone()];
        let mut count = 0;
        while let Some(folder) = folders.pop() {
            let entries = fs::read_dir(folder).into_iter().flatten().flatten();
            for path in entries.map(|entry| entry.path()) {
                count += usize::from(path.extension().is_some_and(|own| own == "arrow"));
                folders.extend(path.is_dir().then_some(path));
            }
        }
        count
    }

    fn kill(&mut self, executor: usize) {
        let own = &mut self.executors[executor].0;
        own.kill()
            .and_then(|()| own.wait())
            .expect("it was running");
    }
}

/// A scheduler and three executors; none, with a word, where there are no ports.
fn cluster(folder: &Path) -> Option<Cluster> {
    let ports: Option<Vec<u16>> = (0..4).map(|_| port()).collect();
    let Some(ports) = ports else {
        eprintln!("skipped: this machine gives no ports");
        return None;
    };
    let bind = |port: u16| format!("127.0.0.1:{port}");
    let scheduler = start(&["scheduler", "--bind", &bind(ports[0])]);
    wait_for(ports[0]);
    let folders: Vec<PathBuf> = (0..3)
        .map(|own| folder.join(format!("work-{own}")))
        .collect();
    let executors = folders.iter().zip(&ports[1..]).map(|(work, port)| {
        fs::create_dir_all(work).expect("a folder");
        let (work, to) = (work.display().to_string(), ports[0].to_string());
        start(&[
            "executor",
            "--bind",
            &bind(*port),
            "--scheduler-port",
            &to,
            "--folder",
            &work,
        ])
    });
    let executors = executors.collect();
    ports[1..].iter().for_each(|port| wait_for(*port));
    // They listen before the scheduler knows them, and it does not tell whom it knows.
    std::thread::sleep(Duration::from_secs(2));
    Some(Cluster {
        url: format!("df://127.0.0.1:{}", ports[0]),
        executors,
        folders,
        _scheduler: scheduler,
    })
}

const QUERY: &str =
    "SELECT serial, estimate(factor, 64) AS e FROM factors GROUP BY serial ORDER BY serial";

async fn ask(folder: &Path, scheduler: Option<&str>) -> Result<Vec<Pooled>, String> {
    let options = Options {
        limit: Some(PATIENCE),
        factors: Some(folder.to_owned().into()),
        scheduler: scheduler.map(str::to_owned),
        partitions: 6,
        ..Options::default()
    };
    let mut fleet = Fleet::open(options).await.expect("a fleet");
    let rows = fleet.sql(QUERY).await;
    let rows = rows.map_err(|error| error.strip_backtrace())?;
    let told = rows.iter().flat_map(|batch| {
        let own = batch.column(1).as_struct();
        (0..batch.num_rows()).map(move |row| pooled(own, row).expect("an estimate"))
    });
    Ok(told.collect())
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
    let here = ask(&folder, None).await.expect("rows");
    let Some(cluster) = cluster(bench.folder.path()) else {
        return;
    };
    for _ in 0..2 {
        let told = ask(&folder, Some(&cluster.url)).await;
        assert_same(&here, &told.expect("rows"));
    }
}

/// Kills the first executor at a moment of a query, which has to be answered as if it had not been.
async fn killed(when: impl Fn(&Cluster, Duration) -> bool + Send + 'static) {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let here = ask(&folder, None).await.expect("rows");
    let Some(mut cluster) = cluster(bench.folder.path()) else {
        return;
    };
    let url = cluster.url.clone();
    let killer = std::thread::spawn(move || {
        let begin = Instant::now();
        while !when(&cluster, begin.elapsed()) && begin.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_micros(200));
        }
        cluster.kill(0);
        cluster
    });
    let told = ask(&folder, Some(&url)).await.expect("rows");
    assert_same(&here, &told);
    // The two that are left go on.
    let _cluster = killer.join().expect("a killer that was in time");
    assert_same(&here, &ask(&folder, Some(&url)).await.expect("rows"));
}

#[tokio::test(flavor = "multi_thread")]
async fn an_executor_that_is_killed_while_it_works_costs_no_answer() {
    killed(|cluster, _| cluster.results(0) > 0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn an_executor_that_is_killed_with_all_its_results_costs_no_answer() {
    // Six partitions have been read, and what was made of them is about to be fetched.
    killed(|cluster, _| (0..3).map(|own| cluster.results(own)).sum::<usize>() >= 6).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn an_executor_that_is_killed_before_it_begins_costs_no_answer() {
    killed(|_, passed| passed > Duration::from_millis(100)).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn without_any_executor_a_query_ends_with_a_way_out() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let Some(mut cluster) = cluster(bench.folder.path()) else {
        return;
    };
    (0..3).for_each(|own| cluster.kill(own));
    let options = Options {
        factors: Some(folder.into()),
        scheduler: Some(cluster.url.clone()),
        limit: Some(Duration::from_secs(5)),
        ..Options::default()
    };
    let begin = Instant::now();
    let mut fleet = Fleet::open(options).await.expect("a fleet");
    let error = fleet.sql(QUERY).await.expect_err("no executor").to_string();
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
    assert!(
        error.contains("--limit") && error.contains("executors"),
        "{error}"
    );
}
