//! Compiles generated C with a driver program, calls its functions and reads the results.
//!
//! The repository has no `unsafe` code, so C runs in a separate process. A call is a function's
//! number followed by its inputs, an answer the error followed by the output, all as doubles. The
//! program rounds these if the C computes with shorter numbers.

use overact_codegen::Float;
use overact_codegen::backends::c::Files;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Any error of a test.
pub(crate) type Failure = Box<dyn std::error::Error>;

/// Value of an output before it is written.
pub(crate) const UNTOUCHED: f64 = 0.125;

/// A function in the driver.
#[derive(Debug, Clone)]
pub(crate) struct Call {
    /// Name without the prefix.
    pub(crate) name: String,
    /// Number of values of each argument.
    pub(crate) arguments: Vec<usize>,
    /// Number of values of the output.
    pub(crate) output: usize,
}

/// A call with its inputs.
pub(crate) struct Question {
    /// Index among the calls.
    pub(crate) call: usize,
    /// All inputs, argument by argument.
    pub(crate) inputs: Vec<f64>,
}

/// An available compiler and its optimisation level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Compiler(pub(crate) &'static str, &'static str);

impl Compiler {
    /// Available compilers among GCC and Clang; prints the others.
    pub(crate) fn all() -> Vec<Self> {
        let is_there = |compiler: &Self| {
            let there = Command::new(compiler.0).arg("--version").output().is_ok();
            if !there {
                eprintln!("skipped: there is no {}", compiler.0);
            }
            there
        };
        ["gcc", "clang"]
            .map(|name| Self(name, "-O1"))
            .into_iter()
            .filter(is_there)
            .collect()
    }

    /// The same compiler without optimisation: an eighth of the time for a large robot.
    pub(crate) fn unoptimised(self) -> Self {
        Self(self.0, "-O0")
    }
}

/// Warnings that are errors.
pub(crate) const WARNINGS: [&str; 9] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pedantic",
    "-Wconversion",
    "-Wshadow",
    "-Wdouble-promotion",
    "-Wstrict-prototypes",
];

/// Generated C as a program.
pub(crate) struct Driver {
    program: PathBuf,
    calls: Vec<Call>,
    folder: PathBuf,
}

impl Driver {
    /// Compiles a robot with the functions to call.
    pub(crate) fn build(
        compiler: Compiler,
        folder: &Path,
        files: &Files,
        calls: Vec<Call>,
        float: Float,
    ) -> Result<Self, Failure> {
        fs::create_dir_all(folder)?;
        let stem = &files.stem;
        fs::write(folder.join(format!("{stem}.h")), &files.header)?;
        fs::write(folder.join(format!("{stem}.c")), &files.source)?;
        fs::write(folder.join("driver.c"), text(stem, &calls, float)?)?;
        let program = folder.join("driver");
        let mut command = Command::new(compiler.0);
        command
            .current_dir(folder)
            .args(WARNINGS)
            .args([compiler.1, "-o"]);
        command
            .arg(&program)
            .args(["driver.c", &format!("{stem}.c"), "-lm"]);
        let printed = command.output()?;
        if !printed.status.success() {
            let printed = String::from_utf8_lossy(&printed.stderr).into_owned();
            return Err(format!("{} refuses {stem}.c:\n{printed}", compiler.0).into());
        }
        Ok(Self {
            program,
            calls,
            folder: folder.to_owned(),
        })
    }

    /// Texts of all errors, by their numbers.
    pub(crate) fn texts(&self) -> Result<Vec<String>, Failure> {
        let printed = Command::new(&self.program).arg("texts").output()?;
        let printed = String::from_utf8(printed.stdout)?;
        Ok(printed.lines().map(str::to_owned).collect())
    }

    /// Error and output of each call.
    pub(crate) fn answers(
        &self,
        questions: &[Question],
    ) -> Result<Vec<(usize, Vec<f64>)>, Failure> {
        let mut bytes = Vec::new();
        for question in questions {
            let call = question.call as f64;
            let numbers = [call].into_iter().chain(question.inputs.iter().copied());
            numbers.for_each(|number| bytes.extend(number.to_ne_bytes()));
        }
        let file = self.folder.join("questions");
        fs::write(&file, bytes)?;
        let printed = Command::new(&self.program)
            .stdin(File::open(&file)?)
            .output()?;
        if !printed.status.success() {
            return Err(format!("the driver failed: {:?}", printed.status).into());
        }
        let (numbers, rest) = printed.stdout.as_chunks::<8>();
        assert!(rest.is_empty());
        let mut numbers = numbers.iter().map(|bytes| f64::from_ne_bytes(*bytes));
        let mut answers = Vec::new();
        for question in questions {
            let length = self.calls[question.call].output;
            let error = numbers.next().ok_or("an answer is missing")?;
            let output: Vec<f64> = numbers.by_ref().take(length).collect();
            assert_eq!(output.len(), length);
            answers.push((error as usize, output));
        }
        assert!(numbers.next().is_none());
        Ok(answers)
    }
}

/// Text of the driver.
fn text(stem: &str, calls: &[Call], float: Float) -> Result<String, Failure> {
    let number = match float {
        Float::F64 => "double",
        Float::F32 => "float",
    };
    let length = |call: &Call| call.arguments.iter().sum::<usize>();
    let inputs = calls.iter().map(length).max().unwrap_or(0) + 1;
    let outputs = calls.iter().map(|call| call.output).max().unwrap_or(0) + 1;
    let mut text = format!(
        "#include \"{stem}.h\"\n#include <stdio.h>\n#include <string.h>\n\n\
         static {number} in[{inputs}];\nstatic {number} out[{outputs}];\n\n\
         static double buffer[{inputs} + {outputs}];\n\n"
    );
    let table = |name: &str, numbers: Vec<usize>| {
        let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
        format!(
            "static const size_t {name}[] = {{ {} }};\n",
            numbers.join(", ")
        )
    };
    text += &table("in_length", calls.iter().map(length).collect());
    text += &table("out_length", calls.iter().map(|call| call.output).collect());
    let partition = calls.iter().find(|call| call.name == "partition");
    text += &partition.map_or(String::new(), |call| crate::partition::wrapper(stem, call));
    text += "\nstatic int call(int number)\n{\n    switch (number) {\n";
    for (number, call) in calls.iter().enumerate() {
        let mut at = 0;
        let mut arguments = Vec::new();
        for length in &call.arguments {
            arguments.push(format!("&in[{at}]"));
            at += length;
        }
        arguments.push("out".to_owned());
        let (name, arguments) = (&call.name, arguments.join(", "));
        if call.name == "partition" {
            writeln!(text, "    case {number}: return partition();")?
        } else {
            writeln!(
                text,
                "    case {number}: return (int){stem}_{name}({arguments});"
            )?
        }
    }
    write!(
        text,
        "    default: return -1;\n    }}\n}}\n\n\
         int main(int count, char **words)\n{{\n    \
             double number;\n    \
             if ((count > 1) && (strcmp(words[1], \"texts\") == 0)) {{\n        \
                 for (int i = 0; strcmp({stem}_error_text(({stem}_error)i), \"no error of this robot\") != 0; i++) {{\n            \
                     puts({stem}_error_text(({stem}_error)i));\n        \
                 }}\n        \
                 return 0;\n    \
             }}\n    \
             while (fread(&number, sizeof number, 1, stdin) == 1) {{\n        \
                 const int which = (int)number;\n        \
                 double error;\n        \
                 if (fread(buffer, sizeof buffer[0], in_length[which], stdin) != in_length[which]) {{\n            \
                     return 1;\n        \
                 }}\n        \
                 for (size_t i = 0; i < in_length[which]; i++) {{\n            \
                     in[i] = ({number})buffer[i];\n        \
                 }}\n        \
                 for (size_t i = 0; i < out_length[which]; i++) {{\n            \
                     out[i] = ({number}){UNTOUCHED:?};\n        \
                 }}\n        \
                 error = (double)call(which);\n        \
                 if (fwrite(&error, sizeof error, 1, stdout) != 1) {{\n            \
                     return 1;\n        \
                 }}\n        \
                 for (size_t i = 0; i < out_length[which]; i++) {{\n            \
                     buffer[i] = (double)out[i];\n        \
                 }}\n        \
                 if (fwrite(buffer, sizeof buffer[0], out_length[which], stdout) != out_length[which]) {{\n            \
                     return 1;\n        \
                 }}\n    \
             }}\n    \
             return 0;\n\
         }}\n"
    )?;
    Ok(text)
}
