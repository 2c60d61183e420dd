//! The page with its numbers as attached files, and these files separately.

use crate::{
    numbers::numbers,
    page::{Attachment, Contents, page},
    published::Published,
    units::Units,
};
use overact_core::Code;
use overact_identification::{Error, Figures, Identification, Problem};
use serde::Serialize;

/// Information about the robot, apart from its identification.
#[derive(Debug, Clone, Copy)]
pub struct About<'a> {
    /// Units of its coordinates and actuators.
    pub units: &'a Units,
    /// Summary of the robot, one sentence; may be empty.
    pub summary: &'a str,
    /// Source of its description; may be empty.
    pub source: &'a str,
    /// A drawing of the robot, an SVG document.
    pub drawing: &'a str,
    /// Published results for comparison.
    pub published: Option<&'a Published>,
}

/// Result with its figures.
#[derive(Serialize)]
struct WithFigures<'a> {
    #[serde(flatten)]
    identification: &'a Identification,
    figures: &'a Figures,
}

/// All numbers as JSON, as printed by `overact identify --json`.
///
/// # Errors
/// Never: the keys of an identification are strings.
pub fn document(identification: &Identification) -> Result<String, Error> {
    json(identification)
}

/// All numbers and figures as JSON.
///
/// # Errors
/// Never: the keys of an identification are strings.
pub fn document_with_figures(identification: &Identification) -> Result<String, Error> {
    json(&WithFigures {
        identification,
        figures: &identification.figures,
    })
}

fn json(document: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string_pretty(document).map_err(|error| {
        let message = format!("the result cannot be written as JSON: {error}");
        Problem::new(Code::NO_RESULT_TEXT, message).into()
    })
}

/// Page of an identification with CSV and JSON files attached; `stem` is their file name.
///
/// # Errors
/// Never: the keys of an identification are strings.
pub fn whole_page(
    identification: &Identification,
    about: &About<'_>,
    stem: &str,
) -> Result<String, Error> {
    let (csv_name, json_name) = (format!("{stem}.csv"), format!("{stem}.json"));
    let (csv, json) = (numbers(identification)?, document(identification)?);
    let attachments = [
        Attachment {
            name: &csv_name,
            media_type: "text/csv",
            what: "all numbers, one per row",
            text: &csv,
        },
        Attachment {
            name: &json_name,
            media_type: "application/json",
            what: "the same as JSON, with settings and warnings",
            text: &json,
        },
    ];
    Ok(page(&Contents {
        identification,
        units: about.units,
        summary: Some(about.summary).filter(|text| !text.is_empty()),
        source: Some(about.source).filter(|text| !text.is_empty()),
        drawing: Some(about.drawing),
        published: about.published,
        attachments: &attachments,
    }))
}
