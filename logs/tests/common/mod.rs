//! Location of reference data.

use std::path::PathBuf;

/// A file of the reference data: in `OVERACT_SHARED`, or `shared` next to the repository.
///
/// `None`, with a message, if it does not exist.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("OVERACT_SHARED").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let file = folder.join(path);
    if file.exists() {
        Some(file)
    } else {
        eprintln!(
            "skipped: the reference data {path} are not here; set OVERACT_SHARED to their folder"
        );
        None
    }
}
