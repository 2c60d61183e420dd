//! The page: one self-contained HTML file that tells an engineer what was identified, how well, and
//! what the data could not tell.
//!
//! The verdict stands first, the parameters follow, and every plot says below what to look for in it.
//! Each section is a file: `verdict`, `checks`, `calibration`, `gravity`, `gains`, `parameters`, `motors`, `estimators`, `limits`,
//! `validation`, `inputs`, `residuals`, `elimination`, `conditioning`, `trajectories`, `tracking`, `data`.
//! Sections that have nothing to show are left out.

mod calibration;
mod checks;
mod conditioning;
mod consistent;
mod data;
mod elimination;
mod estimators;
mod gains;
mod gravity;
mod header;
mod inputs;
mod limits;
pub(super) mod markup;
mod motors;
mod parameters;
mod residuals;
mod select;
mod table;
#[cfg(test)]
mod tests;
mod tracking;
mod trajectories;
mod validation;
mod verdict;

use markup::Section;

use crate::text::escape;
use crate::{published::Published, units::Units};
use overact_identification::Identification;

/// The style: colours for light and dark, a width that suits reading, plots side by side where there
/// is room.
const STYLE: &str = include_str!("style.css");

/// What the page shows.
#[derive(Debug, Clone, Copy)]
pub struct Contents<'a> {
    /// The result.
    pub identification: &'a Identification,
    /// Units of its coordinates and actuators.
    pub units: &'a Units,
    /// What the robot is, in a sentence.
    pub summary: Option<&'a str>,
    /// Where its description comes from.
    pub source: Option<&'a str>,
    /// A drawing of the robot, an SVG document. It is shown as an image, so that its style and its
    /// names stay its own.
    pub drawing: Option<&'a str>,
    /// Published results to show beside the own ones.
    pub published: Option<&'a Published>,
    /// Files to be had from the page.
    pub attachments: &'a [Attachment<'a>],
}

/// A file within the page.
#[derive(Debug, Clone, Copy)]
pub struct Attachment<'a> {
    /// The name that it is saved with.
    pub name: &'a str,
    /// Its media type, `text/csv` for instance.
    pub media_type: &'a str,
    /// What it is, in a few words.
    pub what: &'a str,
    /// Its text.
    pub text: &'a str,
}

/// The page of an identification: HTML that is XML, too.
#[must_use]
pub fn page(contents: &Contents<'_>) -> String {
    let sections: Vec<Section> = [
        verdict::section(contents),
        checks::section(contents),
        calibration::section(contents),
        gravity::section(contents),
        gains::section(contents),
        parameters::section(contents),
        motors::section(contents),
        consistent::section(contents),
        estimators::section(contents),
        limits::section(contents),
        validation::section(contents),
        inputs::section(contents),
        residuals::section(contents),
        elimination::section(contents),
        conditioning::section(contents),
        trajectories::section(contents),
        tracking::section(contents),
        data::section(contents),
        data::files(contents),
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
