//! Converts errors to exceptions of the package, which are classes of `overact._errors`.

use overact::{SampleError, online};
use overact_cli::failure::Failure;
use overact_robot::{Column, Error, Problem};
use pyo3::{call::PyCallArgs, exceptions::PyValueError, prelude::*};

/// Exception of the package.
fn raised<'py, A>(py: Python<'py>, class: &str, arguments: A) -> PyErr
where
    A: PyCallArgs<'py>,
{
    let made = py
        .import("overact._errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| class.call1(arguments));
    match made {
        Ok(value) => PyErr::from_value(value),
        Err(error) => error,
    }
}

/// Exception for an error of a description, of data or of overact itself.
pub(crate) fn of_robot(py: Python<'_>, error: &Error) -> PyErr {
    let class = match error {
        _ if error.internal().is_some() => "InternalError",
        error if is_of_description(error) => "DescriptionError",
        _ => "DataError",
    };
    let problems: Vec<_> = error.problems().into_iter().map(parts).collect();
    raised(py, class, (error.render(false), problems))
}

/// Exception for a failure of the command line.
pub(crate) fn of_command(py: Python<'_>, failure: &Failure) -> PyErr {
    match failure {
        Failure::Input(error) => of_robot(py, error),
        Failure::Internal(_) => raised(py, "InternalError", (failure.render(false),)),
        Failure::Usage(message) | Failure::Refused(message) => {
            PyValueError::new_err(message.clone())
        }
    }
}

/// Exception for a sample at which a function has no value.
pub(crate) fn of_sample(py: Python<'_>, function: &str, error: &SampleError) -> PyErr {
    let message = format!("{function}: {error}");
    raised(
        py,
        "EvaluationError",
        (message, error.sample, error.error.to_string()),
    )
}

/// Exception for an input or state of an online estimator.
///
/// `sample` is that of an update.
pub(crate) fn of_online(
    py: Python<'_>,
    what: &str,
    sample: Option<usize>,
    error: online::Error,
) -> PyErr {
    let reason = error.to_string();
    let is_without_value = matches!(
        error,
        online::Error::NotDetermined | online::Error::Overflow
    );
    match sample {
        Some(sample) => {
            let message = format!("{what}: sample {sample}: {reason}");
            raised(py, "EvaluationError", (message, sample, reason))
        }
        None if is_without_value => raised(
            py,
            "EvaluationError",
            (format!("{what}: {reason}"), 0, reason),
        ),
        None => raised(py, "DataError", (format!("{what}: {reason}"),)),
    }
}

fn is_of_description(error: &Error) -> bool {
    match error {
        Error::Description { .. } => true,
        Error::Problems(_) => false,
        Error::Several(all) => all.iter().any(is_of_description),
    }
}

/// Message, file, line, column, advice and code.
type Parts = (
    String,
    Option<String>,
    Option<usize>,
    Option<Place>,
    Option<String>,
    String,
);

/// Position in a line: number of a character, or name of a column.
#[derive(IntoPyObject)]
pub(crate) enum Place {
    Number(usize),
    Name(String),
}

fn parts(problem: Problem) -> Parts {
    let column = problem.column.map(|column| match column {
        Column::Number(number) => Place::Number(number),
        Column::Name(name) => Place::Name(name),
    });
    (
        problem.message,
        problem.file,
        problem.line,
        column,
        problem.help,
        problem.code.to_string(),
    )
}
