//! `traps ROBOTS…`: results of identifications with one known fault each, and false alarms on
//! faultless data.

use clap::Parser;
use overact_identification::Grade;
use overact_trust::{
    Failure, Subject, draw,
    traps::{Outcome, Trap, clean, identified, outcome, prepared, traps},
};
use rayon::prelude::*;
use std::{
    collections::BTreeMap,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Sets traps, and counts false alarms.
#[derive(Debug, Parser)]
struct Arguments {
    /// Descriptions with virtual experiments
    #[arg(value_name = "TOML", required = true)]
    robots: Vec<PathBuf>,
    /// Faultless draws with motions of their own, in place of the traps
    #[arg(long)]
    clean: Option<u64>,
    /// Only traps whose names contain this
    #[arg(long, default_value = "")]
    only: String,
    /// Work that is done at once
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Shorten all runs to this part of their duration
    #[arg(long, default_value_t = 1.0)]
    part: f64,
    /// Write the outcomes as JSON, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Outcomes of all traps of a robot.
fn trapped(arguments: &Arguments, path: &Path) -> Result<Vec<Outcome>, Failure> {
    let mut subject = Subject::load(path)?;
    subject.shorten(arguments.part);
    let records = prepared(&subject, &subject.experiment)?;
    let faultless = identified(&subject, records.clone())?;
    let one = |trap: &Trap| -> Result<Outcome, Failure> {
        let mut own = if trap.plant.is_empty() {
            records.clone()
        } else {
            let mut plant = Subject::altered(path, &trap.plant)?;
            plant.shorten(arguments.part);
            prepared(&plant, &plant.experiment)?
        };
        (trap.alter)(&mut own);
        let mut reported = outcome(&subject, trap, own, &faultless);
        if let Some(why) = trap.assumed {
            reported.words = format!("assumption: {why}. {}", reported.words);
        }
        eprintln!("{reported:?}");
        Ok(reported)
    };
    let all = traps(subject.info().name).into_iter();
    let mut all: Vec<Trap> = all
        .filter(|trap| trap.name.contains(&arguments.only))
        .collect();
    if arguments.only.is_empty() {
        all.insert(0, Trap::none());
    }
    all.par_iter().map(one).collect()
}

/// Largest number of characters of a message.
const WORDS: usize = 200;

/// One row for each trap of a robot.
fn table(outcomes: &[Outcome]) -> String {
    let mut text = String::from(
        "| fault | worst error | usable parameters | visible | detectable by the report | power | verdict | outcome | checks | first message |\n|---|---:|---:|---:|---:|---:|---|---|---|---|\n",
    );
    let number = |worst: &Option<(f64, String)>| match worst {
        Some((size, name)) if size.is_nan() => format!("undefined `{name}`"),
        Some((size, name)) if *size > 9999.0 => format!("{size:.0e} `{name}`"),
        Some((size, name)) => format!("{size:.1} `{name}`"),
        None => String::from("-"),
    };
    let optional = |value: Option<String>| value.unwrap_or_else(|| String::from("-"));
    for one in outcomes {
        let mut found = one.found.clone();
        let mut seen = Vec::new();
        found.retain(|kind| {
            !seen.contains(kind) && {
                seen.push(kind.clone());
                true
            }
        });
        let words = one.words.replace('|', "/").replace('\n', " ");
        let mut short: String = words.chars().take(WORDS).collect();
        if short.len() < words.len() {
            short.push('…');
        }
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {short} |",
            one.trap,
            number(&one.worst),
            number(&one.worst_listed),
            optional(one.oracle.map(|size| format!("{size:.1}"))),
            one.honest
                .map(|size| format!("{size:.1}"))
                .unwrap_or_default(),
            optional(one.power.map(|power| format!("{:.0} %", 100.0 * power))),
            one.grade.map_or("refused with an error", Grade::words),
            one.standing().name(),
            found.join(", "),
        );
    }
    text
}

/// False alarms on faultless draws of a robot, by check.
fn alarmed(arguments: &Arguments, path: &Path, draws: u64) -> Result<String, Failure> {
    let mut subject = Subject::load(path)?;
    subject.shorten(arguments.part);
    let one = |number: u64| -> Result<_, Failure> {
        let experiment = draw::varied(&subject, number)?;
        let mut experiment = experiment.clone();
        experiment.seed = number;
        let (grade, checks) = clean(&subject, prepared(&subject, &experiment)?)?;
        for check in &checks {
            eprintln!("draw {number}: {:?} {}", check.grade, check.located());
        }
        Ok((grade, checks))
    };
    let all: Vec<_> = (1..=draws)
        .into_par_iter()
        .map(one)
        .collect::<Result<_, _>>()?;
    let mut grades: BTreeMap<Grade, usize> = BTreeMap::new();
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    let mut found = 0;
    for (grade, checks) in &all {
        *grades.entry(*grade).or_default() += 1;
        found += usize::from(!checks.is_empty());
        for check in checks {
            *kinds.entry(check.kind.name()).or_default() += 1;
        }
    }
    let count = |grade: Grade| grades.get(&grade).copied().unwrap_or(0);
    Ok(format!(
        "| {} | {draws} | {} | {} | {} | {found} | {kinds:?} |\n",
        subject.info().name,
        count(Grade::Use),
        count(Grade::UseListed),
        count(Grade::DoNotUse),
    ))
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.threads)
        .build_global()?;
    if let Some(draws) = arguments.clean {
        println!(
            "| robot | draws | use | partly | no | remarks | checks that found something |\n|---|---:|---:|---:|---:|---:|---|"
        );
        for path in &arguments.robots {
            print!("{}", alarmed(arguments, path, draws)?);
        }
        return Ok(());
    }
    let mut all = Vec::new();
    for path in &arguments.robots {
        let own = trapped(arguments, path)?;
        let name = own.first().map_or("", |one| one.robot.as_str());
        println!("## {name}\n\n{}", table(&own));
        all.extend(own);
    }
    if let Some(path) = &arguments.json {
        fs::write(path, serde_json::to_string_pretty(&all)?)?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
