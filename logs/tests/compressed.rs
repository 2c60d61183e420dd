//! Logs compressed by gzip.

#[path = "common/drive.rs"]
mod drive;

use std::io::Write;

use drive::{loaded, run, timed};
use libflate::gzip::Encoder;

fn packed(text: &str) -> Vec<u8> {
    let mut packing = Encoder::new(Vec::new()).expect("an encoder");
    packing.write_all(text.as_bytes()).expect("packed");
    packing.finish().into_result().expect("packed")
}

fn log(count: usize) -> String {
    let rows = (0..count).map(|k| format!("{},{k},{}\n", k as f64 / 10.0, 10 * k));
    format!("t,q,tau\n{}", rows.collect::<String>())
}

#[test]
fn compressed_logs_are_read_like_uncompressed_ones() {
    let bytes = packed(&log(50));
    let mapping = timed("q", "tau");
    let own = run("a.csv.gz", &[("a.csv.gz", &bytes)], &mapping).expect("a log");
    assert_eq!((own.samples(), loaded(&own).1[49]), (50, 490.0));
    let own = run("a.csv.gz[1:2]", &[("a.csv.gz", &bytes)], &mapping).expect("a log");
    assert_eq!(loaded(&own).0[0], 10.0);
    // The numbers do not fit in memory, and the temporary file lives as long as the log.
    let json: String = (0..300_000)
        .map(|k| format!("{{\"t\":{},\"q\":{k},\"tau\":{k}}}\n", f64::from(k) / 10.0))
        .collect();
    let own = run("a.gz", &[("a.gz", &packed(&json))], &mapping).expect("a log");
    assert_eq!(loaded(&own).0[299_999], 299_999.0);
}

#[test]
fn errors_are_located_in_the_unpacked_text() {
    let text = log(50).replace("0.3,3,", "0.3,x,");
    let mapping = timed("q", "tau");
    let message = run("a.csv.gz", &[("a.csv.gz", &packed(&text))], &mapping);
    let message = message.expect_err("a word");
    assert!(message.starts_with("a.csv.gz:5: "), "{message}");
    let whole = packed(&log(500));
    let message = run(
        "a.csv.gz",
        &[("a.csv.gz", &whole[..whole.len() / 2])],
        &mapping,
    );
    let message = message.expect_err("truncated");
    assert!(
        message.contains("the compressed file is damaged or truncated"),
        "{message}"
    );
    let twice = packed("x");
    let mut packing = Encoder::new(Vec::new()).expect("an encoder");
    packing.write_all(&twice).expect("packed");
    let twice = packing.finish().into_result().expect("packed");
    let message = run("a.csv.gz", &[("a.csv.gz", &twice)], &mapping).expect_err("twice");
    assert!(message.contains("compressed by gzip twice"), "{message}");
}
