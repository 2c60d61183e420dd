//! Unpacks compressed files to temporary ones, because logs are read several times.

use std::io::{self, Read, Write};

use libflate::gzip::MultiDecoder;

use crate::bytes::byte_source::ByteSource;

/// First bytes of files compressed by gzip.
pub(crate) const GZIP: &[u8] = b"\x1f\x8b";

/// Largest unpacked size, as a multiple of the compressed size and in addition to it.
///
/// Logs of numbers shrink to about a tenth to a third. A file of zeros shrinks to a thousandth.
const LARGEST_RATIO: u64 = 100;
const ALWAYS: u64 = 1 << 28;

/// A file compressed by gzip, unpacked.
///
/// # Errors
/// A sentence on a damaged file, one that becomes too large, or a temporary folder without space.
pub(crate) fn gunzip(packed: &ByteSource) -> Result<ByteSource, String> {
    let why = |error: io::Error| match error.kind() {
        io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof => {
            String::from("the compressed file is damaged or truncated")
        }
        _ => format!("the compressed file can't be unpacked: {error}"),
    };
    let input = packed.open().map_err(why)?;
    let size = packed.size().map_err(why)?;
    let most = ALWAYS.max(size.saturating_mul(LARGEST_RATIO));
    let mut unpacked = MultiDecoder::new(io::BufReader::new(input))
        .map_err(why)?
        .take(most + 1);
    let source = packed.like(&mut |output: &mut dyn Write| io::copy(&mut unpacked, output));
    let source = source.map_err(why)?;
    if unpacked.limit() == 0 {
        return Err(format!(
            "uncompressed the file has more than {} MB, over {LARGEST_RATIO} times its size",
            most >> 20
        ));
    }
    Ok(source)
}

#[cfg(test)]
mod tests {
    use super::gunzip;
    use crate::bytes::byte_source::ByteSource;
    use libflate::gzip::Encoder;
    use std::io::{Read, Write};

    fn packed(text: &[u8]) -> Vec<u8> {
        let mut packing = Encoder::new(Vec::new()).expect("an encoder");
        packing.write_all(text).expect("packed");
        packing.finish().into_result().expect("packed")
    }

    fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, String> {
        let source = gunzip(&ByteSource::Memory(bytes.into()))?;
        let mut text = Vec::new();
        let mut opened = source.open().expect("open");
        opened.read_to_end(&mut text).expect("read");
        Ok(text)
    }

    #[test]
    fn all_gzip_members_are_unpacked() {
        let members = [packed(b"t,q\n"), packed(b"0,1\n")].concat();
        assert_eq!(unpacked(&members), Ok(b"t,q\n0,1\n".to_vec()));
    }

    #[test]
    fn truncated_and_damaged_files_are_rejected() {
        let text: Vec<u8> = (0..2000_u32).flat_map(u32::to_le_bytes).collect();
        let whole = packed(&text);
        for (at, length) in [(0, 5), (0, whole.len() / 2), (0, whole.len() - 3)] {
            let why = unpacked(&whole[at..length]).expect_err("truncated");
            assert!(why.contains("damaged or truncated"), "{why}");
        }
        let mut damaged = whole.clone();
        let place = damaged.len() - 6;
        damaged[place] ^= 1;
        assert!(unpacked(&damaged).is_err());
    }
}
