//! What the simulation refuses, in the words of the description: at the line of the key, and by the
//! names that keys have there.

use overact_codegen::diagnostic::Code;
use overact_codegen::{
    description::{self, Description},
    diagnostic::{Diagnostic, Diagnostics, Source},
};
use overact_simulation::{Error, Problem, RunError};

/// Names of the simulation's values that are keys of another name in a description.
const KEYS: [(&str, &str); 13] = [
    ("sampling_hz", "sampling"),
    ("duration_s", "duration"),
    ("bandwidth_hz", "bandwidth"),
    ("derivative_cutoff_hz", "derivative_cutoff"),
    ("encoder_resolution", "encoder"),
    ("encoder_delay_s", "encoder_delay"),
    ("delay_s", "delay"),
    ("current_bandwidth_hz", "current_bandwidth"),
    ("flexible_hz", "flexible_frequency"),
    ("fundamental_hz", "fundamental"),
    ("phase_rad", "phase"),
    ("runs", "run"),
    // A run's trajectory is no table of its own.
    ("trajectory", ""),
];

/// The simulation's errors as errors of the description.
pub(crate) fn diagnostics(
    source: &Source,
    description: &Description,
    error: &Error,
) -> Diagnostics {
    let mut all = Diagnostics::new();
    match error {
        Error::Experiment(problems) => problems
            .iter()
            .for_each(|problem| all.push(of_problem(source, problem))),
        Error::Runs(runs) => runs
            .iter()
            .for_each(|run| all.push(of_run(source, description, run))),
        other => {
            let span = description::place(source, "experiment");
            all.push(Diagnostic::global(Code::EXPERIMENT, other.to_string()).at(span));
        }
    }
    all
}

/// A value that makes no sense.
fn of_problem(source: &Source, problem: &Problem) -> Diagnostic {
    let path = path(&problem.field);
    let name = path.rsplit('.').next().unwrap_or(&path);
    let place = description::place(source, &format!("experiment.{path}"));
    Diagnostic::global(
        Code::EXPERIMENT,
        format!("`{name}` {}", in_keys(&problem.message)),
    )
    .at(place)
}

/// A run that could not be finished, at its name.
fn of_run(source: &Source, description: &Description, error: &RunError) -> Diagnostic {
    let runs = description.experiment.iter().flat_map(|table| &table.runs);
    let run = runs.into_iter().find(|run| run.name.value == error.run);
    let message = in_keys(&error.to_string());
    let of_run = run.map(|run| run.name.span.clone());
    let place = of_run.or_else(|| description::place(source, "experiment"));
    Diagnostic::global(Code::EXPERIMENT, message).at(place)
}

/// The path of a value among the description's keys: `runs[1].trajectory.terms[0].phase_rad` is
/// `run[1].terms[0].phase`.
fn path(field: &str) -> String {
    let part = |part: &str| {
        let (name, index) = part.split_at(part.find('[').unwrap_or(part.len()));
        format!("{}{index}", key(name))
    };
    let mut parts: Vec<String> = field.split('.').map(part).collect();
    parts.retain(|part| !part.is_empty());
    parts.join(".")
}

/// The key of a value.
fn key(name: &str) -> &str {
    let known = KEYS.iter().find(|(own, _)| *own == name);
    known.map_or(name, |(_, key)| key)
}

/// A message whose names in backticks are keys.
fn in_keys(message: &str) -> String {
    let parts = message.split('`').enumerate();
    let renamed = parts.map(|(at, part)| if at % 2 == 1 { key(part) } else { part });
    renamed.collect::<Vec<_>>().join("`")
}

#[cfg(test)]
mod tests {
    use super::{in_keys, path};

    #[test]
    fn names_are_those_of_the_description() {
        assert_eq!(
            path("runs[1].trajectory.terms[0].phase_rad"),
            "run[1].terms[0].phase"
        );
        assert_eq!(
            path("drives.flexible_hz[2]"),
            "drives.flexible_frequency[2]"
        );
        assert_eq!(
            path("runs[0].trajectory.fundamental_hz"),
            "run[0].fundamental"
        );
        assert_eq!(
            in_keys("lower `bandwidth_hz`, or `damping`"),
            "lower `bandwidth`, or `damping`"
        );
    }
}
