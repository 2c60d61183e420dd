//! The page with its numbers as files within it, and these files by themselves.

use crate::{
    numbers::numbers,
    page::{Attachment, Contents, page},
    published::Published,
    units::Units,
};
use overact_core::Code;
use overact_identification::{Error, Figures, Identification, Problem};
use serde::Serialize;

/// What the page says of a robot besides its identification.
#[derive(Debug, Clone, Copy)]
pub struct About<'a> {
    /// Units of its coordinates and actuators.
    pub units: &'a Units,
    /// What the robot is, in a sentence; may be empty.
    pub summary: &'a str,
    /// Where its description comes from; may be empty.
    pub source: &'a str,
    /// A drawing of the robot, an SVG document.
    pub drawing: &'a str,
    /// Published results to show beside the own ones.
    pub published: Option<&'a Published>,
}

/// The result with what is plotted.
#[derive(Serialize)]
struct WithFigures<'a> {
    #[serde(flatten)]
    identification: &'a Identification,
    figures: &'a Figures,
}

/// All numbers as a document: what `overact identify --json` prints.
///
/// # Errors
/// Never: the keys of an identification are texts.
pub fn document(identification: &Identification) -> Result<String, Error> {
    json(identification)
}

/// The document with all that is plotted.
///
/// # Errors
/// Never: the keys of an identification are texts.
pub fn document_with_figures(identification: &Identification) -> Result<String, Error> {
    json(&WithFigures {
        identification,
        figures: &identification.figures,
    })
}

fn json(document: &impl Serialize) -> Result<String, Error> {
    serde_json::to_string_pretty(document).map_err(|error| {
        let message = format!("the result is no JSON: {error}");
        Problem::new(Code::NO_RESULT_TEXT, message).into()
    })
}

/// The page of an identification, with all numbers as CSV and as a document in it; the files are called by `stem`.
///
/// # Errors
/// Never: the keys of an identification are texts.
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
            what: "all numbers, one a row",
            text: &csv,
        },
        Attachment {
            name: &json_name,
            media_type: "application/json",
            what: "the same as a document, with settings and warnings",
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
