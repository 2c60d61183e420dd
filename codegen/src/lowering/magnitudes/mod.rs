//! Bounds of the magnitudes in a program, and guards that keep all values finite.
//!
//! Inputs are bounded by [`Largest`](overact_core::limits::Largest), and divisors from below by
//! their guards. From these follows a bound of each value as a power of two. It is rough: the bound
//! of a sum is the sum of the bounds, regardless of cancellation. A value whose bound exceeds the
//! range of its type may be infinite, and so may its dependents. Guards on the sizes of some values
//! ensure that no result is infinite or NaN, and that no finite result depends on an infinite
//! value. They are placed on a smallest set of values that intersects every path from an overflow
//! to a result ([`VertexCut`]).
//!
//! A few guards on values of moderate size can replace many on their dependents. For instance,
//! guards on an inverse matrix can replace those on all columns that it multiplies. So the set is
//! searched at several [thresholds](Threshold), and the smallest is used.

use super::program::{Condition, Guard, Operand, Operation, Program};
use super::vertex_cut::VertexCut;
use super::{LaneOutput, Lanes, LegRows, Sums};
use crate::float::Float;
use overact_core::Limits;

/// Bounds of magnitudes as powers of two, for one floating-point type.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Magnitudes {
    limits: Limits,
    /// Largest exponent of a value; roundings have room above it.
    most: f64,
    /// Thresholds for the placement of guards.
    thresholds: &'static [Threshold],
    /// Exponent below which a divisor counts as unbounded.
    least: f64,
}

/// Size of values on which guards may be placed, and the bound by a guard.
#[derive(Debug, Clone, Copy)]
struct Threshold {
    /// Guards are placed on values whose bound exceeds this exponent.
    large: f64,
    /// Largest magnitude that a guard accepts; below 2^`large`.
    guarded: f64,
}

const fn threshold(large: f64, guarded: f64) -> Threshold {
    Threshold { large, guarded }
}

/// For numbers of 64 bits.
const DOUBLE: [Threshold; 4] = [
    threshold(1022.0, 1e100),
    threshold(500.0, 1e60),
    threshold(220.0, 1e40),
    threshold(140.0, 1e30),
];

/// For numbers of 32 bits.
const SINGLE: [Threshold; 3] = [
    threshold(126.0, 1e12),
    threshold(80.0, 1e12),
    threshold(50.0, 1e12),
];

/// The bound of an element of an input array, as an exponent of two.
pub(crate) type Bounds<'b> = dyn Fn(usize, usize) -> f64 + 'b;

impl Magnitudes {
    /// Bounds for programs of a floating-point type.
    pub(crate) const fn new(float: Float) -> Self {
        match float {
            Float::F64 => Self {
                limits: float.limits(),
                most: 1022.0,
                thresholds: &DOUBLE,
                least: -1000.0,
            },
            Float::F32 => Self {
                limits: float.limits(),
                most: 126.0,
                thresholds: &SINGLE,
                least: -120.0,
            },
        }
    }

    /// Bound of an input by the name of its array.
    pub(crate) fn of_input(&self, array: &str) -> f64 {
        self.limits.largest.of(array).log2()
    }

    /// Adds guards to a program. Returns bounds of its entries, whose magnitudes are at most
    /// `most_of_entries`.
    pub(crate) fn guard(
        &self,
        program: &mut Program,
        inputs: &Bounds<'_>,
        most_of_entries: f64,
    ) -> Vec<f64> {
        let placed = self.thresholds.iter().map(|&threshold| {
            let mut walk = Walk::new(*self, threshold, program, inputs);
            walk.steps();
            let bounds = walk.entries(most_of_entries);
            (walk.guards, bounds)
        });
        let fewest = placed.min_by_key(|(guards, _)| guards.len());
        let (guards, bounds) = fewest.unwrap_or_default();
        program.guards.extend(guards);
        bounds
    }

    /// Adds guards to the programs of legs in SIMD lanes.
    pub(crate) fn guard_lanes(&self, lanes: &mut Lanes, shared: &Bounds<'_>) {
        let constants: Vec<f64> = (0..lanes.constants.first().map_or(0, Vec::len))
            .map(|at| {
                let of_legs = lanes.constants.iter().map(|leg| leg[at].abs());
                of_legs.fold(0.0, f64::max).log2()
            })
            .collect();
        let names: Vec<String> = lanes
            .program
            .inputs
            .iter()
            .map(|i| i.name.clone())
            .collect();
        let elements = lanes.inputs.clone();
        let inputs = |array: usize, index: usize| match &elements[array] {
            super::Elements::Constants => constants[index],
            // Elements of other legs have the bound of the first leg's.
            super::Elements::Scattered { of, .. } => self.of_input(&names[*of]),
            super::Elements::InTurn(_) => self.of_input(&names[array]),
            super::Elements::Shared => shared(array, index),
        };
        // Factors of a product have at most half of the exponents.
        let most = match &lanes.gathered {
            LaneOutput::Columns(_) => f64::INFINITY,
            LaneOutput::Sums(_) => self.most_of_factors(),
        };
        let bounds = self.guard(&mut lanes.program, &inputs, most);
        lanes.homes.resize(lanes.program.guards.len(), Vec::new());
        let legs = (lanes.legs.len() as f64).log2();
        if let LaneOutput::Sums(sums) = &mut lanes.gathered {
            self.guard_sums(sums, &bounds, legs);
        }
    }

    /// Largest magnitude of numbers whose products are summed.
    fn most_of_factors(&self) -> f64 {
        (self.most / 2.0 - 16.0).exp2()
    }

    /// Adds guards to the program of sums over legs, whose terms have these bounds.
    fn guard_sums(&self, sums: &mut Sums, parts: &[f64], legs: f64) {
        let (own, rest) = parts.split_at(sums.count);
        let (shared, rows) = rest.split_at(sums.count);
        let of_sums: Vec<f64> = own
            .iter()
            .zip(shared)
            .map(|(own, shared)| sum(own + legs, *shared))
            .collect();
        let of_rows = rows.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let inputs = |array: usize, index: usize| match array {
            0 => of_sums[index],
            _ => of_rows,
        };
        let most = match sums.rows {
            LegRows::Times(_) => self.most_of_factors(),
            LegRows::None | LegRows::Given(_) => f64::INFINITY,
        };
        self.guard(&mut sums.program, &inputs, most);
    }
}

/// State of the computation of bounds for a program.
struct Walk<'w> {
    magnitudes: Magnitudes,
    threshold: Threshold,
    program: &'w Program,
    inputs: &'w Bounds<'w>,
    /// For each step, the exponent to which its own guard bounds it.
    guarded: Vec<Option<f64>>,
    /// For each step, the exponent of its upper bound; infinite if it may be infinite or NaN.
    upper: Vec<f64>,
    /// For each step, the exponent of its lower bound, if it is bounded away from zero.
    lower: Vec<Option<f64>>,
    guards: Vec<Guard>,
}

impl<'w> Walk<'w> {
    fn new(
        magnitudes: Magnitudes,
        threshold: Threshold,
        program: &'w Program,
        inputs: &'w Bounds<'w>,
    ) -> Self {
        Self {
            magnitudes,
            threshold,
            program,
            inputs,
            guarded: vec![None; program.steps.len()],
            upper: Vec::new(),
            lower: Vec::new(),
            guards: Vec::new(),
        }
    }

    /// Adds guards until no result can be infinite or NaN.
    ///
    /// Guards are placed on a smallest set of steps; then the bounds are recomputed.
    fn steps(&mut self) {
        loop {
            self.bounds();
            let guarded = self.cut();
            if guarded.is_empty() {
                return;
            }
            for step in guarded {
                let bound = self.guard(Operand::Step(step), self.threshold.guarded);
                self.guarded[step] = Some(bound);
            }
        }
    }

    /// Computes the bounds of all steps.
    fn bounds(&mut self) {
        self.upper.clear();
        self.lower.clear();
        for at in 0..self.program.steps.len() {
            let operation = self.program.steps[at].operation;
            let is_finite = carriers(operation).all(|a| self.upper(a) <= self.magnitudes.most);
            let mut upper = self.upper_of(operation);
            if let Some(guarded) = self.guarded[at] {
                upper = guarded.min(upper);
            } else if !is_finite || upper > self.magnitudes.most {
                upper = f64::INFINITY;
            }
            self.upper.push(upper);
            let lower = self.guarded_from_below(Operand::Step(at));
            let lower = lower.or_else(|| self.lower_of(operation));
            let least = self.magnitudes.least;
            self.lower.push(lower.filter(|lower| *lower >= least));
        }
    }

    /// The smallest set of large steps on every path from a step that becomes large to a critical
    /// one.
    ///
    /// Critical is a step that may be infinite or NaN and is a result, or whose user may be finite
    /// nevertheless: a divisor, a direction, a velocity whose sign is used.
    fn cut(&self) -> Vec<usize> {
        let mut cut = VertexCut::new(self.program.steps.len());
        for (at, step) in self.program.steps.iter().enumerate() {
            if self.upper[at] > self.threshold.large {
                let mut larger = carriers(step.operation).filter_map(|a| self.large(a));
                match larger.next() {
                    Some(first) => larger.chain([first]).for_each(|from| cut.edge(from, at)),
                    None => cut.source(at),
                }
            }
            let ends = ends(step.operation).filter_map(|a| self.unbounded(a));
            ends.for_each(|end| cut.sink(end));
        }
        let results = self.program.entries.iter();
        let results = results.filter_map(|entry| self.unbounded(entry.operand));
        results.for_each(|result| cut.sink(result));
        cut.smallest()
    }

    /// The step of an operand, if it may be infinite or NaN.
    fn unbounded(&self, operand: Operand) -> Option<usize> {
        match operand {
            Operand::Step(at) if self.upper[at] == f64::INFINITY => Some(at),
            _ => None,
        }
    }

    /// The step of an operand, if its bound exceeds the threshold.
    fn large(&self, operand: Operand) -> Option<usize> {
        match operand {
            Operand::Step(at) if self.upper[at] > self.threshold.large => Some(at),
            _ => None,
        }
    }

    /// Bounds of the entries; guards those that exceed `most`.
    fn entries(&mut self, most: f64) -> Vec<f64> {
        let mut bounds = Vec::with_capacity(self.program.entries.len());
        for entry in &self.program.entries {
            let mut bound = self.upper(entry.operand);
            if bound > most.log2() {
                bound = self.guard(entry.operand, most.min(self.threshold.guarded));
                if let Operand::Step(at) = entry.operand {
                    self.upper[at] = bound;
                }
            }
            bounds.push(bound);
        }
        bounds
    }

    /// Bounds a value by a guard; returns its exponent.
    fn guard(&mut self, operand: Operand, most: f64) -> f64 {
        self.guards.push(Guard {
            operand,
            condition: Condition::Size { most },
        });
        most.log2()
    }

    fn upper(&self, operand: Operand) -> f64 {
        match operand {
            Operand::Constant(value) => value.abs().log2(),
            Operand::Input { array, index } => (self.inputs)(array, index),
            Operand::Step(at) => self.upper[at],
        }
    }

    fn lower(&self, operand: Operand) -> Option<f64> {
        match operand {
            Operand::Constant(value) => (value != 0.0).then(|| value.abs().log2()),
            Operand::Input { .. } => self.guarded_from_below(operand),
            Operand::Step(at) => self.lower[at],
        }
    }

    /// Exponent of the lower bound of a value that its guards ensure.
    fn guarded_from_below(&self, operand: Operand) -> Option<f64> {
        let limits = &self.magnitudes.limits;
        let own = self.program.guards.iter().filter(|g| g.operand == operand);
        let bounds = own.filter_map(|guard| {
            let least = match guard.condition {
                Condition::Leg { home, .. }
                | Condition::Platform { home, .. }
                | Condition::Coordinates { home } => limits.singular * home.abs(),
                Condition::Reach { home, .. } => limits.radicand * home,
                Condition::Closed { .. } | Condition::Mass | Condition::Size { .. } => 0.0,
            };
            (least > 0.0).then(|| least.log2())
        });
        bounds.reduce(f64::max)
    }

    fn upper_of(&self, operation: Operation) -> f64 {
        let of = |operand| self.upper(operand);
        match operation {
            Operation::Add(a, b) | Operation::Sub(a, b) => sum(of(a), of(b)),
            Operation::Mul(a, b) => product(of(a), of(b)),
            Operation::Div(a, b) => match self.lower(b) {
                Some(least) => of(a) - least,
                None => f64::INFINITY,
            },
            Operation::Neg(a) | Operation::Signed(a, _) => of(a),
            Operation::Sqrt(a) => of(a) / 2.0,
            Operation::Sine(_) | Operation::Cosine(_) | Operation::Sign(_) => 0.0,
            Operation::Atan2(..) => 2.0,
        }
    }

    fn lower_of(&self, operation: Operation) -> Option<f64> {
        match operation {
            Operation::Mul(a, b) => Some(self.lower(a)? + self.lower(b)?),
            Operation::Div(a, b) => Some(self.lower(a)? - self.upper(b)),
            Operation::Neg(a) => self.lower(a),
            Operation::Sqrt(a) => Some(self.lower(a)? / 2.0),
            _ => None,
        }
    }
}

/// Operands that make the result infinite or NaN if they are.
fn carriers(operation: Operation) -> impl Iterator<Item = Operand> {
    let (first, second) = match operation {
        Operation::Add(a, b) | Operation::Sub(a, b) | Operation::Mul(a, b) => (Some(a), Some(b)),
        Operation::Div(a, _)
        | Operation::Signed(a, _)
        | Operation::Neg(a)
        | Operation::Sqrt(a)
        | Operation::Sine(a)
        | Operation::Cosine(a) => (Some(a), None),
        Operation::Sign(_) | Operation::Atan2(..) => (None, None),
    };
    first.into_iter().chain(second)
}

/// Operands whose result may be finite although they are not.
fn ends(operation: Operation) -> impl Iterator<Item = Operand> {
    let (first, second) = match operation {
        Operation::Div(_, b) | Operation::Signed(_, b) => (Some(b), None),
        Operation::Sign(a) => (Some(a), None),
        Operation::Atan2(a, b) => (Some(a), Some(b)),
        _ => (None, None),
    };
    first.into_iter().chain(second)
}

/// The exponent of a sum of magnitudes.
fn sum(a: f64, b: f64) -> f64 {
    let (larger, smaller) = (a.max(b), a.min(b));
    if smaller == f64::NEG_INFINITY || larger == f64::INFINITY {
        return larger;
    }
    larger + (smaller - larger).exp2().ln_1p() / std::f64::consts::LN_2
}

/// The exponent of a product of magnitudes; that of zero is -∞.
fn product(a: f64, b: f64) -> f64 {
    if a == f64::NEG_INFINITY || b == f64::NEG_INFINITY {
        return f64::NEG_INFINITY;
    }
    a + b
}

#[cfg(test)]
mod tests;
