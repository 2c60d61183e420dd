//! Text output of `inspect`.

use crate::output::counted;
use overact_identification::significant;
use overact_report::{
    coefficient,
    layout::{columns, definitions, paragraph},
};
use overact_robot::{Inspection, inspection};
use std::fmt::Write;

pub(super) fn text(document: &Inspection) -> String {
    let mut text = heading(document);
    text += "\nBodies\n";
    text += &bodies(document);
    // Runs with and without payload distinguish its parameters from the platform's.
    let standard = document.parameters.len() - document.payload_parameters.len();
    let _ = writeln!(
        text,
        "\nBase parameters: {} of {standard} standard parameters",
        document.base_parameters.len(),
    );
    text += &base_parameters(&document.base_parameters);
    text += "\nFunctions\n";
    text += &functions(document);
    text += "\nConditioning at home\n";
    text += &conditioning(document);
    text
}

fn heading(document: &Inspection) -> String {
    let mut text = format!("{} ({})\n", document.robot, document.file);
    if !document.summary.is_empty() {
        paragraph(&mut text, "", &document.summary);
    }
    let _ = writeln!(
        text,
        "{}, {}, {}",
        counted(document.dof, "degree of freedom", "degrees of freedom"),
        counted(document.actuators, "actuator", "actuators"),
        counted(document.joints, "joint", "joints"),
    );
    let numbers = |values: &[f64]| {
        let texts: Vec<String> = values.iter().map(|value| significant(*value, 6)).collect();
        texts.join(", ")
    };
    let _ = writeln!(text, "pose: {}", document.pose.join(", "));
    let _ = writeln!(text, "home: {}", numbers(&document.home_pose));
    let actuators = document.actuator_names.join(", ");
    paragraph(&mut text, "", &format!("actuators: {actuators}"));
    if document.actuators > document.dof {
        let _ = writeln!(
            text,
            "kept by the actuator projection: {}",
            document.kept_actuators.join(", ")
        );
    }
    text
}

fn bodies(document: &Inspection) -> String {
    let row = |body: &inspection::Body| {
        let motor = match &body.actuator {
            Some(name) => format!("motor {name}"),
            None => String::new(),
        };
        let parameters = if body.parameters.is_empty() {
            "-".to_owned()
        } else {
            body.parameters.join(" ")
        };
        (
            vec![body.name.clone(), body.joint.to_owned(), motor],
            parameters,
        )
    };
    let (heads, parameters): (Vec<Vec<String>>, Vec<String>) =
        document.bodies.iter().map(row).unzip();
    let heads = columns(&heads, &[true; 3]);
    let rows: Vec<(String, String)> = heads.lines().map(str::to_owned).zip(parameters).collect();
    definitions(&rows, "  ")
}

fn base_parameters(all: &[inspection::Base]) -> String {
    let mut rows = Vec::new();
    let mut alone = Vec::new();
    for base in all {
        if base.regrouping.len() == 1 {
            alone.push(base.name.as_str());
            continue;
        }
        let mut sum = String::new();
        for (index, term) in base.regrouping.iter().enumerate() {
            let sign = match (index, term.coefficient < 0.0) {
                (0, _) => "",
                (_, true) => " -",
                (_, false) => " +",
            };
            let factor = match coefficient(term.coefficient.abs()).as_str() {
                "1" => String::new(),
                number => format!(" {number}"),
            };
            let _ = write!(sum, "{sign}{factor} {}", term.parameter);
        }
        rows.push((base.name.clone(), sum));
    }
    let mut text = definitions(&rows, " = ");
    if !alone.is_empty() {
        paragraph(
            &mut text,
            "",
            &format!("not regrouped: {}", alone.join(", ")),
        );
    }
    text
}

fn functions(document: &Inspection) -> String {
    let header = [
        "function",
        "shape",
        "op",
        "+ -",
        "*",
        "/",
        "sqrt",
        "sin cos",
        "atan2",
        "sign",
        "guard",
        "neg",
        "values",
        "op each step",
    ];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for function in &document.functions {
        let shape = function.outputs.iter().map(|output| {
            let sizes: Vec<String> = output.shape.iter().map(usize::to_string).collect();
            sizes.join(" x ")
        });
        let cost = &function.cost.once;
        let counts = [
            function.operations,
            cost.additions,
            cost.multiplications,
            cost.divisions,
            cost.square_roots,
            cost.trigonometric_pairs,
            cost.arc_tangents,
            cost.signs,
            cost.guards,
            cost.negations,
            cost.intermediates,
        ];
        let mut row = vec![function.function.clone(), shape.collect()];
        row.extend(counts.iter().map(usize::to_string));
        row.push(iterations(function));
        rows.push(row);
    }
    columns(&rows, &[true])
        + "op: additions, multiplications (also by signs) and divisions, with those of called functions.\nsign: signs of velocities. guard: checks before divisions and roots. neg: negations.\nvalues: intermediate numbers.\n"
        + &side_by_side(document)
}

/// Cost of functions in Rust in which legs run in SIMD lanes.
fn side_by_side(document: &Inspection) -> String {
    let function_rows = document.functions.iter().filter_map(|function| {
        let cost = function.cost.side_by_side?;
        let counts = [cost.legs, cost.once, cost.each, cost.lanes].map(|count| count.to_string());
        Some([vec![function.function.clone()], counts.to_vec()].concat())
    });
    let function_rows: Vec<Vec<String>> = function_rows.collect();
    if function_rows.is_empty() {
        return String::new();
    }
    let head = [
        "in Rust, in SIMD lanes",
        "legs",
        "op once",
        "op per leg",
        "lanes",
    ];
    let head = vec![head.map(str::to_owned).to_vec()];
    format!("\n{}", columns(&[head, function_rows].concat(), &[true]))
}

/// Cost per step of functions that iterate.
fn iterations(function: &inspection::Function) -> String {
    let function_rows = function.cost.iterations.iter().map(|one| {
        let runs = match (one.within, one.runs) {
            (Some(_), 1) => " inside".to_owned(),
            (Some(_), runs) => format!(" {runs} times inside"),
            (None, _) => String::new(),
        };
        format!("{}{runs}", one.operations)
    });
    function_rows.collect::<Vec<_>>().join(", ")
}

fn conditioning(document: &Inspection) -> String {
    let number = |value: Option<f64>| {
        value.map_or_else(|| "singular".to_owned(), |value| significant(value, 5))
    };
    let mut rows = vec![vec![
        "all actuators".to_owned(),
        number(document.conditioning.home),
    ]];
    for partition in &document.conditioning.partitions {
        let chosen = if partition.chosen { " (chosen)" } else { "" };
        let name = format!("kept {}{chosen}", partition.kept_actuators.join(", "));
        rows.push(vec![name, number(partition.condition)]);
    }
    columns(&rows, &[true])
}
