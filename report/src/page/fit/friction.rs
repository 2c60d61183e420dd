//! Section on friction: residual of each drive over the velocity of its joint.

use crate::{
    choice::{case_heading, is_answer},
    page::{
        Contents,
        elements::markup::{Section, figure, paragraph},
    },
    plot::{Axis, Chart, Line, Look},
    text::escape,
    units::with_unit,
};
use overact_identification::{LineResidual, ModelKind, ResidualFigures};

/// Largest number of points of a drive.
const DOTS: usize = 600;

/// Section; empty for a model whose lines are not drives.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let identification = contents.identification;
    let all = identification.figures.residuals.iter();
    let shown = all.filter(|one| {
        one.model != ModelKind::Platform && is_answer(identification, one.model, one.stage)
    });
    let mut body: String = shown.map(|one| drives(contents, one)).collect();
    if !body.is_empty() {
        let introduction = "Residual of each drive over the velocity of its joint. If the friction of the description is right, the points scatter around zero at all velocities. A step at zero is missing dry friction, a slope missing viscous friction, a bump at low velocities Stribeck friction.";
        body = paragraph(introduction) + &body;
    }
    Section {
        id: "friction",
        title: "Friction",
        body,
    }
}

/// Figure of one estimate.
fn drives(contents: &Contents<'_>, one: &ResidualFigures) -> String {
    let plots: Vec<String> = { one.lines.iter() }
        .filter_map(|line| drive(contents, line))
        .collect();
    if plots.is_empty() {
        return String::new();
    }
    let caption = format!(
        "{}: measured minus predicted torques of all training runs.",
        case_heading(one.model)
    );
    figure(
        &format!("figure-friction-{}", one.model),
        &plots,
        "",
        &escape(&caption),
    )
}

/// Chart of one drive; `None` without velocities.
fn drive(contents: &Contents<'_>, line: &LineResidual) -> Option<String> {
    let name = line.name.as_str();
    let (mut velocity, mut residual) = (Vec::new(), Vec::new());
    for own in &line.runs {
        let mut runs = contents.identification.figures.runs.iter();
        let run = runs.find(|run| run.identified && run.run == own.run)?;
        let series = run.velocities.iter().find(|one| one.actuator == name)?;
        let count = series.velocity.len().min(own.residual.len());
        velocity.extend_from_slice(&series.velocity[..count]);
        residual.extend_from_slice(&own.residual[..count]);
    }
    if velocity.is_empty() {
        return None;
    }
    let step = velocity.len().div_ceil(DOTS);
    let [velocity, residual] = [velocity, residual]
        .map(|all: Vec<f64>| all.into_iter().step_by(step).collect::<Vec<f64>>());
    let unit = match contents.units.position(name) {
        "" => String::new(),
        unit => format!("{unit}/s"),
    };
    let chart = Chart {
        title: name.to_owned(),
        description: format!("residual of {name} over its velocity"),
        x: Axis::linear(with_unit("velocity", &unit)).including(&[0.0]),
        y: Axis::linear(with_unit("residual", contents.units.torque(name))).including(&[0.0]),
        lines: vec![Line::new(Look::Residual, "residual", &velocity, &residual).dots_alone()],
        rules: Vec::new(),
    };
    Some(chart.svg())
}
