//! Conversion of the DAG to a program: the needed nodes, operands first.

use super::dag::{Angle, Dag, Definition, Edge};
use super::program::{Array, Condition, Entry, Guard, Operand, Operation, Program, Step};
use crate::cas::hasher::QuickMap;
use overact_description::diagnostic::InternalError;

/// The program of a DAG whose angles are planned.
///
/// Entries are visited column by column, so that the program proceeds leg by leg.
///
/// # Errors
/// A node that no program can compute.
pub(crate) fn schedule(
    dag: &Dag,
    inputs: &[Array],
    output: &Array,
) -> Result<Program, InternalError> {
    let mut schedule = Schedule::new(dag, inputs);
    let (rows, columns) = match output.shape[..] {
        [rows, columns] => (rows, columns),
        _ => (output.len(), 1),
    };
    let count = dag.entries().len();
    let mut entries = vec![Entry::positive(Operand::Constant(0.0)); count];
    for column in 0..columns {
        for row in 0..rows {
            let at = row * columns + column;
            let edge = dag.entries().get(at).copied();
            let edge = edge.ok_or_else(|| broken(format!("there is no entry {at}")))?;
            entries[at] = schedule.entry(edge)?;
        }
    }
    let guards = schedule.guards()?;
    Ok(Program {
        least_torques: Vec::new(),
        inputs: inputs.to_vec(),
        output: output.clone(),
        entries,
        steps: schedule.steps,
        guards,
        pieces: dag.pieces(),
    })
}

fn broken(broken: String) -> InternalError {
    InternalError::new("schedule", broken)
}

struct Schedule<'d> {
    dag: &'d Dag,
    inputs: &'d [Array],
    /// Whether an entry needs the node.
    needed: Vec<bool>,
    steps: Vec<Step>,
    done: Vec<Option<Operand>>,
    /// Steps that are negatives of nodes.
    negatives: QuickMap<usize, Operand>,
    /// The group that is computed together with each node, until it is started.
    groups: QuickMap<usize, usize>,
    is_begun: Vec<bool>,
}

impl<'d> Schedule<'d> {
    fn new(dag: &'d Dag, inputs: &'d [Array]) -> Self {
        let entries = dag.entries().iter().map(|entry| entry.node());
        let guards = dag.guards().iter().map(|guard| guard.value.node());
        let groups = dag.groups().iter().enumerate();
        let members = groups.flat_map(|(group, nodes)| nodes.iter().map(move |&n| (n, group)));
        Self {
            dag,
            inputs,
            needed: dag.needed(entries.chain(guards)),
            steps: Vec::new(),
            done: vec![None; dag.len()],
            negatives: QuickMap::default(),
            groups: members.collect(),
            is_begun: vec![false; dag.groups().len()],
        }
    }

    /// A node or its negative; constants include their sign.
    fn entry(&mut self, edge: Edge) -> Result<Entry, InternalError> {
        let operand = self.node(edge.node())?;
        Ok(match operand {
            Operand::Constant(value) if edge.is_negative() => {
                Entry::positive(Operand::Constant(-value))
            }
            _ => Entry {
                operand,
                negative: edge.is_negative(),
            },
        })
    }

    /// The operand of an edge; a negative edge needs a negation first.
    fn operand(&mut self, edge: Edge) -> Result<Operand, InternalError> {
        let entry = self.entry(edge)?;
        if !entry.negative {
            return Ok(entry.operand);
        }
        if let Some(&negative) = self.negatives.get(&edge.node()) {
            return Ok(negative);
        }
        let negative = self.push(Step {
            operation: Operation::Neg(entry.operand),
            name: None,
            scope: String::new(),
        });
        self.negatives.insert(edge.node(), negative);
        Ok(negative)
    }

    /// The operand of a node; computes its whole group.
    fn node(&mut self, node: usize) -> Result<Operand, InternalError> {
        if let Some(&group) = self.groups.get(&node)
            && !std::mem::replace(&mut self.is_begun[group], true)
        {
            for &member in &self.dag.groups()[group] {
                if self.needed[member] {
                    self.single(member)?;
                }
            }
        }
        self.single(node)
    }

    fn single(&mut self, node: usize) -> Result<Operand, InternalError> {
        if let Some(operand) = self.done[node] {
            return Ok(operand);
        }
        let operand = match self.dag.definition(node) {
            Definition::Constant(constant) => Operand::Constant(constant.value()),
            Definition::Symbol(symbol) => self.input(symbol)?,
            definition => {
                let operation = self.operation(definition)?;
                self.push(Step {
                    operation,
                    name: self.dag.name(node).map(str::to_owned),
                    scope: self.dag.context().scopes[self.dag.scope(node) as usize].clone(),
                })
            }
        };
        match self.done[node].replace(operand) {
            None => Ok(operand),
            Some(_) => Err(broken(format!("node {node} is computed from itself"))),
        }
    }

    fn operation(&mut self, definition: Definition) -> Result<Operation, InternalError> {
        Ok(match definition {
            Definition::Sum(a, b) => self.sum(a, b)?,
            Definition::Product(a, b) => Operation::Mul(self.operand(a)?, self.operand(b)?),
            Definition::Quotient(a, b) => Operation::Div(self.operand(a)?, self.operand(b)?),
            Definition::Root(a) => Operation::Sqrt(self.operand(a)?),
            Definition::Sign(a) => Operation::Sign(self.operand(a)?),
            Definition::ArcTangent(y, x) => Operation::Atan2(self.operand(y)?, self.operand(x)?),
            Definition::Selection(a, b) => Operation::Signed(self.operand(a)?, self.operand(b)?),
            Definition::Cosine(Angle::Value(a)) => Operation::Cosine(self.operand(a)?),
            Definition::Sine(Angle::Value(a)) => Operation::Sine(self.operand(a)?),
            Definition::Constant(_)
            | Definition::Symbol(_)
            | Definition::Cosine(Angle::Unplanned(_))
            | Definition::Sine(Angle::Unplanned(_)) => {
                return Err(broken(format!("{definition:?} is no operation")));
            }
        })
    }

    /// ±a ± b; operands are computed in this order.
    fn sum(&mut self, a: Edge, b: Edge) -> Result<Operation, InternalError> {
        if a.is_negative() && !b.is_negative() {
            let (a, b) = (self.operand(a.positive())?, self.operand(b)?);
            return Ok(Operation::Sub(b, a));
        }
        let (a, size) = (self.operand(a)?, self.operand(b.positive())?);
        Ok(if b.is_negative() {
            Operation::Sub(a, size)
        } else {
            Operation::Add(a, size)
        })
    }

    fn push(&mut self, step: Step) -> Operand {
        self.steps.push(step);
        Operand::Step(self.steps.len() - 1)
    }

    /// The input element of a symbol.
    fn input(&self, symbol: u32) -> Result<Operand, InternalError> {
        let element = self.dag.context().symbols[symbol as usize].element;
        let element = element.ok_or_else(|| broken("something unknown is left".to_owned()))?;
        let array = self.inputs.iter().position(|a| a.name == element.array);
        let array = array.ok_or_else(|| broken(format!("`{element}` is no input")))?;
        let index = element.index;
        Ok(Operand::Input { array, index })
    }

    /// The guards, each once.
    ///
    /// Guards on signs keep the sign of their value, others do not. A linear system guards its
    /// determinant once per column, and guards of divisors may repeat it.
    fn guards(&mut self) -> Result<Vec<Guard>, InternalError> {
        let mut all = Vec::new();
        for guard in self.dag.guards() {
            let value = match guard.condition {
                Condition::Reach { .. } | Condition::Mass => guard.value,
                Condition::Leg { .. }
                | Condition::Platform { .. }
                | Condition::Closed { .. }
                | Condition::Size { .. }
                | Condition::Coordinates { .. } => guard.value.positive(),
            };
            let guard = Guard {
                operand: self.operand(value)?,
                condition: guard.condition.clone(),
            };
            if !all.contains(&guard) {
                all.push(guard);
            }
        }
        Ok(all)
    }
}
