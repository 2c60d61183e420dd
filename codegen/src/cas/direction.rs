//! Variable angles: linear combinations of symbols plus a constant.

use overact_exact::Angle;
use overact_exact::Ratio;

/// Index of a symbol in its arena.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SymbolId(pub(crate) u32);

impl SymbolId {
    /// Its number, counted from zero.
    #[must_use]
    pub const fn number(self) -> usize {
        self.0 as usize
    }
}

/// Angle Σ factor × symbol + constant.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Direction {
    /// Symbols in ascending order with factors that are not zero.
    terms: Vec<(SymbolId, Ratio)>,
    constant: Angle,
}

impl Direction {
    /// A constant angle.
    #[must_use]
    pub const fn constant(constant: Angle) -> Self {
        Self {
            terms: Vec::new(),
            constant,
        }
    }

    /// The angle that a symbol represents.
    #[must_use]
    pub fn symbol(symbol: SymbolId) -> Self {
        Self {
            terms: vec![(symbol, Ratio::ONE)],
            constant: Angle::ZERO,
        }
    }

    /// Sum; `None` if a constant overflows its 128 bits.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Option<Self> {
        let mut terms = self.terms.clone();
        for &(symbol, factor) in &other.terms {
            match terms.binary_search_by_key(&symbol, |t| t.0) {
                Ok(at) => {
                    terms[at].1 = terms[at].1.plus(factor)?;
                    if terms[at].1.is_zero() {
                        terms.remove(at);
                    }
                }
                Err(at) => terms.insert(at, (symbol, factor)),
            }
        }
        Some(Self {
            terms,
            constant: self.constant.plus(other.constant)?,
        })
    }

    /// The angle times a fraction; `None` on overflow.
    #[must_use]
    pub fn times(&self, factor: Ratio) -> Option<Self> {
        if factor.is_zero() {
            return Some(Self::constant(Angle::ZERO));
        }
        let terms = self
            .terms
            .iter()
            .map(|&(symbol, f)| Some((symbol, f.times(factor)?)))
            .collect::<Option<Vec<_>>>()?;
        Some(Self {
            terms,
            constant: self.constant.times(factor)?,
        })
    }

    /// The opposite angle.
    #[must_use]
    pub fn negative(&self) -> Self {
        Self {
            terms: self.terms.iter().map(|&(s, f)| (s, f.negative())).collect(),
            constant: self.constant.negative(),
        }
    }

    /// The variable part.
    #[must_use]
    pub fn terms(&self) -> &[(SymbolId, Ratio)] {
        &self.terms
    }

    /// The constant part.
    #[must_use]
    pub const fn offset(&self) -> Angle {
        self.constant
    }

    /// The angle without its constant part.
    #[must_use]
    pub fn without_offset(&self) -> Self {
        Self {
            terms: self.terms.clone(),
            constant: Angle::ZERO,
        }
    }

    /// Whether the angle does not vary.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.terms.is_empty()
    }
}
