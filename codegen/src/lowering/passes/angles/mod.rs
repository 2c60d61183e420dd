//! Sines and cosines of all angles: by evaluation, or from others by the addition theorem.

mod plan;

use crate::cas::arena::Fingerprint;
use crate::cas::hasher::QuickMap;
use crate::cas::{Angle as ConstantAngle, Direction, Number};
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Angle, Constant, Dag, Definition, Edge, Origin};
use plan::{Plan, plan};

/// Replaces all unplanned sines and cosines.
pub(super) fn run(dag: &mut Dag, _: &SearchLimits) {
    dag.forget_digits();
    let turns = needed_turns(dag);
    let context = dag.context();
    let directions: Vec<Direction> = turns
        .iter()
        .map(|&turn| context.turns[turn as usize].direction.clone())
        .collect();
    let mut work = Work::new(dag);
    let mut units: Vec<CosineSine> = Vec::new();
    for (at, how) in plan(&directions) {
        let (turn, direction) = (turns[at], &directions[at]);
        let unit = match how {
            Plan::Direct => work.direct(turn, direction),
            Plan::Sum { of, rest } => {
                let mut parts = of.iter().map(|&(at, sign)| units[at].with_sign(sign < 0));
                let mut products = Vec::new();
                let mut angle = match parts.next() {
                    Some(first) => first,
                    None => work.constant(ConstantAngle::ZERO),
                };
                for part in parts {
                    angle = work.sum(angle, part, &mut products);
                }
                if !rest.offset().is_zero() {
                    let rest = work.constant(rest.offset());
                    angle = work.sum(angle, rest, &mut products);
                }
                work.composed(turn, angle, products)
            }
        };
        units.push(unit);
    }
    dag.measure_depths();
}

/// Cosine and sine of an angle.
#[derive(Clone, Copy)]
struct CosineSine {
    cosine: Edge,
    sine: Edge,
}

impl CosineSine {
    /// Cosine and sine of the negative angle, if `is_negative`.
    const fn with_sign(self, is_negative: bool) -> Self {
        Self {
            cosine: self.cosine,
            sine: self.sine.times(is_negative),
        }
    }
}

/// Indices of all angles whose sine or cosine the entries need, in the order of first use; then
/// those that only guards on the pose need.
fn needed_turns(dag: &Dag) -> Vec<u32> {
    let mut seen = vec![false; dag.len()];
    let of_guards = dag.guards().iter().map(|guard| guard.value.node());
    let roots: Vec<usize> = dag
        .entries()
        .iter()
        .map(|e| e.node())
        .chain(of_guards)
        .collect();
    let mut stack: Vec<usize> = roots.into_iter().rev().collect();
    let mut turns = Vec::new();
    while let Some(node) = stack.pop() {
        if std::mem::replace(&mut seen[node], true) {
            continue;
        }
        let definition = dag.definition(node);
        if let Definition::Cosine(Angle::Unplanned(turn)) | Definition::Sine(Angle::Unplanned(turn)) =
            definition
            && !turns.contains(&turn)
        {
            turns.push(turn);
        }
        let operands: Vec<usize> = definition.operands().collect();
        stack.extend(operands.iter().rev());
    }
    turns
}

struct Work<'d> {
    dag: &'d mut Dag,
    /// Nodes of the sines and cosines, inputs, and added nodes.
    known: QuickMap<Definition, usize>,
}

impl<'d> Work<'d> {
    fn new(dag: &'d mut Dag) -> Self {
        let is_wanted = |definition: &Definition| definition.is_leaf();
        let definitions = (0..dag.len()).map(|node| (dag.definition(node), node));
        let known = definitions.filter(|(definition, _)| is_wanted(definition));
        Self {
            known: known.collect(),
            dag,
        }
    }

    fn node(&mut self, definition: Definition) -> Edge {
        Edge::to(self.dag.node_of(definition, &mut self.known))
    }

    fn number(&mut self, value: f64) -> Edge {
        let node = self.node(Definition::Constant(Constant::new(value.abs())));
        node.times(value < 0.0)
    }

    /// The nodes of an angle's cosine and sine, used or not.
    fn nodes(&mut self, turn: u32) -> (usize, usize) {
        let cosine = self.node(Definition::Cosine(Angle::Unplanned(turn)));
        let sine = self.node(Definition::Sine(Angle::Unplanned(turn)));
        (cosine.node(), sine.node())
    }

    /// Cosine and sine of the angle's value.
    fn direct(&mut self, turn: u32, direction: &Direction) -> CosineSine {
        let angle = Angle::Value(self.value(direction));
        let (cosine, sine) = self.nodes(turn);
        self.dag.redefine(cosine, Definition::Cosine(angle));
        self.dag.redefine(sine, Definition::Sine(angle));
        self.dag.compute_together(&[cosine, sine]);
        CosineSine {
            cosine: Edge::to(cosine),
            sine: Edge::to(sine),
        }
    }

    /// Defines the angle's cosine and sine as those of a sum.
    fn composed(&mut self, turn: u32, by: CosineSine, products: Vec<usize>) -> CosineSine {
        let (cosine, sine) = self.nodes(turn);
        let mut together = products;
        for (node, by) in [(cosine, by.cosine), (sine, by.sine)] {
            // The sum's own node stays unused; the angle's node takes its definition, for later
            // angles as well.
            let definition = self.dag.definition(by.node());
            self.dag.redefine(node, definition);
            self.known.insert(definition, node);
            together.push(node);
        }
        self.dag.compute_together(&together);
        CosineSine {
            cosine: Edge::to(cosine),
            sine: Edge::to(sine),
        }
    }

    /// The value of an angle in radians.
    fn value(&mut self, direction: &Direction) -> Edge {
        let mut sum: Option<Edge> = None;
        for (symbol, factor) in direction.terms() {
            let input = self.node(Definition::Symbol(symbol.number() as u32));
            let size = factor.value().abs();
            let part = if size == 1.0 {
                input
            } else {
                let size = self.number(size);
                self.node(Definition::Product(size, input))
            };
            let part = part.times(factor.value() < 0.0);
            sum = Some(match sum {
                Some(sum) => self.node(Definition::Sum(sum, part)),
                None => part,
            });
        }
        match (sum, direction.offset()) {
            (Some(sum), offset) if offset.is_zero() => sum,
            (Some(sum), offset) => {
                let offset = self.number(offset.value());
                self.node(Definition::Sum(sum, offset))
            }
            (None, offset) => self.number(offset.value()),
        }
    }

    fn constant(&mut self, angle: ConstantAngle) -> CosineSine {
        let (cosine, sine) = angle.cosine_and_sine();
        let mut node = |number: Number| {
            let definition = Definition::Constant(Constant::new(number.value().abs()));
            let is_negative = number.value() < 0.0;
            let size = if is_negative { -number } else { number };
            let edge = match self.known.get(&definition) {
                Some(&node) => Edge::to(node),
                None => {
                    let node = self.dag.push(
                        definition,
                        Fingerprint::number(size),
                        Origin {
                            name: None,
                            scope: 0,
                        },
                    );
                    self.known.insert(definition, node);
                    Edge::to(node)
                }
            };
            edge.times(is_negative)
        };
        CosineSine {
            cosine: node(cosine),
            sine: node(sine),
        }
    }

    /// Applies the addition theorem and records the products.
    fn sum(&mut self, a: CosineSine, b: CosineSine, products: &mut Vec<usize>) -> CosineSine {
        let mut product = |a: Edge, b: Edge| {
            let product = self.node(Definition::Product(a.positive(), b.positive()));
            products.push(product.node());
            product.times(a.is_negative() != b.is_negative())
        };
        let (cc, ss) = (product(a.cosine, b.cosine), product(a.sine, b.sine));
        let (sc, cs) = (product(a.sine, b.cosine), product(a.cosine, b.sine));
        let cosine = self.node(Definition::Sum(cc, ss.times(true)));
        let sine = self.node(Definition::Sum(sc, cs));
        products.extend([cosine.node(), sine.node()]);
        CosineSine { cosine, sine }
    }
}
