//! Generated modules, online estimators and transmissions contain no panics in optimised object code,
//! and no allocation.
//!
//! All robots are compiled without the standard library into one shared object, whose panic handler
//! calls an undefined function. If a panic is reachable, the linker fails and names the function.
//! The full tier tests one robot in eight. All modules, in the nightly tier, take minutes of
//! processor time.

use overact_codegen::derivation::JointsBy;
use overact_codegen::{Effort, Request, RobotModel, Source, backends::rust, compile_with};
use overact_tests::support::library::stems;
use overact_tests::support::random::Sketch;
use overact_tests::support::{Failure, description, repository};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Function that the panic handler calls.
const PANIC_SYMBOL: &str = "a_way_to_a_panic_is_left";

#[test]
fn optimised_modules_link_without_panics() -> Result<(), Failure> {
    if !overact_tier::is_full() {
        return Ok(());
    }
    let stride = if overact_tier::is_night() { 1 } else { 8 };
    let robots = stems()?;
    let modules = robots
        .iter()
        .step_by(stride)
        .map(|stem| Ok((stem.clone(), module(stem)?)));
    let mut modules = modules.collect::<Result<Vec<_>, Failure>>()?;
    modules.push(("newton".to_owned(), with_newtons_method()?));
    let linker_message = link("robots", &modules)?;
    assert!(
        linker_message.is_none(),
        "{}",
        linker_message.unwrap_or_default()
    );
    Ok(())
}

/// Checks the method: the other test would also pass if nothing were linked.
#[test]
fn a_possible_panic_is_detected() -> Result<(), Failure> {
    if !overact_tier::is_full() {
        return Ok(());
    }
    let (stem, text) = ("emps".to_owned(), module("emps")?);
    let checked = "guard::within(&[(\"joints\", joints, 1e12)])?;";
    assert!(text.contains(checked));
    let panics = format!("{checked} assert!(joints[0] < 3.0);");
    let linker_message = link("panics", &[(stem, text.replacen(checked, &panics, 1))])?;
    assert!(linker_message.is_some_and(|linker_message| linker_message.contains(PANIC_SYMBOL)));
    Ok(())
}

/// Online estimators and transmissions, in 64 and 32 bits, without an allocator.
#[test]
fn estimators_and_transmissions_link_without_panics() -> Result<(), Failure> {
    if !overact_tier::is_full() {
        return Ok(());
    }
    let handler = panic_handler();
    let text = format!("#![no_std]\n{handler}{ESTIMATORS}");
    let linker_message = link_library("estimators", &text, &[])?;
    assert!(
        linker_message.is_none(),
        "{}",
        linker_message.unwrap_or_default()
    );
    let indexed = ESTIMATORS.replacen("covariance[0][1]", "covariance[index][1]", 1);
    let text = format!("#![no_std]\n{handler}{indexed}");
    let linker_message = link_library("estimators", &text, &[])?;
    assert!(linker_message.is_some_and(|linker_message| linker_message.contains(PANIC_SYMBOL)));
    Ok(())
}

/// Calls every function of the estimators and transmissions with numbers of the caller.
const ESTIMATORS: &str = include_str!("../panics/estimators.rs");

/// Generated module of a robot.
fn module(stem: &str) -> Result<String, Failure> {
    let source = description(stem)?;
    Ok(rust::file(&model(&source)?, &source.name))
}

/// Module of the first random mechanism whose joints need Newton's method; no robot of the library
/// does.
fn with_newtons_method() -> Result<String, Failure> {
    let drawn = (0..100).map(|seed| Sketch::draw(seed).source());
    let mut models = drawn.filter_map(|source| Some((model(&source).ok()?, source)));
    let needs = |model: &RobotModel| model.selection.joints == JointsBy::Newton;
    let found = models.find(|(model, _)| needs(model));
    let (model, source) = found.ok_or("no mechanism needs Newton's method")?;
    Ok(rust::file(&model, &source.name))
}

fn model(source: &Source) -> Result<RobotModel, Failure> {
    let request = Request::with_effort(Effort::None);
    let compiled = compile_with(source, &request).map_err(|e| e.render_plain(source))?;
    Ok(compiled.model)
}

/// Builds a shared object of modules; returns the linker's message if it fails.
fn link(name: &str, modules: &[(String, String)]) -> Result<Option<String>, Failure> {
    link_library(name, &library(modules)?, modules)
}

/// Builds a shared object of a library with modules; returns the linker's message if it fails.
fn link_library(
    name: &str,
    library: &str,
    modules: &[(String, String)],
) -> Result<Option<String>, Failure> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(folder.join("src"))?;
    fs::write(folder.join("Cargo.toml"), manifest(name))?;
    fs::write(folder.join("src/lib.rs"), library)?;
    for (stem, text) in modules {
        fs::write(folder.join(format!("src/{stem}.rs")), text)?;
    }
    let linked = ["-Clink-arg=-Wl,--no-undefined", "-Clink-arg=-lc"];
    let built = Command::new(env!("CARGO"))
        .current_dir(&folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .args(["rustc", "--release", "--offline", "--"])
        .args(linked)
        .output()?;
    let linker_message = String::from_utf8_lossy(&built.stderr).into_owned();
    Ok((!built.status.success()).then_some(linker_message))
}

fn manifest(name: &str) -> String {
    let runtime = repository("runtime");
    format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
         [lib]\ncrate-type = [\"cdylib\"]\n\n\
         [dependencies]\noveract = {{ path = '{}', default-features = false, features = [\"libm\"] }}\n\n\
         [profile.release]\npanic = \"abort\"\nlto = \"fat\"\n\n[workspace]\n",
        runtime.display()
    )
}

/// Library that exports all robots as models, so that all their functions are kept.
fn library(modules: &[(String, String)]) -> Result<String, Failure> {
    let mut text = String::from("#![no_std]\n");
    let mut robots = String::new();
    for (stem, module) in modules {
        let (_, rest) = module.split_once("pub struct ").ok_or("no type")?;
        let (name, _) = rest.split_once(';').ok_or("no unit struct")?;
        writeln!(text, "mod {stem};")?;
        write!(robots, "&{stem}::{name}, ")?;
    }
    let (count, handler) = (modules.len(), panic_handler());
    write!(
        text,
        "{handler}static ROBOTS: [&dyn overact::Model; {count}] = [{robots}];\n\
         #[unsafe(no_mangle)]\n\
         pub extern \"C\" fn robots() -> *const core::ffi::c_void {{\n    \
             (&raw const ROBOTS).cast()\n}}\n"
    )?;
    Ok(text)
}

/// Panic handler that calls an undefined function.
fn panic_handler() -> String {
    format!(
        "unsafe extern \"C\" {{ fn {PANIC_SYMBOL}() -> !; }}\n\
         #[panic_handler]\n\
         fn panic(_: &core::panic::PanicInfo<'_>) -> ! {{ unsafe {{ {PANIC_SYMBOL}() }} }}\n"
    )
}
