//! Maps locations in a generated description to the file that it was imported from.

use crate::{
    files::{Errors, Files, Place},
    model::Model,
};
use overact_description::diagnostic::{Code, Diagnostic, Diagnostics, Source, Span};

/// Parts of a description and their source files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Origins {
    /// Byte range of each part, and its origin.
    parts: Vec<(Span, Origin)>,
    /// Files read, the robot's file first.
    sources: Vec<Source>,
}

/// Origin of one part of a description.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Origin {
    joint: String,
    place: Place,
}

impl Origins {
    /// Origins of a text whose `parts` belong to joints of the model.
    pub(crate) fn new(files: &Files, model: &Model, parts: Vec<(Span, usize)>) -> Self {
        let origin = |(span, joint): (Span, usize)| {
            let own = &model.joints[joint];
            let origin = Origin {
                joint: own.name.clone(),
                place: own.place.clone(),
            };
            (span, origin)
        };
        Self {
            parts: parts.into_iter().map(origin).collect(),
            sources: files.sources(),
        }
    }

    /// Maps errors of the description to joints of the source file, or to the file as a whole.
    pub(crate) fn located(&self, errors: &Diagnostics) -> Errors {
        let mut all: Vec<(Source, Diagnostics)> = self
            .sources
            .iter()
            .map(|source| (source.clone(), Diagnostics::new()))
            .collect();
        for error in errors {
            let at_span = error.span.as_ref().and_then(|span| self.origin(span));
            let origin = at_span.or_else(|| self.named(&error.label));
            let file = origin.map_or(0, |origin| origin.place.file);
            if let Some((_, own)) = all.get_mut(file) {
                own.push(in_file(error, origin));
            }
        }
        all.retain(|(_, errors)| !errors.is_empty());
        Errors(all)
    }

    /// Origin of the first joint that a text names.
    fn named(&self, text: &str) -> Option<&Origin> {
        let mut names = text.split('`').skip(1).step_by(2);
        names.find_map(|name| {
            let mut parts = self.parts.iter();
            let found = parts.find(|(_, origin)| origin.joint == name);
            found.map(|(_, origin)| origin)
        })
    }

    fn origin(&self, span: &Span) -> Option<&Origin> {
        let mut parts = self.parts.iter();
        let (_, origin) = parts.find(|(part, _)| part.contains(&span.start))?;
        Some(origin)
    }
}

/// Converts an error of the description to an error of the source file.
fn in_file(error: &Diagnostic, origin: Option<&Origin>) -> Diagnostic {
    let label = match error.label.as_str() {
        "" => String::new(),
        label => format!(": {label}"),
    };
    let reason = match origin {
        Some(origin) => format!("joint `{}`: {}{label}", origin.joint, error.message),
        None => format!("{}{label}", error.message),
    };
    let message = format!("this robot can't be described: {reason}");
    let help = help(error);
    match origin {
        Some(origin) => Diagnostic::new(error.code, message, origin.place.span.clone()),
        None => Diagnostic::global(error.code, message),
    }
    .help(help)
}

/// Advice in terms of the source file or the import options.
fn help(error: &Diagnostic) -> String {
    let own = match error.code {
        Code::ACTUATED => "name the driven joints, none of them coupled: `--actuated JOINT,JOINT`",
        Code::MOVES_FREELY | Code::NOT_HELD | Code::SINGULAR_HOME | Code::ALWAYS_SINGULAR => {
            "choose another configuration, `--home JOINT=POSITION`, or other driven joints, `--actuated JOINT,JOINT`"
        }
        Code::DOES_NOT_CLOSE => "choose another configuration, `--home JOINT=POSITION`",
        _ => "correct the file",
    };
    match &error.help {
        Some(help) => format!("{own}; in the description: {help}"),
        None => own.to_owned(),
    }
}
