//! Head of the page: robot, verdict, main results and one plot of measured and predicted torque.

use std::fmt::Write;

use super::{Contents, elements::markup::paragraph, fit::inputs, verdict};
use crate::{
    choice::{answers, case_heading, stage_name},
    line_errors::relative_words,
    text::escape,
};
use overact_identification::{Stage, significant};

/// Head of the page.
pub(super) fn header(contents: &Contents<'_>) -> String {
    let identification = contents.identification;
    let mut html = format!(
        "<header>\n<div class=\"intro\"><h1>Identification of {}</h1>\n",
        escape(&identification.robot)
    );
    // Narrow screens and print show the drawing and the contents before the verdict section.
    let _ = writeln!(
        html,
        "<p><strong>{}</strong></p>",
        escape(&verdict::summary(identification))
    );
    if let Some(summary) = contents.summary {
        html.push_str(&paragraph(&format!("{}.", summary.trim_end_matches('.'))));
    }
    if let Some(source) = contents.source {
        let _ = writeln!(
            html,
            "<p class=\"source\">Source of the description: {}.</p>",
            escape(source.trim_end_matches('.'))
        );
    }
    html.push_str(&facts(contents));
    html.push_str("</div>\n");
    // A page without torques has the drawing here.
    html.push_str(&inputs::first(contents).unwrap_or_else(|| drawing(contents)));
    html.push_str("</header>\n");
    html
}

/// Drawing of the robot; empty without one.
pub(super) fn drawing(contents: &Contents<'_>) -> String {
    let robot = escape(&contents.identification.robot);
    contents.drawing.map_or_else(String::new, |drawing| {
        format!(
            "<figure id=\"figure-robot\" class=\"robot\"><img alt=\"Drawing of {robot} at its home configuration: links, joints, actuators and platform\" src=\"data:image/svg+xml;base64,{}\"/><figcaption>{robot} at its home configuration.</figcaption></figure>\n",
            base64(drawing.as_bytes())
        )
    })
}

/// Main results with their units.
fn facts(contents: &Contents<'_>) -> String {
    let identification = contents.identification;
    let base = identification.base_parameters.len();
    let mut html = String::from("<dl class=\"facts\">\n");
    for estimate in answers(identification) {
        let what = match estimate.stage {
            Stage::Base => String::from("base parameters"),
            stage => format!("{} of {base} base parameters", stage_name(stage)),
        };
        let _ = writeln!(
            html,
            "<div><dt>{}</dt><dd><b>{}</b> {what}, relative error <b>{}</b></dd></div>",
            case_heading(estimate.model),
            estimate.parameters.len(),
            escape(&relative_words(
                &estimate.lines,
                estimate.relative_error_percent,
                3
            ))
            .replace(" %", "\u{a0}%")
        );
    }
    let samples: usize = identification.runs.iter().map(|run| run.samples).sum();
    let seconds: f64 = identification
        .runs
        .iter()
        .map(|run| run.samples as f64 / run.sampling_frequency)
        .sum();
    let _ = writeln!(
        html,
        "<div><dt>Data</dt><dd><b>{}</b> run{}, {}\u{a0}s, {samples} samples</dd></div>",
        identification.runs.len(),
        if identification.runs.len() == 1 {
            ""
        } else {
            "s"
        },
        significant(seconds, 3)
    );
    html.push_str("</dl>\n");
    html
}

/// Base64 encoding for data URLs.
pub(super) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |index: usize| u32::from(chunk.get(index).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let digit = (bits >> (18 - 6 * place)) as usize % 64;
            text.push(if place <= chunk.len() {
                char::from(DIGITS[digit])
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    #[test]
    fn base64_matches_published_values() {
        // RFC 4648, section 10.
        for (text, expected) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(text.as_bytes()), expected);
        }
    }
}
