//! Unusable runs and files, with reasons.

use overact::Code;
use serde::Serialize;

use overact_logs::Problem;

/// A run, or a whole file, that was left out.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ExcludedRun {
    /// File.
    pub file: String,
    /// Name of the run; `None` for the whole file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
    /// Reason.
    pub reason: Reason,
    /// Reason in words.
    pub message: String,
}

/// Reason for leaving out a run or a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Reason {
    /// The file is truncated, or contains no factors.
    Unreadable,
    /// The file is of another version of the format.
    OtherVersion,
    /// Numbers that changed after writing, or are not finite.
    Damaged,
    /// Another description, or other settings.
    Unlike,
    /// The run has been counted before.
    Twice,
    /// The run lacks factors of a model that other runs have.
    MissingModel,
}

impl ExcludedRun {
    /// It as an error, with a remedy.
    pub(super) fn problem(&self) -> Problem {
        let message = match &self.run {
            Some(run) => format!("run `{run}`: {}", self.message),
            None => self.message.clone(),
        };
        let help = match self.reason {
            Reason::Unreadable => "copy or write the file again; `--skip-bad` skips it",
            Reason::OtherVersion => {
                "use the program that wrote it, or factor the logs again; `--skip-bad` skips it"
            }
            Reason::Damaged => "factor the log again; `--skip-bad` skips the run",
            _ => {
                "factor its log again with the current description of the other runs; `--skip-bad` skips the run"
            }
        };
        Problem::new(Code::FACTORS, message)
            .file(self.file.as_str())
            .help(help)
    }
}
