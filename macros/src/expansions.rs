//! Cache of generated code, by its input.
//!
//! The compiler expands a crate again after every change, and so does an editor at every key press.
//! The unoptimised generator takes a minute for a large robot, reading the code from a file a few
//! milliseconds. The files are in the folder of this crate's build script, inside the user's target
//! folder. If anything fails, the generator runs again, without a message.
//!
//! A file begins with a title line and a checksum. Then follow the complete input, so that no two
//! descriptions are confused, and the code. It is written under another name and renamed, because
//! several compilers may write it at once.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// First line of a file.
const TITLE: &str = "overact expansion 1";

/// Largest number of files; the oldest are removed first.
const MOST: usize = 48;

/// Largest size of a valid file, in bytes.
const LARGEST: u64 = 1 << 28;

/// A robot's code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Expansion {
    /// First line of the type's documentation.
    pub(crate) summary: String,
    /// The remaining lines of documentation.
    pub(crate) documentation: Vec<String>,
    /// The items after the type.
    pub(crate) items: String,
}

/// The folder of the files, if it exists.
///
/// The path in a binary built on another machine, as in shared compilation caches, may not exist.
pub(crate) fn folder() -> Option<PathBuf> {
    let built = Path::new(env!("OUT_DIR"));
    let folder = built.join("expansions");
    let is_there = folder.is_dir() || (built.is_dir() && fs::create_dir(&folder).is_ok());
    // Another compiler may have created it first.
    (is_there || folder.is_dir()).then_some(folder)
}

/// The code that was generated from this input, if the file exists and is intact.
pub(crate) fn read(folder: &Path, key: &str) -> Option<Expansion> {
    let file = file(folder, key);
    let length = fs::metadata(&file).ok()?.len();
    let text = (length <= LARGEST).then(|| fs::read_to_string(&file).ok())??;
    let (title, rest) = text.split_once('\n')?;
    let (checksum, body) = rest.split_once('\n')?;
    let is_whole = title == TITLE && checksum == hash(body);
    let mut parts = Parts(is_whole.then_some(body)?);
    if parts.next()? != key {
        return None;
    }
    let count = parts.next()?.parse::<usize>().ok()?;
    let (summary, items) = (parts.next()?.to_owned(), parts.next()?.to_owned());
    let documentation: Vec<String> =
        std::iter::from_fn(|| parts.next().map(str::to_owned)).collect();
    (documentation.len() == count).then_some(Expansion {
        summary,
        documentation,
        items,
    })
}

/// Stores code for later expansions, if possible.
pub(crate) fn keep(folder: &Path, key: &str, expansion: &Expansion) {
    let count = expansion.documentation.len().to_string();
    let head = [key, &count, &expansion.summary, &expansion.items];
    let lines = expansion.documentation.iter().map(String::as_str);
    let parts = head.into_iter().chain(lines);
    let body: String = parts
        .map(|part| format!("{}\n{part}\n", part.len()))
        .collect();
    let text = format!("{TITLE}\n{}\n{body}", hash(&body));
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let now = now.map_or(0, |since| since.as_nanos());
    let file = file(folder, key);
    let unfinished = file.with_extension(format!("{}-{now}", std::process::id()));
    let is_kept = fs::write(&unfinished, text).and_then(|()| fs::rename(&unfinished, &file));
    if is_kept.is_err() {
        // There may be nothing to remove.
        let _ = fs::remove_file(&unfinished);
    }
    leave_few(folder);
}

/// Removes the oldest files above the limit.
fn leave_few(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    let aged = |entry: fs::DirEntry| Some((entry.metadata().ok()?.modified().ok()?, entry.path()));
    let mut files: Vec<(SystemTime, PathBuf)> = entries.flatten().filter_map(aged).collect();
    files.sort();
    let too_many = files.len().saturating_sub(MOST);
    for (_, file) in files.into_iter().take(too_many) {
        // Another compiler may have removed it first.
        let _ = fs::remove_file(file);
    }
}

fn file(folder: &Path, key: &str) -> PathBuf {
    folder.join(hash(key))
}

fn hash(text: &str) -> String {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

/// Parts, each after a line with its length in bytes.
struct Parts<'a>(&'a str);

impl<'a> Parts<'a> {
    fn next(&mut self) -> Option<&'a str> {
        let (length, rest) = self.0.split_once('\n')?;
        let length = length.parse().ok()?;
        let (part, rest) = (rest.get(..length)?, rest.get(length..)?);
        self.0 = rest.strip_prefix('\n')?;
        Some(part)
    }
}

#[cfg(test)]
mod tests {
    use super::{Expansion, MOST, keep, read};
    use std::fs;
    use std::path::PathBuf;

    fn expansion(items: &str) -> Expansion {
        Expansion {
            summary: " A robot.".to_owned(),
            documentation: vec![String::new(), " 3 legs\nand more".to_owned()],
            items: items.to_owned(),
        }
    }

    /// An empty folder of this test.
    fn folder(test: &str) -> PathBuf {
        let folder = super::folder()
            .expect("a build folder")
            .join(format!("test-{test}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("writable");
        folder
    }

    #[test]
    fn cached_expansions_are_read_only_by_their_key() {
        let folder = folder("kept");
        assert_eq!(read(&folder, "key"), None);
        keep(&folder, "key", &expansion("impl A {} // ⋯"));
        assert_eq!(read(&folder, "key"), Some(expansion("impl A {} // ⋯")));
        assert_eq!(read(&folder, "another"), None);
        // Two keys of equal hash would share a file.
        fs::rename(super::file(&folder, "key"), super::file(&folder, "another")).expect("moved");
        assert_eq!(read(&folder, "another"), None);
        keep(&folder, "another", &expansion("impl B {}"));
        assert_eq!(read(&folder, "another"), Some(expansion("impl B {}")));
        fs::remove_dir_all(folder).expect("removed");
    }

    #[test]
    fn damaged_files_and_missing_folders_are_cache_misses() {
        let folder = folder("damaged");
        let whole = expansion("impl A { fn a() {} }");
        keep(&folder, "key", &whole);
        let file = super::file(&folder, "key");
        let bytes = fs::read(&file).expect("kept");
        for at in 0..bytes.len() {
            fs::write(&file, &bytes[..at]).expect("writable");
            assert_eq!(read(&folder, "key"), None, "cut at {at}");
            let mut other = bytes.clone();
            other[at] ^= 1;
            fs::write(&file, &other).expect("writable");
            assert_eq!(read(&folder, "key"), None, "changed at {at}");
        }
        fs::remove_file(&file).expect("removed");
        fs::create_dir(&file).expect("a folder in its place");
        keep(&folder, "key", &whole);
        assert_eq!(read(&folder, "key"), None);
        assert_eq!(
            fs::read_dir(&folder).expect("there").count(),
            1,
            "nothing unfinished is left"
        );
        fs::remove_dir_all(&folder).expect("removed");
        keep(&folder, "key", &whole);
        assert!(!folder.exists(), "no folder is made");
    }

    #[test]
    fn old_cache_files_are_evicted() {
        let folder = folder("room");
        for at in 0..MOST + 5 {
            keep(&folder, &at.to_string(), &expansion("impl A {}"));
        }
        assert_eq!(fs::read_dir(&folder).expect("there").count(), MOST);
        assert!(read(&folder, &(MOST + 4).to_string()).is_some());
        fs::remove_dir_all(folder).expect("removed");
    }
}
