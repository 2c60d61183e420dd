//! A C++17 header that wraps the C code of a robot.
//!
//! It needs only `<array>` and `<cstddef>`. Arrays of wrong length do not compile, matrices have
//! entries `(row, column)`, and the compiler warns about ignored errors. The functions are `inline`
//! calls of the C functions, so they allocate nothing and throw nothing.

use super::function::{extents, size};
use super::lines::documentation;
use super::naming::{Naming, is_keyword};
use super::{generated_from, in_numbers, iteration};
use crate::backends::writing::outline::Outline;
use crate::lowering::Array;
use crate::model::RobotModel;

/// Keywords of C++ that are no keywords of C, and names that the global scope of C++ has.
const WORDS: &str = "\
    and and_eq bitand bitor bool catch char16_t char32_t char8_t class co_await co_return co_yield \
    compl concept consteval constexpr constinit const_cast decltype delete dynamic_cast explicit \
    export false friend import module mutable namespace new noexcept not not_eq nullptr operator \
    or or_eq override private protected public reinterpret_cast requires static_assert static_cast \
    std template this thread_local throw true try typeid typename using virtual wchar_t xor xor_eq";

/// The types of the header; `rob` and `ROB_` are placeholders of the robot's prefix.
const TYPES: &str = "\
/** Why a function has no value; `ok` if it has one. */
using Error = ::rob_error;

/** No error. */
constexpr Error ok = ROB_OK;

/** The meaning of an error, in one sentence. */
[[nodiscard]] inline const char *text(Error error) noexcept { return ::rob_error_text(error); }

/** An array of numbers. */
template <std::size_t Length>
using Vector = std::array<double, Length>;

/** A matrix, stored row by row. */
template <std::size_t Rows, std::size_t Columns>
struct Matrix {
    std::array<double, Rows * Columns> values{};

    double &operator()(std::size_t row, std::size_t column) { return values[row * Columns + column]; }
    double operator()(std::size_t row, std::size_t column) const { return values[row * Columns + column]; }
    double *data() noexcept { return values.data(); }
    const double *data() const noexcept { return values.data(); }
    static constexpr std::size_t rows() noexcept { return Rows; }
    static constexpr std::size_t columns() noexcept { return Columns; }
};

";

/// A function as the header wraps it.
struct Wrapped<'a> {
    name: &'a str,
    summary: &'a str,
    arguments: &'a [Array],
    /// One extent for a vector, two for a matrix, as macros of sizes.
    output: Vec<String>,
}

/// The header, named `STEM.hpp`.
pub(super) fn header(model: &RobotModel, label: &str, naming: &Naming) -> String {
    let guard = naming.constant("HPP");
    let namespace = namespace(naming);
    let mut out = generated_from(label);
    out += &format!("#ifndef {guard}\n#define {guard}\n\n");
    out += &format!(
        "#include <array>\n#include <cstddef>\n\n#include \"{}.h\"\n\n",
        naming.prefix
    );
    out += &documentation(&[format!(
        "The functions of {0}.h for arrays whose lengths the compiler checks. {0}.h states the meaning, \
         units and operations of each function. They return `ok` or an error, which leaves the output \
         unchanged.",
        naming.prefix
    )]);
    out += &format!("namespace {namespace} {{\n\n");
    out += &TYPES
        .replace("::rob_", &format!("::{}_", naming.prefix))
        .replace("ROB_", &naming.constant(""));
    for function in &model.functions {
        let outline = Outline::new(model, function);
        let wrapped = Wrapped {
            name: &function.name,
            summary: function.computes.summary(),
            arguments: &outline.arguments,
            output: extents(function, naming),
        };
        out += &wrapped.written(model, naming);
    }
    if model.forward_kinematics {
        let wrapped = Wrapped {
            name: "pose_from_actuators",
            summary: "Forward kinematics: the pose that fits all actuators best by least squares, iterated from the pose `start`.",
            arguments: &iteration::forward_arguments(model),
            output: vec![naming.constant("POSE")],
        };
        out += &wrapped.written(model, naming);
    }
    out += &format!("}} // namespace {namespace}\n\n#endif\n");
    in_numbers(out, model.float)
}

impl Wrapped<'_> {
    /// Comment and inline function.
    fn written(&self, model: &RobotModel, naming: &Naming) -> String {
        let argument = |one: &Array| {
            let size = size(model, &one.name, naming);
            format!("    const Vector<{size}> &{}", one.name)
        };
        let kind = match self.output.len() {
            1 => "Vector",
            _ => "Matrix",
        };
        let mut parameters: Vec<String> = self.arguments.iter().map(argument).collect();
        parameters.push(format!("    {kind}<{}> &output", self.output.join(", ")));
        let names = self.arguments.iter().map(|one| one.name.as_str());
        let data: Vec<String> = names
            .chain(["output"])
            .map(|name| format!("{name}.data()"))
            .collect();
        let mut out = documentation(&[self.summary.to_owned()]);
        out += &format!(
            "[[nodiscard]] inline Error {}(\n{}) noexcept\n{{\n    return ::{}(\n        {});\n}}\n\n",
            self.name,
            parameters.join(",\n"),
            naming.name(self.name),
            data.join(",\n        ")
        );
        out
    }
}

/// The namespace: the robot's prefix, unless that is a word of C++.
fn namespace(naming: &Naming) -> String {
    let prefix = naming.prefix.as_str();
    if is_keyword(prefix) || WORDS.split_ascii_whitespace().any(|word| word == prefix) {
        format!("{prefix}_robot")
    } else {
        prefix.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::{Naming, namespace};

    #[test]
    fn namespaces_avoid_cpp_keywords() {
        let of = |name: &str| namespace(&Naming::new(name));
        assert_eq!(of("DualV"), "dualv");
        assert_eq!(of("Class"), "class_robot");
        assert_eq!(of("Double"), "double_robot");
        assert_eq!(of("Std"), "std_robot");
    }
}
