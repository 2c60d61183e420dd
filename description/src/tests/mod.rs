//! Tests of whole descriptions; each kind of error is shown as rendered for its reader.

mod chains;
mod compound;
mod dependent;
mod documentation;
mod errors;
mod experiments;
mod friction;
mod motors;
mod point_springs;
mod robots;
mod springs;
mod structure;
mod values;

use super::{Description, parse};
use crate::diagnostic::{Diagnostics, Source};

/// A robot of one revolute joint, with additional keys for the root and the joint.
fn single(root: &str, joint: &str) -> String {
    format!(
        "name = \"Arm\"\n{root}\n[[leg.arm.joint]]\ntype = \"revolute\"\nactuated = true\n{joint}\n\n\
         [[place]]\nname = \"arm\"\nshape = \"arm\"\n"
    )
}

fn parse_text(text: &str) -> (Source, Result<Description, Diagnostics>) {
    let source = Source::new("my.toml", text);
    let result = parse(&source);
    (source, result)
}

/// The description, which has to be valid.
fn good(text: &str) -> Description {
    let (source, result) = parse_text(text);
    match result {
        Ok(description) => description,
        Err(errors) => panic!("{}", errors.render_plain(&source)),
    }
}

/// The rendered errors.
fn rendered(text: &str) -> String {
    let (source, result) = parse_text(text);
    match result {
        Ok(_) => "no error".to_owned(),
        Err(errors) => errors.render_plain(&source),
    }
}

/// Line, column, message and help of all errors.
fn listed(text: &str) -> Vec<String> {
    let (source, result) = parse_text(text);
    let Err(errors) = result else {
        return Vec::new();
    };
    let one = |e: &crate::diagnostic::Located| {
        let help = e
            .help
            .as_ref()
            .map(|help| format!("; {help}"))
            .unwrap_or_default();
        let (line, column) = (e.line.unwrap_or(0), e.column.unwrap_or(0));
        format!("{line}:{column} {}{help}", e.message)
    };
    errors.located(&source).iter().map(one).collect()
}
