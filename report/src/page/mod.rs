//! HTML page of an identification: one self-contained file for engineers.
//!
//! The verdict comes first with a plot of measured and predicted torque, then the parameters. Each
//! plot has a caption on how to read it. Each section is a file: `verdict`, `checks`, and those in
//! the folders `calibrations`, `estimates`, `fit` and `runs`. `elements` has what sections consist
//! of. Empty sections are omitted.

mod calibrations;
mod checks;
pub(crate) mod elements;
mod estimates;
mod fit;
mod header;
mod runs;
mod scope;
mod verdict;

#[cfg(test)]
mod tests;

use elements::markup::Section;

use crate::{published::Published, text::escape, units::Units};
use overact_identification::Identification;

/// Style sheet with light and dark colours and a responsive layout.
const STYLE: &str = include_str!("style.css");

/// Contents of the page.
#[derive(Debug, Clone, Copy)]
pub struct Contents<'a> {
    /// Result of the identification.
    pub identification: &'a Identification,
    /// Units of coordinates and actuators.
    pub units: &'a Units,
    /// Summary of the robot, one sentence.
    pub summary: Option<&'a str>,
    /// Source of its description.
    pub source: Option<&'a str>,
    /// Drawing of the robot, an SVG document; embedded as an image so that styles do not interfere.
    pub drawing: Option<&'a str>,
    /// Published results for comparison.
    pub published: Option<&'a Published>,
    /// Files attached to the page.
    pub attachments: &'a [Attachment<'a>],
}

/// A file attached to the page.
#[derive(Debug, Clone, Copy)]
pub struct Attachment<'a> {
    /// File name for downloads.
    pub name: &'a str,
    /// Its media type, `text/csv` for instance.
    pub media_type: &'a str,
    /// Short description.
    pub what: &'a str,
    /// Contents.
    pub text: &'a str,
}

/// Page of an identification; the HTML is well-formed XML.
#[must_use]
pub fn page(contents: &Contents<'_>) -> String {
    let sections: Vec<Section> = [
        verdict::section(contents),
        estimates::parameters::section(contents),
        scope::section(contents),
        checks::section(contents),
        calibrations::calibration::section(contents),
        calibrations::gravity::section(contents),
        calibrations::gains::section(contents),
        calibrations::gears::section(contents),
        calibrations::stribeck::section(contents),
        estimates::motors::section(contents),
        estimates::online::section(contents),
        estimates::consistent::section(contents),
        estimates::estimators::section(contents),
        estimates::limits::section(contents),
        fit::validation::section(contents),
        fit::inputs::section(contents),
        fit::residuals::section(contents),
        fit::friction::section(contents),
        fit::correlation::section(contents),
        fit::elimination::section(contents),
        fit::conditioning::section(contents),
        runs::ranges::section(contents),
        runs::trajectories::section(contents),
        runs::tracking::section(contents),
        runs::data::section(contents),
        runs::data::files(contents),
    ]
    .into_iter()
    .filter(|section| !section.body.is_empty())
    .collect();
    let robot = escape(&contents.identification.robot);
    let links: String = sections
        .iter()
        .map(|one| format!("<li><a href=\"#{}\">{}</a></li>", one.id, escape(one.title)))
        .collect();
    let body: String = sections.iter().map(Section::html).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n\
         <meta name=\"generator\" content=\"overact {}\"/>\n\
         <title>Identification of {robot}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         {}<div class=\"columns\">\n<nav aria-label=\"Sections\"><ul>{links}</ul></nav>\n<main>\n{body}</main>\n</div>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION"),
        header::header(contents)
    )
}
