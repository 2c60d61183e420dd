//! Section on the motion of every run (Fig. 7 of the paper).

use crate::{
    page::{
        Contents,
        elements::markup::{Section, figure, key},
        fit::inputs,
        header,
    },
    plot::{Axis, Chart, Line, Look},
    text::{escape, last_part},
    units::{Units, with_unit},
};
use overact_identification::RunFigures;

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let runs = &contents.identification.figures.runs;
    // The head of the page has the drawing if there is no plot.
    let mut body = match inputs::first(contents) {
        Some(_) => header::drawing(contents),
        None => String::new(),
    };
    for identified in [true, false] {
        let plots: Vec<String> = runs
            .iter()
            .filter(|run| run.identified == identified)
            .flat_map(|run| charts(run, contents.units))
            .collect();
        if plots.is_empty() {
            continue;
        }
        let (id, what) = if identified && !contents.units.has_platform() {
            (
                "figure-trajectories",
                "The training runs. They should use the whole range of all joints, and accelerate: inertia has no effect without acceleration.",
            )
        } else if identified {
            (
                "figure-trajectories",
                "The training runs. They should use the whole workspace, rotate as well as translate the platform, and accelerate: inertia has no effect without acceleration.",
            )
        } else {
            (
                "figure-trajectories-held-out",
                "The validation runs. They should differ from the training runs.",
            )
        };
        body.push_str(&figure(
            id,
            &plots,
            &keys(runs, contents.units),
            &escape(what),
        ));
    }
    Section {
        id: "trajectories",
        title: "Motion of the runs",
        body,
    }
}

/// Key: coordinates of each look.
fn keys(runs: &[RunFigures], units: &Units) -> String {
    let Some(run) = runs.first() else {
        return String::new();
    };
    let mut named: Vec<(Look, Vec<&str>)> = Vec::new();
    for chart in groups(run, units) {
        for (order, index) in chart.members.iter().enumerate() {
            let (look, name) = (Look::nth(order), run.coordinates[*index].as_str());
            match named.iter_mut().find(|(own, _)| *own == look) {
                Some((_, names)) => names.push(name),
                None => named.push((look, vec![name])),
            }
        }
    }
    let entries: Vec<(&str, String)> = named
        .iter()
        .map(|(look, names)| (look.class(), names.join(", ")))
        .collect();
    key(&entries)
}

/// Coordinates that share a plot.
struct Group {
    unit: &'static str,
    members: Vec<usize>,
}

/// Groups of coordinates with equal units, at most as many as looks.
fn groups(run: &RunFigures, units: &Units) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (index, name) in run.coordinates.iter().enumerate() {
        let unit = units.position(name);
        match groups.iter_mut().find(|group| group.unit == unit) {
            Some(group) => group.members.push(index),
            None => groups.push(Group {
                unit,
                members: vec![index],
            }),
        }
    }
    let parts = groups.into_iter().flat_map(|group| {
        let charts = group.members.len().div_ceil(Look::EQUALS);
        let size = group.members.len().div_ceil(charts);
        let parts = group.members.chunks(size).map(<[usize]>::to_vec);
        let parts: Vec<Vec<usize>> = parts.collect();
        parts.into_iter().map(move |members| Group {
            unit: group.unit,
            members,
        })
    });
    parts.collect()
}

/// Plots of one run, one for each group.
fn charts(run: &RunFigures, units: &Units) -> Vec<String> {
    let payload = if run.payload { ", with payload" } else { "" };
    let charts = groups(run, units).into_iter().map(|group| {
        let name = |index: usize| run.coordinates.get(index).map_or("", String::as_str);
        let names: Vec<&str> = group.members.iter().map(|index| name(*index)).collect();
        let lines = group
            .members
            .iter()
            .enumerate()
            .filter_map(|(order, index)| {
                let values = run.pose.get(*index)?;
                Some(Line::new(Look::nth(order), name(*index), &run.time, values))
            });
        Chart {
            title: format!("{}{payload}", last_part(&run.run)),
            description: format!("{} over time in the run {}", names.join(", "), run.run),
            x: Axis::linear("t (s)"),
            y: Axis::linear(with_unit(&names.join(", "), group.unit)),
            lines: lines.collect(),
            rules: Vec::new(),
        }
        .svg()
    });
    charts.collect()
}
