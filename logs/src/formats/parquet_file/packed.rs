//! Pages compressed by gzip or Zstandard.
//!
//! They are unpacked here instead of by the library. Its Zstandard needs a C compiler and doubles
//! the build time. Its gzip would be a second implementation in overact.

use std::io::Read;

use libflate::gzip::MultiDecoder;
use parquet::{
    basic::Compression,
    column::page::Page,
    errors::{ParquetError, Result},
    file::metadata::ColumnChunkMetaData,
};
use ruzstd::decoding::StreamingDecoder;

/// Largest unpacked size of a page; usual ones have a megabyte.
const LARGEST_PAGE: u64 = 1 << 27;

/// Compression of a column's pages that the library does not unpack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Method {
    Gzip,
    Zstandard,
}

/// Compression of a column's pages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Packing {
    method: Method,
    /// Largest unpacked size: that of the column, limited by that of a page.
    most: u64,
}

impl Packing {
    /// Compression of a column; `None` if the library unpacks it, or it is uncompressed.
    pub(super) fn of(chunk: &ColumnChunkMetaData) -> Option<Self> {
        let method = match chunk.compression() {
            Compression::GZIP(_) => Method::Gzip,
            Compression::ZSTD(_) => Method::Zstandard,
            _ => return None,
        };
        let most = u64::try_from(chunk.uncompressed_size()).unwrap_or(0);
        let most = most.min(LARGEST_PAGE);
        Some(Self { method, most })
    }

    /// Unpacks a page that was read as uncompressed.
    ///
    /// # Errors
    /// Bytes that cannot be unpacked, or that exceed the size in the file.
    pub(super) fn unpack(self, page: &mut Page) -> Result<()> {
        let (bytes, levels) = match page {
            Page::DataPage { buf, .. } | Page::DictionaryPage { buf, .. } => (buf, 0),
            Page::DataPageV2 {
                is_compressed: false,
                ..
            } => return Ok(()),
            Page::DataPageV2 {
                buf,
                def_levels_byte_len,
                rep_levels_byte_len,
                ..
            } => (
                buf,
                def_levels_byte_len.saturating_add(*rep_levels_byte_len),
            ),
        };
        // Pages of version 2 never compress their levels, which mark missing values.
        let split = bytes.split_at_checked(levels as usize);
        let unpacked = split
            .ok_or_else(|| String::from("a page is truncated"))
            .and_then(|(levels, packed)| self.unpacked(levels, packed));
        *bytes = unpacked.map_err(ParquetError::General)?.into();
        Ok(())
    }

    /// Returns the uncompressed start of a page, followed by the unpacked rest.
    fn unpacked(self, beginning: &[u8], mut packed: &[u8]) -> Result<Vec<u8>, String> {
        let mut page = beginning.to_vec();
        let most = self.most + 1;
        // A page without values may be empty, and a page may consist of several streams.
        while !packed.is_empty() {
            match self.method {
                Method::Gzip => {
                    let unpacking = MultiDecoder::new(&mut packed).map_err(broken)?;
                    let unpacked = unpacking.take(most).read_to_end(&mut page);
                    unpacked.map_err(broken)?;
                }
                Method::Zstandard => zstandard(&mut packed, most, &mut page)?,
            }
            if page.len() as u64 > self.most {
                let largest = LARGEST_PAGE >> 20;
                return Err(format!(
                    "a page is larger than its column, or than {largest} MB"
                ));
            }
        }
        Ok(page)
    }
}

/// Unpacks a Zstandard frame.
fn zstandard(packed: &mut &[u8], most: u64, page: &mut Vec<u8>) -> Result<(), String> {
    let mut frame = StreamingDecoder::new(packed).map_err(broken)?;
    let unpacked = frame.by_ref().take(most).read_to_end(page);
    unpacked.map_err(broken)?;
    let frame = frame.into_frame_decoder();
    let told = frame.get_checksum_from_data();
    if told.is_some() && told != frame.get_calculated_checksum() {
        return Err(broken("its checksum does not match"));
    }
    Ok(())
}

/// The message for bytes that cannot be unpacked.
fn broken(why: impl std::fmt::Display) -> String {
    format!("a page can't be unpacked: {why}")
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use libflate::gzip::Encoder;
    use parquet::{basic::Encoding, column::page::Page};
    use ruzstd::encoding::{CompressionLevel, compress_to_vec};

    use super::{Method, Packing};

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut packing = Encoder::new(Vec::new()).expect("an encoder");
        packing.write_all(bytes).expect("packed");
        packing.finish().into_result().expect("packed")
    }

    fn zstandard(bytes: &[u8]) -> Vec<u8> {
        compress_to_vec(bytes, CompressionLevel::Fastest)
    }

    /// Both compressions, with `bytes` compressed by each.
    fn both(most: u64, bytes: &[u8]) -> [(Packing, Vec<u8>); 2] {
        let packing = |method| Packing { method, most };
        [
            (packing(Method::Gzip), gzip(bytes)),
            (packing(Method::Zstandard), zstandard(bytes)),
        ]
    }

    /// A page of version 2, whose levels take `levels` bytes.
    fn page(content: Vec<u8>, levels: u32, is_compressed: bool) -> Page {
        Page::DataPageV2 {
            buf: content.into(),
            num_values: 3,
            encoding: Encoding::PLAIN,
            num_nulls: 0,
            num_rows: 3,
            def_levels_byte_len: levels,
            rep_levels_byte_len: 0,
            is_compressed,
            statistics: None,
        }
    }

    #[test]
    fn page_levels_are_not_compressed() {
        for (packing, packed) in both(12, b"0123456789") {
            let mut own = page([b"ab", &packed[..]].concat(), 2, true);
            assert!(packing.unpack(&mut own).is_ok());
            assert_eq!(own.buffer().as_ref(), b"ab0123456789");
            let mut plain = page(packed.clone(), 2, false);
            assert!(packing.unpack(&mut plain).is_ok());
            assert_eq!(plain.buffer().as_ref(), packed);
            let message = packing.unpack(&mut page(vec![1], 2, true));
            let message = message.expect_err("no levels").to_string();
            assert!(message.ends_with("a page is truncated"), "{message}");
        }
    }

    #[test]
    fn pages_of_several_frames_are_unpacked() {
        for (packing, packed) in both(20, b"0123456789") {
            let pieces = [&packed[..], &packed].concat();
            let unpacked = packing.unpacked(b"", &pieces).expect("unpacked");
            assert_eq!(unpacked, b"01234567890123456789");
            assert_eq!(packing.unpacked(b"ab", b"").expect("no values"), b"ab");
        }
    }

    #[test]
    fn corrupt_pages_are_rejected() {
        for (packing, packed) in both(9, b"0123456789") {
            let message = packing.unpacked(b"", &packed).expect_err("too large");
            assert_eq!(message, "a page is larger than its column, or than 128 MB");
        }
        for (packing, packed) in both(10, b"0123456789") {
            assert!(packing.unpacked(b"", &packed).is_ok());
            for length in 1..packed.len() {
                let message = packing.unpacked(b"", &packed[..length]);
                let message = message.expect_err("truncated");
                assert!(
                    message.starts_with("a page can't be unpacked: "),
                    "{message}"
                );
            }
            // Bytes from the end to the checksum; in gzip, the length follows it.
            let behind = match packing.method {
                Method::Gzip => 8,
                Method::Zstandard => 4,
            };
            let (mut wrong, checksum) = (packed.clone(), packed.len() - behind);
            wrong[checksum] ^= 1;
            assert!(packing.unpacked(b"", &wrong).is_err(), "{packing:?}");
        }
    }
}
