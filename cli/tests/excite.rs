//! `overact excite` on the command line.

mod common;

use common::Bench;

#[test]
fn excite_writes_runs_and_keeps_the_description() {
    let bench = Bench::with("serial-2r", str::to_owned);
    let before = bench.read("my.toml");
    let table = bench.good(&[
        "excite", "my.toml", "-o", "new.toml", "--runs", "1", "--time", "1",
    ]);
    for part in ["condition number", " random", "found", "wrote new.toml"] {
        assert!(table.contains(part), "{part} in {table}");
    }
    assert_eq!(bench.read("my.toml"), before);
    assert!(bench.read("new.toml").contains("name = \"excitation 1\""));
    bench.good(&["check", "new.toml"]);
    let document = bench.good(&["excite", "new.toml", "--runs", "1", "--time", "1", "--json"]);
    for part in ["\"limits\"", "\"log_det\"", "\"tables\""] {
        assert!(document.contains(part), "{part} in {document}");
    }
}
