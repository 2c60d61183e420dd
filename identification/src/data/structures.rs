//! Structures in MATLAB's `.mat` files: their numeric fields as arrays named `STRUCTURE.FIELD`.
//!
//! A field stands in its structure as an array stands in a file, except that it has no name. With one, and
//! with the file's header before it, it is a file of one array, which the reader of arrays takes.

use std::io::Read;

use libflate::zlib::Decoder;

/// Bytes of a file before its first element.
const HEADER: usize = 128;

/// Structures inside of structures, at most.
const LARGEST_DEPTH: usize = 8;

/// Types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Class of an array that is a structure.
const STRUCTURE: u8 = 2;

/// Bytes of an array from which its class is told.
const BEGINNING: u64 = 64;

/// All fields of the structures of a file that are no structures themselves, each with its name and as a file
/// of one array. What is broken is left out: it is missing then.
pub(super) fn fields(file: &[u8]) -> Vec<(String, Vec<u8>)> {
    let Some((header, content)) = file.split_at_checked(HEADER) else {
        return Vec::new();
    };
    let order = Order {
        is_little: header.ends_with(b"IM"),
    };
    let mut fields = Vec::new();
    for element in order.elements(content) {
        let unpacked;
        let element = match element.kind {
            COMPRESSED => match structure(element.data, order) {
                Some(bytes) => {
                    unpacked = bytes;
                    order.elements(&unpacked).next()
                }
                None => None,
            },
            _ => Some(element),
        };
        if let Some(element) = element.filter(|element| element.kind == MATRIX) {
            order.collect((header, ""), element.data, 0, &mut fields);
        }
    }
    fields
}

/// A packed array, unpacked if it is a structure.
fn structure(packed: &[u8], order: Order) -> Option<Vec<u8>> {
    let unpack = |most: u64| -> Option<Vec<u8>> {
        let mut bytes = Vec::new();
        Decoder::new(packed)
            .ok()?
            .take(most)
            .read_to_end(&mut bytes)
            .ok()?;
        Some(bytes)
    };
    let beginning = unpack(BEGINNING)?;
    let flags = order.elements(beginning.get(8..)?).next()?;
    (order.class(flags.data) == Some(STRUCTURE))
        .then(|| unpack(u64::MAX))
        .flatten()
}

/// An element of a file or of an array.
struct Element<'a> {
    kind: u32,
    data: &'a [u8],
    /// With its tag and what fills it up.
    whole: &'a [u8],
}

/// The order of the bytes of a number.
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

    /// The class of an array, of the data of its flags.
    fn class(self, flags: &[u8]) -> Option<u8> {
        self.number(flags).map(|flags| flags.to_le_bytes()[0])
    }

    /// The elements that follow one another.
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
            // The last element of a file may not be filled up.
            let (whole, behind) = rest.split_at(end.min(rest.len()));
            rest = behind;
            Some(Element { kind, data, whole })
        })
    }

    /// Collects the fields of an array if it is a single structure.
    fn collect(
        self,
        (header, outer): (&[u8], &str),
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
            let inside = self.collect((header, &path), element.data, depth + 1, fields);
            if inside.is_none() && element.kind == MATRIX {
                let named = self.named(element.data).into_iter();
                fields.extend(named.map(|array| (path.clone(), [header, &array].concat())));
            }
        }
        Some(())
    }

    /// An array that stands alone needs a name, which those in structures do not have.
    fn named(self, array: &[u8]) -> Option<Vec<u8>> {
        let bytes = |number: u32| match self.is_little {
            true => number.to_le_bytes(),
            false => number.to_be_bytes(),
        };
        let mut elements = self.elements(array);
        let (flags, size) = (elements.next()?.whole, elements.next()?.whole);
        let nameless = flags.len() + size.len() + elements.next()?.whole.len();
        // A small element: one byte of the type of texts.
        let name = [bytes(1 << 16 | 1), *b"x\0\0\0"].concat();
        let array = [flags, size, &name, array.get(nameless..)?].concat();
        let tag = [bytes(MATRIX), bytes(u32::try_from(array.len()).ok()?)].concat();
        Some([tag, array].concat())
    }
}
