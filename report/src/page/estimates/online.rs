//! Section on the base parameters over time, from the replay through the online filter.

use crate::{
    online::{BROAD, FINAL_FACTOR, Replay, changes},
    page::{
        Contents,
        elements::markup::{Section, figure, key, note, paragraph},
    },
    plot::{Axis, Chart, Line, Look, Rule},
    text::escape,
    units::with_unit,
};

/// Largest number of parameters with a plot.
const PLOTS: usize = 12;

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let mut body = String::new();
    if let Some(replay) = Replay::new(contents.identification) {
        body.push_str(&paragraph(&format!(
            "The equations of the training runs, one after another through the square-root information filter of the module `overact::online`. {}",
            changes(&replay)
        )));
        let mut order: Vec<usize> = (0..replay.count()).collect();
        let relative = |place: &usize| replay.last_relative(*place);
        order.sort_by(|a, b| relative(a).total_cmp(&relative(b)));
        order.truncate(PLOTS);
        order.sort_unstable();
        let plots: Vec<String> = order.iter().map(|place| chart(&replay, *place)).collect();
        let keys = [
            (Look::First.class(), "estimate"),
            (Look::Other.class(), "95 % interval"),
        ];
        let caption = "Estimates with intervals for correlated residuals. The dashed line is the estimate of all runs together. Vertical lines are detected changes.";
        body.push_str(&figure(
            "figure-online",
            &plots,
            &key(&keys),
            &escape(caption),
        ));
        if replay.count() > PLOTS {
            body.push_str(&note(&format!(
                "Shown are the {PLOTS} parameters with the smallest relative standard deviations; the JSON document has all {}.",
                replay.count()
            )));
        }
    }
    Section {
        id: "online",
        title: "Parameters over time",
        body,
    }
}

/// Plot of one parameter.
fn chart(replay: &Replay<'_>, place: usize) -> String {
    let parameter = replay.parameter(place);
    let times: Vec<f64> = replay.points.iter().map(|point| point.time).collect();
    let final_width = replay.half_width(replay.points.len() - 1, place);
    let broadest = (BROAD * parameter.value.abs()).max(FINAL_FACTOR * final_width);
    let series = |sign: f64| -> Vec<f64> {
        let points = replay.points.iter().enumerate();
        let values = points.map(|(point, own)| {
            let width = replay.half_width(point, place);
            let value = own.values.get(place).copied().flatten();
            match value {
                Some(value) if width <= broadest => value + sign * width,
                _ => f64::NAN,
            }
        });
        values.collect()
    };
    let line = |look, label: &str, sign| Line::new(look, label, &times, &series(sign));
    let mut rules = vec![Rule::horizontal(parameter.value, "")];
    rules.extend(replay.changes().map(|(time, _)| Rule::vertical(time, "")));
    Chart {
        title: parameter.name.clone(),
        description: format!(
            "estimate of {} over time with its 95 % interval",
            parameter.name
        ),
        x: Axis::linear("t (s)"),
        y: Axis::linear(with_unit(&parameter.name, &parameter.unit)),
        lines: vec![
            line(Look::Other, "upper end of the interval", 1.0),
            line(Look::Other, "lower end of the interval", -1.0),
            line(Look::First, "estimate", 0.0),
        ],
        rules,
    }
    .svg()
}
