//! All formats of logs. They are recognised by their first bytes, never by the file's name.
//!
//! A new format is a file or folder with a [`TableFile`], and an entry of `FORMATS`.

use overact::Code;
use std::io::Read;

#[cfg(feature = "hdf5")]
use crate::formats::hdf5_file::Hdf5;
#[cfg(feature = "mcap")]
use crate::formats::mcap_file;
use crate::{
    bytes::{byte_source::ByteSource, unpacking},
    error::{Error, Problem},
    formats::{
        json_lines::JsonLines, mat_file, numpy, parquet_file::Parquet, table::Table,
        table_file::TableFile, text::Text,
    },
    problems::unreadable,
};

/// Number of bytes that determine the format.
const BEGINNING: usize = 4096;

/// A supported format.
struct Format {
    /// Name in the list of formats.
    name: &'static str,
    /// Whether a file with these first bytes has the format.
    is: fn(&[u8]) -> bool,
    /// Opens a file: one table, or one for each of its parts.
    open: fn(String, &ByteSource) -> Result<Vec<Table>, Error>,
}

/// All formats; the first one that a file has is used.
const FORMATS: &[Format] = &[
    #[cfg(feature = "hdf5")]
    Format {
        name: "HDF5",
        is: |first| first.starts_with(b"MATLAB 7.3") || first.starts_with(HDF5),
        open: |file, bytes| one(Hdf5::open(file.clone(), on_disk(&file, bytes)?)),
    },
    #[cfg(feature = "mcap")]
    Format {
        name: "MCAP",
        is: |first| first.starts_with(MCAP),
        open: |file, bytes| Ok(parts(mcap_file::open(&file, on_disk(&file, bytes)?)?)),
    },
    Format {
        name: "MATLAB's `.mat`",
        is: is_mat,
        open: |file, bytes| one(mat_file::open(file, bytes)),
    },
    Format {
        name: "NumPy's `.npy`",
        is: |first| first.starts_with(b"\x93NUMPY"),
        open: |file, bytes| one(numpy::open_array(file, bytes)),
    },
    Format {
        name: "NumPy's `.npz`",
        is: |first| first.starts_with(b"PK\x03\x04"),
        open: |file, bytes| one(numpy::open_archive(file, bytes)),
    },
    Format {
        name: "Parquet",
        is: |first| first.starts_with(b"PAR1"),
        open: |file, bytes| one(Parquet::open(file, bytes)),
    },
    Format {
        name: "JSON Lines",
        is: |first| is_text(first) && is_json(first),
        open: |file, bytes| one(JsonLines::open(file, bytes)),
    },
    Format {
        name: "text (CSV)",
        is: is_text,
        open: |file, bytes| Ok(parts(Text::open(file, bytes)?)),
    },
];

fn one(file: Result<impl TableFile + 'static, Error>) -> Result<Vec<Table>, Error> {
    Ok(parts([file?]))
}

fn parts(files: impl IntoIterator<Item = impl TableFile + 'static>) -> Vec<Table> {
    files.into_iter().map(Table::new).collect()
}

/// Path of a file whose format can only be read from disk.
#[cfg(any(feature = "hdf5", feature = "mcap"))]
fn on_disk<'m>(file: &str, medium: &'m ByteSource) -> Result<&'m std::path::Path, Error> {
    medium.path().ok_or_else(|| {
        let message = "files of this format can be read from a disk only";
        let problem = Problem::new(Code::LOG_FORMAT, message).file(file);
        problem.help("export CSV").into()
    })
}

/// Formats of features that this build lacks: magic bytes, description, feature, and help.
const OPTIONAL: &[(&[u8], &str, &str, &str)] = &[
    #[cfg(not(feature = "hdf5"))]
    (
        b"MATLAB 7.3",
        "the file is of MATLAB's version 7.3, which is HDF5",
        "hdf5",
        "save it in MATLAB with `save(..., '-v7')`",
    ),
    #[cfg(not(feature = "hdf5"))]
    (HDF5, "the file is HDF5", "hdf5", "export CSV"),
    #[cfg(not(feature = "mcap"))]
    (
        MCAP,
        "the file is MCAP",
        "mcap",
        "export the messages of the joints as CSV",
    ),
];

const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
const MCAP: &[u8] = b"\x89MCAP0\r\n";

/// Unsupported formats: magic bytes, description, and help.
const REFUSED: [(&[u8], &str, &str); 9] = [
    (
        b"#ROSBAG",
        "the file is a ROS bag, which is not supported",
        "export the messages of the joints as CSV",
    ),
    (
        b"SQLite format 3\0",
        "the file is a database of SQLite (a ROS 2 bag?), which is not supported",
        "export the messages of the joints as CSV",
    ),
    (
        b"PARE",
        "the file is encrypted Parquet, which is not supported",
        "write it without encryption",
    ),
    (
        b"ARROW1",
        "the file is Arrow, which is not supported",
        "export CSV",
    ),
    (
        b"\xd0\xcf\x11\xe0",
        "the file is an old document of Office, which is not supported",
        "export CSV",
    ),
    (
        unpacking::GZIP,
        "the file is compressed by gzip twice",
        "unpack it first",
    ),
    (
        b"\x28\xb5\x2f\xfd",
        "the file is compressed by zstd",
        "unpack it first",
    ),
    (
        b"\xff\xfe",
        "the file is text in UTF-16, which is not supported",
        "save it in UTF-8",
    ),
    (
        b"\xfe\xff",
        "the file is text in UTF-16, which is not supported",
        "save it in UTF-8",
    ),
];

/// Opens a file of any format, also a compressed one: one table, or one for each of its parts.
///
/// # Errors
/// A file that cannot be read, or of an unsupported format.
pub(crate) fn open(file: String, medium: &ByteSource) -> Result<Vec<Table>, Error> {
    if let Some(path) = medium.path()
        && path.metadata().is_ok_and(|found| !found.is_file())
    {
        // A log is read several times, which pipes and endless devices do not allow.
        let message = "the log is not a regular file";
        let problem = Problem::new(Code::UNREADABLE_LOG, message).file(file.as_str());
        return Err(problem.help("write it to a file first").into());
    }
    let mut first = beginning(&file, medium)?;
    let mut unpacked = None;
    if first.starts_with(unpacking::GZIP) {
        let own = unpacking::gunzip(medium).map_err(|why| {
            let problem = Problem::new(Code::LOG_FORMAT, why).file(file.as_str());
            problem.help("copy it again, or unpack it first")
        })?;
        first = beginning(&file, &own)?;
        unpacked = Some(own);
    }
    let format = of(&first).map_err(|problem| problem.file(file.as_str()))?;
    (format.open)(file, unpacked.as_ref().unwrap_or(medium))
}

/// First bytes of a file.
fn beginning(file: &str, medium: &ByteSource) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    medium
        .open()
        .and_then(|input| input.take(BEGINNING as u64).read_to_end(&mut bytes))
        .map_err(|error| unreadable(file, &error))?;
    Ok(bytes)
}

/// Recognises the format from the first bytes.
fn of(beginning: &[u8]) -> Result<&'static Format, Problem> {
    let mut refused = REFUSED.iter();
    if let Some((_, what, help)) = refused.find(|(magic, ..)| beginning.starts_with(magic)) {
        return Err(Problem::new(Code::LOG_FORMAT, *what).help(*help));
    }
    let mut optional = OPTIONAL.iter();
    if let Some((_, what, feature, help)) =
        optional.find(|(magic, ..)| beginning.starts_with(magic))
    {
        let message = format!("{what}, which this build of overact does not support");
        return Err(Problem::new(Code::LOG_FORMAT, message).help(format!(
            "install the command with the feature `{feature}`: `cargo install --locked overact-cli --features {feature}`, or `cargo run --release --features {feature} -- …` in a clone; or {help}"
        )));
    }
    if let Some(format) = FORMATS.iter().find(|format| (format.is)(beginning)) {
        return Ok(format);
    }
    if is_matlab_4(beginning) {
        let message = "the file is of MATLAB's version 4, which is not supported";
        let problem = Problem::new(Code::LOG_FORMAT, message);
        return Err(problem.help("save it in MATLAB with `save(..., '-v7')`, or export CSV"));
    }
    let message = "the file is neither text nor of a known format";
    let names: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
    let help = format!("this build of overact reads {}", names.join(", "));
    Err(Problem::new(Code::LOG_FORMAT, message).help(help))
}

/// Whether a file starts as one of MATLAB's versions 5 to 7.2, whose header ends with version and
/// byte order.
fn is_mat(file: &[u8]) -> bool {
    let end = file.get(124..128);
    matches!(end, Some(b"\x00\x01IM" | b"\x01\x00MI")) || file.starts_with(b"MATLAB 5.0")
}

fn is_text(file: &[u8]) -> bool {
    let is_printed = |byte: &u8| !byte.is_ascii_control() || b"\t\n\r\x0c\x1a".contains(byte);
    file.iter().all(is_printed)
}

/// Whether a file starts as one of MATLAB's version 4.
///
/// It starts with five integers of 32 bits: the type M·1000 + O·100 + P·10 + T with O = 0, rows,
/// columns, whether numbers are complex, and the length of the name.
fn is_matlab_4(file: &[u8]) -> bool {
    let Some(header) = file.first_chunk::<20>() else {
        return false;
    };
    let number = |at: usize, is_little: bool| {
        let bytes = [header[at], header[at + 1], header[at + 2], header[at + 3]];
        if is_little {
            u32::from_le_bytes(bytes)
        } else {
            u32::from_be_bytes(bytes)
        }
    };
    [true, false].into_iter().any(|is_little| {
        let own = |at: usize| number(at, is_little);
        let (kind, complex, name) = (own(0), own(12), own(16));
        let machine = if is_little { 0 } else { 1 };
        let is_kind = kind / 1000 == machine && kind / 100 % 10 == 0;
        is_kind && kind / 10 % 10 <= 5 && kind % 10 <= 2 && complex <= 1 && (1..256).contains(&name)
    })
}

/// Whether a text starts with a JSON object, or a list of objects.
fn is_json(beginning: &[u8]) -> bool {
    let text = beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning);
    let text = text.trim_ascii_start();
    let first = match text.strip_prefix(b"[") {
        Some(rest) => rest.trim_ascii_start(),
        None => text,
    };
    let inside = first.strip_prefix(b"{").map(<[u8]>::trim_ascii_start);
    inside.is_some_and(|inside| inside.first().is_some_and(|byte| b"\"}".contains(byte)))
}

#[cfg(test)]
mod tests {
    use super::of;

    fn name(first: &[u8]) -> Option<&'static str> {
        of(first).ok().map(|format| format.name)
    }

    #[test]
    fn the_format_is_detected_from_the_first_bytes() {
        assert_eq!(name(b""), Some("text (CSV)"));
        assert_eq!(name("time;q\u{e9}\n".as_bytes()), Some("text (CSV)"));
        for json in [
            "{\"t\":0}\n",
            "\u{feff}\n{ \"t\":0}",
            "[\n  {\n\"t\": 0",
            "{}\n{\"t\":0}",
        ] {
            assert_eq!(name(json.as_bytes()), Some("JSON Lines"), "{json}");
        }
        assert_eq!(name(b"[rad],{deg}\n"), Some("text (CSV)"));
        let mut mat = vec![b' '; 128];
        mat[124..].copy_from_slice(b"\x00\x01IM");
        assert_eq!(name(&mat), Some("MATLAB's `.mat`"));
        let unknown = of(b"\x00\x01\x02").err().expect("unknown");
        assert!(unknown.message.contains("neither text nor"), "{unknown}");
        assert_eq!(name(b"PAR1\x15\x04"), Some("Parquet"));
        let encrypted = of(b"PARE\x15\x04").err().expect("encrypted");
        assert!(encrypted.message.contains("encrypted"), "{encrypted}");
    }
}
