//! Generates modules for the tests that `generated/` does not keep as text, as a user's build
//! script does.
//!
//! These are the other robots of `robots/`, robots with all kinds of friction, springs, screws and
//! coupled motors, the DualV in each of its four partitions, robots with frames, derivatives of the
//! dynamics, and the RX90 with known parameters.
//!
//! The search for fewer operations is quick: the modules in `generated/` have a thorough one, which
//! does not affect these tests. The partitions differ in one line, so the variants are generated
//! from one description.

use overact_codegen::{
    Choice, Effort, Float, Request, Source, backends::rust, compile_with, description,
};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::{env, fs, thread};

/// A module and the text of its description.
struct Module {
    name: String,
    /// Stem of the description's file in `robots/`.
    stem: String,
    text: String,
    effort: Effort,
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../../robots");
    println!("cargo::rerun-if-changed=friction");
    println!("cargo::rerun-if-changed=framed");
    let mut modules = partitions()?;
    modules.extend(robots()?);
    modules.extend(friction()?);
    write_all(modules)?;
    framed()?;
    derived()?;
    known_parameters()
}

/// Robots of the library that `generated/` does not keep as text.
fn robots() -> Result<Vec<Module>, Box<dyn Error>> {
    let mut modules = Vec::new();
    for entry in fs::read_dir("../../robots")? {
        let path = entry?.path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let is_kept = Path::new(&format!("../../generated/src/{stem}.rs")).exists();
        if path.extension().is_some_and(|e| e == "toml") && !is_kept {
            let text = fs::read_to_string(&path)?;
            modules.push(Module::new(&stem, &stem, text, Effort::Quick));
        }
    }
    Ok(modules)
}

/// Robots with all kinds of friction, with springs, with screws and with coupled motors.
fn friction() -> Result<Vec<Module>, Box<dyn Error>> {
    let mut modules = Vec::new();
    for stem in [
        "friction_arm",
        "friction_bar",
        "motor_bar",
        "screw_arm",
        "spring_bar",
    ] {
        let text = fs::read_to_string(format!("friction/{stem}.toml"))?;
        modules.push(Module::new(stem, stem, text, Effort::Quick));
    }
    Ok(modules)
}

/// The DualV in each of its four partitions.
fn partitions() -> Result<Vec<Module>, Box<dyn Error>> {
    let dualv = fs::read_to_string("../../robots/dualv.toml")?;
    let partition = |kept: [usize; 3]| {
        let [a, b, c] = kept;
        // The description's own partition is compared with the checked-in module, token by token.
        let effort = match kept {
            [1, 2, 3] => Effort::Thorough,
            _ => Effort::Quick,
        };
        let name = format!("dualv_kept_{a}{b}{c}");
        Module::new(&name, "dualv", with_kept(&dualv, kept), effort)
    };
    let all = [[1, 2, 3], [1, 2, 4], [1, 3, 4], [2, 3, 4]];
    Ok(all.into_iter().map(partition).collect())
}

impl Module {
    fn new(name: &str, stem: &str, text: String, effort: Effort) -> Self {
        let (name, stem) = (name.to_owned(), stem.to_owned());
        Self {
            name,
            stem,
            text,
            effort,
        }
    }

    fn write(&self) -> Result<(), Box<dyn Error>> {
        let request = Request::with_effort(self.effort);
        write_as(&self.name, &self.stem, &self.text, &request)
    }
}

/// Writes modules on all processors, the first ones first.
fn write_all(modules: Vec<Module>) -> Result<(), Box<dyn Error>> {
    let waiting = Mutex::new(modules.into_iter());
    let failed = Mutex::new(Vec::new());
    let next = || {
        let mut waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.next()
    };
    let work = || {
        while let Some(module) = next() {
            if let Err(error) = module.write() {
                let mut failed = failed.lock().unwrap_or_else(PoisonError::into_inner);
                failed.push(format!("{}: {error}", module.name));
            }
        }
    };
    let count = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..count {
            scope.spawn(work);
        }
    });
    let failed = failed.into_inner().unwrap_or_else(PoisonError::into_inner);
    if failed.is_empty() {
        return Ok(());
    }
    Err(failed.join("\n").into())
}

/// Writes the module of a description for a request.
fn write_as(
    module: &str,
    stem: &str,
    text: &str,
    request: &Request<'_>,
) -> Result<(), Box<dyn Error>> {
    let name = format!("robots/{stem}.toml");
    let source = Source::new(name.as_str(), text);
    let compiled = compile_with(&source, request).map_err(|errors| errors.render_plain(&source))?;
    let file = Path::new(&env::var("OUT_DIR")?).join(format!("{module}.rs"));
    fs::write(file, rust::file(&compiled.model, &name))?;
    Ok(())
}

/// Functions of frames and of all masses, in 64 and 32 bits.
fn framed() -> Result<(), Box<dyn Error>> {
    const FUNCTIONS: [&str; 15] = [
        "tool_pose",
        "tool_jacobian",
        "tool_velocity",
        "tool_acceleration_bias",
        "tool_torques",
        "link_pose",
        "link_jacobian",
        "link_velocity",
        "link_acceleration_bias",
        "link_torques",
        "total_mass",
        "centre_of_mass",
        "centre_of_mass_jacobian",
        "kinetic_energy",
        "potential_energy",
    ];
    let choice = Choice::new(FUNCTIONS).map_err(|unknown| format!("{unknown:?}"))?;
    for stem in ["ankle", "delta", "dualv", "hexapod", "rx90"] {
        let robot = fs::read_to_string(format!("../../robots/{stem}.toml"))?;
        let frames = fs::read_to_string(format!("framed/{stem}.toml"))?;
        let text = format!("{robot}\n{frames}");
        for (suffix, float) in [("", Float::F64), ("_f32", Float::F32)] {
            let request = Request {
                functions: Some(&choice),
                float,
                ..Request::with_effort(Effort::Quick)
            };
            write_as(&format!("framed_{stem}{suffix}"), stem, &text, &request)?;
        }
    }
    Ok(())
}

/// Derivatives of the dynamics, in 64 and 32 bits.
fn derived() -> Result<(), Box<dyn Error>> {
    const FUNCTIONS: [&str; 4] = [
        "inverse_dynamics_by_displacement",
        "inverse_dynamics_by_twist",
        "forward_dynamics_by_displacement",
        "forward_dynamics_by_twist",
    ];
    let choice = Choice::new(FUNCTIONS).map_err(|unknown| format!("{unknown:?}"))?;
    for stem in ["ankle", "dualv", "rx90"] {
        let text = fs::read_to_string(format!("../../robots/{stem}.toml"))?;
        for (suffix, float) in [("", Float::F64), ("_f32", Float::F32)] {
            let request = Request {
                functions: Some(&choice),
                float,
                ..Request::with_effort(Effort::Quick)
            };
            write_as(&format!("derived_{stem}{suffix}"), stem, &text, &request)?;
        }
    }
    Ok(())
}

/// The RX90 with the parameters of its virtual experiment as constants, and a table of these.
fn known_parameters() -> Result<(), Box<dyn Error>> {
    let text = fs::read_to_string("../../robots/rx90.toml")?;
    let source = Source::new("robots/rx90.toml", text.as_str());
    let described = description::parse(&source).map_err(|errors| errors.render_plain(&source))?;
    let experiment = described.experiment.ok_or("no experiment")?;
    let parameters = experiment.parameters.into_iter();
    let given: BTreeMap<String, f64> = parameters.map(|one| (one.name.value, one.value)).collect();
    let request = Request {
        parameters: Some(&given),
        ..Request::with_effort(Effort::Quick)
    };
    write_as("known_rx90", "rx90", &text, &request)?;
    let entries: Vec<String> = given
        .iter()
        .map(|(name, value)| format!("({name:?}, {value:?})"))
        .collect();
    let table = format!(
        "/// Names and values (SI).\npub const PARAMETERS: &[(&str, f64)] = &[{}];",
        entries.join(", ")
    );
    let file = Path::new(&env::var("OUT_DIR")?).join("known_parameters.rs");
    fs::write(file, table)?;
    Ok(())
}

/// Description with other kept actuators.
fn with_kept(text: &str, kept: [usize; 3]) -> String {
    let names = kept.map(|leg| format!("\"leg{leg}\"")).join(", ");
    let line = |line: &str| {
        if line.starts_with("kept_actuators = ") {
            format!("kept_actuators = [{names}]\n")
        } else {
            format!("{line}\n")
        }
    };
    text.lines().map(line).collect()
}
