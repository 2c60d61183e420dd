//! Text tables that compare own with published results.
//!
//! They cover parameters (Table 2), torque errors (Table 3) and tracking errors (Table 4). Tables
//! that need published results are omitted without these.

use overact_identification::{
    CrossValidation, Estimate, Identification, ModelKind, Stage, significant,
};

use super::{
    choice::{answers, of_stage},
    layout::{line, table},
    published::Published,
};

/// Comparison tables; empty if there is nothing to compare.
#[must_use]
pub fn compare_with_published(
    identification: &Identification,
    published: Option<&Published>,
) -> String {
    let mut text = String::new();
    let source = published.map_or_else(String::new, |all| {
        format!(", compared with {}", all.source.trim_end_matches('.'))
    });
    if let Some(published) = published {
        text += &section(
            &format!("Parameters{source}"),
            parameters(identification, published),
        );
    }
    let rows = torques(identification, published);
    text += &section(
        &format!("Torque errors in percent of the torques{source}"),
        rows,
    );
    let rows = tracking(identification, published);
    text += &section(
        &format!("Largest tracking errors in 1e-3 m or rad{source}"),
        rows,
    );
    text
}

/// Header and rows of a table.
#[derive(Default)]
struct TextTable {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// Titled table; empty without rows.
fn section(title: &str, contents: TextTable) -> String {
    if contents.rows.is_empty() {
        return String::new();
    }
    let header: Vec<&str> = contents.header.iter().map(String::as_str).collect();
    let mut text = String::from("\n");
    line(&mut text, title);
    text + &table(&header, contents.rows)
}

/// Name of a model.
const fn case(model: ModelKind) -> &'static str {
    match model {
        ModelKind::Platform | ModelKind::Actuators => model.label(),
        ModelKind::Joints => model.name(),
    }
}

/// Estimates to compare with published ones: the essential parameters, as those are.
fn comparable(identification: &Identification) -> Vec<&Estimate> {
    let essential = of_stage(identification, Stage::Essential);
    if essential.is_empty() {
        answers(identification)
    } else {
        essential
    }
}

/// Table 2: every parameter of an own or published estimate.
fn parameters(identification: &Identification, published: &Published) -> TextTable {
    let mut header = vec![String::from("parameter")];
    let estimates = comparable(identification);
    let mut names: Vec<&str> = Vec::new();
    for estimate in &estimates {
        let case = case(estimate.model);
        header.extend([case.to_owned(), String::from("% sigma")]);
        header.extend([format!("{case}, published"), String::from("% sigma")]);
        for parameter in &estimate.parameters {
            if !names.contains(&parameter.name.as_str()) {
                names.push(&parameter.name);
            }
        }
        let others = published.estimate(estimate.model);
        for name in others.iter().flat_map(|one| one.parameters.keys()) {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
    }
    let nothing = || String::from("-");
    let rows = names.iter().map(|name| {
        let mut row = vec![(*name).to_owned()];
        for estimate in &estimates {
            let own = estimate.parameters.iter().find(|one| one.name == **name);
            row.push(own.map_or_else(nothing, |one| significant(one.value, 4)));
            // Standard deviations by (47), as in the paper.
            row.push(own.map_or_else(nothing, |one| {
                significant(one.relative_standard_deviation_percent, 3)
            }));
            let other = published.estimate(estimate.model);
            let other = other.and_then(|one| one.parameters.get(*name));
            row.push(other.map_or_else(nothing, |one| significant(one.value, 4)));
            let deviation = other.and_then(|one| one.deviation_percent);
            row.push(deviation.map_or_else(nothing, |percent| significant(percent, 3)));
        }
        row
    });
    TextTable {
        header,
        rows: rows.collect(),
    }
}

/// Header with a column for each actuator.
fn actuator_header(first: [&str; 2], actuators: &[String]) -> Vec<String> {
    let first = first.map(str::to_owned).into_iter();
    first.chain(actuators.iter().cloned()).collect()
}

/// Table 3.
fn torques(identification: &Identification, published: Option<&Published>) -> TextTable {
    let stages = comparable(identification);
    let shown = |one: &&CrossValidation| {
        stages
            .iter()
            .any(|last| last.model == one.model && last.stage == one.stage)
    };
    let own: Vec<&CrossValidation> = identification
        .cross_validation
        .iter()
        .filter(shown)
        .collect();
    let Some(first) = own.first() else {
        return TextTable::default();
    };
    let actuators: Vec<String> = first.table.iter().map(|one| one.actuator.clone()).collect();
    let percent = |value: &f64| format!("{value:.1}");
    let mut rows = Vec::new();
    let mut add = |run: &str, what: String, errors: &[f64]| {
        let mut row = vec![run.to_owned(), what];
        row.extend(errors.iter().map(percent));
        row.push(percent(
            &(errors.iter().sum::<f64>() / errors.len().max(1) as f64),
        ));
        rows.push(row);
    };
    let known = published.filter(|all| all.actuators == actuators);
    for one in own {
        let least: Vec<f64> = one
            .table
            .iter()
            .map(|entry| entry.least_norm_percent)
            .collect();
        add(&one.run, format!("{}, least norm", case(one.model)), &least);
        let closure: Option<Vec<f64>> = one
            .table
            .iter()
            .map(|entry| entry.closure_percent)
            .collect();
        if let Some(closure) = closure {
            add(&one.run, format!("{}, eq. (26)", case(one.model)), &closure);
        }
        let others = known.iter().flat_map(|all| &all.cross_validation);
        for other in others.filter(|other| is_run(&one.run, &other.run) && other.model == one.model)
        {
            let what = format!("{}, eq. (26), published", case(one.model));
            add(&one.run, what, &other.torques_percent);
        }
    }
    let mut header = actuator_header(["run", "prediction"], &actuators);
    header.push(String::from("mean"));
    TextTable { header, rows }
}

/// Whether a run has a name, or is a log file named after it.
///
/// `simulate` names `log_trajectory_1.csv` after `trajectory 1`.
fn is_run(run: &str, name: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        text.split(|c: char| !c.is_alphanumeric())
            .filter(|word| !word.is_empty())
            .map(str::to_lowercase)
            .collect()
    };
    let file = std::path::Path::new(run);
    let stem = match file.extension() {
        Some(_) => file.file_stem().and_then(|stem| stem.to_str()),
        None => None,
    };
    let (run, name) = (words(stem.unwrap_or(run)), words(name));
    !name.is_empty() && run.ends_with(&name)
}

/// Table 4.
fn tracking(identification: &Identification, published: Option<&Published>) -> TextTable {
    let Some(first) = identification.tracking.first() else {
        return TextTable::default();
    };
    let known = published.filter(|all| all.actuators == first.actuators);
    let mut rows = Vec::new();
    let mut add = |run: &str, what: String, largest: &[f64]| {
        let mut row = vec![run.to_owned(), what];
        row.extend(largest.iter().map(|error| significant(1e3 * error, 3)));
        rows.push(row);
    };
    for one in &identification.tracking {
        add(&one.run, one.controller.clone(), &one.largest);
        let others = known.iter().flat_map(|all| &all.tracking);
        let same = others
            .filter(|other| is_run(&one.run, &other.run) && other.controller == one.controller);
        for other in same {
            add(
                &one.run,
                format!("{}, published", one.controller),
                &other.largest,
            );
        }
    }
    TextTable {
        header: actuator_header(["run", "controller"], &first.actuators),
        rows,
    }
}

#[cfg(test)]
mod tests {
    use super::is_run;

    #[test]
    fn logs_are_matched_to_runs_by_name() {
        for run in [
            "trajectory 1",
            "log_trajectory_1.csv",
            "a b/log_trajectory_1.csv",
        ] {
            assert!(is_run(run, "trajectory 1"), "{run}");
        }
        for run in [
            "trajectory 2",
            "log_trajectory_11.csv",
            "1.csv",
            "trajectory_1_late.csv",
        ] {
            assert!(!is_run(run, "trajectory 1"), "{run}");
        }
    }
}
