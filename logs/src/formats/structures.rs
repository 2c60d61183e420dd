//! Structures and cell arrays in MATLAB's `.mat` files, with names as in MATLAB.
//!
//! Numeric fields are arrays `STRUCTURE.FIELD`, `STRUCTURE(2).FIELD` of arrays of structures, and
//! `CELLS{2}` of cell arrays. Files of Simulink and dSPACE have texts that name a signal: the
//! values of `signals(2)` are in `values` and their name in `label`, or in `Data` and `Name`.
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

/// Largest number of arrays in structures.
const MOST_FIELDS: usize = 100_000;

/// Fields with the name of a signal, and with its values.
const LABELS: [&str; 2] = ["name", "label"];
const VALUES: [&str; 2] = ["data", "values"];

/// Types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Classes of cell arrays, structures, texts, and objects of MATLAB's classes.
const CELL: u8 = 1;
const STRUCTURE: u8 = 2;
const TEXT: u8 = 4;
const OBJECT: u8 = 17;

/// Classes of numeric arrays.
const NUMBERS: std::ops::RangeInclusive<u8> = 6..=15;

/// Classes of integers with 32 and 64 bits.
const INT32: u8 = 12;
const INT64: u8 = 14;

/// Bytes of an array that determine its class and size, and the class of an object.
const BEGINNING: usize = 160;

/// An array of a file, as a file of that array alone.
pub(crate) struct OneArray<'a> {
    /// Name of a field, `STRUCTURE.FIELD`; `None` for arrays with names of their own.
    pub(crate) name: Option<&'a str>,
    /// Text that names the signal.
    pub(crate) label: Option<&'a str>,
    /// Whether it is compressed in the original file.
    pub(crate) is_packed: bool,
    /// Content of the file.
    pub(crate) file: &'a mut dyn Read,
}

/// An object of a MATLAB class, whose content is not documented.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Object {
    pub(crate) name: String,
    pub(crate) class: String,
}

/// A numeric array in a structure or cell array.
struct Field {
    name: String,
    label: Option<String>,
    array: Vec<u8>,
}

/// Passes all numeric arrays of a file to `take`, including fields of structures.
///
/// Returns the objects of MATLAB's classes.
///
/// Other arrays are skipped, compressed ones without unpacking.
///
/// # Errors
/// A sentence on a defect or on an exceeded budget, or the error of `take`.
pub(crate) fn arrays(
    file: &[u8],
    budget: &mut Budget,
    take: &mut dyn FnMut(OneArray<'_>) -> Result<(), String>,
) -> Result<Vec<Object>, String> {
    let cut_off = || String::from("it is truncated");
    let (header, content) = file.split_at_checked(HEADER).ok_or_else(cut_off)?;
    let order = Order {
        is_little: header.ends_with(b"IM"),
    };
    let (mut read, mut objects) = (0, Vec::new());
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
                let mut file = header.chain(order.readable(&beginning, &mut unpacked));
                let taken = take(OneArray {
                    name: None,
                    label: None,
                    is_packed,
                    file: &mut file,
                });
                budget.settle(&unpacked)?;
                taken?;
            }
            (ArrayKind::Numbers, _) => {
                let mut file = header.chain(order.readable(&beginning, element.whole));
                take(OneArray {
                    name: None,
                    label: None,
                    is_packed,
                    file: &mut file,
                })?;
            }
            (ArrayKind::Structure, true) => {
                let packed = Decoder::new(element.data).map_err(|_| String::from(BROKEN))?;
                let unpacked = budget.unpack(packed)?;
                if let Some(element) = order.elements(&unpacked).next() {
                    order.collect(None, element.data, 0, &mut fields);
                }
            }
            (ArrayKind::Structure, _) => {
                order.collect(None, element.data, 0, &mut fields);
            }
            (ArrayKind::Object, _) => objects.extend(order.object(&beginning)),
            (ArrayKind::Other, _) => {}
        }
        if fields.len() > MOST_FIELDS {
            return Err(format!(
                "its structures have more than {MOST_FIELDS} arrays"
            ));
        }
        for field in &fields {
            // Fields that are not numeric are skipped like other variables.
            let beginning = &field.array[..field.array.len().min(BEGINNING)];
            if matches!(order.kind(beginning), Ok(ArrayKind::Numbers)) {
                let array = field.array.as_slice();
                let mut file = header.chain(order.readable(beginning, array));
                take(OneArray {
                    name: Some(field.name.as_str()),
                    label: field.label.as_deref(),
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
    Ok(objects)
}

/// Message for broken compressed bytes.
const BROKEN: &str = "it is damaged";

/// Content of an array.
enum ArrayKind {
    Numbers,
    /// A structure, an array of structures, or a cell array.
    Structure,
    Object,
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

/// An array whose class is stated as another one.
///
/// `matfile` 0.5 rejects the numbers of the class of 32-bit integers, but reads them in an array of
/// 64-bit integers.
struct Restated<R> {
    array: R,
    /// Bytes that have been read.
    read: usize,
    /// Place of the class and its other value, if it changes.
    class: Option<(usize, u8)>,
}

impl<R: Read> Read for Restated<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.array.read(buffer)?;
        if let Some((place, class)) = self.class
            && let Some(byte) = place.checked_sub(self.read).filter(|at| *at < count)
        {
            buffer[byte] = class;
        }
        self.read += count;
        Ok(count)
    }
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
            Some(STRUCTURE | CELL) => return Ok(ArrayKind::Structure),
            Some(OBJECT) => return Ok(ArrayKind::Object),
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

    /// An array as the reader of arrays accepts it; `beginning` are its first bytes.
    fn readable<R: Read>(self, beginning: &[u8], array: R) -> Restated<R> {
        // Tags of the array and of its flags come first, 8 bytes each.
        let place = if self.is_little { 16 } else { 19 };
        let is_int32 = beginning.get(place) == Some(&INT32);
        Restated {
            array,
            read: 0,
            class: is_int32.then_some((place, INT64)),
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

    /// Collects the numeric arrays in structures and cell arrays; `None` for other arrays.
    ///
    /// `name` is that of the array, which has a name of its own otherwise.
    fn collect(
        self,
        name: Option<&str>,
        array: &[u8],
        depth: usize,
        fields: &mut Vec<Field>,
    ) -> Option<()> {
        let mut elements = self.elements(array);
        let class = self.class(elements.next()?.data)?;
        let sizes = elements.next()?.data.chunks_exact(4);
        let own = String::from_utf8_lossy(elements.next()?.data);
        let name = name.unwrap_or(&own);
        if ![STRUCTURE, CELL].contains(&class) || depth > LARGEST_DEPTH {
            return None;
        }
        let count = sizes.into_iter().try_fold(1_usize, |count, size| {
            count.checked_mul(self.number(size)? as usize)
        })?;
        if class == CELL {
            for (place, element) in elements.take(count).enumerate() {
                let path = format!("{name}{{{}}}", place + 1);
                self.add(path, None, &element, depth, fields);
            }
            return Some(());
        }
        let length = self.number(elements.next()?.data)? as usize;
        let names = elements.next()?.data;
        if length == 0 {
            return None;
        }
        let names: Vec<String> = names.chunks_exact(length).map(until_zero).collect();
        for place in 0..count {
            let own: Vec<Element<'_>> = elements.by_ref().take(names.len()).collect();
            if own.is_empty() || fields.len() > MOST_FIELDS {
                break;
            }
            let is_one = |field: &str, of: [&str; 2]| {
                of.iter().any(|known| field.eq_ignore_ascii_case(known))
            };
            let mut labels = names
                .iter()
                .zip(&own)
                .filter(|(name, _)| is_one(name, LABELS));
            let label = labels.find_map(|(_, element)| self.text(element.data));
            for (field, element) in names.iter().zip(&own) {
                let index = if count == 1 {
                    String::new()
                } else {
                    format!("({})", place + 1)
                };
                let label = label.clone().filter(|_| is_one(field, VALUES));
                let path = format!("{name}{index}.{field}");
                self.add(path, label, element, depth, fields);
            }
        }
        Some(())
    }

    /// Adds a field of a structure, or an item of a cell array.
    fn add(
        self,
        path: String,
        label: Option<String>,
        element: &Element<'_>,
        depth: usize,
        fields: &mut Vec<Field>,
    ) {
        if element.kind != MATRIX || fields.len() > MOST_FIELDS {
            return;
        }
        let inside = self.collect(Some(&path), element.data, depth + 1, fields);
        if inside.is_none()
            && let Some(array) = self.named(element.data)
        {
            fields.push(Field {
                name: path,
                label,
                array,
            });
        }
    }

    /// A text of one line; `None` if it is empty or no text.
    fn text(self, array: &[u8]) -> Option<String> {
        const UTF16: [u32; 2] = [4, 17];
        let mut elements = self.elements(array);
        if self.class(elements.next()?.data)? != TEXT {
            return None;
        }
        let rows = self.number(elements.next()?.data)?;
        let content = elements.nth(1)?;
        let text = if UTF16.contains(&content.kind) {
            let (units, _) = content.data.as_chunks::<2>();
            let units = units.iter().map(|own| {
                if self.is_little {
                    u16::from_le_bytes(*own)
                } else {
                    u16::from_be_bytes(*own)
                }
            });
            String::from_utf16_lossy(&units.collect::<Vec<_>>())
        } else {
            String::from_utf8_lossy(content.data).into_owned()
        };
        let text = text.trim();
        (rows == 1 && !text.is_empty()).then(|| text.to_owned())
    }

    /// Name and class of an object, from its first bytes.
    fn object(self, beginning: &[u8]) -> Option<Object> {
        let mut elements = self.elements(beginning.get(8..)?);
        let name = until_zero(elements.nth(1)?.data);
        // After the name of the type system, `MCOS`.
        let class = elements.nth(1).map(|class| until_zero(class.data));
        Some(Object {
            name,
            class: class.unwrap_or_default(),
        })
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

/// A text up to its first zero byte.
fn until_zero(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0);
    String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]).into_owned()
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
