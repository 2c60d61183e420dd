//! From the text of a test case to a DAG.

use super::language::{Line, Text};
use crate::cas::{Angle, Arena, Direction, Expr, InputElement, Number, Ratio, Stream};
use crate::lowering::dag::from_arena::{Copy, from_arena};
use crate::lowering::dag::{Dag, Definition, Edge, GuardedEdge, Origin};
use crate::lowering::program::{Array, Condition};
use crate::lowering::{GuardedExpr, States};
use std::collections::HashMap;

/// Starting point of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Start {
    /// The graph that the arena makes of the expressions, as for functions of robots.
    Arena,
    /// The nodes as written, so that a pass gets nodes that the arena would have folded.
    Nodes,
}

/// A DAG with its inputs.
#[derive(Debug)]
pub(super) struct Built {
    pub(super) dag: Dag,
    pub(super) inputs: Vec<Array>,
    pub(super) output: Array,
    /// Values of inputs in the home configuration.
    home: HashMap<String, f64>,
}

impl Built {
    /// Compares accuracy at states around home and near failing guards.
    pub(super) fn measure(&mut self) {
        let home =
            |element: InputElement| Some(self.home.get(element.array).copied().unwrap_or(0.7));
        let regular = |group: usize, number: usize, element: InputElement| {
            let name: u64 = element.array.bytes().map(u64::from).sum();
            let mut stream = Stream::new(name ^ ((group * 64 + number) as u64) << 16);
            Some(home(element)? + 0.4 * stream.number())
        };
        self.dag.measure_digits(&States {
            home: &home,
            groups: &[8, 8],
            regular: &regular,
        });
    }
}

/// The DAG of some lines.
pub(super) fn build(lines: &[Line], start: Start) -> Built {
    let names = lines.iter().flat_map(|line| match line {
        Line::Input(names) => names.clone(),
        _ => Vec::new(),
    });
    let inputs = names.map(|name| Array {
        name,
        shape: vec![1],
    });
    let inputs: Vec<Array> = inputs.collect();
    let home = lines.iter().filter_map(|line| match line {
        Line::Home(name, value) => Some((name.clone(), *value)),
        _ => None,
    });
    let arena = Arena::new();
    let dag = match start {
        Start::Arena => expressions(&arena, lines),
        Start::Nodes => nodes(&arena, lines),
    };
    Built {
        output: Array {
            name: "output".to_owned(),
            shape: vec![dag.entries().len()],
        },
        home: home.collect(),
        inputs,
        dag,
    }
}

/// Leaks the name of an input array; a test has few of them.
fn array(name: &str) -> &'static str {
    name.to_owned().leak()
}

fn condition(line: &Line) -> Condition {
    let leg = "leg".to_owned();
    match line {
        Line::Reach(_) => Condition::Reach { leg, home: 0.0 },
        _ => Condition::Leg { leg, home: 1.0 },
    }
}

/// The angle of a text.
fn direction(arena: &Arena, text: &Text) -> Direction {
    let of = |text: &Text| direction(arena, text);
    match text {
        Text::Name(name) => arena.input_angle(array(name), 0),
        Text::Minus(a) => of(a).negative(),
        Text::Binary('+', a, b) => of(a).plus(&of(b)).expect("no overflow"),
        Text::Binary('-', a, b) => of(a).plus(&of(b).negative()).expect("no overflow"),
        Text::Binary('*', a, b) => match &**a {
            Text::Number(factor) => of(b).times(decimal(factor)).expect("no overflow"),
            _ => panic!("{a:?} is no factor of an angle"),
        },
        Text::Call(name, arguments) if name == "deg" => match &arguments[..] {
            [Text::Number(degrees)] => {
                Direction::constant(Angle::degrees(decimal(degrees)).expect("no overflow"))
            }
            _ => panic!("{arguments:?} are no degrees"),
        },
        _ => panic!("{text:?} is no angle"),
    }
}

fn decimal(text: &str) -> Ratio {
    Ratio::decimal(text).expect("a decimal number")
}

fn expressions(arena: &Arena, lines: &[Line]) -> Dag {
    let mut names: HashMap<String, Expr<'_>> = HashMap::new();
    let (mut entries, mut guards) = (Vec::new(), Vec::new());
    for line in lines {
        let of = |text: &Text| expression(arena, &names, text);
        match line {
            Line::Input(_) | Line::Home(..) => {}
            Line::Section(name) => arena.enter(name),
            Line::Output(texts) => entries.extend(texts.iter().map(of)),
            Line::Guard(text) | Line::Reach(text) => guards.push(GuardedExpr {
                value: of(text),
                condition: condition(line),
            }),
            Line::Let(name, text) => {
                let value = of(text);
                names.insert(name.clone(), value);
            }
            Line::Node(name, text) => {
                let value = of(text).named(name);
                names.insert(name.clone(), value);
            }
        }
    }
    from_arena(arena, &entries, &guards)
}

fn expression<'a>(arena: &'a Arena, names: &HashMap<String, Expr<'a>>, text: &Text) -> Expr<'a> {
    let of = |text: &Text| expression(arena, names, text);
    match text {
        Text::Number(number) => arena.number(Number::ratio(decimal(number))),
        Text::Name(name) => match names.get(name) {
            Some(&known) => known,
            None => arena.input(array(name), 0),
        },
        Text::Minus(a) => -of(a),
        Text::Binary('+', a, b) => of(a) + of(b),
        Text::Binary('-', a, b) => of(a) - of(b),
        Text::Binary('*', a, b) => of(a) * of(b),
        Text::Binary(_, a, b) => of(a) / of(b),
        Text::Call(name, arguments) => match (name.as_str(), &arguments[..]) {
            ("sqrt", [a]) => of(a).sqrt(),
            ("sign", [a]) => of(a).sign(),
            ("atan2", [y, x]) => of(y).atan2(of(x)),
            ("cos", [a]) => arena.cosine_and_sine(&direction(arena, a)).cosine,
            ("sin", [a]) => arena.cosine_and_sine(&direction(arena, a)).sine,
            _ => panic!(
                "there is no function {name} of {} arguments",
                arguments.len()
            ),
        },
    }
}

/// The nodes as written; equal texts are the same node.
fn nodes(arena: &Arena, lines: &[Line]) -> Dag {
    let leaves = lines.iter().flat_map(|line| match line {
        Line::Output(texts) => texts.clone(),
        Line::Let(_, text) | Line::Node(_, text) | Line::Guard(text) | Line::Reach(text) => {
            vec![text.clone()]
        }
        _ => Vec::new(),
    });
    for line in lines {
        if let Line::Input(names) = line {
            for name in names {
                arena.input_symbol(array(name), 0);
            }
        }
    }
    // Angles have to be known before the first node.
    leaves.for_each(|text| angles(arena, &text));
    let mut work = Nodes {
        arena,
        copy: Copy::new(arena),
        names: HashMap::new(),
        known: HashMap::new(),
    };
    for line in lines {
        work.line(line);
    }
    work.copy.dag
}

fn angles(arena: &Arena, text: &Text) {
    match text {
        Text::Number(_) | Text::Name(_) => {}
        Text::Minus(a) => angles(arena, a),
        Text::Binary(_, a, b) => [a, b].into_iter().for_each(|text| angles(arena, text)),
        Text::Call(name, arguments) if name == "cos" || name == "sin" => {
            arena.cosine_and_sine(&direction(arena, &arguments[0]));
        }
        Text::Call(_, arguments) => arguments.iter().for_each(|text| angles(arena, text)),
    }
}

struct Nodes<'a> {
    arena: &'a Arena,
    copy: Copy<'a>,
    names: HashMap<String, Edge>,
    known: HashMap<(Definition, Option<String>), usize>,
}

impl Nodes<'_> {
    fn line(&mut self, line: &Line) {
        match line {
            Line::Input(_) | Line::Home(..) | Line::Section(_) => {}
            Line::Output(texts) => {
                for text in texts {
                    let entry = self.edge(text, None);
                    self.copy.dag.push_entry(entry);
                }
            }
            Line::Guard(text) | Line::Reach(text) => {
                let (value, condition) = (self.edge(text, None), condition(line));
                self.copy.dag.push_guard(GuardedEdge { value, condition });
            }
            Line::Let(name, text) => {
                let edge = self.edge(text, None);
                self.names.insert(name.clone(), edge);
            }
            Line::Node(name, text) => {
                let edge = self.edge(text, Some(name));
                self.names.insert(name.clone(), edge);
            }
        }
    }

    fn edge(&mut self, text: &Text, name: Option<&str>) -> Edge {
        let definition = match text {
            Text::Name(name) if self.names.contains_key(name) => return self.names[name],
            Text::Number(_) | Text::Name(_) => return self.leaf(text),
            Text::Call(call, _) if call == "cos" || call == "sin" => return self.leaf(text),
            Text::Minus(a) => return self.edge(a, name).times(true),
            Text::Binary(operator, a, b) => {
                let (a, b) = (self.edge(a, None), self.edge(b, None));
                match operator {
                    '+' => Definition::Sum(a, b),
                    '-' => Definition::Sum(a, b.times(true)),
                    '*' => Definition::Product(a, b),
                    _ => Definition::Quotient(a, b),
                }
            }
            Text::Call(call, arguments) => {
                let a = self.edge(&arguments[0], None);
                match call.as_str() {
                    "sqrt" => Definition::Root(a),
                    "sign" => Definition::Sign(a),
                    _ => Definition::ArcTangent(a, self.edge(&arguments[1], None)),
                }
            }
        };
        let key = (definition, name.map(str::to_owned));
        if let Some(&node) = self.known.get(&key) {
            return Edge::to(node);
        }
        let dag = &mut self.copy.dag;
        let origin = Origin {
            name: name.map(Into::into),
            scope: 0,
        };
        let node = dag.push(definition, dag.fingerprint_of(definition), origin);
        self.known.insert(key, node);
        Edge::to(node)
    }

    fn leaf(&mut self, text: &Text) -> Edge {
        let expression = expression(self.arena, &HashMap::new(), text);
        self.copy.edge(expression.handle())
    }
}
