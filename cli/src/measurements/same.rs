//! Detects logs that are given twice, under any names.
//!
//! Their samples would count twice, and validation with training data has little meaning.

use crate::failure::{Failure, Problem};
use overact_codegen::diagnostic::Code;
use std::{fs, path::Path};

/// Rejects logs with equal content; the first `estimated` ones are training data, the others
/// validation data.
///
/// # Errors
/// Every log with the content of an earlier one.
pub(crate) fn check(logs: &[&Path], estimated: usize) -> Result<(), Failure> {
    let sizes: Vec<Option<Vec<u64>>> = logs.iter().map(|log| sizes(log)).collect();
    let mut problems = Vec::new();
    for at in 1..logs.len() {
        let is_same = |&other: &usize| {
            sizes[at].is_some()
                && overlap(logs[at], logs[other])
                && sizes[at] == sizes[other]
                && content(logs[at]) == content(logs[other])
        };
        if let Some(other) = (0..at).find(is_same) {
            problems.push(problem(
                logs[at],
                logs[other],
                at < estimated,
                other < estimated,
            ));
        }
    }
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems.into())
    }
}

/// Whether two logs have times in common, if both are read in part, `log.csv[10:60]`.
fn overlap(one: &Path, other: &Path) -> bool {
    // Ranges that cannot be used are reported when the logs are read.
    let range = |log: &Path| overact_logs::time_range(log).ok().flatten();
    match (range(one), range(other)) {
        (Some(one), Some(other)) => one.overlaps(&other),
        _ => true,
    }
}

fn problem(log: &Path, other: &Path, is_estimated: bool, is_other_estimated: bool) -> Problem {
    let other = other.display();
    let (message, help) = if !is_estimated && is_other_estimated {
        (
            format!(
                "the log has the content of `{other}`, from which the parameters are estimated"
            ),
            "cross-validate with a run that is not training data",
        )
    } else {
        (
            format!("the log has the content of `{other}`: its samples would count twice"),
            "give each log once",
        )
    };
    Problem::new(Code::SAME_LOG, message)
        .file(log.display().to_string())
        .help(help)
}

/// Sizes of a log's files; `None` if one is not a file, which is reported when the log is read.
fn sizes(log: &Path) -> Option<Vec<u64>> {
    let size = |path: &Path| Some(fs::metadata(path).ok().filter(fs::Metadata::is_file)?.len());
    overact_logs::parts(log).into_iter().map(size).collect()
}

/// Contents of a log's files.
fn content(log: &Path) -> Option<Vec<Vec<u8>>> {
    let parts = overact_logs::parts(log).into_iter();
    parts.map(|path| fs::read(path).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::check;
    use std::{fs, path::Path};

    #[test]
    fn a_log_given_twice_under_different_names_is_rejected() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let at = |name: &str| folder.path().join(name);
        for (name, text) in [
            ("a.csv", "t,q\n0,1\n"),
            ("b.csv", "t,q\n0,2\n"),
            ("c.csv", "t,q\n0,1\n"),
        ] {
            fs::write(at(name), text)?;
        }
        let [a, b, c, none] = ["a.csv", "b.csv", "c.csv", "none.csv"].map(at);
        let check_message = |logs: &[&Path], estimated| match check(logs, estimated) {
            Ok(()) => String::new(),
            Err(failure) => failure.render(false),
        };
        assert_eq!(check_message(&[&a, &b, &none, &none], 1), "");
        let twice = check_message(&[&a, &b, &a, &c], 4);
        assert_eq!(
            twice.matches("its samples would count twice").count(),
            2,
            "{twice}"
        );
        assert!(
            twice.contains("c.csv") && twice.contains("give each log once"),
            "{twice}"
        );
        let validated = check_message(&[&a, &c], 1);
        assert!(
            validated.contains("from which the parameters are estimated"),
            "{validated}"
        );
        assert!(check_message(&[&a, &b, &b], 1).contains("count twice"));
        // Ranges of one log are different runs unless they overlap.
        let [start, end, middle] = ["a.csv[:1]", "a.csv[1:]", "a.csv[0.5:1.5]"].map(at);
        assert_eq!(check_message(&[&start, &end], 1), "");
        assert!(check_message(&[&end, &middle], 2).contains("count twice"));
        assert!(
            check_message(&[&a, &middle], 1).contains("from which the parameters are estimated")
        );
        Ok(())
    }
}
