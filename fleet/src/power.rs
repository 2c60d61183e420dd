//! Which drifts are found when: virtual robots of which one parameter drifts by a given size, watched as those of a
//! real fleet are, and robots without drift, of which the false alarms are counted.
//!
//! Each robot makes a run a day, of which factors and estimate are made as by `factor` and `estimate`. The drift
//! grows over the middle third of the days.

use crate::chart::{Chart, Point, Rule, charts};
use overact::Model;
use overact_identification::factors::{Factory, Pool};
use overact_robot::{Error, Robot, VirtualExperiment};
use overact_simulation::{Fault, Fleet, Member, Record};
use std::collections::BTreeMap;

/// Robots that are looked through for one with a fault, for each that is wanted.
const LOOKED_THROUGH: usize = 100;

/// What is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Robots with each drift.
    pub robots: usize,
    /// Robots without drift.
    pub healthy: usize,
    /// Days, of which each robot makes a run.
    pub days: usize,
    /// Seed of everything.
    pub seed: u64,
    /// Sizes of the drifts of a first moment of mass, in percent.
    pub moments: Vec<f64>,
    /// Sizes of the drifts of viscous friction, in percent.
    pub frictions: Vec<f64>,
}

/// What became of the robots with one drift.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// What drifts.
    pub fault: Fault,
    /// By how much, in percent.
    pub percent: f64,
    /// Robots.
    pub robots: usize,
    /// Ends of the days of all looks.
    pub looks: Vec<f64>,
    /// Of each look the robots that have been accused by then of the parameter that drifts.
    pub by_look: Vec<usize>,
    /// Robots that were accused of another parameter.
    pub of_another: usize,
    /// Robots that were accused of anything before the drift began.
    pub before: usize,
    /// Robots that were accused of anything.
    pub accused: usize,
}

/// Tries all drifts, robots without drift first; `tell` hears of each before it is tried.
///
/// # Errors
/// A description without an experiment, runs that can't be made.
pub fn power(
    robot: &Robot,
    plan: &Plan,
    rule: &Rule,
    tell: &dyn Fn(Fault, f64),
) -> Result<Vec<Found>, Error> {
    let experiment = robot.experiment()?;
    let settings = robot.settings(experiment.plan().sampling_hz);
    let factory = robot.factory(&settings)?;
    let of = |fault: Fault, sizes: &[f64]| -> Vec<(Fault, f64)> {
        sizes.iter().map(|size| (fault, *size)).collect()
    };
    let all = [
        of(Fault::None, &[0.0]),
        of(Fault::Moment, &plan.moments),
        of(Fault::Friction, &plan.frictions),
    ];
    let mut found = Vec::new();
    for (fault, percent) in all.concat() {
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
        let points = points((&experiment, &factory), &fleet, &members)?;
        let charts = charts(&points, rule);
        found.push(counted(
            (robot, &members),
            (fault, percent),
            (&charts, rule.looks(&points)),
        ));
    }
    Ok(found)
}

/// The serial number of a robot.
fn serial(number: usize) -> String {
    format!("R{number:05}")
}

/// The estimates of all robots and days.
fn points(
    (experiment, factory): (&VirtualExperiment<'_>, &Factory<'_>),
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

/// Counts the accused.
fn counted(
    (robot, members): (&Robot, &[Member]),
    (fault, percent): (Fault, f64),
    (charts, looks): (&[Chart], Vec<f64>),
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
        fault,
        percent,
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
            fault != Fault::None && Some(&chart.parameter.as_str()) == names.get(member.place)
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

/// What was found, as a table of Markdown.
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
