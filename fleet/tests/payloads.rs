//! Payloads in SQL: `factor(robot, columns, carried)` gives the factors of the log.

mod common;

use arrow::{array::AsArray, record_batch::RecordBatch};
use overact_fleet::{
    functions::pooled,
    robots::Robots,
    session::{Fleet, Options},
};
use overact_identification::{
    Log,
    factors::{Pool, Record},
};
use overact_logs::write_parquet;
use overact_robot::Robot;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Runs without and with payload, one per day.
const RUNS: [(&str, &str); 3] = [
    ("circle-like", "false"),
    ("with heavy", "heavy"),
    ("with light", "light"),
];

/// The five-bar robot with one payload, or with several named ones.
fn description(named: bool) -> String {
    let text = common::description();
    let runs: Vec<usize> = text
        .match_indices("[[experiment.run]]")
        .map(|(at, _)| at)
        .collect();
    let own = &text[runs[0]..runs[1]];
    let loaded = |name: &str| {
        let payload = if named {
            format!("\"{name}\"")
        } else {
            "true".to_owned()
        };
        own.replace(
            "\"circle-like\"",
            &format!("\"with {name}\"\npayload = {payload}"),
        )
    };
    let head = text[..runs[0]].replace(
        "[leg.arm]",
        "[platform.payload]\nparameters = [\"m\"]\n\n[leg.arm]",
    );
    let (names, values) = if named {
        (
            "payloads = [\"heavy\", \"light\"]\n\n",
            "m_payload_heavy = 0.9\nm_payload_light = 0.4\n",
        )
    } else {
        ("", "m_payload = 0.9\n")
    };
    let head = head
        .replace("[constants]", &format!("{names}[constants]"))
        .replace(
            "[experiment.parameters]\n",
            &format!("[experiment.parameters]\n{values}"),
        );
    head + own + &loaded("heavy") + &loaded("light")
}

struct Bench {
    _folder: tempfile::TempDir,
    robot: Robot,
    file: PathBuf,
    root: PathBuf,
    logs: Vec<Log>,
}

fn day(run: usize) -> String {
    format!("2026-03-{:02}", run + 2)
}

fn write_log(root: &Path, run: usize, log: &Log) {
    let folder = root.join(format!("serial=R00000/day={}", day(run)));
    fs::create_dir_all(&folder).expect("a folder");
    let (positions, torques) = log.load().expect("numbers");
    let of =
        |all: &[f64], at: usize| -> Vec<f64> { all.iter().skip(at).step_by(2).copied().collect() };
    let time = (0..log.samples()).map(|k| k as f64 / 200.0).collect();
    let columns = [
        ("time".to_owned(), time),
        ("q_left".to_owned(), of(&positions, 0)),
        ("q_right".to_owned(), of(&positions, 1)),
        ("tau_left".to_owned(), of(&torques, 0)),
        ("tau_right".to_owned(), of(&torques, 1)),
    ];
    let bytes = write_parquet(&columns).expect("a log");
    fs::write(folder.join("run.parquet"), bytes).expect("a file");
}

impl Bench {
    fn new(named: bool) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("five_bar.toml");
        fs::write(&file, description(named)).expect("a file");
        let robot =
            Robot::from_toml(&file).unwrap_or_else(|error| panic!("{}", error.render(false)));
        let experiment = robot.experiment().expect("an experiment");
        let records = experiment.records(&|_, _| {}).expect("runs");
        let names: Vec<&str> = records.iter().map(|own| own.name.as_str()).collect();
        assert_eq!(names, RUNS.map(|(name, _)| name));
        let logs = records.into_iter().map(|own| experiment.log_of(own));
        let logs: Vec<Log> = logs.collect::<Result<_, _>>().expect("logs");
        let root = folder.path().join("logs");
        for (run, log) in logs.iter().enumerate() {
            write_log(&root, run, log);
        }
        Self {
            robot: Robot::from_toml(&file).expect("a description"),
            _folder: folder,
            file,
            root,
            logs,
        }
    }

    /// Records of a run, as `overact factor` writes them.
    fn records(&self, run: usize) -> Vec<u8> {
        let settings = self.robot.settings(200.0);
        let factory = self.robot.factory(&settings).expect("settings that fit");
        let run = factory.run(&self.logs[run], "", None).expect("a factor");
        run.records().iter().flat_map(Record::to_bytes).collect()
    }

    /// Result of a query over the logs, in which `{f}` is the factor with this third argument.
    async fn ask(&self, query: &str, carried: &str) -> Result<Vec<RecordBatch>, String> {
        let mut fleet = Fleet::open(Options {
            logs: Some(self.root.clone().into()),
            robots: Robots::read(std::slice::from_ref(&self.file)).expect("a description"),
            partitions: 2,
            ..Options::default()
        })
        .await
        .expect("a fleet");
        let factor = format!(
            "factor('FiveBar', named_struct('time', time, 'q_left', q_left, 'q_right', q_right, \
             'tau_left', tau_left, 'tau_right', tau_right), {carried})"
        );
        let rows = fleet.sql(&query.replace("{f}", &factor)).await;
        rows.map_err(|error| error.strip_backtrace())
    }

    /// Factors of each day, and the problem if there are none.
    async fn factors(&self, carried: &str) -> Result<Vec<(Option<Vec<u8>>, String)>, String> {
        let query = "SELECT f['factor'], f['problem'] FROM (SELECT day, {f} AS f FROM logs GROUP BY day) ORDER BY day";
        let rows = self.ask(query, carried).await?;
        let rows = rows.iter().flat_map(|batch| {
            let (factors, problems) = (
                batch.column(0).as_binary::<i64>(),
                batch.column(1).as_string::<i32>(),
            );
            factors
                .iter()
                .zip(problems.iter())
                .map(|(factor, problem)| {
                    (
                        factor.map(<[u8]>::to_vec),
                        problem.unwrap_or_default().to_owned(),
                    )
                })
                .collect::<Vec<_>>()
        });
        Ok(rows.collect())
    }
}

/// Payload of each day as an SQL expression.
fn by_day() -> String {
    let cases = RUNS.iter().enumerate();
    let cases: String = cases
        .map(|(run, (_, carried))| format!(" WHEN '{}' THEN '{carried}'", day(run)))
        .collect();
    format!("CASE day{cases} END")
}

fn parsed(bytes: &[u8]) -> Vec<Record> {
    Record::all(bytes)
        .into_iter()
        .collect::<Result<_, _>>()
        .expect("records that are not damaged")
}

#[tokio::test]
async fn named_payloads_give_the_factors_of_their_logs() {
    let bench = Bench::new(true);
    let found = bench.factors(&by_day()).await.expect("rows");
    assert_eq!(found.len(), RUNS.len());
    for (run, (factor, problem)) in found.iter().enumerate() {
        assert_eq!(problem, "");
        let (actual, expected) = (
            parsed(factor.as_deref().expect("a factor")),
            parsed(&bench.records(run)),
        );
        assert!(!actual.is_empty() && actual.len() == expected.len());
        for (actual, expected) in actual.iter().zip(&expected) {
            assert_eq!(actual.load, expected.load);
            assert_eq!(actual.columns, expected.columns);
            assert_eq!(
                (actual.kind(), actual.content),
                (expected.kind(), expected.content)
            );
            assert_eq!(actual.factor, expected.factor);
        }
        // Each payload has its own factors.
        let load = actual[0].load.as_deref().unwrap_or("none");
        assert_eq!(load, ["none", "heavy", "light"][run]);
    }

    // Estimates by payload equal those of its records.
    let query = "SELECT carried, estimate(f['factor']) AS e FROM (SELECT day, max(carried) AS carried, {f} AS f FROM \
                 (SELECT *, CARRIED AS carried FROM logs) GROUP BY day) GROUP BY carried ORDER BY carried"
        .replace("CARRIED", &by_day());
    let rows = bench.ask(&query, "carried").await.expect("rows");
    let mut carried = 0;
    for batch in &rows {
        for row in 0..batch.num_rows() {
            let actual = pooled(batch.column(1).as_struct(), row).expect("an estimate");
            assert_eq!(
                (actual.problem.as_str(), actual.runs, actual.unlike),
                ("", 1, 0)
            );
            let run = RUNS
                .iter()
                .position(|own| own.1 == batch.column(0).as_string::<i32>().value(row));
            let mut pool = Pool::default();
            pool.push(&bench.records(run.expect("a run")));
            let expected = pool.estimate();
            assert!(actual.parameters.len() > 10);
            assert_eq!(actual.parameters.len(), expected.parameters.len());
            for (actual, expected) in actual.parameters.iter().zip(&expected.parameters) {
                assert_eq!(actual.name, expected.name);
                let far = (actual.value - expected.value).abs()
                    / expected.value.abs().max(expected.deviation);
                assert!(far <= 1e-12, "{actual:?} {expected:?}");
            }
            carried += 1;
        }
    }
    assert_eq!(carried, RUNS.len());
}

#[tokio::test]
async fn unnamed_payloads_may_be_booleans_or_text() {
    let bench = Bench::new(false);
    // As text and as a comparison.
    let first = day(0);
    for carried in [
        format!("day <> '{first}'"),
        format!("CASE day WHEN '{first}' THEN 'false' ELSE 'true' END"),
        format!("CASE day WHEN '{first}' THEN NULL ELSE 'true' END"),
    ] {
        let found = bench.factors(&carried).await.expect("rows");
        for (run, (factor, problem)) in found.iter().enumerate() {
            assert_eq!(problem, "", "{carried}");
            let actual = parsed(factor.as_deref().expect("a factor"));
            assert_eq!(actual, parsed(&bench.records(run)), "{carried}");
            assert_eq!(actual[0].load.is_some(), run > 0);
        }
    }
}

#[tokio::test]
async fn invalid_payloads_are_rejected_with_advice() {
    let (named, single) = (Bench::new(true), Bench::new(false));
    for (bench, carried, word) in [
        (&named, "'true'", "several payloads"),
        (&named, "true", "of heavy, light"),
        (&named, "'weight'", "no payload `weight`, but heavy, light"),
        (&single, "'heavy'", "write `true` or `false`"),
    ] {
        for (factor, problem) in bench.factors(carried).await.expect("rows") {
            assert!(
                factor.is_none() && problem.contains(word),
                "{carried}: {problem}"
            );
        }
    }
    // Rows with different payloads do not form a run.
    let query = "SELECT serial, {f} AS f FROM logs GROUP BY serial";
    let error = named.ask(query, &by_day()).await.expect_err("several runs");
    assert!(error.contains("several payloads, in a group"), "{error}");
    let error = named
        .factors("1.5")
        .await
        .expect_err("a number is no payload");
    assert!(error.contains("the name of the payload"), "{error}");
}
