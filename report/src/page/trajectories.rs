//! The platform's way in every run: Fig. 7 of the paper.

use super::{
    Contents,
    markup::{Section, figure, key},
};
use crate::{
    escape::escape,
    plot::{Axis, Chart, Line, Look},
    units::Units,
    units::with_unit,
};
use overact_identification::RunFigures;

/// The section.
pub(super) fn section(contents: &Contents<'_>) -> Section {
    let runs = &contents.identification.figures.runs;
    let mut body = String::new();
    for identified in [true, false] {
        let plots: Vec<String> = runs
            .iter()
            .filter(|run| run.identified == identified)
            .flat_map(|run| charts(run, contents.units))
            .collect();
        if plots.is_empty() {
            continue;
        }
        let (id, what) = if identified {
            (
                "figure-trajectories",
                "The runs identified from. They should use the whole workspace, turn the platform as well as move it, and accelerate: what does not accelerate shows no inertia.",
            )
        } else {
            (
                "figure-trajectories-held-out",
                "The runs for the cross-validation. They should differ from those identified from.",
            )
        };
        body.push_str(&figure(id, &plots, &keys(runs), &escape(what)));
    }
    Section {
        id: "trajectories",
        title: "Trajectories",
        body,
    }
}

/// The key: coordinates of one unit share a plot, and their order there gives their look.
fn keys(runs: &[RunFigures]) -> String {
    let most = runs.iter().map(|run| run.coordinates.len()).max();
    let names = [
        ("first", "first"),
        ("second", "second"),
        ("third", "third"),
        ("fourth", "others"),
    ];
    let shown = most.unwrap_or(0).min(names.len());
    if shown < 2 {
        return String::new();
    }
    key(&names
        .iter()
        .take(shown)
        .map(|(class, name)| (*class, *name))
        .collect::<Vec<_>>())
}

/// The plots of one run: coordinates of the same unit together.
fn charts(run: &RunFigures, units: &Units) -> Vec<String> {
    let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
    for (index, name) in run.coordinates.iter().enumerate() {
        let unit = units.position(name);
        match groups.iter_mut().find(|group| group.0 == unit) {
            Some(group) => group.1.push(index),
            None => groups.push((unit, vec![index])),
        }
    }
    let payload = if run.payload { ", with payload" } else { "" };
    let charts = groups.into_iter().map(|(unit, members)| {
        let name = |index: usize| run.coordinates.get(index).map_or("", String::as_str);
        let names: Vec<&str> = members.iter().map(|index| name(*index)).collect();
        let lines = members.iter().enumerate().filter_map(|(order, index)| {
            let values = run.pose.get(*index)?;
            Some(Line::new(Look::nth(order), name(*index), &run.time, values))
        });
        Chart {
            title: format!("{}{payload}", run.run),
            description: format!("{} over time in the run {}", names.join(", "), run.run),
            x: Axis::linear("t (s)"),
            y: Axis::linear(with_unit(&names.join(", "), unit)),
            lines: lines.collect(),
            rules: Vec::new(),
        }
        .svg()
    });
    charts.collect()
}
