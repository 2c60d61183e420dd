//! Maps errors of the simulation to lines and keys of the description.

use overact_codegen::diagnostic::Code;
use overact_codegen::{
    description::{self, Description},
    diagnostic::{Diagnostic, Diagnostics, Source},
};
use overact_simulation::{Error, Problem, RunError};

/// Fields of the simulation and the description's keys for them.
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
    // A run's trajectory has no table of its own.
    ("trajectory", ""),
];

/// Converts the simulation's errors to errors of the description.
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

/// Error for an invalid value.
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

/// Error for a run that failed, located at its name.
fn of_run(source: &Source, description: &Description, error: &RunError) -> Diagnostic {
    let runs = description.experiment.iter().flat_map(|table| &table.runs);
    let run = runs.into_iter().find(|run| run.name.value == error.run);
    let message = in_keys(&error.to_string());
    let of_run = run.map(|run| run.name.span.clone());
    let place = of_run.or_else(|| description::place(source, "experiment"));
    Diagnostic::global(Code::EXPERIMENT, message).at(place)
}

/// Key path of a field: `runs[1].trajectory.terms[0].phase_rad` becomes `run[1].terms[0].phase`.
fn path(field: &str) -> String {
    let part = |part: &str| {
        let (name, index) = part.split_at(part.find('[').unwrap_or(part.len()));
        format!("{}{index}", key(name))
    };
    let mut parts: Vec<String> = field.split('.').map(part).collect();
    parts.retain(|part| !part.is_empty());
    parts.join(".")
}

/// Key of a field.
fn key(name: &str) -> &str {
    let known = KEYS.iter().find(|(own, _)| *own == name);
    known.map_or(name, |(_, key)| key)
}

/// Message with fields in backticks replaced by keys.
fn in_keys(message: &str) -> String {
    let parts = message.split('`').enumerate();
    let renamed = parts.map(|(at, part)| if at % 2 == 1 { key(part) } else { part });
    renamed.collect::<Vec<_>>().join("`")
}

#[cfg(test)]
mod tests {
    use super::{in_keys, path};

    #[test]
    fn errors_use_the_key_names_of_the_description() {
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
