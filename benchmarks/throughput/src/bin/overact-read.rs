//! Times reading and checking a log: `overact-read DESCRIPTION LOG` prints processor seconds.

use overact_codegen::{Source, compile};
use overact_identification::Mapping;
use overact_logs::read;
use overact_robot::InterpretedRobot;
use std::{env, fs, path::Path, process::ExitCode};

use overact::Model;

type Failure = Box<dyn std::error::Error>;

/// Processor time of this process so far, s.
fn processor_time() -> Result<f64, Failure> {
    let mut nanoseconds = 0.0;
    // Each thread is accounted separately.
    for task in fs::read_dir("/proc/self/task")? {
        let text = fs::read_to_string(task?.path().join("schedstat"))?;
        nanoseconds += text
            .split_whitespace()
            .next()
            .ok_or("no time")?
            .parse::<f64>()?;
    }
    Ok(1e-9 * nanoseconds)
}

fn run() -> Result<(), Failure> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [description, log] = &arguments[..] else {
        return Err("DESCRIPTION LOG are needed".into());
    };
    let text = fs::read_to_string(description)?;
    let compiled = compile(&Source::new(description, &text)).map_err(|e| format!("{e:?}"))?;
    let robot = InterpretedRobot::new(compiled.model);
    let mapping = Mapping::for_robot(&robot.info());
    let start = processor_time()?;
    let log = read(Path::new(log), &mapping, false)?;
    let end = processor_time()?;
    if log.samples() == 0 {
        return Err("no sample".into());
    }
    println!("{}", end - start);
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
