//! `overact new`: writes a description from a commented template, or lists the templates.

use crate::{
    failure::{Failure, Problem},
    input::is_stream,
    output::{json, print, write},
};
use clap::builder::PossibleValuesParser;
use overact_codegen::diagnostic::Code;
use overact_report::layout::definitions;
use serde::Serialize;
use std::path::PathBuf;

/// Template with its name and text.
macro_rules! template {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../templates/", $name, ".toml")),
        )
    };
}

/// All templates, by the degrees of freedom of their platforms.
///
/// Names consist of motion and legs, with a letter per joint (P prismatic, R revolute, S spherical,
/// U universal).
const TEMPLATES: [(&str, &str); 15] = [
    template!("serial-2r"),
    template!("serial-6r"),
    template!("fixed-axis-2p"),
    template!("point-2rr"),
    template!("point-3rr"),
    template!("planar-3rrr"),
    template!("planar-3prr"),
    template!("planar-4rrr"),
    template!("translation-3rus"),
    template!("translation-4rus"),
    template!("schoenflies-4rus"),
    template!("spherical-3rrr"),
    template!("spherical-4rrr"),
    template!("spatial-6ups"),
    template!("spatial-8ups"),
];

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Template to start from; without it, all templates are listed
    #[arg(value_parser = PossibleValuesParser::new(TEMPLATES.map(|(name, _)| name)), requires = "file")]
    template: Option<String>,
    /// The description to write, which must not exist; `-` is standard output
    #[arg(value_name = "TOML")]
    file: Option<PathBuf>,
}

/// List entry of a template.
#[derive(Debug, Serialize)]
struct Listed {
    template: &'static str,
    robot: &'static str,
}

/// Runs the command.
///
/// # Errors
/// A file that exists or cannot be written.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let (Some(template), Some(path)) = (&arguments.template, &arguments.file) else {
        return list(as_json);
    };
    let file = path.display().to_string();
    let text = TEMPLATES
        .iter()
        .find(|(name, _)| name == template)
        .map_or("", |t| t.1);
    if is_stream(path) && !as_json {
        return print(text);
    }
    // A dangling link counts as an existing file.
    if path.symlink_metadata().is_ok() {
        let problem =
            Problem::new(Code::FILE_EXISTS, "the file exists and is not overwritten").file(file);
        return Err(problem
            .help("choose another name, or remove the file first")
            .into());
    }
    write(vec![(path.clone(), text.as_bytes().to_vec())])?;
    if as_json {
        return print(&json(
            &serde_json::json!({ "file": file, "template": template }),
        )?);
    }
    print(&format!(
        "wrote {file}; next:\n\
         \u{20} overact check {file}                 every error, each at its line\n\
         \u{20} overact inspect {file} --svg my.svg  the model, and a drawing\n\
         \u{20} overact identify {file}              a virtual experiment and its parameters"
    ))
}

/// List of the templates, described by their first lines.
fn list(as_json: bool) -> Result<(), Failure> {
    let listed = |&(template, text): &(&'static str, &'static str)| Listed {
        template,
        robot: text.lines().next().unwrap_or("").trim_start_matches("# "),
    };
    let all: Vec<Listed> = TEMPLATES.iter().map(listed).collect();
    if as_json {
        return print(&json(&serde_json::json!({ "templates": all }))?);
    }
    let row = |one: &Listed| (one.template.to_owned(), one.robot.to_owned());
    let rows: Vec<(String, String)> = all.iter().map(row).collect();
    print(&format!(
        "{}\n`overact new TEMPLATE my.toml` writes one",
        definitions(&rows, "  ")
    ))
}
