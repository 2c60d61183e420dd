//! The examples of `docs/logs.md`: every `[data]` table reads the file shown above it.
//!
//! Files of binary formats are those of `logs/tests/written`, which other libraries have written.

use overact_identification::Log;
use overact_robot::Robot;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Two joints in the vertical plane.
const ROBOT: &str = r#"
name = "TwoLinks"
summary = "Two links in the vertical plane"

[[leg.arm.joint]]
type = "revolute"
alpha = "90 deg"
actuated = true

[[leg.arm.joint]]
type = "revolute"
d = "0.3 m"
actuated = true

[[place]]
name = "arm"
shape = "arm"

"#;

/// The path of a file of the repository.
fn repository(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file)
}

fn page() -> String {
    fs::read_to_string(repository("docs/logs.md")).expect("the page")
}

/// An example of the page.
struct Example {
    title: String,
    /// Names and contents of shown texts, or names of files in `logs/tests/written`.
    texts: Vec<(String, String)>,
    written: Vec<String>,
    table: String,
}

/// All examples of the page.
fn examples(page: &str) -> Vec<Example> {
    let (mut all, mut title) = (Vec::new(), String::new());
    let (mut texts, mut written) = (Vec::new(), Vec::new());
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        if let Some(own) = line.strip_prefix("### ") {
            title = own.to_owned();
        } else if let Some(names) = line.strip_prefix("<!-- files: ") {
            let names = names.trim_end_matches(" -->").split(' ');
            written = names.map(str::to_owned).collect();
        } else if let Some(language) = line.strip_prefix("```") {
            let inside = lines.by_ref().take_while(|line| *line != "```");
            let content: String = inside.map(|line| format!("{line}\n")).collect();
            match language.split_once(' ').unwrap_or((language, "log.txt")) {
                ("toml", _) => all.push(Example {
                    title: title.clone(),
                    texts: std::mem::take(&mut texts),
                    written: std::mem::take(&mut written),
                    table: content,
                }),
                ("text" | "json", name) => texts.push((name.to_owned(), content)),
                _ => {}
            }
        }
    }
    all
}

/// Whether this build reads a file.
fn is_supported(name: &str) -> bool {
    let needs = |ends: &[&str]| ends.iter().any(|end| name.ends_with(end));
    (cfg!(feature = "mcap") || !needs(&[".mcap"]))
        && (cfg!(feature = "hdf5") || !needs(&[".h5", "_v73.mat"]))
}

fn read(example: &Example, path: &str) -> Log {
    let text = format!("{ROBOT}{}", example.table);
    let robot = Robot::from_text("arm.toml", &text);
    let robot = robot.unwrap_or_else(|error| panic!("{}: {error}", example.title));
    let logs = robot.read_logs(&[(Path::new(path), false)], &|_| {});
    let mut logs = logs.unwrap_or_else(|error| panic!("{}: {path}: {error}", example.title));
    assert_eq!(logs.len(), 1, "{}", example.title);
    logs.remove(0)
}

#[test]
fn documented_texts_are_read_with_their_tables() {
    let page = page();
    let examples = examples(&page);
    let shown: Vec<&Example> = examples
        .iter()
        .filter(|own| !own.texts.is_empty())
        .collect();
    assert!(shown.len() >= 10, "{}", shown.len());
    for example in shown {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(example.title.replace(' ', "_"));
        fs::create_dir_all(&folder).expect("a folder");
        for (name, content) in &example.texts {
            fs::write(folder.join(name), content).expect("written");
        }
        let paths = example.texts.iter().map(|(name, _)| folder.join(name));
        let paths: Vec<String> = paths.map(|path| path.display().to_string()).collect();
        let log = read(example, &paths.join("+"));
        let title = &example.title;
        assert!((log.sampling_frequency() - 1000.0).abs() < 1.0, "{title}");
        let (positions, torques) = log.load().expect("numbers");
        assert!(positions.len() >= 6, "{title}: {positions:?}");
        // The second angle of all examples is twice the first one.
        for (q, tau) in positions.chunks_exact(2).zip(torques.chunks_exact(2)) {
            assert!(
                (q[1] - 2.0 * q[0]).abs() < 1e-12 && q[0] > 0.09,
                "{title}: {q:?}"
            );
            assert!(
                q[0] < 0.3 && tau[0] > 3.0 * tau[1] - 2.0,
                "{title}: {tau:?}"
            );
        }
    }
}

#[test]
fn files_of_other_programs_are_read_with_the_documented_tables() {
    let page = page();
    let mut names = Vec::new();
    for example in examples(&page) {
        for name in example.written.iter().filter(|name| is_supported(name)) {
            let path = repository("logs/tests/written").join(name);
            let log = read(&example, &path.display().to_string());
            assert!(log.samples() >= 12, "{}: {name}", example.title);
            names.push(name.clone());
        }
        assert!(
            !example.written.is_empty() || !example.texts.is_empty(),
            "{}: no file",
            example.title
        );
    }
    for name in [
        "same.mat",
        "same.npz",
        "same.npy",
        "same.parquet",
        "structures.mat",
    ] {
        assert!(names.iter().any(|own| own == name), "{name}");
    }
}

#[test]
fn unsupported_formats_are_reported_as_documented() {
    let files: [(&str, &[u8]); 10] = [
        ("bag of ROS 1", b"#ROSBAG V2.0\n"),
        ("bag of ROS 2 in SQLite", b"SQLite format 3\0\0\0"),
        ("Arrow, Feather", b"ARROW1\0\0"),
        ("encrypted Parquet", b"PARE\x15\x04"),
        ("`.xls`", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"),
        ("`.xlsx`, other zip archives", EMPTY_SHEET),
        ("compressed by zstd", b"\x28\xb5\x2f\xfd\x04\x00"),
        ("compressed by gzip twice", GZIP_TWICE),
        ("text in UTF-16", b"\xff\xfet\0i\0m\0e\0"),
        ("anything else that is not text", b"\0\x01\x02\x03"),
    ];
    let page = page();
    let section = page
        .split("### Formats that are refused")
        .nth(1)
        .expect("a section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let rows = section.lines().filter_map(|line| {
        let (name, message) = line
            .strip_prefix("| ")?
            .strip_suffix(" |")?
            .split_once(" | ")?;
        (name != "file").then_some((name, message))
    });
    let rows: Vec<(&str, &str)> = rows.collect();
    assert_eq!(rows.len(), files.len());
    let robot = Robot::from_text("arm.toml", ROBOT).expect("a robot");
    for (name, bytes) in files {
        let row = rows.iter().find(|(own, _)| *own == name);
        let (_, message) = row.unwrap_or_else(|| panic!("{name} is not documented"));
        let error = robot
            .log_of_bytes("log", bytes.into(), false)
            .expect_err(name);
        let problem = &error.problems()[0];
        assert!(
            problem.message.starts_with(message),
            "{name}: {}",
            problem.message
        );
        assert!(problem.help.is_some(), "{name}: no help");
    }
}

/// A zip archive with one empty file `a.xml`.
const EMPTY_SHEET: &[u8] = b"PK\x03\x04\x14\x00\x00\x00\x00\x00\x00\x00!\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x05\x00\x00\x00a.xmlPK\x01\x02\x14\x03\x14\x00\x00\x00\x00\x00\x00\x00!\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x05\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x80\x01\x00\x00\x00\x00a.xmlPK\x05\x06\x00\x00\x00\x00\x01\x00\x01\x003\x00\x00\x00#\x00\x00\x00\x00\x00";

/// A text compressed by gzip, and again.
const GZIP_TWICE: &[u8] = b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x93\xef\xe6`\x00\x01&f\xed\x8b\x9aO\x8c.\x18>abX^#\xaf\x01\x12\x05\x00\x7f\x19=h\x1c\x00\x00\x00";
