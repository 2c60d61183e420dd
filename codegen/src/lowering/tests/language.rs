//! A small language of expressions for the test cases.
//!
//! The lines are:
//!
//! - `input a b`: numbers or angles;
//! - `let x = …`: a name for the text only;
//! - `x = …`: a node with a name;
//! - `section leg1`: the heading of the following lines;
//! - `guard x`: x must not be zero;
//! - `reach x`: x must not be negative;
//! - `home a = 2` and `output …, …`.
//!
//! Expressions contain `+ - * /`, parentheses, numbers, `sqrt`, `sign`, `atan2`, and `cos` and
//! `sin` of sums of inputs and `deg(30)`.

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Text {
    Number(String),
    Name(String),
    Minus(Box<Text>),
    Binary(char, Box<Text>, Box<Text>),
    Call(String, Vec<Text>),
}

/// A line of a case.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    Input(Vec<String>),
    Let(String, Text),
    Node(String, Text),
    Section(String),
    Guard(Text),
    Reach(Text),
    Home(String, f64),
    Output(Vec<Text>),
}

/// The lines of a text.
pub(super) fn parse(text: &str) -> Vec<Line> {
    let lines = text.lines().map(str::trim);
    lines.filter(|line| !line.is_empty()).map(line).collect()
}

fn line(text: &str) -> Line {
    let (word, rest) = text.split_once(' ').expect("a word and more");
    let assigned = |text: &str| {
        let (name, value) = text.split_once('=').expect("name = expression");
        (name.trim().to_owned(), expression(value))
    };
    match word {
        "input" => Line::Input(rest.split_whitespace().map(str::to_owned).collect()),
        "let" => {
            let (name, value) = assigned(rest);
            Line::Let(name, value)
        }
        "section" => Line::Section(rest.to_owned()),
        "guard" => Line::Guard(expression(rest)),
        "reach" => Line::Reach(expression(rest)),
        "home" => {
            let (name, value) = rest.split_once('=').expect("home a = 1");
            Line::Home(
                name.trim().to_owned(),
                value.trim().parse().expect("a number"),
            )
        }
        "output" => {
            let mut parser = Parser::new(rest);
            let outputs = parser.list();
            parser.end();
            Line::Output(outputs)
        }
        _ => {
            let (name, value) = assigned(text);
            Line::Node(name, value)
        }
    }
}

fn expression(text: &str) -> Text {
    let mut parser = Parser::new(text);
    let expression = parser.sum();
    parser.end();
    expression
}

struct Parser {
    tokens: Vec<String>,
    at: usize,
}

impl Parser {
    fn new(text: &str) -> Self {
        let mut tokens: Vec<String> = Vec::new();
        let mut is_open = false;
        for character in text.chars() {
            let is_word = character.is_alphanumeric() || character == '_' || character == '.';
            match tokens.last_mut().filter(|_| is_open && is_word) {
                Some(last) => last.push(character),
                None if character.is_whitespace() => {}
                None => tokens.push(character.to_string()),
            }
            is_open = is_word;
        }
        Self { tokens, at: 0 }
    }

    fn peek(&self) -> &str {
        self.tokens.get(self.at).map_or("", String::as_str)
    }

    fn next(&mut self) -> String {
        let token = self.peek().to_owned();
        self.at += 1;
        token
    }

    fn takes(&mut self, token: &str) -> bool {
        let takes = self.peek() == token;
        self.at += usize::from(takes);
        takes
    }

    fn end(&self) {
        assert_eq!(self.peek(), "", "too much in {:?}", self.tokens);
    }

    fn list(&mut self) -> Vec<Text> {
        let mut list = vec![self.sum()];
        while self.takes(",") {
            list.push(self.sum());
        }
        list
    }

    fn binary(&mut self, operators: &[&str], part: fn(&mut Self) -> Text) -> Text {
        let mut left = part(self);
        while operators.contains(&self.peek()) {
            let operator = self.next().chars().next().expect("an operator");
            left = Text::Binary(operator, Box::new(left), Box::new(part(self)));
        }
        left
    }

    fn sum(&mut self) -> Text {
        self.binary(&["+", "-"], Self::product)
    }

    fn product(&mut self) -> Text {
        self.binary(&["*", "/"], Self::factor)
    }

    fn factor(&mut self) -> Text {
        if self.takes("-") {
            return Text::Minus(Box::new(self.factor()));
        }
        if self.takes("(") {
            let inner = self.sum();
            assert!(
                self.takes(")"),
                "a parenthesis is open in {:?}",
                self.tokens
            );
            return inner;
        }
        let token = self.next();
        assert!(
            token.starts_with(char::is_alphanumeric),
            "`{token}` in {:?}",
            self.tokens
        );
        if token.starts_with(|c: char| c.is_ascii_digit()) {
            return Text::Number(token);
        }
        if !self.takes("(") {
            return Text::Name(token);
        }
        let arguments = self.list();
        assert!(self.takes(")"), "a call is open in {:?}", self.tokens);
        Text::Call(token, arguments)
    }
}
