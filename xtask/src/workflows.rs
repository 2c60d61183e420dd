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
fn workflows_have_read_permission_by_default() {
    for (path, text) in workflows() {
        assert!(
            text.contains("\npermissions:\n  contents: read\njobs:\n"),
            "{path}"
        );
    }
}

/// The jobs of a workflow with their text; names are indented by two blanks.
fn jobs(text: &str) -> Vec<(&str, String)> {
    let (_, text) = text.split_once("\njobs:\n").expect("jobs");
    let mut jobs: Vec<(&str, String)> = Vec::new();
    for line in text.lines() {
        let name = line.strip_prefix("  ").and_then(|l| l.strip_suffix(':'));
        match (name.filter(|name| !name.starts_with(' ')), jobs.last_mut()) {
            (Some(name), _) => jobs.push((name, String::new())),
            (None, Some((_, job))) => {
                job.push_str(line);
                job.push('\n');
            }
            (None, None) => panic!("a line before all jobs: {line}"),
        }
    }
    jobs
}

#[test]
fn publishing_jobs_depend_on_the_guard() {
    let text = read(".github/workflows/release.yml").expect("the workflow");
    let jobs = jobs(&text);
    let publishes = |job: &str| job.contains("secrets.") || job.contains(": write");
    let publishing: Vec<_> = jobs
        .iter()
        .filter(|(name, job)| *name != "guard" && publishes(job))
        .collect();
    assert_eq!(publishing.len(), 3);
    for (name, job) in publishing {
        assert!(job.contains("\n    needs: [guard, "), "{name}:\n{job}");
        // The standard condition is that all of them succeeded.
        let condition = job.lines().find(|line| line.starts_with("    if: "));
        assert_eq!(
            condition,
            Some("    if: github.event_name == 'push'"),
            "{name}"
        );
    }
    let (_, guard) = jobs
        .iter()
        .find(|(name, _)| *name == "guard")
        .expect("a guard");
    assert!(
        guard.contains("cargo xtask release --tag \"$TAG\""),
        "{guard}"
    );
}

#[test]
fn scripts_contain_no_template_expressions() {
    for (path, text) in workflows() {
        for line in text.lines().filter(|line| line.contains("${{")) {
            let is_script = line
                .trim_start()
                .trim_start_matches("- ")
                .starts_with("run:");
            assert!(!is_script, "{path}: {line}");
        }
    }
}
