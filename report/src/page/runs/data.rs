//! Sections on runs and settings, and on the attached files.

use std::fmt::Write;

use crate::{
    page::{
        Contents,
        elements::{
            markup::{Section, paragraph},
            table::{Cell, Table},
        },
        header::base64,
    },
    text::escape,
};
use overact_identification::{Identification, Normalisation, significant};

/// Runs and settings.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    Section {
        id: "data",
        title: "Data and settings",
        body: runs(identification) + &settings(identification),
    }
}

/// Attached files.
pub(crate) fn files(contents: &Contents<'_>) -> Section {
    let mut body = String::new();
    for file in contents.attachments {
        let _ = writeln!(
            body,
            "<li><a download=\"{}\" href=\"data:{};base64,{}\">{}</a>: {}</li>",
            escape(file.name),
            escape(file.media_type),
            base64(file.text.as_bytes()),
            escape(file.name),
            escape(file.what)
        );
    }
    if !body.is_empty() {
        let introduction = "This page is a single file. Its numbers are attached as files:";
        body = format!("{}<ul>\n{body}</ul>\n", paragraph(introduction));
    }
    Section {
        id: "files",
        title: "The numbers",
        body,
    }
}

/// Training runs.
fn runs(identification: &Identification) -> String {
    let rows = identification.runs.iter().map(|run| {
        vec![
            Cell::text(&run.name),
            Cell::number(run.samples.to_string()),
            Cell::digits(Some(run.sampling_frequency), 6),
            Cell::digits(Some(run.samples as f64 / run.sampling_frequency), 4),
            Cell::text(run.carried().words()),
            Cell::digits(Some(run.closure_residual), 3),
        ]
    });
    let titles = [
        ("run", ""),
        ("samples", "n"),
        ("rate (Hz)", "n"),
        ("duration (s)", "n"),
        ("payload", ""),
        ("closure residual (m, rad)", "n"),
    ];
    Table {
        caption: String::from("Training runs"),
        header: vec![
            titles
                .iter()
                .map(|(title, class)| Cell::text(title).class(class))
                .collect(),
        ],
        rows: rows.collect(),
    }
    .html()
}

/// Settings in words.
fn settings(identification: &Identification) -> String {
    let settings = &identification.settings;
    let yes = |flag: bool| String::from(if flag { "yes" } else { "no" });
    let rows = [
        (
            "Low-pass on the positions",
            format!(
                "Butterworth of order {}, forwards and backwards, {} Hz",
                settings.filter_order,
                significant(settings.filter_cutoff_hz, 4)
            ),
        ),
        (
            "Differentiation",
            format!("central differences of order {}", settings.difference_order),
        ),
        (
            "Decimation",
            format!("every {}th sample", settings.decimation),
        ),
        (
            "Skipped samples of each run",
            format!(
                "{} at the start, {} at the end",
                settings.skip_start, settings.skip_end
            ),
        ),
        (
            "Equations skipped at standstill",
            standstill(identification),
        ),
        ("Weighted least squares", yes(settings.weighted)),
        (
            "Direction-dependent friction",
            yes(settings.asymmetric_friction),
        ),
        (
            "Standard deviation of the residual",
            String::from(match settings.normalisation {
                Normalisation::Unbiased => "unbiased, eq. (46)",
                Normalisation::SampleVariance => "sample variance",
            }),
        ),
        ("Limit of the r_σ rule", significant(settings.r_sigma, 4)),
        ("Seed of the random states", settings.seed.to_string()),
    ];
    Table {
        caption: String::from("Settings"),
        header: vec![vec![Cell::text("setting"), Cell::text("value")]],
        rows: rows
            .into_iter()
            .map(|(name, value)| vec![Cell::text(name), Cell::prose(&value)])
            .collect(),
    }
    .html()
}

/// Velocity limits below which equations are omitted, and their number.
fn standstill(identification: &Identification) -> String {
    let limits = &identification.settings.standstill_velocity;
    let runs = identification.runs.iter();
    let count: usize = runs.flat_map(|run| &run.standstill_equations).sum();
    if limits.is_empty() {
        return String::from("none");
    }
    let limits: Vec<String> = limits.iter().map(|one| significant(*one, 4)).collect();
    format!("{count}, below {} rad/s or m/s", limits.join(", "))
}
