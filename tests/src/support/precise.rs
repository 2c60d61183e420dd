//! Evaluates programs in 128-bit arithmetic, to measure errors of double precision.

use astro_float_num::{BigFloat, Consts, RoundingMode, Sign};
use overact_codegen::lowering::{Operand, Operation, Program};

/// Bits of the mantissa.
const BITS: usize = 128;
/// Round to nearest, as in hardware.
const ROUNDING: RoundingMode = RoundingMode::ToEven;

/// Evaluator with 128-bit arithmetic.
#[derive(Debug)]
pub struct Precise {
    constants: Consts,
}

impl Precise {
    /// Evaluator with its constants.
    ///
    /// # Errors
    ///
    /// If there is no memory for them.
    pub fn new() -> Result<Self, super::Failure> {
        let constants = Consts::new().map_err(|e| format!("no constants: {e}"))?;
        Ok(Self { constants })
    }

    /// Entries of a program at one sample, ignoring its guards.
    pub fn evaluate(&mut self, program: &Program, inputs: &[Vec<f64>]) -> Vec<BigFloat> {
        let mut steps: Vec<BigFloat> = Vec::with_capacity(program.steps.len());
        for step in &program.steps {
            let value = |operand: Operand| fetch(operand, inputs, &steps);
            let result = match step.operation {
                Operation::Add(a, b) => value(a).add(&value(b), BITS, ROUNDING),
                Operation::Sub(a, b) => value(a).sub(&value(b), BITS, ROUNDING),
                Operation::Mul(a, b) => value(a).mul(&value(b), BITS, ROUNDING),
                Operation::Div(a, b) => value(a).div(&value(b), BITS, ROUNDING),
                Operation::Neg(a) => value(a).neg(),
                Operation::Sqrt(a) => value(a).sqrt(BITS, ROUNDING),
                Operation::Sine(a) => value(a).sin(BITS, ROUNDING, &mut self.constants),
                Operation::Cosine(a) => value(a).cos(BITS, ROUNDING, &mut self.constants),
                Operation::Sign(a) => signed(&one(), &value(a)),
                Operation::Signed(a, b) => signed(&value(a), &value(b)),
                Operation::Atan2(y, x) => self.atan2(&value(y), &value(x)),
            };
            steps.push(result);
        }
        let entry = |e: &overact_codegen::lowering::Entry| {
            let value = fetch(e.operand, inputs, &steps);
            if e.negative { value.neg() } else { value }
        };
        program.entries.iter().map(entry).collect()
    }

    fn atan2(&mut self, y: &BigFloat, x: &BigFloat) -> BigFloat {
        if x.is_zero() {
            let quarter = self
                .pi()
                .div(&BigFloat::from_f64(2.0, BITS), BITS, ROUNDING);
            return signed(&quarter, y);
        }
        let angle = y
            .div(x, BITS, ROUNDING)
            .atan(BITS, ROUNDING, &mut self.constants);
        match (x.is_negative(), y.is_negative()) {
            (false, _) => angle,
            (true, false) => angle.add(&self.pi(), BITS, ROUNDING),
            (true, true) => angle.sub(&self.pi(), BITS, ROUNDING),
        }
    }

    fn pi(&mut self) -> BigFloat {
        self.constants.pi(BITS, ROUNDING)
    }
}

fn one() -> BigFloat {
    BigFloat::from_f64(1.0, BITS)
}

/// First number with the sign of the second; zero if the second is zero.
fn signed(value: &BigFloat, sign: &BigFloat) -> BigFloat {
    match sign.sign() {
        _ if sign.is_zero() => BigFloat::from_f64(0.0, BITS),
        Some(Sign::Neg) => value.neg(),
        _ => value.clone(),
    }
}

fn fetch(operand: Operand, inputs: &[Vec<f64>], steps: &[BigFloat]) -> BigFloat {
    match operand {
        Operand::Constant(value) => BigFloat::from_f64(value, BITS),
        Operand::Input { array, index } => BigFloat::from_f64(inputs[array][index], BITS),
        Operand::Step(at) => steps[at].clone(),
    }
}

/// Nearest number of double precision.
#[must_use]
pub fn rounded(value: &BigFloat) -> f64 {
    let Some((words, _, sign, exponent, _)) = value.as_raw_parts() else {
        return f64::NAN;
    };
    // The mantissa is a fraction below one; its highest word contains all bits of a double.
    let highest = words.last().copied().unwrap_or_default();
    let magnitude = highest as f64 * 2_f64.powi(exponent - 64);
    if sign == Sign::Neg {
        -magnitude
    } else {
        magnitude
    }
}

/// Difference of an exact number and one of double precision.
#[must_use]
pub fn difference(exact: &BigFloat, value: f64) -> f64 {
    rounded(&exact.sub(&BigFloat::from_f64(value, BITS), BITS, ROUNDING))
}
