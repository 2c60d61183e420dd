//! The header for C++: strict compilation, and equality with the C functions that it wraps.

use crate::driver::{Compiler, Failure};
use crate::expected::{Inputs, calls, states};
use crate::{folder, model, repository};
use overact_codegen::{Effort, Float, backends::c};
use overact_robot::InterpretedRobot;
use overact_tier::by_tier;
use std::fmt::Write as _;
use std::fs;
use std::process::Command;

/// Warnings that are errors.
const WARNINGS: [&str; 8] = [
    "-std=c++17",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pedantic",
    "-Wconversion",
    "-Wshadow",
    "-Wdouble-promotion",
];

/// The C++ compiler of a C compiler.
fn cpp(compiler: &str) -> &'static str {
    match compiler {
        "clang" => "clang++",
        _ => "g++",
    }
}

/// A program that calls each function through C and C++ and returns the number of differences.
fn program(robot: &InterpretedRobot, stem: &str, states: &[Inputs], number: &str) -> String {
    let mut text = format!(
        "#include \"{stem}.hpp\"\n#include <cstdio>\n#include <cstring>\nint main()\n{{\n    int bad = 0;\n"
    );
    for (call, names) in calls(robot.model()) {
        for state in states {
            text += "    {\n";
            for (name, length) in names.iter().zip(&call.arguments) {
                let values: Vec<String> = { state[name.as_str()].iter() }
                    .map(|value| format!("static_cast<{number}>({value:?})"))
                    .collect();
                let _ = writeln!(
                    text,
                    "        const {stem}::Vector<{length}> {name}{{{{{}}}}};",
                    values.join(", ")
                );
            }
            let function = robot
                .model()
                .functions
                .iter()
                .find(|function| function.name == call.name);
            let shape = function.map_or(vec![call.output], |f| f.program.output.shape.clone());
            let shape: Vec<String> = shape.iter().map(ToString::to_string).collect();
            let kind = if shape.len() == 1 { "Vector" } else { "Matrix" };
            let own: String = names.iter().map(|name| format!("{name}, ")).collect();
            let data: String = names
                .iter()
                .map(|name| format!("{name}.data(), "))
                .collect();
            let _ = writeln!(
                text,
                "        {stem}::{kind}<{}> left{{}}, right{{}};\n        \
                 const {stem}::Error one = {stem}::{}({own}left);\n        \
                 const {stem}::Error two = {stem}_{}({data}right.data());\n        \
                 bad += one != two || std::memcmp(left.data(), right.data(), {} * sizeof({number})) != 0 ? 1 : 0;\n    }}",
                shape.join(", "),
                call.name,
                call.name,
                call.output
            );
        }
    }
    text += "    std::printf(\"%s\\n\", bad == 0 ? ";
    let _ = writeln!(
        text,
        "{stem}::text({stem}::ok) : \"different\");\n    return bad;\n}}"
    );
    text
}

/// Compiles and runs the program of a robot.
fn check(name: &str, functions: &[&str], float: Float) -> Result<(), Failure> {
    let path = repository(&format!("robots/{name}.toml"));
    let model = model(&path, Effort::None, functions, float)?;
    let files = c::files(&model, name);
    let header = c::cpp_header(&model, name);
    let robot = InterpretedRobot::new(model);
    let states = states(&robot, 2, 5);
    let number = match float {
        Float::F64 => "double",
        Float::F32 => "float",
    };
    for compiler in Compiler::all() {
        let at = folder(name).join(format!("{}_cpp_{number}", compiler.0));
        fs::create_dir_all(&at)?;
        let stem = &files.stem;
        fs::write(at.join(format!("{stem}.h")), &files.header)?;
        fs::write(at.join(format!("{stem}.c")), &files.source)?;
        fs::write(at.join(format!("{stem}.hpp")), &header)?;
        fs::write(at.join("main.cpp"), program(&robot, stem, &states, number))?;
        let run = |command: &mut Command| -> Result<(), Failure> {
            let finished = command.current_dir(&at).output()?;
            let text = String::from_utf8_lossy(&finished.stderr).into_owned();
            assert!(finished.status.success(), "{name}, {}:\n{text}", compiler.0);
            Ok(())
        };
        let source = format!("{stem}.c");
        run(Command::new(compiler.0).args(["-std=c99", "-O0", "-c", &source, "-o", "robot.o"]))?;
        let mut command = Command::new(cpp(compiler.0));
        run(command
            .args(WARNINGS)
            .args(["main.cpp", "robot.o", "-o", "program", "-lm"]))?;
        run(&mut Command::new(at.join("program")))?;
    }
    Ok(())
}

#[test]
fn the_cpp_header_gives_the_results_of_the_c_functions() -> Result<(), Failure> {
    let robots = by_tier([
        &["five_bar"][..],
        &["ankle", "emps", "five_bar", "hexapod", "rx90"],
    ]);
    for stem in robots {
        check(stem, &["control"], Float::F64)?;
    }
    check("dualv", &["twist_from_actuators"], Float::F32)
}
