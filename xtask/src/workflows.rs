//! Tests of the workflows in `.github/workflows`.

use crate::files::{read, stems};

fn workflows() -> Vec<(String, String)> {
    let folder = ".github/workflows";
    let stems = stems(folder, "yml").expect("a folder of workflows");
    let paths = stems.iter().map(|stem| format!("{folder}/{stem}.yml"));
    paths
        .map(|path| (path.clone(), read(&path).expect("a workflow")))
        .collect()
}

#[test]
fn actions_are_pinned_by_commit() {
    for (path, text) in workflows() {
        let actions = text.lines().filter_map(|line| line.split_once("uses: "));
        for (_, action) in actions {
            let commit = action.split_once('@').map_or("", |(_, rest)| rest);
            let commit = commit.split(' ').next().unwrap_or_default();
            let is_hash = commit.len() == 40 && commit.bytes().all(|b| b.is_ascii_hexdigit());
            assert!(is_hash, "{path}: {action}");
        }
    }
}

#[test]
fn workflows_may_only_read_unless_a_job_says_more() {
    for (path, text) in workflows() {
        assert!(
            text.contains("\npermissions:\n  contents: read\njobs:\n"),
            "{path}"
        );
    }
}
