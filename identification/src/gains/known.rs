//! Columns of known parameters, and whether they determine the scale.
//!
//! If all parameters are unknown, parameters and gains are determined up to a common factor. A
//! known parameter fixes it if its column is independent of those of unknown ones. Otherwise its
//! contribution is absorbed by an unknown base parameter. The mass of a payload is suitable if some
//! runs carry it and others do not. The mass of a body of a chain is usually regrouped.

use overact::Code;
use overact::Model;

use crate::{
    estimation::base::{
        BaseParameters, Combination, PayloadUse, base_parameters_with_known, payload_names,
    },
    regression::columns::ColumnSet,
    settings::Settings,
};
use overact_logs::{Error, Log, Problem, suggestion};

/// Largest number of names in a sum.
const NAMES: usize = 5;

/// Help that suits any robot.
const WEIGHED: &str =
    "weigh a payload, give its mass in [identification.known], and record runs with and without it";

/// Column of a known parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnownColumn {
    pub(super) column: usize,
    /// Value of the parameter (SI units).
    pub(super) value: f64,
}

/// Columns of a model, split into those of known and of unknown parameters.
#[derive(Debug)]
pub(super) struct Split {
    pub(super) columns: ColumnSet,
    /// Base parameters of the unknown columns.
    pub(super) base: BaseParameters,
    /// Columns of known parameters.
    pub(super) known: Vec<KnownColumn>,
}

impl Split {
    /// Splits a model's columns for these runs.
    ///
    /// # Errors
    /// No known parameter that fixes the scale, or names that are no parameters.
    pub(super) fn new(model: &dyn Model, runs: &[Log], settings: &Settings) -> Result<Self, Error> {
        let info = model.info();
        if settings.known.is_empty() {
            let message = "gains are not determined: without a known parameter, gains and parameters have a common factor";
            return Err(Problem::new(Code::GAINS, message).help(WEIGHED).into());
        }
        let payload = PayloadUse::of(&info, runs)?;
        let columns = ColumnSet::new(
            model,
            payload != PayloadUse::Absent,
            settings.asymmetric_friction,
            settings.seed,
        )?
        .with_payloads(&payload_names(runs));
        let known = found(model, &columns, settings)?;
        let places: Vec<usize> = known.iter().map(|own| own.column).collect();
        let (base, combinations) =
            base_parameters_with_known(model, &columns, payload, &places, settings.seed)?;
        let fixes = known
            .iter()
            .zip(&combinations)
            .any(|(own, others)| own.value != 0.0 && others.is_none());
        if !fixes {
            let problem = |(own, others): (&KnownColumn, &Combination)| {
                scaleless(&columns, payload, *own, others.as_deref())
            };
            let problems = known.iter().zip(&combinations).map(problem).collect();
            Error::check(problems)?;
        }
        let columns = columns.with_friction_signs(model, settings)?;
        Ok(Self {
            columns,
            base,
            known,
        })
    }
}

/// Columns of the known parameters.
fn found(
    model: &dyn Model,
    columns: &ColumnSet,
    settings: &Settings,
) -> Result<Vec<KnownColumn>, Error> {
    let info = model.info();
    let all = columns.as_slice();
    let (mut known, mut problems) = (Vec::new(), Vec::new());
    for (name, value) in &settings.known {
        if let Some(column) = all.iter().position(|one| one.name == *name) {
            known.push(KnownColumn {
                column,
                value: *value,
            });
        } else if info
            .payload_parameters
            .iter()
            .any(|one| is_of(name, one.name))
        {
            problems.push(not_carried(name, columns));
        } else {
            let problem = Problem::new(Code::GAINS, format!("the robot has no parameter `{name}`"));
            let names = all.iter().map(|one| one.name.as_str());
            problems.push(match suggestion(name, names) {
                Some(other) => problem.help(format!("did you mean `{other}`?")),
                None => problem.help("names are those of the parameters that `inspect` lists"),
            });
        }
    }
    Error::check(problems)?;
    Ok(known)
}

/// Whether a name is that of a payload's parameter, or of a named payload's.
fn is_of(name: &str, parameter: &str) -> bool {
    let rest = name.strip_prefix(parameter);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
}

/// The problem of a known parameter of a payload that no run carries.
fn not_carried(name: &str, columns: &ColumnSet) -> Problem {
    let all = columns.as_slice().iter().map(|one| &one.name);
    let named: Vec<String> = all
        .filter(|one| one.as_str() != name && is_of(one, name))
        .map(|one| format!("`{one}`"))
        .collect();
    let problem = |why: &str| {
        let message = format!("gains are not determined: `{name}` is known, but {why}");
        Problem::new(Code::GAINS, message)
    };
    if named.is_empty() {
        problem("no run carries the payload")
            .help("also record runs with the payload, and mark them with --payload-data")
    } else {
        problem("the payloads have names").help(format!("give {} instead", named.join(" or ")))
    }
}

/// Why a known parameter does not fix the scale; its column is a combination of `others`.
fn scaleless(
    columns: &ColumnSet,
    payload: PayloadUse,
    known: KnownColumn,
    others: Option<&[usize]>,
) -> Problem {
    let name = |column: &usize| {
        let column = columns.as_slice().get(*column);
        column.map_or_else(String::new, |one| format!("`{}`", one.name))
    };
    let own = name(&known.column);
    let others = others.unwrap_or_default();
    let problem =
        |why: String| Problem::new(Code::GAINS, format!("gains are not determined: {why}"));
    if known.value == 0.0 {
        return problem(format!(
            "{own} is known to be zero, which does not determine the scale"
        ))
        .help(WEIGHED);
    }
    if others.is_empty() {
        return problem(format!("{own} has no effect on the torques")).help(WEIGHED);
    }
    let mut names: Vec<String> = others.iter().take(NAMES).map(name).collect();
    if others.len() > NAMES {
        names.push(format!("{} more", others.len() - NAMES));
    }
    let why = format!(
        "{own} is known, but its column is a combination of those of {}, which are not",
        names.join(", ")
    );
    let is_load = columns.indices(true).contains(&known.column);
    match payload {
        PayloadUse::Regrouped if is_load => {
            problem(why).help("all runs carry the payload: also record some without it")
        }
        _ => problem(why).help(format!("{WEIGHED}, or also give the values of these")),
    }
}
