//! Statements and expressions of a body.

use super::errors;
use super::lines::{code, comment_text};
use super::naming::Naming;
use super::tables::number;
use crate::backends::writing::body::Body;
use crate::backends::writing::statement::{
    Binding, Call, Expression, Operator, SineCosinePair, Statement,
};
use crate::lowering::{Array, Condition};
use crate::model::RobotModel;

/// Indentation of a function's body.
const INDENT: usize = 4;

/// Writes the statements and expressions of a body.
pub struct Writer<'a> {
    /// The robot.
    pub model: &'a RobotModel,
    /// Its names.
    pub naming: &'a Naming,
    /// Names of the program's inputs in the body.
    pub inputs: Vec<String>,
    /// Number of angles with a name of their own.
    pub angles: usize,
}

impl Writer<'_> {
    /// The statements of a body, and the assignments of its output.
    #[must_use]
    pub fn write(&mut self, body: &Body, output: &Array) -> String {
        let mut out = String::new();
        for constant in &body.constants {
            let (name, value) = (&constant.name, number(constant.value));
            let comment = comment_text(&constant.expression);
            out += &format!("    static const double {name} = {value}; /* {comment} */\n");
        }
        let mut sections = body.sections.iter().peekable();
        for statement in &body.statements {
            while let Some((_, heading)) = sections.next_if(|(name, _)| assigns(statement, name)) {
                out += &format!("    /* --- {heading} */\n");
            }
            out += &self.statement(statement, body, output);
        }
        if output.is_empty() {
            out += "    (void)output;\n";
        }
        for (at, value) in body.output.iter().enumerate() {
            out += &self.output(at, value);
        }
        out
    }

    fn statement(&mut self, statement: &Statement, body: &Body, output: &Array) -> String {
        match statement {
            Statement::Assign { name, value } => self.assign(name, value),
            Statement::Pairs(pairs) => pairs.iter().map(|pair| self.pair(pair, body)).collect(),
            Statement::Pair(pair) => self.pair(pair, body),
            Statement::Guard { value, condition } => self.guard(value, condition),
            Statement::Output {
                row,
                columns,
                value,
            } => {
                let width = output.shape.get(1).copied().unwrap_or_default();
                let places = columns.clone().map(|column| row * width + column);
                places.map(|at| self.output(at, value)).collect()
            }
        }
    }

    /// A number of the output.
    fn output(&self, at: usize, value: &Expression) -> String {
        code(INDENT, &format!("output[{at}] = {};", self.text(value)))
    }

    fn assign(&self, name: &str, value: &Expression) -> String {
        code(
            INDENT,
            &format!("const double {name} = {};", self.text(value)),
        )
    }

    /// Sine and cosine of an angle, which is computed once.
    fn pair(&mut self, pair: &SineCosinePair, body: &Body) -> String {
        let is_atom = matches!(pair.angle, Expression::Input { .. } | Expression::Value(_));
        let (mut out, mut angle) = (String::new(), pair.angle.clone());
        if !is_atom && pair.sine.is_some() && pair.cosine.is_some() {
            let name = self.angle(body);
            out += &self.assign(&name, &angle);
            angle = Expression::Value(name);
        }
        for (name, function) in [(&pair.sine, Call::Sine), (&pair.cosine, Call::Cosine)] {
            if let Some(name) = name {
                out += &self.assign(name, &Expression::Call(function, vec![angle.clone()]));
            }
        }
        out
    }

    /// A name that no value of the body has.
    fn angle(&mut self, body: &Body) -> String {
        loop {
            self.angles += 1;
            let name = format!("angle_{}", self.angles);
            let is_taken = body.names.contains(&name) || self.naming.is_reserved(&name);
            if !is_taken {
                return name;
            }
        }
    }

    fn guard(&self, value: &Expression, condition: &Condition) -> String {
        let holds = match condition {
            Condition::Reach { home, .. } => {
                let least = self.model.float.limits().radicand * home;
                format!("{} >= {}", self.text(value), number(least))
            }
            Condition::Mass => format!("{} > 0.0", self.text(value)),
            Condition::Closed { within: most, .. } | Condition::Size { most } => {
                format!("fabs({}) <= {}", self.text(value), number(*most))
            }
            Condition::Leg { home, .. }
            | Condition::Platform { home, .. }
            | Condition::Coordinates { home } => {
                format!(
                    "fabs({}) > {}",
                    self.text(value),
                    number(self.model.float.limits().singular * home)
                )
            }
        };
        let error = self
            .naming
            .constant(&errors::of_condition(self.model, condition));
        match condition {
            Condition::Reach { leg, home } if *home > 0.0 => {
                let singular = errors::singular_leg(self.model, leg);
                let singular = self.naming.constant(&singular);
                let is_negative = format!("!({} >= 0.0)", self.text(value));
                fails(&holds, &format!("({is_negative}) ? {error} : {singular}"))
            }
            _ => fails(&holds, &error),
        }
    }

    /// The text, in parentheses if the context binds more tightly.
    fn within(&self, expression: &Expression, binding: Binding) -> String {
        let text = self.text(expression);
        if expression.binding() < binding {
            format!("({text})")
        } else {
            text
        }
    }

    fn text(&self, expression: &Expression) -> String {
        match expression {
            Expression::Number(value) => number(*value),
            Expression::Constant { name, negative } => {
                if *negative {
                    format!("-{name}")
                } else {
                    name.clone()
                }
            }
            Expression::Input { array, index } => format!("{}[{index}]", self.inputs[*array]),
            Expression::Value(name) => name.clone(),
            Expression::Negative(inner) => format!("-{}", self.within(inner, Binding::Atom)),
            Expression::Binary(operator, operands) => {
                let (left, right) = operator.binding();
                let a = self.within(&operands[0], left);
                let b = self.within(&operands[1], right);
                let sign = match operator {
                    Operator::Add => '+',
                    Operator::Sub => '-',
                    Operator::Mul => '*',
                    Operator::Div => '/',
                };
                format!("{a} {sign} {b}")
            }
            Expression::Call(function, operands) => self.call(*function, operands),
            Expression::Broken(what) => format!("internal_error({what})"),
        }
    }

    fn call(&self, function: Call, operands: &[Expression]) -> String {
        let name = match function {
            Call::Sqrt => "sqrt".to_owned(),
            Call::Sine => "sin".to_owned(),
            Call::Cosine => "cos".to_owned(),
            Call::Atan2 => "atan2".to_owned(),
            Call::Sign => self.naming.name("sign"),
            Call::Signed => self.naming.name("signed"),
        };
        let operands: Vec<String> = operands.iter().map(|operand| self.text(operand)).collect();
        format!("{name}({})", operands.join(", "))
    }
}

/// Returns from the function with an error unless a condition holds; NaN violates it.
#[must_use]
pub fn fails(holds: &str, error: &str) -> String {
    let condition = code(INDENT, &format!("if (!({holds})) {{"));
    format!("{condition}        return {error};\n    }}\n")
}

/// Whether a statement assigns a name, alone or with another one.
fn assigns(statement: &Statement, name: &str) -> bool {
    let in_pair = |pair: &SineCosinePair| {
        let names = [&pair.sine, &pair.cosine];
        names.into_iter().flatten().any(|own| own == name)
    };
    match statement {
        Statement::Assign { name: own, .. } => own == name,
        Statement::Pairs(pairs) => pairs.iter().any(in_pair),
        Statement::Pair(pair) => in_pair(pair),
        Statement::Guard { .. } | Statement::Output { .. } => false,
    }
}
