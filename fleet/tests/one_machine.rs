//! Queries on one machine give the result of a single pass over the logs, whatever the files.

mod common;

use arrow::{
    array::{Array, AsArray, StructArray},
    datatypes::{DataType, Float64Type},
    record_batch::RecordBatch,
};
use common::{Bench, DAYS, ROBOTS, serial};
use overact_fleet::{
    chart::{Rule, charts, outliers},
    functions::pooled,
    report,
    robots::Robots,
    session::{Fleet, Options},
};
use overact_identification::{
    Stage,
    factors::{Pooled, write_factors},
};
use overact_logs::write_parquet;
use overact_robot::Identifier;
use std::{collections::BTreeMap, fs, path::Path};

fn options(factors: &Path, partitions: usize) -> Options {
    Options {
        factors: Some(factors.to_owned().into()),
        partitions,
        ..Options::default()
    }
}

/// Estimates by the text in the first column.
fn estimates(rows: &[RecordBatch]) -> BTreeMap<String, Pooled> {
    let mut found = BTreeMap::new();
    for batch in rows {
        let keys = arrow::compute::cast(batch.column(0), &DataType::Utf8).expect("texts");
        let keys = keys.as_string::<i32>();
        let own: &StructArray = batch.column(1).as_struct();
        for row in 0..batch.num_rows() {
            let actual = pooled(own, row).expect("an estimate");
            assert_eq!(actual.problem, "", "{}", keys.value(row));
            found.insert(keys.value(row).to_owned(), actual);
        }
    }
    found
}

fn assert_same(a: &Pooled, b: &Pooled) {
    assert_eq!(
        (a.runs, a.equations, a.groups),
        (b.runs, b.equations, b.groups)
    );
    assert!(a.parameters.len() > 10 && a.parameters.len() == b.parameters.len());
    for (a, b) in a.parameters.iter().zip(&b.parameters) {
        let near =
            |a: f64, b: f64| assert!((a - b).abs() <= 1e-11 * a.abs(), "{}: {a} and {b}", "value");
        assert_eq!(a.name, b.name);
        near(a.value, b.value);
        near(a.deviation, b.deviation);
    }
}

const PER_ROBOT: &str = "SELECT serial, estimate(factor, 64) AS e FROM factors GROUP BY serial";
const ALL: &str = "SELECT 'all' AS k, estimate(factor, 64) AS e FROM factors";

#[tokio::test]
async fn fleet_estimates_equal_one_pass_over_the_logs() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let mut fleet = Fleet::open(options(&folder, 2)).await.expect("a fleet");
    let per_robot = estimates(&fleet.sql(PER_ROBOT).await.expect("rows"));
    assert_eq!(per_robot.len(), ROBOTS);
    let logs: Vec<_> = { bench.logs.iter() }
        .filter(|(member, ..)| member.number == 2)
        .map(|(.., log)| log.clone())
        .collect();
    let one_pass = Identifier::new(&bench.robot)
        .runs(&logs)
        .run()
        .expect("an identification");
    let base = one_pass
        .estimates
        .iter()
        .find(|own| own.stage == Stage::Base && own.weighted);
    let base = base.expect("a base estimate");
    let own = &per_robot[&serial(2)];
    assert_eq!(base.parameters.len(), own.parameters.len());
    for (a, b) in base.parameters.iter().zip(&own.parameters) {
        assert!(
            (a.value - b.value).abs() <= 1e-11 * a.value.abs(),
            "{a:?} {b:?}"
        );
        let white = (a.standard_deviation - b.white_deviation).abs();
        assert!(white <= 1e-11 * a.standard_deviation, "{a:?} {b:?}");
    }

    // Other partitions, a merge of merges, and a query by week.
    let mut other = Fleet::open(options(&folder, 7)).await.expect("a fleet");
    for (serial, actual) in estimates(&other.sql(PER_ROBOT).await.expect("rows")) {
        assert_same(&per_robot[&serial], &actual);
    }
    let whole = estimates(&fleet.sql(ALL).await.expect("rows"));
    assert_eq!(whole["all"].runs, (ROBOTS * DAYS) as u64);
    let twice = "SELECT 'all' AS k, estimate(r, 64) AS e \
                 FROM (SELECT merge_r(factor, 64) AS r FROM factors GROUP BY serial)";
    assert_same(
        &whole["all"],
        &estimates(&other.sql(twice).await.expect("rows"))["all"],
    );
    let weeks = "SELECT serial || CAST(date_trunc('week', time) AS VARCHAR) AS k, estimate(factor) AS e \
                 FROM factors GROUP BY k";
    let weeks = estimates(&fleet.sql(weeks).await.expect("rows"));
    assert_eq!(weeks.len(), 2 * ROBOTS);
    assert_eq!(
        weeks.values().map(|own| own.runs).sum::<u64>(),
        (ROBOTS * DAYS) as u64
    );
}

#[tokio::test]
async fn estimates_are_compared_in_sql() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let mut fleet = Fleet::open(options(&folder, 2)).await.expect("a fleet");
    let query = "WITH r AS (SELECT serial, estimate(factor) AS e FROM factors GROUP BY serial) \
                 SELECT a.serial, f_test(a.e, b.e, 'fv_1_left,fs_1_left')['probability'] AS p, \
                 parameter(a.e, 'fv_1_left')['value'] AS v, parameter(a.e, 'nothing')['value'] AS n \
                 FROM r a JOIN r b ON b.serial = 'R00000' ORDER BY a.serial";
    let rows = fleet.sql(query).await.expect("rows");
    let rows = arrow::compute::concat_batches(&rows[0].schema(), &rows).expect("one batch");
    let p = rows.column(1).as_primitive::<Float64Type>();
    assert_eq!(rows.num_rows(), ROBOTS);
    // Equal runs do not differ; robots whose friction differs by a tenth or more do.
    assert!((p.value(0) - 1.0).abs() < 1e-12);
    let different = (1..ROBOTS).filter(|row| p.value(*row) < 1e-3).count();
    assert!(different >= ROBOTS - 2, "{p:?}");
    let v = rows.column(2).as_primitive::<Float64Type>();
    assert!(v.values().iter().all(|v| (0.02..0.09).contains(v)), "{v:?}");
    assert_eq!(rows.column(3).null_count(), ROBOTS);
    let wrong = fleet
        .sql("SELECT estimate(serial) FROM factors")
        .await
        .expect_err("no factors");
    assert!(wrong.to_string().contains("column of factors"), "{wrong}");
}

#[tokio::test]
async fn duplicate_and_damaged_files_are_excluded_and_reported() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let mut good = Fleet::open(options(&folder, 2)).await.expect("a fleet");
    let good = estimates(&good.sql(ALL).await.expect("rows"));
    let read = |name: &str| fs::read(folder.join(name)).expect("a file");
    let put = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).expect("a file");
    // A copy, a file with another file's run and its own, a truncated file, a file of another type,
    // and a file with one changed byte.
    put("copy.parquet", &read("day-3.parquet"));
    let both: Vec<_> = bench
        .runs
        .iter()
        .skip(1)
        .step_by(DAYS)
        .chain(&bench.runs[..1])
        .cloned()
        .collect();
    put("day-1.parquet", &write_factors(&both).expect("factors"));
    let half = read("day-5.parquet");
    put("half.parquet", &half[..half.len() / 2]);
    put("text.parquet", b"serial,day\n");
    put(
        "log.parquet",
        &write_parquet(&[("time".to_owned(), vec![0.0, 1.0])]).expect("a log"),
    );
    let mut fleet = Fleet::open(options(&folder, 3)).await.expect("a fleet");
    assert_same(
        &good["all"],
        &estimates(&fleet.sql(ALL).await.expect("rows"))["all"],
    );
    let why = |file: &str| {
        let mut all = fleet.left_out().iter();
        all.find(|own| own.file.ends_with(file))
            .map(|own| (own.runs.len(), own.why.clone()))
    };
    assert_eq!(fleet.left_out().len(), 5, "{:?}", fleet.left_out());
    assert!(
        why("day-3.parquet").is_some_and(|(runs, why)| runs == 0 && why.contains("copy.parquet"))
    );
    assert!(
        why("day-1.parquet").is_some_and(|(runs, why)| runs == 1 && why.contains("day-0.parquet"))
    );
    assert!(why("half.parquet").is_some() && why("text.parquet").is_some());
    assert!(why("log.parquet").is_some_and(|(_, why)| why.contains("no column")));

    // A changed byte within the factors: the page is unreadable, or the record is reported as
    // damaged.
    fs::remove_file(folder.join("day-6.parquet")).expect("a file");
    let mut without = Fleet::open(options(&folder, 2)).await.expect("a fleet");
    let without = estimates(&without.sql(ALL).await.expect("rows"));
    let six: Vec<_> = bench.runs.iter().skip(6).step_by(DAYS).cloned().collect();
    let mut six = write_factors(&six).expect("factors");
    let middle = six.len() / 2;
    six[middle] ^= 0x40;
    put("day-6.parquet", &six);
    let mut corrupted = Fleet::open(options(&folder, 2)).await.expect("a fleet");
    let actual = estimates(&corrupted.sql(ALL).await.expect("rows"));
    let lost = corrupted
        .left_out()
        .iter()
        .any(|own| own.file.ends_with("day-6.parquet"));
    assert!(lost || actual["all"].damaged > 0);
    if lost {
        assert_same(&without["all"], &actual["all"])
    } else {
        assert!(actual["all"].equations < good["all"].equations)
    }

    // The late file arrives intact.
    let six: Vec<_> = bench.runs.iter().skip(6).step_by(DAYS).cloned().collect();
    put("late.parquet", &write_factors(&six).expect("factors"));
    fs::remove_file(folder.join("day-6.parquet")).expect("a file");
    let mut late = Fleet::open(options(&folder, 2)).await.expect("a fleet");
    assert_same(
        &good["all"],
        &estimates(&late.sql(ALL).await.expect("rows"))["all"],
    );
}

#[tokio::test]
async fn logs_are_factored_in_sql() {
    let bench = Bench::new();
    let root = bench.path("logs");
    for (member, day, log) in &bench.logs {
        let folder = root.join(format!(
            "serial={}/day=2026-03-{:02}",
            serial(member.number),
            day + 2
        ));
        fs::create_dir_all(&folder).expect("a folder");
        let (positions, torques) = log.load().expect("numbers");
        let column = |all: &[f64], at: usize| {
            all.iter()
                .skip(at)
                .step_by(2)
                .copied()
                .collect::<Vec<f64>>()
        };
        let time = (0..log.samples()).map(|k| k as f64 / 200.0).collect();
        let columns = [
            ("time".to_owned(), time),
            ("q_left".to_owned(), column(&positions, 0)),
            ("q_right".to_owned(), column(&positions, 1)),
            ("tau_left".to_owned(), column(&torques, 0)),
            ("tau_right".to_owned(), column(&torques, 1)),
        ];
        fs::write(
            folder.join("run.parquet"),
            write_parquet(&columns).expect("a log"),
        )
        .expect("a file");
    }
    let from_factors = bench.factor_files("factors");
    let mut reference = Fleet::open(options(&from_factors, 2))
        .await
        .expect("a fleet");
    let reference = estimates(&reference.sql(PER_ROBOT).await.expect("rows"));
    let open = || async {
        Fleet::open(Options {
            logs: Some(root.clone().into()),
            robots: Robots::read(&[bench.path("five_bar.toml")]).expect("a description"),
            partitions: 3,
            ..Options::default()
        })
        .await
        .expect("a fleet")
    };
    let query = "SELECT serial, estimate(f['factor'], 64) AS e FROM (SELECT serial, day, factor('FiveBar', \
                 named_struct('time', time, 'q_left', q_left, 'q_right', q_right, 'tau_left', tau_left, \
                 'tau_right', tau_right)) AS f FROM logs GROUP BY serial, day) GROUP BY serial";
    let actual = estimates(&open().await.sql(query).await.expect("rows"));
    assert_eq!(actual.len(), ROBOTS);
    for (serial, actual) in &actual {
        assert_same(&reference[serial], actual);
    }
    // One log is truncated: its robot has one day less, which is reported.
    let cut = root.join("serial=R00001/day=2026-03-04/run.parquet");
    let bytes = fs::read(&cut).expect("a file");
    fs::write(&cut, &bytes[..bytes.len() - 9]).expect("a file");
    let mut fleet = open().await;
    let less = estimates(&fleet.sql(query).await.expect("rows"));
    assert_eq!(fleet.left_out().len(), 1);
    assert_eq!(less[&serial(1)].runs, DAYS as u64 - 1);
    assert_same(&actual[&serial(0)], &less[&serial(0)]);
}

#[tokio::test]
async fn the_report_page_shows_the_fleet_size_and_its_parameters() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let mut fleet = Fleet::open(options(&folder, 2)).await.expect("a fleet");
    let days = report::days(&mut fleet).await.expect("days");
    assert_eq!(days.points.len(), ROBOTS * DAYS);
    assert_eq!(days.counts, [(ROBOTS * DAYS) as u64, 0, 0, 0]);
    let rule = Rule {
        parameters: vec!["fv_1_left".to_owned()],
        ..Rule::default()
    };
    let charts = charts(&days.points, &rule);
    assert_eq!(charts.len(), ROBOTS);
    let outliers = outliers(&charts, report::BEYOND);
    let page = report::Page {
        days: &days,
        charts: &charts,
        outliers: &outliers,
        rule: &rule,
        left_out: &[],
        link: Some("own/{serial}.html"),
    };
    let page = page.html();
    assert!(
        page.contains("Fleet of 5 robots") && page.contains("fv_1_left"),
        "{page}"
    );
}
