//! Bytes of files: their source, limits on unpacked sizes, and temporary storage of samples.

pub(crate) mod budget;
pub(crate) mod byte_source;
pub(crate) mod temporary_store;
pub(crate) mod unpacking;
