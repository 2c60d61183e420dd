//! Symbols: elements of input arrays, placeholders of unknowns, and free names.

use super::super::direction::{Direction, SymbolId};
use super::super::field::{Element, mix, mix_name};
use super::super::sample::Sample;
use super::expr::Expr;
use super::{Arena, Fingerprint, Op, POINTS};
use overact_exact::Number;

/// An element of an input array of a function, such as `pose[2]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InputElement {
    /// Name of the array.
    pub array: &'static str,
    /// Which element, counted from zero.
    pub index: usize,
}

impl std::fmt::Display for InputElement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}[{}]", self.array, self.index)
    }
}

/// What a symbol represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SymbolKind {
    /// An element of a function's input array.
    Input(InputElement),
    /// An unknown in the search for equations.
    Placeholder,
    /// A free variable, identified by its name.
    Free,
}

#[derive(Debug)]
pub(super) struct Symbol {
    pub(super) name: String,
    /// Fingerprint of the symbol as a number.
    pub(super) fingerprint: Fingerprint,
    /// Points on the field's unit circle for the symbol as an angle.
    pub(super) circle: [Element; POINTS],
    /// Real sample of the symbol as a number or an angle.
    pub(super) sample: f64,
    kind: SymbolKind,
    /// Fingerprint of an arbitrary number, if the symbol's own is that of a sign.
    as_any: Option<Fingerprint>,
}

impl Symbol {
    fn new(name: &str, kind: SymbolKind) -> Self {
        let seed = mix_name(name);
        let sample = Sample::of_bits(seed ^ 5);
        Self {
            name: name.to_owned(),
            fingerprint: Fingerprint {
                image: std::array::from_fn(|k| Element::from_bits(mix(seed ^ (k as u64 + 101)))),
                sample,
            },
            circle: std::array::from_fn(|k| Element::circle_point(mix(seed ^ (k as u64 + 11)))),
            sample: sample.re(),
            kind,
            as_any: None,
        }
    }

    pub(super) fn is_placeholder(&self) -> bool {
        self.kind == SymbolKind::Placeholder
    }
}

impl Arena {
    /// Name of a symbol.
    #[must_use]
    pub fn symbol_name(&self, id: SymbolId) -> String {
        self.tables.borrow().symbols[id.0 as usize].name.clone()
    }

    /// The element of an input array that a symbol represents, if any.
    #[must_use]
    pub fn input_element(&self, id: SymbolId) -> Option<InputElement> {
        match self.tables.borrow().symbols[id.0 as usize].kind {
            SymbolKind::Input(element) => Some(element),
            SymbolKind::Placeholder | SymbolKind::Free => None,
        }
    }

    /// Whether a symbol is a placeholder of an unknown.
    #[must_use]
    pub fn is_placeholder(&self, id: SymbolId) -> bool {
        self.tables.borrow().symbols[id.0 as usize].is_placeholder()
    }

    /// Fingerprint of a symbol as a number; a sign has that of an arbitrary number here.
    ///
    /// At a single point of the field, only 1 and -1 have a square of one, so no value there
    /// represents a sign.
    pub(crate) fn symbol_fingerprint(&self, id: SymbolId) -> Fingerprint {
        let own = &self.tables.borrow().symbols[id.0 as usize];
        own.as_any.unwrap_or(own.fingerprint)
    }

    /// All symbols.
    pub fn symbols(&self) -> impl Iterator<Item = SymbolId> + use<> {
        (0..self.tables.borrow().symbols.len() as u32).map(SymbolId)
    }

    /// The symbol of that name, created if it is new. It represents a number and, in a
    /// [`Direction`], an angle.
    pub fn symbol(&self, name: &str) -> SymbolId {
        self.symbol_of_kind(name, SymbolKind::Free)
    }

    /// The symbol of an element of an input array.
    pub fn input_symbol(&self, array: &'static str, index: usize) -> SymbolId {
        let element = InputElement { array, index };
        self.symbol_of_kind(&element.to_string(), SymbolKind::Input(element))
    }

    /// The symbol of another graph, created here if it is new.
    pub(crate) fn symbol_like(&self, other: &Self, id: SymbolId) -> SymbolId {
        let kind = other.tables.borrow().symbols[id.0 as usize].kind;
        self.symbol_of_kind(&other.symbol_name(id), kind)
    }

    fn symbol_of_kind(&self, name: &str, kind: SymbolKind) -> SymbolId {
        let mut tables = self.tables.borrow_mut();
        if let Some(&id) = tables.symbol_ids.get(name) {
            return id;
        }
        let id = SymbolId(tables.symbols.len() as u32);
        tables.symbols.push(Symbol::new(name, kind));
        tables.symbol_ids.insert(name.to_owned(), id);
        id
    }

    /// Represents a constant, and its negative, by an element of an input array from now on.
    ///
    /// The constant is then not folded into others, but keeps its relations to them, such as c² +
    /// s² = 1.
    pub(crate) fn stand_for(&self, number: Number, array: &'static str, index: usize) {
        let symbol = self.input_symbol(array, index);
        let mut tables = self.tables.borrow_mut();
        let own = &mut tables.symbols[symbol.0 as usize];
        own.fingerprint = Fingerprint::number(number);
        own.sample = number.value();
        tables.stands.insert(number.image(), (symbol, false));
        tables.stands.insert((-number).image(), (symbol, true));
    }

    /// A sum of products of constants, folded unless a symbol represents a factor.
    pub(crate) fn constant_sum<const N: usize>(&self, terms: [[Number; 3]; N]) -> Expr<'_> {
        let tables = self.tables.borrow();
        let mut factors = terms.iter().flatten();
        let stands = factors.any(|factor| tables.stands.contains_key(&factor.image()));
        drop(tables);
        if stands {
            let products = terms.iter().map(|term| {
                let [a, b, c] = term.map(|factor| self.number(factor));
                a * b * c
            });
            products.fold(self.zero(), |sum, product| sum + product)
        } else {
            let products = terms.iter().map(|&[a, b, c]| a * b * c);
            self.number(products.fold(Number::ZERO, |sum, product| sum + product))
        }
    }

    /// Makes an element of an input array a sign, with values 1, -1 and, at the real point, 1.
    ///
    /// Its square is then one, but it equals neither 1 nor -1.
    pub(crate) fn let_be_sign(&self, array: &'static str, index: usize) {
        let symbol = self.input_symbol(array, index);
        let mut tables = self.tables.borrow_mut();
        let own = &mut tables.symbols[symbol.0 as usize];
        own.as_any = Some(own.fingerprint);
        own.fingerprint = Fingerprint {
            image: [Element::ONE, -Element::ONE],
            sample: Sample::real(1.0),
        };
        own.sample = 1.0;
    }

    /// Makes four elements of an input array a unit quaternion, with the entries `zero` fixed at
    /// zero.
    ///
    /// Its field points lie on the sphere, at (1 - u², 2 u) / (1 + u²) for free u, so that
    /// identities of rotations are found. None of the elements may be in use yet.
    pub(crate) fn unit_quaternion(&self, array: &'static str, first: usize, zero: &[usize]) {
        let symbols: [SymbolId; 4] = std::array::from_fn(|k| self.input_symbol(array, first + k));
        let mut tables = self.tables.borrow_mut();
        let number = |value| Fingerprint::number(Number::integer(value));
        let mut free = symbols.map(|symbol| tables.symbols[symbol.0 as usize].fingerprint);
        let is_zero = |k: &usize| zero.contains(&(first + k));
        (0..4).filter(is_zero).for_each(|k| free[k] = number(0));
        // The first entry that is not fixed at zero is the pole.
        let Some(pole) = (0..4).find(|k| !is_zero(k)) else {
            return;
        };
        let others = (0..4).filter(|&k| k != pole);
        let square = others.fold(number(0), |sum, k| sum + free[k] * free[k]);
        let sum = number(1) + square;
        for (k, symbol) in symbols.into_iter().enumerate() {
            let part = if k == pole {
                number(1) + -square
            } else {
                free[k] + free[k]
            };
            let own = &mut tables.symbols[symbol.0 as usize];
            own.fingerprint = part.over(sum);
            own.sample = own.fingerprint.sample.re();
        }
    }

    /// Value of the constant that a symbol represents, if any.
    pub(crate) fn constant_of(&self, symbol: SymbolId) -> Option<f64> {
        let tables = self.tables.borrow();
        let own = &tables.symbols[symbol.0 as usize];
        let stands = tables.stands.get(&own.fingerprint.value());
        stands
            .is_some_and(|&(id, _)| id == symbol)
            .then_some(own.sample)
    }

    /// The value of a symbol as an expression.
    pub fn value_of(&self, symbol: SymbolId) -> Expr<'_> {
        self.expr(self.intern(Op::Symbol(symbol)))
    }

    /// The value of the symbol of that name as an expression.
    pub fn variable(&self, name: &str) -> Expr<'_> {
        self.value_of(self.symbol(name))
    }

    /// The value of an element of an input array as an expression.
    pub fn input(&self, array: &'static str, index: usize) -> Expr<'_> {
        self.value_of(self.input_symbol(array, index))
    }

    /// The direction of an angle that is an element of an input array.
    pub fn input_angle(&self, array: &'static str, index: usize) -> Direction {
        Direction::symbol(self.input_symbol(array, index))
    }

    /// A symbol of an unknown in the search for equations, as an expression.
    ///
    /// Where it cancels, the expression equals one without it but still contains it. Such a node
    /// never replaces an expression without the placeholder.
    pub fn placeholder(&self, name: &str) -> Expr<'_> {
        self.value_of(self.symbol_of_kind(name, SymbolKind::Placeholder))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cas::Ratio;

    /// The squares of a quaternion's entries sum to one, also if some entries are zero.
    #[test]
    fn the_squared_entries_of_a_unit_quaternion_sum_to_one() {
        for zero in [&[][..], &[6], &[3, 5]] {
            let arena = Arena::new();
            arena.unit_quaternion("pose", 3, zero);
            let entry = |k: usize| {
                if zero.contains(&k) {
                    arena.zero()
                } else {
                    arena.input("pose", k)
                }
            };
            let sum: Expr<'_> = (3..7).map(|k| entry(k) * entry(k)).sum();
            assert!(sum.is_one(), "{zero:?}");
            let less: Expr<'_> = (3..6).map(|k| entry(k) * entry(k)).sum();
            assert_eq!(less.is_one(), zero == [6], "{zero:?}");
        }
    }

    #[test]
    fn a_symbolic_sign_only_has_a_square_of_one() {
        let arena = Arena::new();
        arena.let_be_sign("of_leg", 0);
        let (sign, x) = (arena.input("of_leg", 0), arena.input("pose", 0));
        assert_eq!(sign * sign, arena.one());
        assert_eq!(sign * (sign * x), x);
        assert_eq!(x / sign, sign * x);
        assert_ne!(sign * x, x);
        assert_ne!(sign * x, -x);
        // Cosine and sine with a root of either sign.
        let cosine = sign * (arena.one() - x * x).sqrt();
        assert_eq!(cosine * cosine + x * x, arena.one());
    }

    /// In the field √(x²) is x for some symbols and -x for others; only the sample tells them apart.
    #[test]
    fn roots_of_squares_keep_their_sign_beside_signs_of_a_value() {
        for k in 0..40 {
            let arena = Arena::new();
            let (x, y) = (arena.input("pose", k), arena.input("twist", k));
            let root = (x * x).sqrt();
            for factor in [y.sign() + arena.one(), y.sign() - arena.one()] {
                assert_ne!(root * factor, -x * factor, "{k}");
            }
            assert_ne!(root.sign(), -x.sign(), "{k}");
        }
    }

    #[test]
    fn constant_sums_are_folded_and_keep_placeholders() {
        let arena = Arena::new();
        let [half, third] = [2, 3].map(|d| Number::ratio(Ratio::new(1, d).expect("a ratio")));
        let one = Number::ONE;
        let sum = arena.constant_sum([[half, third, one], [third, one, one]]);
        assert_eq!(sum.as_number(), Some(half));
        let own = Number::float(0.123_456);
        arena.stand_for(own, "of_leg", 0);
        let sum = arena.constant_sum([[half, own, one], [third, one, one]]);
        assert_eq!(sum, arena.input("of_leg", 0) * half + arena.number(third));
    }
}
