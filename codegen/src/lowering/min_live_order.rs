//! Order of a program whose results are written as soon as they are known, for few live values.
//!
//! A processor has sixteen or thirty-two registers, and values that live longer are spilled to the
//! stack. Many of a model's hundreds of results use the same velocities and accelerations. The next
//! result is the one that leaves the fewest live values; of equal ones it is the first, column by
//! column. Guarded values come first, for all legs: their roots and quotients have a long latency,
//! and overlap as long as no result of another leg is written between them. Steps and results do
//! not change.
//!
//! The cost of a result depends on all steps that it still needs. So in large programs only the
//! next results are compared; their number decreases with the number of steps.

use super::program::{Condition, Operand, Operation, Program};
use std::collections::BTreeSet;

/// The same program, ordered for few live values.
#[must_use]
pub(crate) fn schedule_min_live(program: &Program) -> Program {
    let mut order = Order::new(program);
    // Size guards are checked wherever their values are computed, so they keep nothing alive.
    let guarded = program.guards.iter();
    let guarded = guarded.filter(|guard| !matches!(guard.condition, Condition::Size { .. }));
    for step in guarded.filter_map(|guard| step(guard.operand)) {
        order.compute(step);
    }
    while let Some(next) = order.cheapest() {
        order.compute(order.results[next].step);
    }
    renumbered(program, &order.steps)
}

/// Number of compared results times the square of the number of steps.
///
/// It covers all results of a robot with seven joints, and ten of a program with ten thousand
/// steps. Both the cost of a comparison and the number of comparisons grow with the steps.
const COMPARED: usize = 1_000_000_000;

/// A number of the output that has to be computed.
struct Result {
    /// The step that computes it.
    step: usize,
    /// Change of the number of live values when it is computed, if known.
    waiting: Option<isize>,
}

struct Order<'p> {
    program: &'p Program,
    /// Remaining uses of each step.
    left: Vec<usize>,
    is_done: Vec<bool>,
    /// The steps scheduled so far.
    steps: Vec<usize>,
    /// Results in their default order, for ties.
    results: Vec<Result>,
    /// Results that are not written yet.
    open: Vec<usize>,
    /// Number of these that are compared.
    compared: usize,
    /// For each step the results whose cost depends on it.
    concerned: Vec<BTreeSet<usize>>,
}

/// Steps that a result still needs, with their uses.
#[derive(Default)]
struct Cone {
    /// Unscheduled steps, operands first.
    new: BTreeSet<usize>,
    /// Number of uses of steps by those and by the result.
    uses: Vec<(usize, usize)>,
}

impl<'p> Order<'p> {
    fn new(program: &'p Program) -> Self {
        let count = program.steps.len();
        let columns = match program.output.shape[..] {
            [_, columns] => columns.max(1),
            _ => 1,
        };
        let mut places: Vec<usize> = (0..program.entries.len()).collect();
        places.sort_by_key(|at| (at % columns, at / columns));
        let steps = places
            .into_iter()
            .filter_map(|at| step(program.entries[at].operand));
        let results: Vec<Result> = steps
            .map(|step| Result {
                step,
                waiting: None,
            })
            .collect();
        Self {
            program,
            left: program.uses(),
            is_done: vec![false; count],
            steps: Vec::with_capacity(count),
            open: (0..results.len()).collect(),
            compared: (COMPARED / count.max(1) / count.max(1)).max(1),
            results,
            concerned: vec![BTreeSet::new(); count],
        }
    }

    /// The next result: among those compared, the one that leaves the fewest live values.
    fn cheapest(&mut self) -> Option<usize> {
        let compared = self.open.len().min(self.compared);
        for place in 0..compared {
            let at = self.open[place];
            if self.results[at].waiting.is_none() {
                let cone = self.cone(self.results[at].step);
                for &(step, _) in &cone.uses {
                    self.concerned[step].insert(at);
                }
                self.results[at].waiting = Some(self.waiting(&cone));
            }
        }
        let cheapest = (0..compared).min_by_key(|&place| self.results[self.open[place]].waiting)?;
        Some(self.open.remove(cheapest))
    }

    /// Change of the number of live values when a cone is computed.
    fn waiting(&self, cone: &Cone) -> isize {
        let uses = cone.uses.iter();
        uses.map(|&(step, uses)| {
            let is_over = self.left[step] == uses;
            if self.is_done[step] {
                -isize::from(is_over)
            } else {
                isize::from(!is_over)
            }
        })
        .sum()
    }

    /// Schedules a step for a result or a guard, and invalidates the costs that this changes.
    fn compute(&mut self, step: usize) {
        let cone = self.cone(step);
        for &(step, uses) in &cone.uses {
            self.left[step] -= uses;
            for concerned in std::mem::take(&mut self.concerned[step]) {
                self.results[concerned].waiting = None;
            }
        }
        for &step in &cone.new {
            self.is_done[step] = true;
        }
        // The original order has operands first.
        self.steps.extend(cone.new);
    }

    /// The steps that a result still needs.
    fn cone(&self, result: usize) -> Cone {
        let mut cone = Cone::default();
        let mut used = vec![result];
        let mut open = vec![result];
        while let Some(at) = open.pop() {
            if self.is_done[at] || !cone.new.insert(at) {
                continue;
            }
            open.extend(partner(self.program, at));
            let operands = self.program.steps[at].operation.operands();
            let operands = operands.into_iter().filter_map(step);
            for operand in operands {
                used.push(operand);
                open.push(operand);
            }
        }
        used.sort_unstable();
        cone.uses = used
            .chunk_by(|a, b| a == b)
            .map(|same| (same[0], same.len()))
            .collect();
        cone
    }
}

/// The step of an operand.
fn step(operand: Operand) -> Option<usize> {
    match operand {
        Operand::Step(at) => Some(at),
        _ => None,
    }
}

/// The adjacent step with the cosine or sine of the same angle; both stay together.
fn partner(program: &Program, at: usize) -> Option<usize> {
    let operation = |at: usize| program.steps.get(at).map(|step| step.operation);
    let is_pair = |a: Option<Operation>, b: Option<Operation>| match (a, b) {
        (Some(Operation::Sine(a)), Some(Operation::Cosine(b)))
        | (Some(Operation::Cosine(a)), Some(Operation::Sine(b))) => a == b,
        _ => false,
    };
    if is_pair(operation(at), operation(at + 1)) {
        return Some(at + 1);
    }
    let before = at.checked_sub(1)?;
    is_pair(operation(before), operation(at)).then_some(before)
}

/// The program with its steps in another order, operands first.
fn renumbered(program: &Program, order: &[usize]) -> Program {
    let mut places = vec![0; order.len()];
    for (place, &at) in order.iter().enumerate() {
        places[at] = place;
    }
    let mut ordered = Program {
        least_torques: program.least_torques.clone(),
        steps: order.iter().map(|&at| program.steps[at].clone()).collect(),
        ..program.clone()
    };
    ordered.replace(|operand| match operand {
        Operand::Step(at) => Operand::Step(places[at]),
        other => other,
    });
    ordered
}
