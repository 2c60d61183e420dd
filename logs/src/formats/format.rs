//! Recognises the format of a log from its first bytes, never from its name.

use overact::Code;
use std::io::Read;

use crate::{
    bytes::{byte_source::ByteSource, unpacking},
    error::{Error, Problem},
    problems::unreadable,
};

/// Number of bytes that determine the format.
const BEGINNING: usize = 4096;

/// Supported formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    /// Lines of numbers.
    Text,
    /// JSON objects, one per line or in a list.
    JsonLines,
    /// MATLAB versions 5 to 7.2.
    Mat,
    /// NumPy's `.npy`.
    Array,
    /// Parquet.
    Parquet,
    /// A zip archive, possibly NumPy's `.npz`.
    Archive,
    /// HDF5, including MATLAB version 7.3.
    #[cfg(feature = "hdf5")]
    Hdf5,
    /// MCAP.
    #[cfg(feature = "mcap")]
    Mcap,
}

/// Formats of optional features: magic bytes, description, feature, and help without it.
const OPTIONAL: [(&[u8], &str, &str, &str); 3] = [
    (
        b"MATLAB 7.3",
        "the file is of MATLAB's version 7.3, which is HDF5",
        "hdf5",
        "save it in MATLAB with `save(..., '-v7')`",
    ),
    (HDF5, "the file is HDF5", "hdf5", "export CSV"),
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

/// Recognises the format of a file; the second value is the unpacked file if it is compressed.
///
/// # Errors
/// A file that cannot be read, or of an unsupported format.
pub(crate) fn recognise(
    file: &str,
    medium: &ByteSource,
) -> Result<(Format, Option<ByteSource>), Error> {
    if let Some(path) = medium.path()
        && path.metadata().is_ok_and(|found| !found.is_file())
    {
        // A log is read several times, which pipes and endless devices do not allow.
        let message = "the log is not a regular file";
        let problem = Problem::new(Code::UNREADABLE_LOG, message).file(file);
        return Err(problem.help("write it to a file first").into());
    }
    let mut first = beginning(file, medium)?;
    let mut unpacked = None;
    if first.starts_with(unpacking::GZIP) {
        let own = unpacking::gunzip(medium).map_err(|why| {
            let problem = Problem::new(Code::LOG_FORMAT, why).file(file);
            problem.help("copy it again, or unpack it first")
        })?;
        first = beginning(file, &own)?;
        unpacked = Some(own);
    }
    let format = of(&first).map_err(|problem| problem.file(file))?;
    Ok((format, unpacked))
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
fn of(beginning: &[u8]) -> Result<Format, Problem> {
    let mut refused = REFUSED.iter();
    if let Some((_, what, help)) = refused.find(|(magic, ..)| beginning.starts_with(magic)) {
        return Err(Problem::new(Code::LOG_FORMAT, *what).help(*help));
    }
    #[cfg(feature = "hdf5")]
    if beginning.starts_with(b"MATLAB 7.3") || beginning.starts_with(HDF5) {
        return Ok(Format::Hdf5);
    }
    #[cfg(feature = "mcap")]
    if beginning.starts_with(MCAP) {
        return Ok(Format::Mcap);
    }
    let mut optional = OPTIONAL.iter();
    if let Some((_, what, feature, help)) =
        optional.find(|(magic, ..)| beginning.starts_with(magic))
    {
        let message = format!("{what}, which this build of overact does not support");
        return Err(Problem::new(Code::LOG_FORMAT, message).help(format!(
            "build it with the feature `{feature}`: `cargo run --release --features {feature} -- …`; or {help}"
        )));
    }
    // The header of a `.mat` file ends with its version and byte order.
    let is_mat = matches!(beginning.get(124..128), Some(b"\x00\x01IM" | b"\x01\x00MI"));
    if is_mat || beginning.starts_with(b"MATLAB 5.0") {
        return Ok(Format::Mat);
    }
    if beginning.starts_with(b"\x93NUMPY") {
        return Ok(Format::Array);
    }
    if beginning.starts_with(b"PAR1") {
        return Ok(Format::Parquet);
    }
    if beginning.starts_with(b"PK\x03\x04") {
        return Ok(Format::Archive);
    }
    let is_text = |byte: &u8| !byte.is_ascii_control() || b"\t\n\r\x0c\x1a".contains(byte);
    if beginning.iter().all(is_text) {
        return Ok(if is_json(beginning) {
            Format::JsonLines
        } else {
            Format::Text
        });
    }
    if is_matlab_4(beginning) {
        let message = "the file is of MATLAB's version 4, which is not supported";
        let problem = Problem::new(Code::LOG_FORMAT, message);
        return Err(problem.help("save it in MATLAB with `save(..., '-v7')`, or export CSV"));
    }
    let message = "the file is neither text nor of a known format";
    Err(Problem::new(Code::LOG_FORMAT, message).help(
        "logs are text (CSV), JSON Lines, Parquet, MATLAB's `.mat`, NumPy's `.npy` and `.npz`, HDF5 or MCAP",
    ))
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
    use super::{Format, of};

    #[test]
    fn first_bytes_tell_the_format() {
        assert_eq!(of(b""), Ok(Format::Text));
        assert_eq!(of("time;q\u{e9}\n".as_bytes()), Ok(Format::Text));
        for json in [
            "{\"t\":0}\n",
            "\u{feff}\n{ \"t\":0}",
            "[\n  {\n\"t\": 0",
            "{}\n{\"t\":0}",
        ] {
            assert_eq!(of(json.as_bytes()), Ok(Format::JsonLines), "{json}");
        }
        assert_eq!(of(b"[rad],{deg}\n"), Ok(Format::Text));
        let mut mat = vec![b' '; 128];
        mat[124..].copy_from_slice(b"\x00\x01IM");
        assert_eq!(of(&mat), Ok(Format::Mat));
        let unknown = of(b"\x00\x01\x02").expect_err("unknown");
        assert!(unknown.message.contains("neither text nor"), "{unknown}");
        assert_eq!(of(b"PAR1\x15\x04"), Ok(Format::Parquet));
        let encrypted = of(b"PARE\x15\x04").expect_err("encrypted");
        assert!(encrypted.message.contains("encrypted"), "{encrypted}");
    }
}
