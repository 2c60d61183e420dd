//! A DAG as text: one line for each node with a name or several users, then the output.

use crate::lowering::dag::{Angle, Dag, Definition, Edge};
use std::fmt::Write as _;

/// The text of a DAG and the total cost of its nodes.
pub(super) fn listing(dag: &Dag) -> String {
    let mut writer = Writer {
        dag,
        names: vec![None; dag.len()],
        text: String::new(),
        count: 0,
    };
    let outputs: Vec<String> = dag.entries().iter().map(|&e| writer.edge(e, 0)).collect();
    let guards: Vec<String> = dag
        .guards()
        .iter()
        .map(|g| writer.edge(g.value, 0))
        .collect();
    let mut text = writer.text;
    for guard in guards {
        let _ = writeln!(text, "guard {guard}");
    }
    let _ = writeln!(text, "output {}", outputs.join(", "));
    text
}

struct Writer<'d> {
    dag: &'d Dag,
    names: Vec<Option<String>>,
    text: String,
    count: usize,
}

impl Writer<'_> {
    /// The text of an edge inside of: 0 a sum, 1 a product, 2 a divisor or operand.
    fn edge(&mut self, edge: Edge, within: u8) -> String {
        let (own, text) = self.node(edge.node());
        let (own, text) = match (edge.is_negative(), own) {
            (false, _) => (own, text),
            (true, 2) => (1, format!("-{text}")),
            (true, _) => (1, format!("-({text})")),
        };
        if own < within {
            format!("({text})")
        } else {
            text
        }
    }

    /// Binding strength of a node's text, and the text.
    fn node(&mut self, node: usize) -> (u8, String) {
        if let Some(name) = &self.names[node] {
            return (2, name.clone());
        }
        let definition = self.dag.definition(node);
        let (own, text) = self.definition(definition);
        let name = self.dag.name(node).map(str::to_owned);
        if definition.is_leaf() || (name.is_none() && self.dag.uses(node) < 2) {
            return (own, text);
        }
        let name = name.unwrap_or_else(|| {
            self.count += 1;
            format!("t{}", self.count)
        });
        let _ = writeln!(self.text, "{name} = {text}");
        self.names[node] = Some(name.clone());
        (2, name)
    }

    fn definition(&mut self, definition: Definition) -> (u8, String) {
        match definition {
            Definition::Constant(constant) => (2, constant.value().to_string()),
            Definition::Symbol(symbol) => (2, self.symbol(symbol)),
            Definition::Sum(a, b) => {
                let (first, second) = (self.edge(a, 0), self.edge(b.positive(), 1));
                let operator = if b.is_negative() { '-' } else { '+' };
                (0, format!("{first} {operator} {second}"))
            }
            Definition::Product(a, b) => (1, format!("{} * {}", self.edge(a, 1), self.edge(b, 2))),
            Definition::Quotient(a, b) => (1, format!("{} / {}", self.edge(a, 1), self.edge(b, 2))),
            Definition::Root(a) => (2, format!("sqrt({})", self.edge(a, 0))),
            Definition::Sign(a) => (2, format!("sign({})", self.edge(a, 0))),
            Definition::ArcTangent(y, x) => (
                2,
                format!("atan2({}, {})", self.edge(y, 0), self.edge(x, 0)),
            ),
            Definition::Selection(a, b) => {
                let (value, of) = (self.edge(a, 0), self.edge(b, 0));
                (2, format!("select({value}, {of})"))
            }
            Definition::Cosine(angle) => (2, format!("cos({})", self.angle(angle))),
            Definition::Sine(angle) => (2, format!("sin({})", self.angle(angle))),
        }
    }

    fn symbol(&self, symbol: u32) -> String {
        let element = self.dag.context().symbols[symbol as usize].element;
        element.map_or_else(|| "unknown".to_owned(), |e| e.array.to_owned())
    }

    /// An angle that is not planned is in brackets.
    fn angle(&mut self, angle: Angle) -> String {
        let turn = match angle {
            Angle::Value(edge) => return self.edge(edge, 0),
            Angle::Unplanned(turn) => turn,
        };
        let direction = &self.dag.context().turns[turn as usize].direction;
        let terms = direction.terms().iter().map(|(symbol, factor)| {
            let name = self.symbol(symbol.number() as u32);
            format!("{} {name}", factor.value()).replace("1 ", "")
        });
        let mut parts: Vec<String> = terms.collect();
        if !direction.offset().is_zero() {
            parts.push(direction.offset().to_string());
        }
        format!("[{}]", parts.join(" + "))
    }
}
