//! A scheduler with three executors gives the same answers as one machine.
#![cfg(feature = "distributed")]

mod common;

use arrow::array::AsArray;
use common::{
    Bench,
    cluster::{Cluster, PATIENCE, cluster},
};
use overact_fleet::{
    functions::pooled,
    session::{Fleet, Options},
};
use overact_identification::factors::Pooled;
use std::{
    path::Path,
    time::{Duration, Instant},
};

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
    let answer = rows.iter().flat_map(|batch| {
        let own = batch.column(1).as_struct();
        (0..batch.num_rows()).map(move |row| pooled(own, row).expect("an estimate"))
    });
    Ok(answer.collect())
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
async fn three_executors_give_the_results_of_one_machine() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let here = ask(&folder, None).await.expect("rows");
    let Some(cluster) = cluster(bench.folder.path(), &[], &[]) else {
        return;
    };
    for _ in 0..2 {
        let answer = ask(&folder, Some(&cluster.url)).await;
        assert_same(&here, &answer.expect("rows"));
    }
}

/// Kills the first executor at a moment of a query; the answer must not change.
async fn killed(when: impl Fn(&Cluster, Duration) -> bool + Send + 'static) {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let here = ask(&folder, None).await.expect("rows");
    let Some(mut cluster) = cluster(bench.folder.path(), &[], &[]) else {
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
    let answer = ask(&folder, Some(&url)).await.expect("rows");
    assert_same(&here, &answer);
    // The two remaining executors continue.
    let _cluster = killer.join().expect("a killer that was in time");
    assert_same(&here, &ask(&folder, Some(&url)).await.expect("rows"));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_query_survives_an_executor_killed_at_work() {
    killed(|cluster, _| cluster.results(0) > 0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_query_survives_an_executor_killed_with_its_results() {
    // Six partitions are complete, and their results are about to be fetched.
    killed(|cluster, _| (0..3).map(|own| cluster.results(own)).sum::<usize>() >= 6).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_query_survives_an_executor_killed_before_its_start() {
    killed(|_, passed| passed > Duration::from_millis(100)).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_query_without_executors_ends_with_advice() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let Some(mut cluster) = cluster(bench.folder.path(), &[], &[]) else {
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
