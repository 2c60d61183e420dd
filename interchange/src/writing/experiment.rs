//! Writes the virtual experiment as TOML.

use super::comment;
use crate::{
    experiment::{Experiment, FASTER, Term},
    geometry::digits::decimal,
};
use std::fmt::Write as _;

/// Number of harmonics of a run.
const HARMONICS: f64 = 5.0;
/// Ratio of filter cutoff to the highest harmonic, above the limit that the identification checks.
const CUTOFF: f64 = 12.2;
/// Sampling frequency, Hz.
const SAMPLING: f64 = 1000.0;

/// Writes the settings of experiment and identification, and the runs.
pub(super) fn toml(text: &mut String, designed: &Result<Experiment, String>) {
    let experiment = match designed {
        Ok(experiment) => experiment,
        Err(reason) => {
            text.push('\n');
            comment(text, &format!("No virtual experiment was found: {reason}."));
            return;
        }
    };
    let highest = HARMONICS * FASTER * experiment.fundamental;
    let cutoff = (CUTOFF * highest).ceil();
    let _ = writeln!(
        text,
        "\n[identification]\nfilter_cutoff = \"{cutoff} Hz\"\ndecimation = {}",
        decimation(cutoff)
    );
    text.push('\n');
    comment(
        text,
        "A virtual experiment: motions about home inside the limits of the joints, away from singular configurations. \
         Controller, resolutions and noise are assumed, noise as half a percent of the torques. `overact excite` finds \
         motions that determine more.",
    );
    for note in &experiment.notes {
        comment(text, note);
    }
    let _ = writeln!(
        text,
        "[experiment]\nsampling = \"{} kHz\"\nduration = \"{} s\"\nbandwidth = \"20 Hz\"\nderivative_cutoff = \"80 Hz\"",
        SAMPLING / 1000.0,
        experiment.duration
    );
    let _ = writeln!(text, "encoder = {}", list(&experiment.encoders));
    let _ = writeln!(text, "torque_noise = {}\nseed = 1", list(&experiment.noise));
    for (at, name) in ["first", "second", "held out"].into_iter().enumerate() {
        let _ = writeln!(text, "\n[[experiment.run]]\nname = \"{name}\"");
        let is_held_out = at + 1 == experiment.runs.len();
        if is_held_out {
            text.push_str("validation = true\n");
        }
        let faster = if is_held_out { FASTER } else { 1.0 };
        let _ = writeln!(
            text,
            "fundamental = \"{} Hz\"\nterms = [",
            decimal(faster * experiment.fundamental)
        );
        for term in &experiment.runs[at] {
            self::term(text, term);
        }
        text.push_str("]\n");
    }
}

/// Decimation at which the equations keep frequencies up to twice the cutoff of the positions.
fn decimation(cutoff: f64) -> f64 {
    (SAMPLING / (2.0 * 2.0 * cutoff)).round().max(1.0)
}

fn term(text: &mut String, term: &Term) {
    let unit = if term.is_angle { " deg" } else { " m" };
    let _ = writeln!(
        text,
        "    {{ coordinate = \"{}\", harmonic = {}, amplitude = \"{}{unit}\", phase = \"{} deg\" }},",
        term.coordinate, term.harmonic, term.amplitude, term.phase
    );
}

/// Values of all actuators, or one value if they are equal.
fn list(values: &[f64]) -> String {
    let shown: Vec<String> = values.iter().map(|value| decimal(*value)).collect();
    match shown.first() {
        Some(first) if shown.iter().all(|value| value == first) => first.clone(),
        _ => format!("[{}]", shown.join(", ")),
    }
}
