//! Pages of a column, unpacked and checked for assumptions of the library.

use std::sync::Arc;

use parquet::{
    basic::{Compression, Encoding},
    column::page::{Page, PageMetadata, PageReader},
    errors::{ParquetError, Result},
    file::{metadata::ColumnChunkMetaData, serialized_reader::SerializedPageReader},
};

use super::packed::Packing;
use crate::bytes::byte_source::Opened;

/// Pages of a column within a row group.
pub(super) struct Pages {
    pages: SerializedPageReader<Opened>,
    packing: Option<Packing>,
    has_dictionary: bool,
}

impl Pages {
    /// Starts at the first page.
    ///
    /// # Errors
    /// A compression that the library does not know.
    pub(super) fn new(
        input: &Arc<Opened>,
        chunk: &ColumnChunkMetaData,
        rows: usize,
    ) -> Result<Self> {
        let packing = Packing::of(chunk);
        let mut chunk = chunk.clone();
        if packing.is_some() {
            // Makes the library return the compressed bytes.
            let plain = chunk.into_builder();
            chunk = plain.set_compression(Compression::UNCOMPRESSED).build()?;
        }
        Ok(Self {
            pages: SerializedPageReader::new(Arc::clone(input), &chunk, rows, None)?,
            packing,
            has_dictionary: false,
        })
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let mut page = self.pages.get_next_page()?;
        if let (Some(packing), Some(page)) = (self.packing, &mut page) {
            packing.unpack(page)?;
        }
        let encoding = match &page {
            Some(Page::DictionaryPage { .. }) => {
                self.has_dictionary = true;
                None
            }
            Some(Page::DataPage { encoding, .. } | Page::DataPageV2 { encoding, .. }) => {
                Some(*encoding)
            }
            None => None,
        };
        let asks = matches!(
            encoding,
            Some(Encoding::RLE_DICTIONARY | Encoding::PLAIN_DICTIONARY)
        );
        if asks && !self.has_dictionary {
            let why = String::from("a page lacks its dictionary");
            return Err(ParquetError::General(why));
        }
        Ok(page)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.pages.skip_next_page()
    }
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}
