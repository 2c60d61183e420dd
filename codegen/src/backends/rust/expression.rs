//! The body of a function as tokens.

use crate::backends::writing::body::Body;
use crate::backends::writing::statement::{
    Binding, Call, Expression, Operator, SineCosinePair, Statement,
};
use crate::float::Float;
use crate::lowering::{Array, Condition};
use overact_core::ActuatorGroup;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use std::ops::Range;

/// A function's body.
pub struct FunctionBody {
    /// The assignments.
    pub statements: TokenStream,
    /// The output; empty if the statements write it.
    pub value: TokenStream,
}

/// Statements and value of a body with this output, which the statements may write.
#[must_use]
pub(super) fn write(writer: &Writer<'_>, body: &Body, output: Option<&Array>) -> FunctionBody {
    let constants = constants(body, writer.float);
    let statements = body.statements.iter().map(|s| writer.statement(s));
    FunctionBody {
        statements: quote!(#constants #(#statements)*),
        value: match output {
            Some(output) => writer.output(&body.output, output),
            None => quote!(()),
        },
    }
}

/// `[f64; 3]` or `[[f64; 64]; 3]`.
#[must_use]
pub(crate) fn array_type(array: &Array, float: Float) -> TokenStream {
    let kind = kind(float);
    let length = |n: usize| Literal::usize_unsuffixed(n);
    match array.shape[..] {
        [rows, columns] => {
            let (rows, columns) = (length(rows), length(columns));
            quote!([[#kind; #columns]; #rows])
        }
        _ => {
            let len = length(array.len());
            quote!([#kind; #len])
        }
    }
}

/// The named constants of a body.
pub(super) fn constants(body: &Body, float: Float) -> TokenStream {
    let kind = kind(float);
    let constants = body.constants.iter().map(|constant| {
        let (name, value) = (ident(&constant.name), number(constant.value, float));
        let doc = format!(" {}", constant.expression);
        quote!(#[doc = #doc] const #name: #kind = #value;)
    });
    quote!(#(#constants)*)
}

pub(super) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// Converts the expressions and statements of a body to tokens.
pub(super) struct Writer<'a> {
    inputs: &'a [Array],
    float: Float,
    /// Path of the module of called functions.
    math: TokenStream,
    /// Additional argument of functions of two numbers: the mask of active legs.
    of_legs: TokenStream,
}

impl<'a> Writer<'a> {
    /// A writer for a body with these inputs.
    pub(super) fn new(inputs: &'a [Array], float: Float) -> Self {
        let math = match float {
            Float::F64 => quote!(::overact::math),
            Float::F32 => quote!(::overact::math::single),
        };
        Self {
            inputs,
            float,
            math,
            of_legs: TokenStream::new(),
        }
    }

    /// A writer for a body that is also compiled for wider vectors.
    pub(super) fn wide(inputs: &'a [Array], float: Float) -> Self {
        let narrow = Self::new(inputs, float);
        match float {
            Float::F64 => Self {
                math: quote!(::overact::math::wide),
                ..narrow
            },
            Float::F32 => narrow,
        }
    }

    /// A writer for values in lanes.
    pub(super) fn of_lanes(inputs: &'a [Array]) -> Self {
        Self {
            inputs,
            float: Float::F64,
            math: quote!(::overact::simd),
            of_legs: quote!(, at),
        }
    }

    pub(super) fn statement(&self, statement: &Statement) -> TokenStream {
        let math = &self.math;
        match statement {
            Statement::Assign { name, value } => {
                let (name, value) = (ident(name), self.tokens(value));
                quote!(let #name = #value;)
            }
            Statement::Pairs(pairs) => {
                let names = pairs.iter().map(sine_and_cosine);
                let angles = pairs.iter().map(|pair| self.tokens(&pair.angle));
                quote!(let [#(#names),*] = #math::sin_cos_all([#(#angles),*]);)
            }
            Statement::Pair(pair) => {
                let (names, angle) = (sine_and_cosine(pair), self.tokens(&pair.angle));
                quote!(let #names = #math::sin_cos(#angle);)
            }
            Statement::Guard { value, condition } => self.guard(value, condition),
            Statement::Output {
                row,
                columns,
                value,
            } => self.place(*row, columns, value),
        }
    }

    /// Numbers of the output.
    pub(super) fn place(
        &self,
        row: usize,
        columns: &Range<usize>,
        value: &Expression,
    ) -> TokenStream {
        let value = self.tokens(value);
        let [row, first, end] = [row, columns.start, columns.end].map(Literal::usize_unsuffixed);
        match columns.len() {
            1 => quote!(output[#row][#first] = #value;),
            _ => quote!(output[#row][#first..#end].fill(#value);),
        }
    }

    fn guard(&self, value: &Expression, condition: &Condition) -> TokenStream {
        let value = self.tokens(value);
        match condition {
            Condition::Reach { leg, home } => {
                let home = number(*home, self.float);
                quote!(::overact::guard::reach(#value, #home, #leg)?;)
            }
            Condition::Leg { leg, home } => {
                let home = number(*home, self.float);
                quote!(::overact::guard::leg(#value, #home, #leg)?;)
            }
            Condition::Mass => quote!(::overact::guard::mass(#value)?;),
            Condition::Size { most } => {
                let most = magnitude(*most);
                quote!(::overact::guard::size(#value, #most)?;)
            }
            Condition::Closed { leg, within } => {
                let within = number(*within, self.float);
                quote!(::overact::guard::closed(#value, #within, #leg)?;)
            }
            Condition::Coordinates { home } => {
                let home = number(*home, self.float);
                quote!(::overact::guard::coordinates(#value, #home)?;)
            }
            Condition::Platform { actuators, home } => {
                let home = number(*home, self.float);
                let actuators = match actuators {
                    ActuatorGroup::All => quote!(::overact::ActuatorGroup::All),
                    ActuatorGroup::Kept => quote!(::overact::ActuatorGroup::Kept),
                };
                quote!(::overact::guard::platform(#value, #home, #actuators)?;)
            }
        }
    }

    /// The tokens, in parentheses if the context binds more tightly.
    fn within(&self, expression: &Expression, binding: Binding) -> TokenStream {
        let tokens = self.tokens(expression);
        if expression.binding() < binding {
            quote!((#tokens))
        } else {
            tokens
        }
    }

    pub(super) fn tokens(&self, expression: &Expression) -> TokenStream {
        match expression {
            Expression::Number(value) => number(*value, self.float),
            Expression::Constant { name, negative } => {
                let name = ident(name);
                if *negative {
                    quote!(-#name)
                } else {
                    quote!(#name)
                }
            }
            Expression::Input { array, index } => {
                let name = ident(&self.inputs[*array].name);
                let index = Literal::usize_unsuffixed(*index);
                quote!(#name[#index])
            }
            Expression::Value(name) => {
                let name = ident(name);
                quote!(#name)
            }
            Expression::Negative(inner) => {
                let inner = self.within(inner, Binding::Atom);
                quote!(-#inner)
            }
            Expression::Binary(operator, operands) => {
                let (left, right) = operator.binding();
                let a = self.within(&operands[0], left);
                let b = self.within(&operands[1], right);
                match operator {
                    Operator::Add => quote!(#a + #b),
                    Operator::Sub => quote!(#a - #b),
                    Operator::Mul => quote!(#a * #b),
                    Operator::Div => quote!(#a / #b),
                }
            }
            Expression::Call(function, operands) => self.call(*function, operands),
            Expression::Broken(what) => internal_error(what),
        }
    }

    fn call(&self, function: Call, operands: &[Expression]) -> TokenStream {
        let operands = operands.iter().map(|operand| self.tokens(operand));
        let (math, of_legs) = (&self.math, &self.of_legs);
        match function {
            Call::Sqrt => quote!(#math::sqrt(#(#operands),*)),
            Call::Sign => quote!(#math::sign(#(#operands),*)),
            Call::Signed => quote!(#math::signed(#(#operands),* #of_legs)),
            Call::Atan2 => quote!(#math::atan2(#(#operands),* #of_legs)),
            Call::Sine => quote!(#math::sin_cos(#(#operands),*).0),
            Call::Cosine => quote!(#math::sin_cos(#(#operands),*).1),
        }
    }

    fn output(&self, values: &[Expression], output: &Array) -> TokenStream {
        let values: Vec<TokenStream> = values.iter().map(|value| self.tokens(value)).collect();
        match output.shape[..] {
            [_, columns] if columns > 0 => {
                let rows = values.chunks(columns).map(|row| quote!([#(#row),*]));
                quote!([#(#rows),*])
            }
            [rows, _] => {
                let rows = (0..rows).map(|_| quote!([]));
                quote!([#(#rows),*])
            }
            _ => quote!([#(#values),*]),
        }
    }
}

/// The pattern of a sine and a cosine.
fn sine_and_cosine(pair: &SineCosinePair) -> TokenStream {
    let name = |name: &Option<String>| match name {
        Some(name) => {
            let name = ident(name);
            quote!(#name)
        }
        None => quote!(_),
    };
    let (sine, cosine) = (name(&pair.sine), name(&pair.cosine));
    quote!((#sine, #cosine))
}

/// Tokens for a violated invariant of lowering.
///
/// They do not compile, so that a meaningless number does not reach a user.
fn internal_error(what: &str) -> TokenStream {
    let message = format!(
        "internal error of overact {}: {what}; please report it with the robot's description",
        env!("CARGO_PKG_VERSION")
    );
    quote!(::core::compile_error!(#message))
}

/// The floating-point type.
#[must_use]
pub fn kind(float: Float) -> TokenStream {
    match float {
        Float::F64 => quote!(::core::primitive::f64),
        Float::F32 => quote!(::core::primitive::f32),
    }
}

/// A bound of magnitudes, a power of ten, in exponent notation.
#[must_use]
pub fn magnitude(value: f64) -> TokenStream {
    let literal = format!("{value:e}").parse();
    literal.unwrap_or_else(|_| internal_error("a bound is no number"))
}

/// A number in a notation that reads back as the same value, rounded to the floating-point type.
#[must_use]
pub fn number(value: f64, float: Float) -> TokenStream {
    if !float.holds(value) {
        return internal_error("a constant is not finite");
    }
    let literal = match float {
        Float::F64 => Literal::f64_unsuffixed(value.abs()),
        Float::F32 => Literal::f32_unsuffixed(value.abs() as f32),
    };
    if value < 0.0 {
        quote!(-#literal)
    } else {
        quote!(#literal)
    }
}

#[cfg(test)]
mod tests {
    use super::{Float, number};

    #[test]
    fn floats_round_trip() {
        for value in [0.0, 1.0, -2.5, 0.1 + 0.2, 1e-300, f64::MAX] {
            let text = number(value, Float::F64).to_string().replace(' ', "");
            assert_eq!(
                text.parse::<f64>().map(f64::to_bits),
                Ok(value.to_bits()),
                "{text}"
            );
        }
    }

    #[test]
    fn short_floats_are_rounded_once() {
        for value in [0.1 + 0.2, 1.0 / 3.0, 16_777_217.0, 1e-30] {
            let text = number(value, Float::F32).to_string();
            assert_eq!(text.parse::<f32>(), Ok(value as f32), "{text}");
        }
        for value in [1e-40, 1e39] {
            assert!(
                number(value, Float::F32)
                    .to_string()
                    .contains("compile_error")
            );
        }
    }

    #[test]
    fn non_finite_numbers_become_compile_errors() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let text = number(value, Float::F64).to_string();
            assert!(
                text.contains("compile_error") && text.contains("report"),
                "{text}"
            );
        }
    }
}
