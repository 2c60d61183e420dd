//! Estimates over time from a replay, as text.

use crate::{
    choice::of_stage,
    layout::{line, paragraph},
};
use overact_identification::{
    Estimate, Identification, OnlineChange, OnlineEstimate, ParameterEstimate, Stage, significant,
};

/// Half width of a 95 % interval, in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// Largest half width of an interval that is plotted, relative to the estimate.
pub(crate) const BROAD: f64 = 0.5;

/// The same, relative to the last half width.
pub(crate) const FINAL_FACTOR: f64 = 10.0;

/// Half width of an interval, relative to the estimate, that counts as accurate.
const ACCURATE: f64 = 0.05;

/// Largest number of names or changes in a line.
const NAMES: usize = 8;

/// A replay with the parameters that it estimates.
pub(crate) struct Replay<'a> {
    pub(crate) points: &'a [OnlineEstimate],
    estimate: &'a Estimate,
}

impl<'a> Replay<'a> {
    /// The replay of an identification, if there is one.
    pub(crate) fn new(identification: &'a Identification) -> Option<Self> {
        let estimate = *of_stage(identification, Stage::Base).first()?;
        let points = identification.online.as_slice();
        (!points.is_empty()).then_some(Self { points, estimate })
    }

    /// Number of parameters.
    pub(crate) fn count(&self) -> usize {
        self.estimate.parameters.len()
    }

    /// A parameter with its batch estimate.
    pub(crate) fn parameter(&self, place: usize) -> &ParameterEstimate {
        &self.estimate.parameters[place]
    }

    /// Half width of a parameter's interval at a point; infinite if undetermined.
    pub(crate) fn half_width(&self, point: usize, place: usize) -> f64 {
        let deviations = &self.points[point].standard_deviations;
        let deviation = deviations.get(place).copied().flatten();
        deviation.map_or(f64::INFINITY, |own| HALF_WIDTH * own)
    }

    /// Last half width of a parameter relative to its batch estimate.
    pub(crate) fn last_relative(&self, place: usize) -> f64 {
        self.half_width(self.points.len() - 1, place) / self.parameter(place).value.abs()
    }

    /// Detected changes with their times, s.
    pub(crate) fn changes(&self) -> impl Iterator<Item = (f64, &'a OnlineChange)> {
        let points = self.points.iter();
        points.filter_map(|point| Some((point.time, point.change.as_ref()?)))
    }

    /// Time from which a parameter's interval stays narrower than ±5 % of the estimate, s.
    fn accurate_from(&self, place: usize) -> Option<f64> {
        let is_accurate = |point: &usize| {
            let value = self.points[*point].values.get(place).copied().flatten();
            value.is_some_and(|own| self.half_width(*point, place) <= ACCURATE * own.abs())
        };
        let points = (0..self.points.len()).rev();
        let first = points.take_while(is_accurate).last()?;
        Some(self.points[first].time)
    }
}

/// Sentence on detected changes.
pub(crate) fn changes(replay: &Replay<'_>) -> String {
    let all: Vec<_> = replay.changes().collect();
    if all.is_empty() {
        return String::from("No change was detected in the innovations.");
    }
    let one = |(time, change): &(f64, &OnlineChange)| {
        let sign = if change.increase { "above" } else { "below" };
        let time = significant(*time, 3);
        format!("{time} s ({}: {sign} the prediction)", change.line)
    };
    let mut words: Vec<String> = all.iter().take(NAMES).map(one).collect();
    if all.len() > NAMES {
        words.push(format!("{} more", all.len() - NAMES));
    }
    format!("Changes detected at {}.", words.join(", "))
}

/// Paragraph of the summary; empty without a replay.
pub(crate) fn online(identification: &Identification) -> String {
    let mut text = String::new();
    let Some(replay) = Replay::new(identification) else {
        return text;
    };
    let mut accurate: Vec<(f64, &str)> = (0..replay.count())
        .filter_map(|place| {
            let name = replay.parameter(place).name.as_str();
            Some((replay.accurate_from(place)?, name))
        })
        .collect();
    accurate.sort_by(|a, b| a.0.total_cmp(&b.0));
    text.push('\n');
    line(
        &mut text,
        "Online estimation (replay of the training runs):",
    );
    paragraph(&mut text, "  ", &changes(&replay));
    let named = accurate.iter().take(NAMES);
    let named: Vec<String> = named
        .map(|(time, name)| format!("{name} {} s", significant(*time, 3)))
        .collect();
    let more = match accurate.len().saturating_sub(NAMES) {
        0 => String::new(),
        count => format!(", {count} more later"),
    };
    let words = if named.is_empty() {
        String::from("No 95 % interval became narrower than ±5 %.")
    } else {
        format!(
            "95 % interval narrower than ±5 % from: {}{more}; {} of {} parameters.",
            named.join(", "),
            accurate.len(),
            replay.count()
        )
    };
    paragraph(&mut text, "  ", &words);
    text
}
