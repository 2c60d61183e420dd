//! Detection rates of drifts, from simulated robots.
//!
//! One parameter of each robot drifts by a given size over the middle third of the days. Robots
//! without drift give the false alarm rate. Each robot makes a run per day; factor and estimate are
//! computed as by `factor` and `estimate`.

use crate::chart::{Chart, Point, Rule, charts};
use overact::Model;
use overact_identification::factors::{Factory, Pool};
use overact_robot::{Error, Robot, VirtualExperiment};
use overact_simulation::{Fault, Fleet, Member, Record};
use std::collections::BTreeMap;

/// Number of candidates searched for each robot with a fault.
const LOOKED_THROUGH: usize = 100;

/// Settings of the study.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Number of robots with each drift.
    pub robots: usize,
    /// Number of robots without drift.
    pub healthy: usize,
    /// Number of days, with one run per robot and day.
    pub days: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Drifts of a first moment, in percent.
    pub moments: Vec<f64>,
    /// Drifts of viscous friction, in percent.
    pub frictions: Vec<f64>,
}

/// Drift of one parameter of each robot.
#[derive(Clone, Copy)]
struct Drift {
    /// Drifting quantity.
    fault: Fault,
    /// Size of the drift, in percent.
    percent: f64,
}

/// Results for the robots with one drift.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Drifting quantity.
    pub fault: Fault,
    /// Size of the drift, in percent.
    pub percent: f64,
    /// Number of robots.
    pub robots: usize,
    /// End of each look, in days.
    pub looks: Vec<f64>,
    /// For each look: number of robots with an alarm for the drifting parameter so far.
    pub by_look: Vec<usize>,
    /// Number of robots with an alarm for another parameter.
    pub of_another: usize,
    /// Number of robots with an alarm before the drift began.
    pub before: usize,
    /// Number of robots with any alarm.
    pub accused: usize,
}

/// Simulates all drifts, robots without drift first; `tell` receives a message before each.
///
/// # Errors
/// A description without an experiment, or runs that fail.
pub fn power(
    robot: &Robot,
    plan: &Plan,
    rule: &Rule,
    tell: &dyn Fn(Fault, f64),
) -> Result<Vec<Found>, Error> {
    let experiment = robot.experiment()?;
    let settings = robot.settings(experiment.plan().sampling_hz);
    let factory = robot.factory(&settings)?;
    let of = |fault: Fault, sizes: &[f64]| -> Vec<Drift> {
        sizes
            .iter()
            .map(|&percent| Drift { fault, percent })
            .collect()
    };
    let all = [
        of(Fault::None, &[0.0]),
        of(Fault::Moment, &plan.moments),
        of(Fault::Friction, &plan.frictions),
    ];
    let mut found = Vec::new();
    for drift in all.concat() {
        let Drift { fault, percent } = drift;
        tell(fault, percent);
        let fleet = Fleet {
            days: plan.days,
            seed: plan.seed,
            share: if fault == Fault::None { 0.0 } else { 0.25 },
            friction_drift: percent / 100.0,
            moment_drift: percent / 100.0,
        };
        let wanted = match fault {
            Fault::None => plan.healthy,
            _ => plan.robots,
        };
        let members = (0..wanted * LOOKED_THROUGH).map(|number| experiment.member(&fleet, number));
        let members: Vec<Member> = members
            .filter(|member| member.fault == fault)
            .take(wanted)
            .collect();
        let points = points(&experiment, &factory, &fleet, &members)?;
        let charts = charts(&points, rule);
        let looks = rule.looks(&points);
        found.push(counted(robot, &members, drift, &charts, looks));
    }
    Ok(found)
}

/// Serial number of a robot.
fn serial(number: usize) -> String {
    format!("R{number:05}")
}

/// Estimates of all robots and days.
fn points(
    experiment: &VirtualExperiment<'_>,
    factory: &Factory<'_>,
    fleet: &Fleet,
    members: &[Member],
) -> Result<Vec<Point>, Error> {
    let mut points = Vec::new();
    for day in 0..fleet.days {
        let one = |member: &Member, record: Record| -> Result<Point, Error> {
            let log = experiment.log_of(record)?;
            let serial = serial(member.number);
            let run = factory.run(&log, &serial, None)?;
            let mut pool = Pool::default();
            run.records()
                .into_iter()
                .for_each(|record| pool.add(record));
            let values = pool.estimate().parameters.into_iter();
            Ok(Point {
                serial,
                day: day as f64,
                values: values.map(|own| (own.name, own.value)).collect(),
            })
        };
        for point in experiment.days(fleet, members, day, &one) {
            points.push(point?);
        }
    }
    Ok(points)
}

/// Counts the alarms.
fn counted(
    robot: &Robot,
    members: &[Member],
    drift: Drift,
    charts: &[Chart],
    looks: Vec<f64>,
) -> Found {
    let info = robot.model().info();
    let names: Vec<&str> = { info.parameters.iter().chain(info.payload_parameters) }
        .map(|parameter| parameter.name)
        .collect();
    let mut alarms: BTreeMap<&str, Vec<&Chart>> = BTreeMap::new();
    for chart in charts.iter().filter(|chart| chart.alarm.is_some()) {
        alarms.entry(&chart.serial).or_default().push(chart);
    }
    let mut found = Found {
        fault: drift.fault,
        percent: drift.percent,
        robots: members.len(),
        by_look: vec![0; looks.len()],
        looks,
        of_another: 0,
        before: 0,
        accused: 0,
    };
    for member in members {
        let Some(own) = alarms.get(serial(member.number).as_str()) else {
            continue;
        };
        let drifts = |chart: &&&Chart| {
            drift.fault != Fault::None && Some(&chart.parameter.as_str()) == names.get(member.place)
        };
        found.accused += 1;
        found.of_another += usize::from(own.iter().any(|chart| !drifts(&chart)));
        let first = own.iter().filter_map(|chart| chart.alarm);
        let first = first.fold(f64::INFINITY, f64::min);
        found.before += usize::from(first < member.begin as f64);
        let right = own.iter().find(drifts).and_then(|chart| chart.alarm);
        for (count, look) in found.by_look.iter_mut().zip(&found.looks) {
            *count += usize::from(right.is_some_and(|alarm| alarm <= *look));
        }
    }
    found
}

/// Results as a Markdown table.
#[must_use]
pub fn table(found: &[Found]) -> String {
    let looks = found.first().map_or(&[][..], |own| &own.looks);
    let heads = looks
        .iter()
        .map(|look| format!(" by day {:.0} |", look.floor() + 1.0));
    let heads: String = heads.collect();
    let mut text = format!(
        "| drift | robots |{heads} of another parameter | before the drift |\n|---|---|{}---|---|\n",
        "---|".repeat(looks.len())
    );
    for own in found {
        let share = |count: &usize| match own.fault {
            Fault::None => " |".to_owned(),
            _ => format!(
                " {:.0} % |",
                100.0 * *count as f64 / own.robots.max(1) as f64
            ),
        };
        let shares: String = own.by_look.iter().map(share).collect();
        let drift = match own.fault {
            Fault::None => "none".to_owned(),
            fault => format!("{} {} %", fault.name(), own.percent),
        };
        let before = match own.fault {
            Fault::None => String::new(),
            _ => own.before.to_string(),
        };
        text.push_str(&format!(
            "| {drift} | {} |{shares} {} | {before} |\n",
            own.robots, own.of_another
        ));
    }
    text
}
