//! Table of the parameters of all results.

use crate::{
    choice::{answers, stage_name},
    intervals::{half_width_percent, is_outside},
    layout::{WIDTH, definitions, paragraph, table},
    terminal::sum,
};
use overact_identification::{
    BaseParameter, Estimate, Grade, Identification, ModelKind, ParameterEstimate, Verdict,
    significant,
};

/// Results and the names of their parameters.
pub(super) struct Rows<'a> {
    answers: Vec<&'a Estimate>,
    /// Names in the order of the base parameters.
    names: Vec<&'a str>,
    /// Indices of the names in order of priority.
    ranked: Vec<usize>,
    base: &'a [BaseParameter],
}

/// Parameters of the results.
pub(super) fn rows(identification: &Identification) -> Rows<'_> {
    let answers = answers(identification);
    let mut names: Vec<&str> = Vec::new();
    for one in answers.iter().flat_map(|one| &one.parameters) {
        if !names.contains(&one.name.as_str()) {
            names.push(&one.name);
        }
    }
    let base = &identification.base_parameters;
    names.sort_by_key(|name| base.iter().position(|one| one.name == *name));
    let usable = |verdict: &Verdict, name: &str| match verdict.grade {
        Grade::Use => true,
        Grade::UseListed => verdict.listed.iter().any(|own| own == name),
        Grade::DoNotUse => false,
    };
    let rank = |&place: &usize| {
        let mut verdicts = identification.verdicts.iter();
        let is_usable = verdicts.any(|verdict| usable(verdict, names[place]));
        (!is_usable, best_known(&answers, names[place]))
    };
    let mut ranked: Vec<usize> = (0..names.len()).collect();
    ranked.sort_by(|a, b| {
        let ((a_last, a_width), (b_last, b_width)) = (rank(a), rank(b));
        a_last.cmp(&b_last).then(a_width.total_cmp(&b_width))
    });
    Rows {
        answers,
        names,
        ranked,
        base,
    }
}

/// Half width of the narrowest interval in percent of the value; infinite if there is none.
fn best_known(answers: &[&Estimate], name: &str) -> f64 {
    let all = answers.iter().filter_map(|answer| own(answer, name));
    all.filter_map(half_width_percent)
        .fold(f64::INFINITY, f64::min)
}

/// Parameter of an estimate.
fn own<'a>(estimate: &'a Estimate, name: &str) -> Option<&'a ParameterEstimate> {
    estimate.parameters.iter().find(|one| one.name == name)
}

impl Rows<'_> {
    /// Number of parameters.
    pub(super) fn count(&self) -> usize {
        self.names.len()
    }

    /// Titled table of at most `most` parameters with notes; empty without results.
    pub(super) fn table(&self, most: usize) -> String {
        let Some(first) = self.answers.first() else {
            return String::new();
        };
        let (shown, left) = self.ranked.split_at(most.min(self.ranked.len()));
        let mut shown = shown.to_vec();
        shown.sort_unstable();
        let names: Vec<&str> = shown.iter().map(|&place| self.names[place]).collect();
        let title = match stage_name(first.stage).split_at_checked(1) {
            Some((letter, rest)) => letter.to_uppercase() + rest,
            None => String::new(),
        };
        let mut text = format!("\n{title}\n");
        let owns = || {
            names
                .iter()
                .flat_map(|name| self.answers.iter().filter_map(|one| own(one, name)))
        };
        let has_truth = owns().any(|one| one.true_value.is_some());
        let with_truth = self.side_by_side(&names, has_truth);
        let fits = |text: &str| text.lines().all(|line| line.chars().count() <= WIDTH);
        // A table that is too wide was split into parts.
        let is_whole = fits(&with_truth) && with_truth.lines().count() == names.len() + 2;
        if has_truth && !is_whole {
            text.push_str(&self.side_by_side(&names, false));
            paragraph(&mut text, "", "--tables prints the true values.");
        } else {
            text.push_str(&with_truth)
        }
        if owns().any(is_outside) {
            paragraph(
                &mut text,
                "",
                "* outside its own interval: eliminating other parameters moved this estimate to a value that the data contradict",
            );
        }
        text.push_str(&self.sums(&names));
        if !left.is_empty() {
            let best = left
                .iter()
                .map(|&place| best_known(&self.answers, self.names[place]));
            let best = best.fold(f64::INFINITY, f64::min);
            let known = if best.is_finite() {
                format!(
                    "; the most precise one is known to {} %",
                    significant(best, 2)
                )
            } else {
                String::new()
            };
            let sentence = format!("--all lists {} more{known}.", left.len());
            paragraph(&mut text, "", &sentence);
        }
        text
    }

    /// Sums of standard parameters that the named parameters are; empty if none is regrouped.
    fn sums(&self, names: &[&str]) -> String {
        let base = self.base.iter().filter(|one| !one.regrouping.is_empty());
        let shown = base.filter(|one| names.contains(&one.name.as_str()));
        let rows: Vec<(String, String)> = shown.map(|one| (one.name.clone(), sum(one))).collect();
        definitions(&rows, " = ")
    }

    fn side_by_side(&self, names: &[&str], with_truth: bool) -> String {
        // Two results must fit in a line.
        let most = if self.answers.len() > 1 { 5 } else { 6 };
        let mut header = vec!["parameter"];
        if with_truth {
            header.push("true value");
        }
        for answer in &self.answers {
            header.extend([column_title(answer.model), "95 % interval"]);
        }
        header.push("unit");
        let nothing = || String::from("-");
        let rows = names.iter().map(|name| {
            let some = self.answers.iter().find_map(|answer| own(answer, name));
            let mut row = vec![(*name).to_owned()];
            if with_truth {
                let truth = some.and_then(|one| one.true_value);
                row.push(truth.map_or_else(nothing, |value| significant(value, 6)));
            }
            for answer in &self.answers {
                let own = own(answer, name);
                row.push(own.map_or_else(nothing, |one| {
                    significant(one.value, value_digits(one, most))
                }));
                row.push(own.map_or_else(nothing, interval));
            }
            row.push(some.map_or_else(String::new, |one| one.unit.clone()));
            row
        });
        table(&header, rows.collect())
    }
}

/// Title of the column with the values of a model.
const fn column_title(model: ModelKind) -> &'static str {
    match model {
        ModelKind::Platform => "platform",
        ModelKind::Actuators => "actuators",
        ModelKind::Joints => "joint model",
    }
}

/// Ends of an interval; an asterisk marks estimates outside.
fn interval(one: &ParameterEstimate) -> String {
    let [low, high] = one.interval_95;
    let digits = interval_digits(one).unwrap_or(2);
    let mark = if is_outside(one) { " *" } else { "" };
    format!(
        "{} .. {}{mark}",
        significant(low, digits),
        significant(high, digits)
    )
}

/// Number of digits at which the interval's ends differ; `None` if they do not.
fn interval_digits(one: &ParameterEstimate) -> Option<usize> {
    let [low, high] = one.interval_95;
    let ratio = low.abs().max(high.abs()) / (high - low).abs();
    let digits = ratio.log10().ceil().max(1.0) + 1.0;
    ratio.is_finite().then_some((digits as usize).min(7))
}

/// Digits of a value: one more than those of its interval, at most `most`.
fn value_digits(one: &ParameterEstimate, most: usize) -> usize {
    interval_digits(one).map_or(most, |digits| (digits + 1).min(most))
}
