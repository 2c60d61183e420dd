use std::sync::Arc;

use super::JsonLines;
use crate::{bytes::byte_source::ByteSource, error::Error, formats::table_file::TableFile};

fn open(text: &str) -> Result<JsonLines, Error> {
    let bytes: Arc<[u8]> = text.as_bytes().into();
    JsonLines::open(String::from("log.jsonl"), &ByteSource::Memory(bytes))
}

/// All rows of these columns; the first problems otherwise.
fn rows(text: &str, names: &[&str]) -> Result<Vec<Vec<f64>>, String> {
    let file = open(text).map_err(|error| error.to_string())?;
    let wanted = names.iter().map(|&name| {
        let place = file.find(name).expect("unique").expect("existing");
        (place, name)
    });
    let wanted: Vec<(usize, &str)> = wanted.collect();
    let mut rows = file.rows(&wanted).expect("open");
    let mut all = Vec::new();
    let mut row = vec![f64::NAN; names.len()];
    while rows.next(&mut row).map_err(|error| error.to_string())? {
        all.push(row.clone());
    }
    Ok(all)
}

#[test]
fn nested_values_become_columns() {
    let text = "{\"t\": 0, \"p\": {\"q\": [1, \"2.5\"], \"on\": true}}\r\n\n\
                {\"p\": {\"on\": false, \"q\": [-3e2, 4, 5]}, \"more\": [[]], \"t\": 0.1}";
    let file = open(text).expect("open");
    let names = ["t", "p.q[0]", "p.q[1]", "p.on", "p.q[2]"];
    assert_eq!(file.existing().names, names);
    assert_eq!(
        rows(text, &["p.q[1]", "t", "p.q[0]", "p.on"]),
        Ok(vec![vec![2.5, 0.0, 1.0, 1.0], vec![4.0, 0.1, -300.0, 0.0]])
    );
}

#[test]
fn json_lists_and_multiline_objects_are_read() {
    let expected = Ok(vec![vec![1.0], vec![2.0]]);
    for text in [
        "{\"q\":1}\n{\"q\":2}",
        "\u{feff}{\"q\":1}\n\n{\"q\":2}\n",
        "[{\"q\":1},{\"q\":2}]",
        "[\n  {\"q\": 1, \"s\": \"}]\\\"{\"},\n  {\"q\": 2}\n]\n",
        "{\n  \"q\": 1\n}\n{\n  \"q\": 2\n}\n",
    ] {
        assert_eq!(rows(text, &["q"]), expected, "{text}");
    }
}

#[test]
fn non_numeric_values_are_located() {
    for (second, what) in [
        ("{}", "log.jsonl:2: `q` is missing"),
        ("{\"q\": null}", "log.jsonl:2: `q` is null, not a number"),
        (
            "{\"q\": \"on\"}",
            "log.jsonl:2: `q` is the text \"on\", not a number",
        ),
        (
            "{\"q\": NaN}",
            "log.jsonl:2: `q` is NaN, not a finite number",
        ),
        (
            "{\"q\": -Infinity}",
            "log.jsonl:2: `q` is -inf, not a finite number",
        ),
        ("{\"q\": [1]}", "log.jsonl:2: `q` is an object or a list"),
        ("{\"q\": 1, \"q\": 2}", "log.jsonl:2: `q` is given twice"),
        (
            "{\"q\": 1",
            "log.jsonl:2: this is not JSON: EOF while parsing an object",
        ),
        (
            "{\"q\": 1e999}",
            "log.jsonl:2: this is not JSON: number out of range",
        ),
        (
            "q: 1",
            "log.jsonl:2: this is not JSON: expected value, at character 1",
        ),
    ] {
        let message = rows(&format!("{{\"q\": 1}}\n{second}\n"), &["q"]).expect_err(second);
        assert!(message.starts_with(what), "{message}");
        assert!(message.contains("help: "), "{message}");
    }
    // Other columns may have anything.
    let text = "{\"q\": 1, \"x\": NaN, \"n\": \"NaN\\\"\"}\n{\"q\": 2, \"x\": null}\n";
    assert_eq!(rows(text, &["q"]), Ok(vec![vec![1.0], vec![2.0]]));
    let message =
        rows("{\"t\": 0, \"q\": 1}\n{\"event\": 3}\n", &["t", "q"]).expect_err("an event");
    assert!(
        message.contains("log.jsonl:2: the object has none of the keys `t`, `q`"),
        "{message}"
    );
}

#[test]
fn malformed_lists_are_rejected() {
    for (text, what) in [
        (
            "[{\"q\":1},\n{\"q\":2}",
            "log.jsonl:2: the list of objects has no end",
        ),
        ("[{\"q\":1}\n{\"q\":2}]", "log.jsonl:2: there is no comma"),
        (
            "[{\"q\":1},\n2]",
            "log.jsonl:2: the list has an item that is not an object",
        ),
        (
            "[{\"q\":1}]\n{\"q\":2}",
            "log.jsonl:2: the file goes on after its list",
        ),
    ] {
        let message = rows(text, &["q"]).expect_err(text);
        assert!(message.starts_with(what), "{message}");
    }
}

#[test]
fn nesting_depth_and_object_size_are_bounded() {
    let deep = format!(
        "{{\"q\": 1, \"x\": {}1{}}}\n",
        "[".repeat(40),
        "]".repeat(40)
    );
    let message = rows(&deep, &["q"]).expect_err("deep");
    assert!(
        message.contains("log.jsonl:1: objects and lists are nested more than 16 deep"),
        "{message}"
    );
    let long = format!(
        "{{\"q\": 1}}\n{{\"q\": 2, \"x\": \"{}\"}}\n",
        "x".repeat(2 << 20)
    );
    let message = rows(&long, &["q"]).expect_err("long");
    assert!(
        message.contains("log.jsonl:2: an object has more than 1024 kB"),
        "{message}"
    );
    let wide = format!("{{\"x\": [{}1]}}", "1,".repeat(30_000));
    let message = open(&wide).expect_err("wide").to_string();
    assert!(
        message.contains("an object has more than 20000 values"),
        "{message}"
    );
    // Deep values further down are skipped.
    let later = format!("{}{deep}", "{\"q\": 1}\n".repeat(100));
    assert_eq!(rows(&later, &["q"]).map(|rows| rows.len()), Ok(101));
}
