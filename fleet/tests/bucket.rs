//! Factor files and logs in a bucket with an S3 interface give the same answers as in a folder.
#![cfg(feature = "s3")]

mod common;

use common::{Bench, DAYS, serial};
use hyper_util::{
    rt::{TokioExecutor, TokioIo},
    server::conn::auto::Builder,
};
use overact_logs::write_parquet;
use s3s::{auth::SimpleAuth, service::S3ServiceBuilder};
use s3s_fs::FileSystem;
use std::{
    fs,
    net::SocketAddr,
    path::Path,
    process::{Command, Output, Stdio},
};
use tokio::net::TcpListener;

const KEYS: [&str; 2] = ["a-key", "a-secret"];
const QUERY: &str = "SELECT serial, count, p['name'] AS name, p['value'] AS value, p['deviation'] AS deviation FROM \
                     (SELECT serial, e['runs'] AS count, unnest(e['parameters']) AS p FROM \
                     (SELECT serial, estimate(factor, 64) AS e FROM factors GROUP BY serial)) ORDER BY serial, name";
const OF_LOGS: &str = "SELECT serial, count, p['name'] AS name, p['value'] AS value, p['deviation'] AS deviation FROM \
                       (SELECT serial, e['runs'] AS count, unnest(e['parameters']) AS p FROM \
                       (SELECT serial, estimate(f['factor'], 64) AS e FROM (SELECT serial, day, factor('FiveBar', \
                       named_struct('time', time, 'q_left', q_left, 'q_right', q_right, 'tau_left', tau_left, \
                       'tau_right', tau_right)) AS f FROM logs GROUP BY serial, day) GROUP BY serial)) \
                       ORDER BY serial, name";

/// Server whose buckets are the folders below `root`; `None`, with a message, if no port is
/// available.
async fn server(root: &Path) -> Option<SocketAddr> {
    let Ok(listener) = TcpListener::bind("127.0.0.1:0").await else {
        eprintln!("skipped: this machine gives no ports");
        return None;
    };
    let address = listener.local_addr().expect("an address");
    let mut service = S3ServiceBuilder::new(FileSystem::new(root).expect("a folder"));
    service.set_auth(SimpleAuth::from_single(KEYS[0], KEYS[1]));
    let service = service.build();
    tokio::spawn(async move {
        while let Ok((socket, _)) = listener.accept().await {
            let service = service.clone();
            tokio::spawn(async move {
                let connections = Builder::new(TokioExecutor::new());
                // A client that disconnects ends its connection.
                let _ = connections
                    .serve_connection(TokioIo::new(socket), service)
                    .await;
            });
        }
    });
    Some(address)
}

/// Environment variables with the address and keys of the bucket.
fn environment(server: SocketAddr, secret: &str) -> [(&'static str, String); 5] {
    [
        ("AWS_ENDPOINT_URL", format!("http://{server}")),
        ("AWS_ALLOW_HTTP", "true".to_owned()),
        ("AWS_REGION", "us-east-1".to_owned()),
        ("AWS_ACCESS_KEY_ID", KEYS[0].to_owned()),
        ("AWS_SECRET_ACCESS_KEY", secret.to_owned()),
    ]
}

/// The program, with the bucket in its environment.
fn program(server: SocketAddr, secret: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_overact-fleet"));
    command
        .envs(environment(server, secret))
        .stdin(Stdio::null());
    command
}

async fn asked(server: SocketAddr, secret: &str, arguments: &[&str]) -> Output {
    let mut command = tokio::process::Command::from(program(server, secret));
    let output = command.arg("sql").args(arguments).arg("--csv").output();
    output.await.expect("the program")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("a text")
}

/// Rows of one robot, or of all, sorted, because the engine does not order them.
fn rows(output: &Output, serial: &str) -> Vec<String> {
    assert!(output.status.success(), "{}", text(&output.stderr));
    let all = text(&output.stdout);
    let own = all.lines().filter(|row| row.starts_with(serial));
    let mut own: Vec<String> = own.map(str::to_owned).collect();
    own.sort_unstable();
    own
}

/// Asserts that names are equal, and numbers up to a few units of the last digits.
fn assert_same(a: &[String], b: &[String]) {
    assert!(a.len() > 10 && a.len() == b.len(), "{a:?} {b:?}");
    for (a, b) in a.iter().zip(b) {
        assert_eq!(a.split(',').count(), b.split(',').count());
        for (a, b) in a.split(',').zip(b.split(',')) {
            let near = match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) => (a - b).abs() <= 1e-10 * a.abs(),
                _ => a == b,
            };
            assert!(near, "{a} and {b}");
        }
    }
}

/// Copies a folder into a bucket.
fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").flatten() {
        let (own, target) = (entry.path(), to.join(entry.file_name()));
        if own.is_dir() {
            copied(&own, &target)
        } else {
            drop(fs::copy(&own, &target).expect("a file"))
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn factor_files_in_a_bucket_and_a_folder_give_equal_results() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let root = bench.path("buckets");
    copied(&folder, &root.join("fleet/below/day one"));
    let Some(server) = server(&root).await else {
        return;
    };
    let place = folder.display().to_string();
    let here = asked(server, KEYS[1], &[QUERY, "--factors", &place]).await;
    let there = ["--factors", "s3://fleet/below"];
    let answer = asked(server, KEYS[1], &[QUERY, there[0], there[1]]).await;
    assert_same(&rows(&here, ""), &rows(&answer, ""));

    // Damaged files are excluded and reported, as in a folder.
    let bucket = root.join("fleet/below/day one");
    let bytes = fs::read(bucket.join("day-3.parquet")).expect("a file");
    fs::write(bucket.join("copy.parquet"), &bytes).expect("a file");
    fs::write(bucket.join("half.parquet"), &bytes[..bytes.len() / 2]).expect("a file");
    let answer = asked(server, KEYS[1], &[QUERY, there[0], there[1]]).await;
    assert_same(&rows(&here, ""), &rows(&answer, ""));
    let message = text(&answer.stderr);
    let left_out: Vec<&str> = { message.lines() }
        .filter(|line| line.starts_with("left out: s3://fleet/below/day"))
        .collect();
    assert_eq!(left_out.len(), 2, "{message}");
    assert!(
        left_out
            .iter()
            .any(|line| line.contains("already in s3://"))
    );

    // A wrong key, a missing bucket and an invalid address are reported with advice.
    let answer = asked(server, "another", &[QUERY, there[0], there[1]]).await;
    let message = text(&answer.stderr);
    assert!(
        !answer.status.success() && message.contains("AWS_SECRET_ACCESS_KEY"),
        "{message}"
    );
    for (place, word) in [
        ("s3://nothing/below", "AWS_ENDPOINT_URL"),
        ("s3://fleet/nothing", "no readable file"),
        ("s3:///below", "BUCKET"),
        ("ftp://fleet/below", "s3://BUCKET/PREFIX"),
    ] {
        let answer = asked(server, KEYS[1], &[QUERY, "--factors", place]).await;
        let message = text(&answer.stderr);
        assert!(
            !answer.status.success() && message.contains(word),
            "{place}: {message}"
        );
    }
}

#[cfg(feature = "distributed")]
#[tokio::test(flavor = "multi_thread")]
async fn executors_read_a_bucket_with_their_own_keys() {
    let bench = Bench::new();
    let folder = bench.factor_files("factors");
    let root = bench.path("buckets");
    copied(&folder, &root.join("fleet/below"));
    let Some(server) = server(&root).await else {
        return;
    };
    let place = folder.display().to_string();
    let here = asked(server, KEYS[1], &[QUERY, "--factors", &place]).await;
    for secrets in [[KEYS[1]; 2], ["another", KEYS[1]], [KEYS[1], "another"]] {
        let [own, other_environment] = secrets.map(|secret| environment(server, secret));
        let Some(cluster) = common::cluster::cluster(bench.folder.path(), &own, &other_environment)
        else {
            return;
        };
        let there = ["--factors", "s3://fleet/below", "--scheduler", &cluster.url];
        let more = ["--partitions", "6", "--limit", "120"];
        let answer = asked(server, KEYS[1], &[&[QUERY][..], &there, &more].concat()).await;
        if secrets == [KEYS[1]; 2] {
            assert_same(&rows(&here, ""), &rows(&answer, ""));
            continue;
        }
        // The executors read the files, because only their key is wrong.
        let message = text(&answer.stderr);
        assert!(
            !answer.status.success()
                && message.contains("403")
                && message.contains("in its environment"),
            "{secrets:?}: {message}"
        );
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn logs_in_a_bucket_and_a_folder_give_equal_results() {
    let bench = Bench::new();
    let (folder, root) = (bench.path("logs"), bench.path("buckets"));
    for (member, day, log) in bench.logs.iter().filter(|own| own.0.number < 2) {
        let of = format!(
            "serial={}/day=2026-03-{:02}",
            serial(member.number),
            day + 2
        );
        let of = folder.join(of);
        fs::create_dir_all(&of).expect("a folder");
        let (positions, torques) = log.load().expect("numbers");
        let column = |name: &str, all: &[f64], at: usize| {
            (
                name.to_owned(),
                all.iter()
                    .skip(at)
                    .step_by(2)
                    .copied()
                    .collect::<Vec<f64>>(),
            )
        };
        let time = (0..log.samples()).map(|k| k as f64 / 200.0).collect();
        let columns = [
            ("time".to_owned(), time),
            column("q_left", &positions, 0),
            column("q_right", &positions, 1),
            column("tau_left", &torques, 0),
            column("tau_right", &torques, 1),
        ];
        let bytes = write_parquet(&columns).expect("a log");
        fs::write(of.join("run.parquet"), bytes).expect("a file");
    }
    copied(&folder, &root.join("logs"));
    let Some(server) = server(&root).await else {
        return;
    };
    let robot = bench.path("five_bar.toml").display().to_string();
    let place = folder.display().to_string();
    let here = asked(
        server,
        KEYS[1],
        &[OF_LOGS, "--logs", &place, "--robot", &robot],
    )
    .await;
    let there = [OF_LOGS, "--logs", "s3://logs", "--robot", &robot];
    let answer = asked(server, KEYS[1], &there).await;
    assert_same(&rows(&here, ""), &rows(&answer, ""));
    assert!(text(&answer.stdout).contains(&format!("{},{DAYS},", serial(1))));

    // A truncated log removes a day of its robot, which is reported.
    let cut = root.join("logs/serial=R00001/day=2026-03-04/run.parquet");
    let bytes = fs::read(&cut).expect("a file");
    fs::write(&cut, &bytes[..bytes.len() - 9]).expect("a file");
    let less = asked(server, KEYS[1], &there).await;
    let message = text(&less.stderr);
    assert!(
        message.contains("left out: s3://logs/serial=R00001/day=2026-03-04/run.parquet"),
        "{message}"
    );
    assert_same(&rows(&less, &serial(0)), &rows(&answer, &serial(0)));
    let own = rows(&less, &serial(1));
    let count = format!(",{},", DAYS - 1);
    assert!(
        own.len() > 10 && own.iter().all(|row| row.contains(&count)),
        "{own:?}"
    );
}
