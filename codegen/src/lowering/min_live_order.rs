//! The order of a program whose results are written as soon as they are known.
//!
//! A processor has sixteen registers, or thirty-two. A value that waits longer for its last use is written to the stack,
//! and of a model's hundreds of results many are made of the same velocities and accelerations. Which of them is computed
//! next is therefore chosen by how many values wait after it: the one that leaves the fewest, of equal ones the first
//! column by column. What conditions are on comes first, of all legs: their roots and quotients take long, and do so side
//! by side as long as no result of another leg is written between them. The steps and their results stay what they are.
//!
//! To tell what a result costs all has to be seen that is still to be computed for it, so of a large program only the next
//! results are compared, the fewer the more steps there are.

use super::program::{Condition, Operand, Operation, Program};
use std::collections::BTreeSet;

/// The same program in an order in which few values wait for their last use.
#[must_use]
pub(crate) fn schedule_min_live(program: &Program) -> Program {
    let mut order = Order::new(program);
    // Sizes are looked at wherever their values stand: nothing waits for them.
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

/// Over the square of the number of steps, how many results are compared: all that a robot of seven joints has, and ten
/// where there are ten thousand steps. What a comparison looks at grows with the steps, and so does how often it is made.
const COMPARED: usize = 1_000_000_000;

/// A number of the output that has to be computed.
struct Result {
    /// The step that computes it.
    step: usize,
    /// By how many more values wait once it is computed, if that is known.
    waiting: Option<isize>,
}

struct Order<'p> {
    program: &'p Program,
    /// How often each step is still to be used.
    left: Vec<usize>,
    is_done: Vec<bool>,
    /// The steps so far.
    steps: Vec<usize>,
    /// In the order in which they are taken where nothing else tells them apart.
    results: Vec<Result>,
    /// Those that are not written yet.
    open: Vec<usize>,
    /// How many of these are compared.
    compared: usize,
    /// For each step the results whose cost depends on it.
    concerned: Vec<BTreeSet<usize>>,
}

/// What is to be computed for a result, with the uses of steps by it.
#[derive(Default)]
struct Cone {
    /// Steps that are not done yet, operands first.
    new: BTreeSet<usize>,
    /// How often steps are used by those and by the result.
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

    /// The next result: of those that are compared the one that leaves the fewest values waiting.
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

    /// By how many more values wait once a cone is computed.
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

    /// Computes a step for a result or a condition, and forgets the costs that this changes.
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
        // As they were, operands stand first.
        self.steps.extend(cone.new);
    }

    /// What is to be computed for a result.
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

/// The step that an operand is the result of.
fn step(operand: Operand) -> Option<usize> {
    match operand {
        Operand::Step(at) => Some(at),
        _ => None,
    }
}

/// The step beside one that is its cosine or sine: the two stay together.
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
        steps: order.iter().map(|&at| program.steps[at].clone()).collect(),
        ..program.clone()
    };
    ordered.replace(|operand| match operand {
        Operand::Step(at) => Operand::Step(places[at]),
        other => other,
    });
    ordered
}
