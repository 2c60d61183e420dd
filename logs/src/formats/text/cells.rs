//! Parses the numbers of a line without quotation marks.

use memchr::memchr;

/// Whether a byte is a blank next to a number in its cell.
fn is_blank(byte: u8) -> bool {
    byte.is_ascii_whitespace()
}

/// Parses the requested cells of a line into `values`.
///
/// `wanted` has pairs of cell and index in `values`, by increasing cell. Returns `false` if a cell
/// is missing or no finite number, or if there are more than `most` cells; the values are then
/// undefined.
pub(super) fn read(
    line: &[u8],
    separator: u8,
    most: usize,
    wanted: &[(usize, usize)],
    values: &mut [f64],
) -> bool {
    let mut cells = Cells {
        rest: line,
        separator,
        next: Some(0),
    };
    let mut last = None;
    for &(cell, place) in wanted {
        let value = match last {
            Some((own, value)) if own == cell => value,
            _ => {
                let Some(value) = cells.at(cell) else {
                    return false;
                };
                value
            }
        };
        last = Some((cell, value));
        values[place] = value;
    }
    while let Some(next) = cells.next {
        if next >= most {
            return false;
        }
        if cells.pass().is_none() {
            break;
        }
    }
    true
}

/// The remaining cells of a line.
struct Cells<'a> {
    rest: &'a [u8],
    separator: u8,
    /// Number of the first remaining cell, if there is one.
    next: Option<usize>,
}

impl Cells<'_> {
    /// Parses the number in a later cell and skips to the cell after it.
    fn at(&mut self, cell: usize) -> Option<f64> {
        while self.next? < cell {
            self.pass()?;
        }
        if self.separator != b' ' {
            self.skip_blanks();
        }
        let (value, length) = fast_float2::parse_partial::<f64, _>(self.rest).ok()?;
        self.rest = &self.rest[length..];
        // The usual case: the separator follows the number.
        if self.rest.first() == Some(&self.separator) && self.separator != b' ' {
            self.rest = &self.rest[1..];
            self.next = Some(cell + 1);
            return value.is_finite().then_some(value);
        }
        let has_blank = self.skip_blanks();
        self.next = match self.rest.first() {
            None => None,
            Some(_) if self.separator == b' ' && has_blank => Some(cell + 1),
            Some(byte) if *byte == self.separator => {
                self.rest = &self.rest[1..];
                Some(cell + 1)
            }
            Some(_) => return None,
        };
        value.is_finite().then_some(value)
    }

    /// Skips a cell; `None` after the last one.
    fn pass(&mut self) -> Option<()> {
        let end = if self.separator == b' ' {
            self.rest.iter().position(|byte| is_blank(*byte))?
        } else {
            memchr(self.separator, self.rest)?
        };
        self.rest = &self.rest[end + 1..];
        if self.separator == b' ' {
            self.skip_blanks();
        }
        self.next = self.next.map(|next| next + 1);
        Some(())
    }

    /// Skips blanks that are no separators, or all if blanks separate; returns whether any.
    fn skip_blanks(&mut self) -> bool {
        let separator = self.separator;
        let is_skipped = |byte: &u8| is_blank(*byte) && (*byte != separator || separator == b' ');
        let before = self.rest.len();
        while self.rest.first().is_some_and(is_skipped) {
            self.rest = &self.rest[1..];
        }
        self.rest.len() < before
    }
}

/// Splits a line into cells without parsing.
pub(super) fn split(line: &[u8], separator: u8) -> Vec<&[u8]> {
    if separator == b' ' {
        let cells = line.split(|byte| is_blank(*byte));
        cells.filter(|cell| !cell.is_empty()).collect()
    } else {
        line.split(|byte| *byte == separator).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{read, split};

    fn numbers(line: &str, separator: u8, wanted: &[(usize, usize)]) -> Option<Vec<f64>> {
        let mut values = vec![f64::NAN; wanted.len()];
        read(line.as_bytes(), separator, 5, wanted, &mut values).then_some(values)
    }

    #[test]
    fn cells_are_found_after_any_other_cells() {
        let wanted = [(0, 1), (2, 0), (2, 2), (3, 3)];
        let expected = Some(vec![-2.5e-3, 1.0, -2.5e-3, 7.0]);
        assert_eq!(numbers("1,x y,-2.5e-3,7", b',', &wanted), expected);
        assert_eq!(numbers(" 1 , ,\t-.0025 ,+7.,z", b',', &wanted), expected);
        assert_eq!(numbers("1\t\t -25e-4\t7 ", b'\t', &wanted), expected);
        assert_eq!(numbers("1  x \t-2.5e-3\t7", b' ', &wanted), expected);
        assert_eq!(split(b"1  x \t-2.5e-3\t7", b' ').len(), 4);
        assert_eq!(split(b"1;; 2", b';'), [&b"1"[..], b"", b" 2"]);
    }

    #[test]
    fn lines_with_extra_cells_are_left_to_the_slow_parser() {
        let wanted = [(0, 0), (1, 1)];
        assert_eq!(numbers("1,2,a,b,5", b',', &wanted), Some(vec![1.0, 2.0]));
        assert_eq!(numbers("1,2,a,b,5,", b',', &wanted), None);
        assert_eq!(numbers("1 2 3 4 5", b' ', &wanted), Some(vec![1.0, 2.0]));
        assert_eq!(numbers("1 2 3 4 5 6", b' ', &wanted), None);
    }

    #[test]
    fn non_numeric_cells_are_left_to_the_slow_parser() {
        let wanted = [(0, 0), (1, 1)];
        for line in [
            "1", "1,", "1,x", "1,2x", "1,2 3", "1,nan", "1,inf", "1,1e999", "1,2e", "1 2,3",
        ] {
            assert_eq!(numbers(line, b',', &wanted), None, "{line}");
        }
        assert_eq!(numbers("1 2x", b' ', &wanted), None);
    }

    #[test]
    fn parsed_numbers_equal_those_of_the_library() {
        let mut seed = 7_u64;
        for _ in 0..20_000 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let value = f64::from_bits(seed >> 2 | (seed & 1) << 63);
            let bits = |value: f64| Some(vec![value.to_bits()]);
            for text in [
                format!("{value}"),
                format!("{value:e}"),
                format!("{value:.6}"),
            ] {
                let expected = text.parse().ok().filter(|value: &f64| value.is_finite());
                let found = numbers(&text, b',', &[(0, 0)]);
                let found = found.map(|values| values.iter().map(|own| own.to_bits()).collect());
                assert_eq!(found, expected.and_then(bits), "{text}");
            }
        }
    }
}
