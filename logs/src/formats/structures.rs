//! Structures in MATLAB's `.mat` files: numeric fields as arrays named `STRUCTURE.FIELD`.
//!
//! A field is stored like an array of a file, except for its name. With a name and the file's
//! header, it becomes a file of one array for the array reader.

use std::io::Read;

use libflate::zlib::Decoder;

use crate::bytes::budget::Budget;

/// Bytes of a file before its first element.
pub(crate) const HEADER: usize = 128;

/// Largest depth of nested structures.
const LARGEST_DEPTH: usize = 8;

/// Types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Class of structures.
const STRUCTURE: u8 = 2;

/// Classes of numeric arrays.
const NUMBERS: std::ops::RangeInclusive<u8> = 6..=15;

/// Bytes of an array that determine its class and size.
const BEGINNING: usize = 72;

/// An array of a file, as a file of that array alone.
pub(crate) struct OneArray<'a> {
    /// Name of a field, `STRUCTURE.FIELD`; `None` for arrays with names of their own.
    pub(crate) name: Option<&'a str>,
    /// Whether it is compressed in the original file.
    pub(crate) is_packed: bool,
    /// Content of the file.
    pub(crate) file: &'a mut dyn Read,
}

/// Passes all numeric arrays of a file to `take`, including fields of structures.
///
/// Other arrays are skipped, compressed ones without unpacking.
///
/// # Errors
/// A sentence on a defect or on an exceeded budget, or the error of `take`.
pub(crate) fn arrays(
    file: &[u8],
    budget: &mut Budget,
    take: &mut dyn FnMut(OneArray<'_>) -> Result<(), String>,
) -> Result<(), String> {
    let cut_off = || String::from("it is truncated");
    let (header, content) = file.split_at_checked(HEADER).ok_or_else(cut_off)?;
    let order = Order {
        is_little: header.ends_with(b"IM"),
    };
    let mut read = 0;
    for element in order.elements(content) {
        read += element.whole.len();
        let beginning = match element.kind {
            COMPRESSED => beginning(element.data)?,
            _ => element.whole[..element.whole.len().min(BEGINNING)].to_vec(),
        };
        let is_packed = element.kind == COMPRESSED;
        let mut fields = Vec::new();
        match (order.kind(&beginning)?, is_packed) {
            (ArrayKind::Numbers, true) => {
                let packed = Decoder::new(element.data).map_err(|_| String::from(BROKEN))?;
                let mut unpacked = budget.limited(packed);
                let mut file = header.chain(&mut unpacked);
                let taken = take(OneArray {
                    name: None,
                    is_packed,
                    file: &mut file,
                });
                budget.settle(&unpacked)?;
                taken?;
            }
            (ArrayKind::Numbers, _) => {
                let mut file = header.chain(element.whole);
                take(OneArray {
                    name: None,
                    is_packed,
                    file: &mut file,
                })?;
            }
            (ArrayKind::Structure, true) => {
                let packed = Decoder::new(element.data).map_err(|_| String::from(BROKEN))?;
                let unpacked = budget.unpack(packed)?;
                if let Some(element) = order.elements(&unpacked).next() {
                    order.collect("", element.data, 0, &mut fields);
                }
            }
            (ArrayKind::Structure, _) => {
                order.collect("", element.data, 0, &mut fields);
            }
            (ArrayKind::Other, _) => {}
        }
        for (name, field) in &fields {
            // Fields that are not numeric are skipped like other variables.
            let beginning = &field[..field.len().min(BEGINNING)];
            if matches!(order.kind(beginning), Ok(ArrayKind::Numbers)) {
                let mut file = header.chain(field.as_slice());
                take(OneArray {
                    name: Some(name.as_str()),
                    is_packed,
                    file: &mut file,
                })?;
            }
        }
    }
    // Padding may follow the last element.
    if content[read..].iter().any(|byte| *byte != 0) {
        return Err(cut_off());
    }
    Ok(())
}

/// Message for broken compressed bytes.
const BROKEN: &str = "it is damaged";

/// Content of an array.
enum ArrayKind {
    Numbers,
    Structure,
    Other,
}

/// Unpacks the first bytes of a compressed array.
fn beginning(packed: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let unpacked = Decoder::new(packed).map_err(|_| String::from(BROKEN))?;
    let read = unpacked.take(BEGINNING as u64).read_to_end(&mut bytes);
    read.map_err(|_| String::from(BROKEN))?;
    Ok(bytes)
}

/// An element of a file or of an array.
struct Element<'a> {
    kind: u32,
    data: &'a [u8],
    /// The element with its tag and padding.
    whole: &'a [u8],
}

/// Byte order of a number.
#[derive(Clone, Copy)]
struct Order {
    is_little: bool,
}

impl Order {
    fn number(self, bytes: &[u8]) -> Option<u32> {
        let bytes = bytes.get(..4)?.try_into().ok()?;
        Some(if self.is_little {
            u32::from_le_bytes(bytes)
        } else {
            u32::from_be_bytes(bytes)
        })
    }

    /// Class of an array, from the data of its flags.
    fn class(self, flags: &[u8]) -> Option<u8> {
        self.number(flags).map(|flags| flags.to_le_bytes()[0])
    }

    /// Content of an array, from its first bytes.
    ///
    /// # Errors
    /// A sentence on a numeric array with an invalid size.
    fn kind(self, beginning: &[u8]) -> Result<ArrayKind, String> {
        if self.number(beginning) != Some(MATRIX) {
            return Ok(ArrayKind::Other);
        }
        let mut elements = self.elements(beginning.get(8..).unwrap_or_default());
        let class = elements.next().and_then(|flags| self.class(flags.data));
        match class {
            Some(STRUCTURE) => return Ok(ArrayKind::Structure),
            Some(class) if NUMBERS.contains(&class) => {}
            _ => return Ok(ArrayKind::Other),
        }
        let sizes = elements.next().map_or(&[][..], |sizes| sizes.data);
        let sizes = sizes.chunks_exact(4).map(|size| self.number(size));
        let count = sizes
            .into_iter()
            .try_fold(1_u32, |count, size| count.checked_mul(size?));
        if count.is_some_and(|count| i32::try_from(count).is_ok()) {
            Ok(ArrayKind::Numbers)
        } else {
            Err(String::from("the size of an array is none"))
        }
    }

    /// Successive elements.
    fn elements<'a>(self, mut rest: &'a [u8]) -> impl Iterator<Item = Element<'a>> {
        std::iter::from_fn(move || {
            let kind = self.number(rest)?;
            let (kind, start, size) = match kind >> 16 {
                0 => (kind, 8, self.number(rest.get(4..)?)? as usize),
                small => (kind & 0xffff, 4_usize, small as usize),
            };
            let data = rest.get(start..start.checked_add(size)?)?;
            let end = match (start, kind) {
                (4, _) => 8,
                (_, COMPRESSED) => start + size,
                _ => start + size.next_multiple_of(8),
            };
            // The last element of a file may lack its padding.
            let (whole, behind) = rest.split_at(end.min(rest.len()));
            rest = behind;
            Some(Element { kind, data, whole })
        })
    }

    /// Collects the fields of an array if it is a single structure.
    fn collect(
        self,
        outer: &str,
        array: &[u8],
        depth: usize,
        fields: &mut Vec<(String, Vec<u8>)>,
    ) -> Option<()> {
        let mut elements = self.elements(array);
        let class = self.class(elements.next()?.data)?;
        let size = elements.next()?.data;
        let own = String::from_utf8_lossy(elements.next()?.data).into_owned();
        let name = match (outer, own.as_str()) {
            ("", own) => own,
            (outer, _) => outer,
        };
        if class != STRUCTURE {
            return None;
        }
        let is_single = size.chunks_exact(4).all(|one| self.number(one) == Some(1));
        let length = self.number(elements.next()?.data)? as usize;
        let names = elements.next()?.data;
        if !is_single || length == 0 || depth > LARGEST_DEPTH {
            return None;
        }
        for (field, element) in names.chunks_exact(length).zip(elements) {
            let end = field.iter().position(|byte| *byte == 0);
            let field = String::from_utf8_lossy(&field[..end.unwrap_or(length)]);
            let path = format!("{name}.{field}");
            let inside = self.collect(&path, element.data, depth + 1, fields);
            if inside.is_none() && element.kind == MATRIX {
                let named = self.named(element.data).into_iter();
                fields.extend(named.map(|array| (path.clone(), array)));
            }
        }
        Some(())
    }

    /// Adds a name to an array, since those in structures have none.
    fn named(self, array: &[u8]) -> Option<Vec<u8>> {
        let bytes = |number: u32| {
            if self.is_little {
                number.to_le_bytes()
            } else {
                number.to_be_bytes()
            }
        };
        let mut elements = self.elements(array);
        let (flags, size) = (elements.next()?.whole, elements.next()?.whole);
        let nameless = flags.len() + size.len() + elements.next()?.whole.len();
        // A small element: one byte of type text.
        let name = [bytes(1 << 16 | 1), *b"x\0\0\0"].concat();
        let array = [flags, size, &name, array.get(nameless..)?].concat();
        let tag = [bytes(MATRIX), bytes(u32::try_from(array.len()).ok()?)].concat();
        Some([tag, array].concat())
    }
}

#[cfg(test)]
mod tests {
    use super::{COMPRESSED, HEADER, MATRIX, arrays};
    use crate::bytes::budget::Budget;
    use libflate::zlib::Encoder;
    use std::io::Write;

    fn element(kind: u32, data: &[u8]) -> Vec<u8> {
        let size = u32::try_from(data.len()).expect("a size");
        [&kind.to_le_bytes()[..], &size.to_le_bytes(), data].concat()
    }

    /// A file of one compressed array with this class and number of zero bytes.
    fn packed(class: u8, bytes: usize) -> Vec<u8> {
        let flags = element(6, &[class, 0, 0, 0, 0, 0, 0, 0]);
        let rows = i32::try_from(bytes / 8).expect("a size").to_le_bytes();
        let size = element(5, &[rows, 1_i32.to_le_bytes()].concat());
        let name = element(1, b"q1234567");
        let array = element(
            MATRIX,
            &[flags, size, name, element(9, &vec![0; bytes])].concat(),
        );
        let mut packing = Encoder::new(Vec::new()).expect("an encoder");
        packing.write_all(&array).expect("packed");
        let packed = packing.finish().into_result().expect("packed");
        let mut file = b"MATLAB 5.0 MAT-file".to_vec();
        file.resize(HEADER - 4, b' ');
        file.extend(b"\x00\x01IM");
        file.extend(element(COMPRESSED, &packed));
        file
    }

    /// Number of bytes unpacked from the array of a file.
    fn unpacked(file: &[u8], budget: &mut Budget) -> Result<usize, String> {
        let mut bytes = Vec::new();
        arrays(file, budget, &mut |one| {
            one.file
                .read_to_end(&mut bytes)
                .map_err(|error| error.to_string())?;
            Ok(())
        })?;
        Ok(bytes.len())
    }

    #[test]
    fn packed_arrays_are_unpacked_within_the_budget() {
        const NUMBERS: u8 = 6;
        const TEXT: u8 = 4;
        let file = packed(NUMBERS, 80_000);
        assert!(file.len() < 2000);
        let mut budget = Budget::of_file(&file);
        assert!(unpacked(&file, &mut budget).is_ok_and(|bytes| bytes > 80_000));
        let mut budget = Budget::with(40_000);
        let refused = unpacked(&file, &mut budget).expect_err("too large");
        assert!(
            refused.contains("uncompressed it has more than"),
            "{refused}"
        );
        // Text is not unpacked.
        let mut budget = Budget::with(0);
        assert_eq!(unpacked(&packed(TEXT, 80_000), &mut budget), Ok(0));
    }
}
