//! Report files of an identification by extension, and published results for comparison.

use crate::{
    failure::{Failure, Problem},
    names::file_stem,
};
use overact::Info;
use overact_codegen::diagnostic::Code;
use overact_identification::Identification;
use overact_report::{About, Published, Units, numbers, whole_page};
use overact_robot::{Robot, drawing};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Where reports go, and what they are compared with.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(crate) struct Arguments {
    /// Write a report: a page for a browser (.html), all numbers and plotted series (.json), or all
    /// numbers as one flat table (.csv); once for each
    #[arg(long = "report", value_name = "FILE")]
    reports: Vec<PathBuf>,
    /// Published results to compare with [default: `published/NAME.toml` in the folder of
    /// the description NAME.toml, where it exists]
    #[arg(long, value_name = "TOML")]
    published: Option<PathBuf>,
}

/// Format of a report file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Html,
    Json,
    Csv,
}

/// Requested reports, checked before the long work begins.
#[derive(Debug)]
pub(crate) struct ReportRequest {
    files: Vec<(PathBuf, Format)>,
    published: Option<PathBuf>,
}

/// Requested reports with the published results.
#[derive(Debug)]
pub(crate) struct Reports {
    files: Vec<(PathBuf, Format)>,
    published: Option<Published>,
}

impl Arguments {
    /// Checks the requested reports for a description.
    ///
    /// # Errors
    /// A file with an unknown extension.
    pub(crate) fn check(&self, description: &Path) -> Result<ReportRequest, Failure> {
        let with_format = |path: &PathBuf| Ok((path.clone(), format(path)?));
        let files = self.reports.iter().map(with_format);
        Ok(ReportRequest {
            files: files.collect::<Result<_, Failure>>()?,
            published: self
                .published
                .clone()
                .or_else(|| default_published_file(description)),
        })
    }
}

impl ReportRequest {
    /// Files to read.
    pub(crate) fn inputs(&self) -> Vec<&Path> {
        self.published.iter().map(PathBuf::as_path).collect()
    }

    /// Files to write.
    pub(crate) fn outputs(&self) -> Vec<&Path> {
        self.files.iter().map(|(path, _)| path.as_path()).collect()
    }

    /// Reads the published results.
    ///
    /// # Errors
    /// Published results that cannot be read.
    pub(crate) fn read(self) -> Result<Reports, Failure> {
        Ok(Reports {
            files: self.files,
            published: self.published.as_deref().map(published).transpose()?,
        })
    }
}

impl Reports {
    /// Published results of the robot, if there are any.
    pub(crate) const fn published(&self) -> Option<&Published> {
        self.published.as_ref()
    }

    /// Path of the page, if one is requested.
    pub(crate) fn page(&self) -> Option<&Path> {
        let mut files = self.files.iter();
        let page = files.find(|(_, format)| *format == Format::Html);
        page.map(|(path, _)| path.as_path())
    }

    /// Files with their contents.
    ///
    /// # Errors
    /// A result that is not valid JSON, which does not happen.
    pub(crate) fn written(
        self,
        robot: &Robot,
        info: &Info<'_>,
        result: &Identification,
    ) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
        let mut written = Vec::new();
        for (path, format) in self.files {
            let text = match format {
                Format::Csv => numbers(result)?,
                Format::Json => document(result)?,
                Format::Html => html(robot, info, result, self.published.as_ref())?,
            };
            written.push((path, text.into_bytes()));
        }
        Ok(written)
    }
}

/// JSON document of a report: all numbers and figures.
///
/// # Errors
/// A result that is not valid JSON, which does not happen.
pub fn document(result: &Identification) -> Result<String, Failure> {
    Ok(overact_report::document_with_figures(result)?)
}

/// Format of an extension.
fn format(path: &Path) -> Result<Format, Failure> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("html" | "htm") => Ok(Format::Html),
        Some("json") => Ok(Format::Json),
        Some("csv") => Ok(Format::Csv),
        _ => Err(Failure::Usage(format!(
            "the name of a report must end with .html, .json or .csv, unlike `{}`",
            path.display()
        ))),
    }
}

/// HTML page with its numbers as attached files.
///
/// # Errors
/// A result that is not valid JSON, which does not happen.
pub fn html(
    robot: &Robot,
    info: &Info<'_>,
    result: &Identification,
    published: Option<&Published>,
) -> Result<String, Failure> {
    let description = robot.description();
    let about = About {
        units: &Units::new(info),
        summary: &description.summary,
        source: &description.source,
        drawing: &drawing::svg(&robot.model().model().mechanism),
        published,
    };
    Ok(whole_page(result, &about, &file_stem(&result.robot))?)
}

/// Default file of published results for a description.
#[must_use]
pub fn default_published_file(description: &Path) -> Option<PathBuf> {
    let folder = description.parent()?.join("published");
    let file = folder.join(description.file_name()?);
    file.is_file().then_some(file)
}

/// Reads published results.
///
/// # Errors
/// A file that cannot be read, unknown keys, or lists of different lengths.
pub fn published(path: &Path) -> Result<Published, Failure> {
    let file = path.display().to_string();
    let text = fs::read_to_string(path).map_err(|error| {
        Problem::new(
            Code::PUBLISHED,
            format!("the published results can't be read: {error}"),
        )
        .file(file.as_str())
    })?;
    let published: Published = toml::from_str(&text).map_err(|error| {
        let before = error.span().and_then(|span| text.get(..span.start));
        let line = before.map(|before| before.matches('\n').count() + 1);
        Problem::new(
            Code::PUBLISHED,
            format!("published results: {}", error.message()),
        )
        .file(file.as_str())
        .line(line)
        .help("robots/README.md documents the keys")
    })?;
    let wrong = published.wrong_lengths();
    let problems: Vec<Problem> = wrong
        .into_iter()
        .map(|(what, length)| {
            let message = format!(
                "published results: {what} has {length} numbers for {} actuators",
                published.actuators.len()
            );
            Problem::new(Code::PUBLISHED, message)
                .file(file.as_str())
                .help("give one number for each name in `actuators`")
        })
        .collect();
    if problems.is_empty() {
        Ok(published)
    } else {
        Err(problems.into())
    }
}
