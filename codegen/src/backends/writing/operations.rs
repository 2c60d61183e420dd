//! Operation counts in the documentation of functions and of the robot type.

use crate::lowering::Cost;
use crate::model::RobotModel;
use crate::total_cost::{SideBySide, TotalCost};

/// Lines for a function.
#[must_use]
pub fn of_function(cost: &TotalCost) -> Vec<String> {
    let mut lines = vec![format!(" {}.", cost.once)];
    if let Some(SideBySide {
        once,
        each,
        legs,
        lanes,
    }) = cost.side_by_side
    {
        let others = "interpreted robots and other languages use";
        lines.push(match lanes {
            0..=2 => format!(
                " These are the counts of the scalar program, which {others}. This code has the {legs} legs in the lanes of SIMD vectors: {once} operations, and {each} for each leg."
            ),
            _ => format!(
                " These are the counts of the scalar program, which {others}, also on processors without vectors of {lanes} numbers. With such vectors (chosen at run time by the feature `dispatch`, or at compile time by `-C target-cpu=native`) the {legs} legs are in their lanes: {once} operations, and {each} for each leg."
            ),
        });
        lines.push(
            " In the loop, `at` is the first leg of a vector, names with the suffix `_leg` hold one value per leg, and `of_leg` holds the constants that differ between legs, the rows of `OF_LEG`.".to_owned(),
        );
    }
    for iteration in &cost.iterations {
        let (function, step) = (iteration.function, iteration.step);
        let runs = match iteration.runs {
            1 => String::new(),
            runs => format!(", which is run {runs} times"),
        };
        let within = match iteration.within {
            Some(outer) => format!(" in each step of `{outer}`"),
            None => String::new(),
        };
        lines.push(format!(
            " Additionally in each step of the iteration in `{function}`{runs}{within}: {step}."
        ));
    }
    lines
}

/// Lines for a robot: a table of its functions.
#[must_use]
pub fn of_robot(model: &RobotModel) -> Vec<String> {
    let mut lines = vec![
        " # Operations".to_owned(),
        String::new(),
        " Additions, multiplications (including those by signs and constants) and divisions of each function and of all functions that it calls; then √ square roots, sc sine-cosine pairs, at arc tangents, sg signs of velocities, gd guards. Iterations have the counts of one step.".to_owned(),
        String::new(),
        " | function | once | each step |".to_owned(),
        " |---|---|---|".to_owned(),
    ];
    for function in &model.functions {
        let cost = model.cost(function);
        let steps: Vec<String> = cost.iterations.iter().map(|one| short(&one.step)).collect();
        lines.push(format!(
            " | `{}` | {}{} | {} |",
            function.name,
            short(&cost.once),
            lanes(&cost),
            steps.join("; ")
        ));
    }
    lines
}

/// Text for the operations of legs in SIMD lanes: `; in lanes of vectors 237 + 6 x 419`.
fn lanes(cost: &TotalCost) -> String {
    let lane_count = cost.side_by_side.map(|side| {
        let (once, each, legs) = (side.once, side.each, side.legs);
        let lanes = match side.lanes {
            0..=2 => "in lanes".to_owned(),
            least => format!("in {least} lanes"),
        };
        format!("; {lanes} {once} + {legs} x {each}")
    });
    lane_count.unwrap_or_default()
}

/// Short text of a cost: `362, 4 √, 1 sc, 8 gd`.
fn short(cost: &Cost) -> String {
    let others = [
        (cost.square_roots, "√"),
        (cost.trigonometric_pairs, "sc"),
        (cost.arc_tangents, "at"),
        (cost.signs, "sg"),
        (cost.guards, "gd"),
    ];
    let mut text = cost.operations().to_string();
    for (count, name) in others.into_iter().filter(|(count, _)| *count > 0) {
        text += &format!(", {count} {name}");
    }
    text
}
