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
        let others = "interpreted robots and other languages have";
        lines.push(match lanes {
            0..=2 => format!(
                " That is the straight program, which {others}. Here the {legs} legs run side by side, in the lanes of vectors: {once} operations once, and {each} of each leg."
            ),
            _ => format!(
                " That is the straight program, which {others}, and processors without vectors of {lanes} numbers, as is found out when it runs (with the feature `dispatch`) or said to the compiler (`-C target-cpu=native`). With these the {legs} legs run side by side, in the lanes of vectors: {once} operations once, and {each} of each leg."
            ),
        });
        lines.push(
            " In the loop `at` is the first leg of those that run at once, a name that ends with `_leg` has a value of each of them if it is assigned there, and `of_leg` has the numbers in which legs differ: a row of `OF_LEG` for each, of all legs.".to_owned(),
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
            " And in each step of the iteration in `{function}`{runs}{within}: {step}."
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
        " Additions, multiplications (those with a sign and by constants, too) and divisions of each function, all that it calls included; beside them √ square roots, sc sine-cosine pairs, at arc tangents, sg signs of velocities, gd guards. What an iteration takes is said for each of its steps.".to_owned(),
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
    let told = cost.side_by_side.map(|side| {
        let (once, each, legs) = (side.once, side.each, side.legs);
        let lanes = match side.lanes {
            0..=2 => "in lanes".to_owned(),
            least => format!("in {least} lanes"),
        };
        format!("; {lanes} {once} + {legs} x {each}")
    });
    told.unwrap_or_default()
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
