//! Base parameter names: in every list of a document, and in `inspect`, one name is one sum of
//! standard parameters with one value.

use overact_identification::{
    ColumnSet, Identification, Instruments, Log, PayloadUse, Regrouping, Stage, base_parameters,
};
use overact_robot::{Identifier, Robot};
use overact_tier::{is_full, of_many};
use std::{collections::BTreeMap, fs, path::Path};

/// Robots of the default tier: one with a platform, and two whose functions keep other columns than
/// the symmetric order would.
const ROBOTS: [&str; 3] = ["five_bar", "palletiser", "stanford"];

/// A turning arm with a vertical quill, whose torque contains mass, inertia and a constant force.
const QUILL: &str = r#"
name = "Quill"
gravity = [0, 0, "-9.81 m/s^2"]

[[leg.arm.joint]]
type = "revolute"
actuated = true
parameters = ["inertia", "ia", "friction"]

[[leg.arm.joint]]
type = "prismatic"
d = "0.2 m"
actuated = true
parameters = ["inertia", "ia", "friction", "off"]

[[place]]
name = "arm"
shape = "arm"
"#;

/// A sum of standard parameters: coefficients by name.
type Sum = BTreeMap<String, f64>;

/// Sum of a kept parameter and its regrouping.
fn sum(kept: &str, regrouping: &[Regrouping]) -> Sum {
    let mut sum = Sum::from([(kept.to_owned(), 1.0)]);
    for term in regrouping {
        *sum.entry(term.parameter.clone()).or_default() += term.coefficient;
    }
    sum
}

/// Whether two sums have equal terms.
fn is_same(one: &Sum, other: &Sum) -> bool {
    one.len() == other.len()
        && one.iter().zip(other).all(|((a, x), (b, y))| {
            let largest = x.abs().max(y.abs());
            a == b && (x - y).abs() <= 1e-6 * largest
        })
}

/// Sums of `inspect` and of generated code, by name.
fn of_functions(robot: &Robot) -> BTreeMap<String, Sum> {
    let model = robot.model().model();
    let bases = model.base.iter().map(|base| {
        let mut sum = Sum::from([(model.parameter_name(base.parameter), 1.0)]);
        for &(other, coefficient) in &base.regrouped {
            sum.insert(model.parameter_name(other), coefficient);
        }
        (model.base_name(base), sum)
    });
    bases.collect()
}

/// Sums of an identification without payload, by name.
fn of_identification(robot: &Robot) -> BTreeMap<String, Sum> {
    let model = robot.model();
    let columns = ColumnSet::new(model, false, false, 1).expect("columns");
    let base = base_parameters(model, &columns, PayloadUse::Absent, 1).expect("parameters");
    let name = |index: usize| columns.as_slice()[index].name.clone();
    let sums = { base.columns.iter().zip(&base.regroupings) }.map(|(&kept, regrouping)| {
        let others = regrouping.iter().map(|&(other, c)| (name(other), c));
        [(name(kept), 1.0)].into_iter().chain(others).collect()
    });
    base.names.iter().cloned().zip(sums).collect()
}

/// Differences between the base parameters of the identification and of the functions.
fn differences(name: &str, robot: &Robot) -> Vec<String> {
    let (functions, identified) = (of_functions(robot), of_identification(robot));
    let mut found = Vec::new();
    for (own, sum) in &identified {
        match functions.get(own) {
            Some(other) if is_same(sum, other) => {}
            other => found.push(format!("{name}: {own} = {sum:?}, {other:?}")),
        }
    }
    if identified.len() != functions.len() {
        found.push(format!("{name}: {} {}", identified.len(), functions.len()));
    }
    found
}

fn described(name: &str) -> Robot {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    Robot::from_toml(folder.join(format!("{name}.toml"))).expect("a description")
}

/// Names of all descriptions.
fn library() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let files = fs::read_dir(folder).expect("the library");
    let files = files.map(|entry| entry.expect("an entry").path());
    let files = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    let stem = |path: &Path| Some(path.file_stem()?.to_str()?.to_owned());
    let mut names: Vec<String> = files.filter_map(|path| stem(&path)).collect();
    names.sort();
    assert!(names.len() >= 20);
    names
}

#[test]
fn identification_and_functions_have_the_same_base_parameters() {
    let names = if is_full() {
        library()
    } else {
        ROBOTS.map(str::to_owned).to_vec()
    };
    let found: Vec<String> = { names.iter() }
        .flat_map(|name| differences(name, &described(name)))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn an_inertia_is_regrouped_with_a_mass_and_not_with_a_force() {
    let robot = Robot::from_text("quill", QUILL).expect("a description");
    assert_eq!(differences("quill", &robot), Vec::<String>::new());
    let sums = of_identification(&robot);
    let terms = |name: &str| -> Vec<&str> {
        let sum = sums.get(name).map(|sum| sum.keys().map(String::as_str));
        sum.into_iter().flatten().collect()
    };
    assert_eq!(terms("ia_2R"), ["ia_2", "m_2"], "{sums:?}");
    assert_eq!(terms("off_2R"), ["m_2", "off_2"], "{sums:?}");
}

/// Identification from the beginnings of the virtual runs.
fn identified(robot: &Robot) -> Identification {
    let mut experiment = robot.experiment().expect("an experiment");
    let plan = experiment.plan_mut();
    // Instruments are simulated for the described durations.
    if robot.settings(plan.sampling_hz).instruments != Instruments::Simulated {
        plan.duration_s = plan.duration_s.min(5.0);
        for duration in plan.runs.iter_mut().flat_map(|run| &mut run.duration_s) {
            *duration = duration.min(5.0);
        }
    }
    let runs = experiment
        .runs(&robot.held_out(), &|_, _| {})
        .expect("runs");
    let logs: &[Log] = &runs.identified;
    Identifier::new(robot).runs(logs).run().expect("a result")
}

#[test]
fn base_parameter_names_have_one_sum_and_one_value() {
    let names: Vec<String> = if is_full() {
        of_many(library())
    } else {
        ROBOTS.map(str::to_owned).to_vec()
    };
    for name in names {
        let robot = described(&name);
        let result = identified(&robot);
        let base = result.estimates.iter().find(|one| one.stage == Stage::Base);
        let values: BTreeMap<&str, f64> = { base.expect("an estimate").parameters.iter() }
            .map(|one| (one.name.as_str(), one.value))
            .collect();
        let sums: BTreeMap<&str, Sum> = { result.base_parameters.iter() }
            .map(|one| (one.name.as_str(), sum(&one.parameter, &one.regrouping)))
            .collect();
        let mut seen = Vec::new();
        for own in &result.functions_base {
            assert!(!seen.contains(&&own.name), "{name}: {} twice", own.name);
            seen.push(&own.name);
            if let Some(other) = sums.get(own.name.as_str()) {
                let own_sum = sum(&own.parameter, &own.regrouping);
                assert!(is_same(&own_sum, other), "{name}: {own:?} {other:?}");
            }
            if let Some(value) = values.get(own.name.as_str()) {
                let most = 1e-6 * value.abs().max(1e-3);
                assert!((own.value - value).abs() < most, "{name}: {own:?} {value}");
            }
        }
        let other_sums = seen.iter().filter(|own| own.ends_with('F')).count();
        assert_eq!(other_sums, 0, "{name}: {seen:?}");
    }
}
