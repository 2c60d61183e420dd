//! NumPy's files: `.npy`, one array, and `.npz`, a zip archive of such files.
//!
//! An array has a header, which is the text of a Python dictionary, and numbers. Headers and
//! archives are parsed here: libraries for arbitrary Python literals and archives take longer to
//! build than all other readers.

use crate::{
    bytes::{budget::Budget, byte_source::ByteSource},
    error::{Error, Problem},
    formats::{archive, arrays::Arrays, table_file::TableFile},
    problems::{shown, unreadable},
};
use overact::Code;

/// Magic bytes of a `.npy` file.
const MAGIC: &[u8] = b"\x93NUMPY";

/// Reads the array of a `.npy` file, whose columns are numbered.
///
/// # Errors
/// A file that cannot be read or is broken, or an array without numbers.
pub(crate) fn open_array(file: String, medium: &ByteSource) -> Result<Arrays, Error> {
    let bytes = medium.read().map_err(|error| unreadable(&file, &error))?;
    let mut arrays = Arrays::new(file.clone());
    push(&mut arrays, "array", &bytes).map_err(|why| {
        let problem =
            Problem::new(Code::LOG_FORMAT, format!("the file is NumPy's, but {why}")).file(file);
        problem.help("write it again with `numpy.save`, an array of numbers, samples x columns")
    })?;
    Ok(arrays)
}

/// Reads all arrays of a `.npz` file; skips arrays without numbers.
///
/// # Errors
/// A file that cannot be read, is broken, or contains nothing from NumPy.
pub(crate) fn open_archive(file: String, medium: &ByteSource) -> Result<Arrays, Error> {
    let bytes = medium.read().map_err(|error| unreadable(&file, &error))?;
    let broken = |why: String| -> Error {
        let problem = Problem::new(
            Code::LOG_FORMAT,
            format!("the zip archive can't be read: {why}"),
        );
        let help = "copy the file once more, or write it again with `numpy.savez`";
        problem.file(file.as_str()).help(help).into()
    };
    let members = archive::members(&bytes).map_err(broken)?;
    if !members.iter().any(|member| member.name.ends_with(".npy")) {
        let problem = Problem::new(
            Code::LOG_FORMAT,
            "the file is a zip archive, but not one of NumPy's (`.npz`)",
        );
        let help = "unpack it; export a spreadsheet as CSV";
        return Err(problem.file(file.as_str()).help(help).into());
    }
    let mut arrays = Arrays::new(file.clone());
    let mut left_out = Vec::new();
    let mut budget = Budget::of_file(&bytes);
    for member in &members {
        let Some(name) = member.name.strip_suffix(".npy") else {
            continue;
        };
        let content = member.content(&bytes, &mut budget).map_err(broken)?;
        if let Err(why) = push(&mut arrays, name, &content) {
            left_out.push(format!("`{}`: {why}", shown(name)));
        }
    }
    if arrays.columns() == 0 {
        let message = format!("no array of the file can be read: {}", left_out.join("; "));
        let help = "write it again with `numpy.savez`, arrays of numbers, samples x columns";
        return Err(Problem::new(Code::LOG_FORMAT, message)
            .file(file)
            .help(help)
            .into());
    }
    Ok(arrays)
}

/// Adds an array from the bytes of its file.
///
/// # Errors
/// A description of the defect, to follow `but`.
fn push(arrays: &mut Arrays, name: &str, file: &[u8]) -> Result<(), String> {
    let broken = || String::from("it is truncated");
    let version = *file.get(6).ok_or_else(broken)?;
    let (start, size) = match (file.starts_with(MAGIC), version) {
        (false, _) => return Err(String::from("it does not start like an array")),
        (true, 1) => {
            let size = file.get(8..10).ok_or_else(broken)?;
            (10, usize::from(u16::from_le_bytes([size[0], size[1]])))
        }
        (true, _) => {
            let size = file.get(8..12).ok_or_else(broken)?;
            let size = [size[0], size[1], size[2], size[3]];
            (12, u32::from_le_bytes(size) as usize)
        }
    };
    let end = start + size;
    let header = file.get(start..end).ok_or_else(broken)?;
    let header = Header::read(&String::from_utf8_lossy(header))?;
    let count = header
        .shape
        .iter()
        .try_fold(1_usize, |all, one| all.checked_mul(*one));
    let bytes = count.and_then(|count| count.checked_mul(header.number.size));
    let data = bytes
        .and_then(|bytes| file[end..].get(..bytes))
        .ok_or_else(broken)?;
    let values: Vec<f64> = data
        .chunks_exact(header.number.size)
        .map(|bytes| header.number.value(bytes))
        .collect();
    let (rows, columns) = match header.shape[..] {
        [] => (1, 1),
        [rows] => (rows, 1),
        [rows, columns] => (rows, columns),
        _ => return Err(format!("the array has {} dimensions", header.shape.len())),
    };
    if values.is_empty() {
        // An empty array, of any other size.
        arrays.push(name, 0, 0, &values);
    } else if header.is_by_columns || columns <= 1 {
        arrays.push(name, rows, columns, &values);
    } else {
        let column = |column: usize| {
            values
                .iter()
                .skip(column)
                .step_by(columns)
                .take(rows)
                .copied()
        };
        let values: Vec<f64> = (0..columns).flat_map(column).collect();
        arrays.push(name, rows, columns, &values);
    }
    Ok(())
}

/// Header of an array.
struct Header {
    number: Number,
    is_by_columns: bool,
    shape: Vec<usize>,
}

impl Header {
    /// Reads `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }`.
    fn read(text: &str) -> Result<Self, String> {
        let broken = || format!("its header is `{}`", shown(text));
        let value = |key: &str| -> Option<&str> {
            let behind = text.split_once(key)?.1;
            Some(behind.trim_start_matches(['\'', '"', ' ', ':']))
        };
        let kind = value("'descr'").ok_or_else(broken)?;
        if kind.starts_with('[') {
            return Err(String::from(
                "its elements are records of several fields; save each field as a separate array",
            ));
        }
        let kind = kind.split(['\'', '"']).next().ok_or_else(broken)?;
        let number = Number::of(kind)
            .ok_or_else(|| format!("its elements are not supported numbers (`{}`)", shown(kind)))?;
        let shape = value("'shape'").and_then(|text| text.strip_prefix('('));
        let shape = shape
            .and_then(|text| text.split_once(')'))
            .ok_or_else(broken)?
            .0;
        let sizes = shape
            .split(',')
            .map(str::trim)
            .filter(|size| !size.is_empty());
        let shape: Option<Vec<usize>> = sizes.map(|size| size.parse().ok()).collect();
        Ok(Self {
            number,
            is_by_columns: value("'fortran_order'")
                .ok_or_else(broken)?
                .starts_with("True"),
            shape: shape.ok_or_else(broken)?,
        })
    }
}

/// Encoding of a number.
struct Number {
    is_little: bool,
    /// `f`, `i`, `u`, or `b` for booleans.
    kind: u8,
    /// Size in bytes.
    size: usize,
}

impl Number {
    /// Parses NumPy's name, such as `<f8`.
    fn of(name: &str) -> Option<Self> {
        let (order, rest) = name.as_bytes().split_first()?;
        let (kind, size) = rest.split_first()?;
        let size: usize = std::str::from_utf8(size).ok()?.parse().ok()?;
        let is_known = match kind {
            b'f' => matches!(size, 4 | 8),
            b'i' | b'u' => matches!(size, 1 | 2 | 4 | 8),
            b'b' => size == 1,
            _ => false,
        };
        (is_known && b"<>|=".contains(order)).then_some(Self {
            is_little: *order != b'>',
            kind: *kind,
            size,
        })
    }

    fn value(&self, bytes: &[u8]) -> f64 {
        let mut all = [0; 8];
        for (place, byte) in bytes.iter().enumerate() {
            let place = if self.is_little {
                place
            } else {
                self.size - 1 - place
            };
            all[place] = *byte;
        }
        let bits = u64::from_le_bytes(all);
        match (self.kind, self.size) {
            (b'f', 4) => f64::from(f32::from_bits(bits as u32)),
            (b'f', _) => f64::from_bits(bits),
            (b'i', size) => {
                // Sign extension from the number's highest bit.
                let unused = 64 - 8 * size as u32;
                (((bits << unused) as i64) >> unused) as f64
            }
            _ => bits as f64,
        }
    }
}
