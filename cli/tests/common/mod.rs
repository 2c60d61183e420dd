//! Runs the program `overact` as users do.

// Every test file uses some of these helpers.
#![allow(dead_code)]

use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

/// A separate working folder for `overact`.
pub(crate) struct Bench {
    folder: TempDir,
}

/// Result of a run.
pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        Self { folder }
    }

    /// A bench with `my.toml`, a template shortened by `edit`.
    pub(crate) fn with(template: &str, edit: impl Fn(&str) -> String) -> Self {
        let bench = Self::new();
        let new = bench.run(&["new", template, "my.toml"]);
        assert_eq!(new.code, Some(0), "{}", new.err);
        let text = bench.read("my.toml");
        bench.write("my.toml", &edit(&text));
        bench
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("a file in the temporary folder");
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the temporary folder");
        let name = |entry: std::io::Result<fs::DirEntry>| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Outcome {
        let output = Command::new(env!("CARGO_BIN_EXE_overact"))
            .args(arguments)
            .current_dir(self.folder.path())
            .output()
            .expect("the program");
        outcome(output)
    }

    /// Runs a command that must succeed.
    pub(crate) fn good(&self, arguments: &[&str]) -> String {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.err);
        outcome.out
    }

    /// JSON document of a command that must succeed.
    pub(crate) fn json(&self, arguments: &[&str]) -> Value {
        let arguments = [&["--json"], arguments].concat();
        serde_json::from_str(&self.good(&arguments)).expect("JSON")
    }

    /// Errors of a command that must fail with code 1, as text; its JSON must be equivalent.
    pub(crate) fn bad(&self, arguments: &[&str]) -> String {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, Some(1), "{arguments:?}: {}", outcome.out);
        assert_eq!(outcome.out, "", "{arguments:?}");
        let json = self.run(&[&["--json"], arguments].concat());
        assert_eq!(json.code, Some(1));
        let document: Value = serde_json::from_str(&json.err).expect("errors as JSON");
        let errors = document["errors"].as_array().expect("a list");
        assert!(!errors.is_empty());
        for error in errors {
            for key in ["message", "file", "line", "column", "help"] {
                assert!(error.get(key).is_some(), "{key} in {error}");
            }
            let message = error["message"].as_str().expect("a text");
            assert!(
                outcome.err.contains(message),
                "{message}\nin\n{}",
                outcome.err
            );
        }
        outcome.err
    }
}

fn outcome(output: Output) -> Outcome {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    Outcome {
        code: output.status.code(),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

/// Path of a robot of this repository.
pub(crate) fn robot(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../robots")
        .join(name);
    path.display().to_string()
}

/// The names of the library's robots, sorted.
pub(crate) fn robots() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let entries = fs::read_dir(folder).expect("the robots");
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
        .filter_map(|name| Some(name.strip_suffix(".toml")?.to_owned()))
        .collect();
    names.sort();
    assert!(!names.is_empty());
    names
}

/// A file of the measured data, in a folder next to the repository or at `OVERACT_SHARED`.
pub(crate) fn shared(name: &str) -> Option<String> {
    let root = std::env::var_os("OVERACT_SHARED").map(PathBuf::from);
    let root = root.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"));
    let path = root.join(name);
    if path.is_file() {
        return Some(path.display().to_string());
    }
    eprintln!("skipped: {name} is not there; set OVERACT_SHARED to the folder of the data");
    None
}

/// A list of a document.
pub(crate) fn list(value: &Value) -> &[Value] {
    value
        .as_array()
        .unwrap_or_else(|| panic!("{value} is no list"))
}

/// The names in a list of a document.
pub(crate) fn names(value: &Value) -> Vec<&str> {
    fn name(item: &Value) -> &str {
        item.as_str().unwrap_or_else(|| panic!("{item} is no text"))
    }
    list(value).iter().map(name).collect()
}

/// A number of a document.
pub(crate) fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

/// Names and true values of the DualV's essential parameters: Table 2 of the paper (case 1), and
/// the values of the virtual experiment.
pub(crate) const NINE: [(&str, f64); 9] = [
    ("zz_platformR", 0.0206),
    ("m_platformR", 1.92),
    ("zz_1_leg1R", 0.0445),
    ("zz_1_leg2R", 0.0481),
    ("zz_1_leg3R", 0.0481),
    ("zz_1_leg4R", 0.0507),
    ("zz_payload", 0.0161),
    ("mx_payload", -0.127),
    ("m_payload", 5.42),
];
