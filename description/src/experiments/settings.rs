//! The table `[identification]`.

use crate::diagnostic::Code;
use crate::experiments::data::check_count;
use crate::experiments::experiment::position;
use crate::experiments::known;
use crate::experiments::{gears, stribeck};
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::Inventory;
use crate::robot::model::Spanned;
use crate::toml_text::reader::{Item, Table};
use overact_exact::Number;

/// Normalisation of the residual's variance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Normalisation {
    /// By the number of equations minus one, about the residual's mean.
    MinusOne,
    /// By the number of equations minus that of parameters, eq. (46).
    #[default]
    MinusParameters,
}

/// Friction model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Friction {
    /// The same coefficients in both directions, and an offset.
    #[default]
    Symmetric,
    /// Separate coefficients for each direction.
    Asymmetric,
}

/// Sign of a velocity in Coulomb friction if it reverses between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reversals {
    /// The mean of the sign over the sampling interval.
    #[default]
    Averaged,
    /// The sign at the sample.
    Sampled,
}

/// Origin of the instrumental variables, by which errors of the positions are detected and
/// corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Instruments {
    /// Other periods of a periodic motion.
    #[default]
    Periods,
    /// Motion of the simulated robot.
    Simulated,
    /// No instruments.
    None,
}

/// Settings of the identification.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// Order of the Butterworth low-pass filter on the positions.
    pub filter_order: usize,
    /// Its cutoff, Hz; chosen from the sampling frequency if absent.
    pub filter_cutoff: Option<f64>,
    /// Order of the finite differences' error, 2 or 4; `None` for the default.
    pub difference_order: Option<usize>,
    /// Decimation factor: one sample in this many is kept; chosen from the sampling frequency if
    /// absent.
    pub decimation: Option<usize>,
    /// Samples dropped at the start of each run after differentiation.
    ///
    /// If neither end has a number, it is the length of the filter's transient; otherwise the
    /// default is 0.
    pub skip_start: Option<usize>,
    /// Samples dropped at the end of each run, with the same default.
    pub skip_end: Option<usize>,
    /// Velocity of a joint (rad/s or m/s) below which its Coulomb friction counts as zero.
    pub velocity_dead_band: f64,
    /// Velocities of the actuators' joints (rad/s or m/s) below which their equations are left out;
    /// may be empty.
    pub standstill_velocity: Vec<f64>,
    /// Whether the torques are filtered like the positions.
    pub filter_torques: bool,
    /// Whether both sides of the equations are filtered so.
    pub filter_equations: bool,
    /// Number of decimated samples, from the first on, of validation data that count in its errors;
    /// all if absent.
    pub validation_samples: Option<usize>,
    /// Sign of velocities around reversals.
    pub reversals: Reversals,
    /// Ratio of relative standard deviations at which the elimination of parameters ends.
    pub r_sigma: f64,
    /// Kept actuators of the actuator projection, indices among all actuators.
    ///
    /// If absent, the first r that determine the platform's motion.
    pub kept_actuators: Option<Vec<usize>>,
    /// Normalisation of the residual's variance.
    pub normalisation: Normalisation,
    /// Friction model.
    pub friction: Friction,
    /// Weighted least squares (48); ordinary ones otherwise.
    pub weighted: bool,
    /// Whether the base parameters are reduced to essential ones.
    pub essential: bool,
    /// Origin of the instrumental variables.
    pub instruments: Instruments,
    /// Period of the motion, s; found from each run if absent.
    pub period: Option<f64>,
    /// Whether the gains of the drives are identified first.
    pub gains: bool,
    /// Whether the direction of gravity is identified together with the parameters.
    pub gravity_direction: bool,
    /// Whether the friction of the gears is identified first.
    pub gear_friction: bool,
    /// Whether the Stribeck velocities are identified first.
    pub stribeck_velocity: bool,
    /// Standard parameters that are known exactly, by name, SI units.
    pub known: Vec<(String, f64)>,
}

/// Reads `[identification]`, which may be missing.
pub(crate) fn identification(
    item: Option<&Item<'_, '_>>,
    robot: &Inventory<'_>,
    gravity: &[Number; 3],
) -> Identification {
    let mut settings = Identification {
        filter_order: 4,
        filter_cutoff: None,
        difference_order: None,
        decimation: None,
        skip_start: None,
        skip_end: None,
        velocity_dead_band: 0.0,
        standstill_velocity: Vec::new(),
        filter_torques: false,
        filter_equations: false,
        validation_samples: None,
        reversals: Reversals::default(),
        r_sigma: 10.0,
        kept_actuators: None,
        normalisation: Normalisation::default(),
        friction: Friction::default(),
        weighted: true,
        essential: true,
        instruments: Instruments::default(),
        period: None,
        gains: false,
        gravity_direction: false,
        gear_friction: false,
        stribeck_velocity: false,
        known: Vec::new(),
    };
    if let Some(table) = item.and_then(|item| item.table("the table `[identification]`")) {
        fill(&mut settings, &table, robot);
        settings.gravity_direction = table.get("gravity_direction").is_some_and(|item| {
            crate::experiments::gravity::direction(&item, settings.gains, gravity)
        });
        let is_corrected = settings.gains || settings.gravity_direction;
        settings.gear_friction = table
            .get("gear_friction")
            .is_some_and(|item| gears::friction(&item, is_corrected, robot));
        let is_corrected = is_corrected || settings.gear_friction;
        settings.stribeck_velocity = table
            .get("stribeck_velocity")
            .is_some_and(|item| stribeck::velocity(&item, is_corrected, robot));
        table.finish();
    }
    settings
}

fn fill(settings: &mut Identification, table: &Table<'_, '_>, robot: &Inventory<'_>) {
    let scope = robot.scope;
    let size = |key: &str, minimum| table.get(key).and_then(|i| i.size(minimum));
    let switch = |key: &str| table.get(key).and_then(|i| i.boolean()).unwrap_or(true);
    settings.filter_order = size("filter_order", 1).unwrap_or(settings.filter_order);
    settings.filter_cutoff = table
        .get("filter_cutoff")
        .and_then(|i| i.positive(Dimension::FREQUENCY, scope));
    if let Some(item) = table.get("difference_order") {
        settings.difference_order = item.size(1);
        if settings
            .difference_order
            .is_some_and(|order| !matches!(order, 2 | 4))
        {
            let error = item
                .error(Code::OUT_OF_RANGE, "`difference_order` must be 2 or 4")
                .help("4 has the smaller error; published work uses 2");
            table.context.report(error);
        }
    }
    settings.decimation = size("decimation", 1);
    settings.skip_start = size("skip_start", 0);
    settings.skip_end = size("skip_end", 0);
    if let Some(item) = table.get("velocity_dead_band") {
        // Joints may be revolute and prismatic, so the number is in the SI unit of each.
        let band = item.not_negative(Dimension::NONE, scope);
        settings.velocity_dead_band = band.unwrap_or(settings.velocity_dead_band);
    }
    if let Some(item) = table.get("standstill_velocity") {
        settings.standstill_velocity = standstill(&item, robot).unwrap_or_default();
    }
    let torques = table.get("filter_torques").and_then(|i| i.boolean());
    settings.filter_torques = torques.unwrap_or(settings.filter_torques);
    if let Some(item) = table.get("filter_equations") {
        settings.filter_equations = item.boolean().unwrap_or(settings.filter_equations);
        if settings.filter_equations && settings.filter_torques {
            let error = item
                .error(Code::CONTRADICTION, "with `filter_torques` the torques would be filtered twice")
                .help("`filter_equations` filters torques and columns alike; leave out `filter_torques`");
            table.context.report(error);
        }
    }
    settings.validation_samples = size("validation_samples", 1);
    if let Some(item) = table.get("r_sigma") {
        let ratio = item.positive(Dimension::NONE, scope);
        if ratio.is_some_and(|ratio| ratio <= 1.0) {
            let error = item
                .error(Code::OUT_OF_RANGE, "`r_sigma` must be greater than 1")
                .help("choose between 10 and 30");
            table.context.report(error);
        }
        settings.r_sigma = ratio.unwrap_or(settings.r_sigma);
    }
    settings.kept_actuators = table
        .get("kept_actuators")
        .and_then(|item| kept_actuators(&item, robot));
    let choices = [
        ("n-1", Normalisation::MinusOne),
        ("n-p", Normalisation::MinusParameters),
    ];
    if let Some(choice) = table.get("normalisation").and_then(|i| i.choice(&choices)) {
        settings.normalisation = choice.value;
    }
    let choices = [
        ("symmetric", Friction::Symmetric),
        ("asymmetric", Friction::Asymmetric),
    ];
    if let Some(choice) = table.get("friction").and_then(|i| i.choice(&choices)) {
        settings.friction = choice.value;
    }
    let choices = [
        ("averaged", Reversals::Averaged),
        ("sampled", Reversals::Sampled),
    ];
    if let Some(choice) = table.get("reversals").and_then(|i| i.choice(&choices)) {
        settings.reversals = choice.value;
    }
    let choices = [
        ("periods", Instruments::Periods),
        ("simulated", Instruments::Simulated),
        ("none", Instruments::None),
    ];
    if let Some(choice) = table.get("instruments").and_then(|i| i.choice(&choices)) {
        settings.instruments = choice.value;
    }
    settings.period = table
        .get("period")
        .and_then(|i| i.positive(Dimension::TIME, scope));
    settings.weighted = switch("weighted");
    settings.essential = switch("essential");
    let known = table.get("known");
    settings.known = known.map_or_else(Vec::new, |item| known::read(&item, robot));
    settings.gains = table
        .get("gains")
        .is_some_and(|item| known::gains(&item, &settings.known, robot));
    if let Some(item) = table.get("known").filter(|_| !settings.gains) {
        let what = String::from(
            "[identification.known] has no effect on the estimates without `gains = true` or `--gains`: known values only determine gains",
        );
        item.context.warn(what, &item.key.span);
    }
}

/// Velocities of standstill: one for all actuators or a list.
fn standstill(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Vec<f64>> {
    let kinds = robot.actuator_kinds();
    let list = if item.value.is_array() {
        item.list()?
    } else {
        vec![item.clone(); kinds.len()]
    };
    check_count(item, list.len(), kinds.len())?;
    let dimension = |kind| match position(kind) {
        Dimension::LENGTH => Dimension::SPEED,
        _ => Dimension::ANGULAR_SPEED,
    };
    // All are read, so that each error is reported.
    let each = list.iter().zip(kinds);
    let limits: Vec<Option<f64>> = each
        .map(|(item, kind)| item.not_negative(dimension(kind), robot.scope))
        .collect();
    limits.into_iter().collect()
}

/// Number of kept actuators: r, or all of a robot with fewer.
fn kept_count(robot: &Inventory<'_>) -> usize {
    robot.coordinates().len().min(robot.actuator_count())
}

fn kept_actuators(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Vec<usize>> {
    let names = robot.actuator_names();
    let given = item.strings()?;
    // For a robot without actuators only their absence is reported.
    names.usual().next()?;
    let mut kept: Vec<usize> = Vec::new();
    for name in &given {
        match names.find(&name.value) {
            Some(index) if kept.contains(&index) => {
                let message = format!("the actuator `{}` is listed twice", name.value);
                item.context
                    .report(error_at(Code::SAME_NAME, name, message));
            }
            Some(index) => kept.push(index),
            None => {
                let help = names.help(&name.value);
                let message = format!("there is no actuator `{}`", name.value);
                item.context
                    .report(error_at(Code::UNKNOWN_NAME, name, message).help(help));
            }
        }
    }
    let count = kept_count(robot);
    if given.len() != count {
        let message = format!(
            "`kept_actuators`: expected {count} names, one for each degree of freedom, found {}",
            given.len()
        );
        item.context.report(item.error(Code::WRONG_COUNT, message));
    }
    (kept.len() == count).then_some(kept)
}

fn error_at(code: Code, name: &Spanned<String>, message: String) -> crate::diagnostic::Diagnostic {
    crate::diagnostic::Diagnostic::new(code, message, name.span.clone())
}
