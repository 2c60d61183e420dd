//! Checks the paths of output files, and writes them completely or not at all.
//!
//! The check comes before any work: no output may overwrite an input or another output.

use crate::{
    failure::{Failure, Problem},
    input::is_stream,
    signals,
};
use overact_codegen::diagnostic::Code;
use std::{
    fs, io,
    io::Write,
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// Largest number of symbolic links that are followed, as in Linux.
const MAX_LINKS: usize = 40;

/// Runs [`check_distinct`], and checks that the folder of every output exists.
///
/// # Errors
/// As [`check_distinct`], or a folder that does not exist.
pub(crate) fn check<'a>(inputs: &[&'a Path], outputs: &[&'a Path]) -> Result<(), Failure> {
    check_distinct(inputs, outputs)?;
    for output in outputs {
        let folder = output.parent().filter(|f| !f.as_os_str().is_empty());
        if folder.is_some_and(|folder| !folder.is_dir()) {
            let error = io::Error::from(io::ErrorKind::NotFound);
            return Err(unwritable(output, &error));
        }
    }
    Ok(())
}

/// Checks that every output differs from all inputs and other outputs, and may be written.
///
/// Symbolic links are followed. Devices and pipes are not compared.
///
/// # Errors
/// Arguments that name one file twice, or files that may not be written.
pub(crate) fn check_distinct<'a>(inputs: &[&'a Path], outputs: &[&'a Path]) -> Result<(), Failure> {
    if outputs.iter().any(|output| is_stream(output)) {
        let message = "`-` is standard output, which is for the result of `-o` only: write `./-` for a file of that name";
        return Err(Failure::Usage(message.to_owned()));
    }
    if inputs.iter().filter(|input| is_stream(input)).count() > 1 {
        let message =
            "`-` is standard input, which can be read once: give the other inputs as files";
        return Err(Failure::Usage(message.to_owned()));
    }
    let is_regular = |path: &&&Path| fs::metadata(path).map_or(true, |existing| existing.is_file());
    let outputs: Vec<&Path> = outputs.iter().filter(is_regular).copied().collect();
    for (at, output) in outputs.iter().enumerate() {
        let identity = identity(output);
        if let Some(input) = inputs
            .iter()
            .find(|input| self::identity(input) == identity)
        {
            return Err(Failure::Usage(format!(
                "the output `{}` would replace `{}`, which the command reads: choose another name",
                output.display(),
                input.display()
            )));
        }
        let earlier = outputs[..at].iter();
        if earlier
            .clone()
            .any(|other| self::identity(other) == identity)
        {
            let message = format!("two results would be written to `{}`", output.display());
            return Err(Failure::Usage(message));
        }
    }
    let problems: Vec<Problem> = outputs
        .iter()
        .filter_map(|output| check_writable(output).err().map(|e| (output, e)))
        .map(|(output, error)| unwritable_problem(output, &error))
        .collect();
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems.into())
    }
}

/// Identity of a file, equal for all paths to it.
#[derive(Debug, PartialEq, Eq)]
enum Identity {
    /// Device and inode numbers, equal for symbolic and hard links to one file.
    #[cfg(unix)]
    Numbers(u64, u64),
    /// Path without symbolic links, for a file that does not exist yet.
    Path(PathBuf),
}

fn identity(path: &Path) -> Identity {
    // `-` is stdin, which the shell may have opened from one of the files.
    let path = if path.as_os_str() == "-" {
        Path::new("/dev/stdin")
    } else {
        path
    };
    #[cfg(unix)]
    if let Ok(existing) = fs::metadata(path) {
        use std::os::unix::fs::MetadataExt;
        return Identity::Numbers(existing.dev(), existing.ino());
    }
    Identity::Path(resolved(path))
}

/// Path without symbolic links; its last component may not exist.
fn resolved(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(target) = fs::read_link(&path) else {
            break;
        };
        path = folder(&path).join(target);
    }
    if let Ok(canonical) = fs::canonicalize(&path) {
        return canonical;
    }
    match (fs::canonicalize(folder(&path)), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path,
    }
}

/// The folder of a file.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Checks the permission to write to a file, if it exists.
///
/// Renaming another file over it would only require the permission of the folder.
fn check_writable(path: &Path) -> io::Result<()> {
    let Ok(existing) = fs::metadata(path) else {
        return Ok(());
    };
    if existing.is_file() {
        // A privileged user can open any file; respect its read-only flag nevertheless.
        if existing.permissions().readonly() {
            return Err(io::Error::from(io::ErrorKind::ReadOnlyFilesystem));
        }
        fs::OpenOptions::new().write(true).open(path)?;
    }
    Ok(())
}

/// Writes files through temporary files, which are renamed when all are complete.
///
/// An error before the first rename leaves all old files unchanged. If a later rename fails, the
/// files before it are already replaced.
///
/// # Errors
/// A folder that cannot be written, or a file that may not be replaced.
pub(crate) fn write(files: Vec<(PathBuf, Vec<u8>)>) -> Result<(), Failure> {
    let mut staged = Vec::new();
    for (path, bytes) in files {
        let staging = stage(&path, &bytes).map_err(|error| unwritable(&path, &error))?;
        staged.push((path, staging, bytes));
    }
    for (path, staging, bytes) in staged {
        let done = match staging {
            StagedFile::Temporary(file, target) => signals::persist(file, &target),
            StagedFile::Device => fs::write(&path, bytes),
        };
        done.map_err(|error| unwritable(&path, &error))?;
    }
    Ok(())
}

/// Output that is ready to become visible under its name.
enum StagedFile {
    /// Complete temporary file, and its final path.
    Temporary(NamedTempFile, PathBuf),
    /// Device or pipe, such as `/dev/stdout`, which is written to and never replaced.
    Device,
}

/// Writes the temporary file of an output.
fn stage(path: &Path, bytes: &[u8]) -> io::Result<StagedFile> {
    let existing = fs::metadata(path).ok();
    if let Some(existing) = &existing {
        if existing.is_dir() {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        if !existing.is_file() {
            return Ok(StagedFile::Device);
        }
    }
    check_writable(path)?;
    // Replace the target of a link, not the link.
    let target = resolved(path);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".overact-");
    let permissions = existing
        .as_ref()
        .map(fs::Metadata::permissions)
        .or_else(usual_permissions);
    let folder = folder(&target);
    if let Some(permissions) = permissions {
        builder.permissions(permissions);
    }
    let mut file = signals::guarded(|| builder.tempfile_in(folder))?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(StagedFile::Temporary(file, target))
}

/// Permissions of new files before the umask; temporary files are private by default.
#[cfg(unix)]
fn usual_permissions() -> Option<fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<fs::Permissions> {
    None
}

/// Failure with the reason why a file cannot be written.
fn unwritable(path: &Path, error: &io::Error) -> Failure {
    unwritable_problem(path, error).into()
}

/// Reason why a file cannot be written.
///
/// The text is that of the error's kind, since the error itself may name the temporary file.
fn unwritable_problem(path: &Path, error: &io::Error) -> Problem {
    let reason = match error.kind() {
        io::ErrorKind::NotFound if folder(path).is_dir() => {
            "its folder does not accept files".to_owned()
        }
        io::ErrorKind::NotFound => "its folder does not exist".to_owned(),
        io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::ReadOnlyFilesystem => "it is read-only".to_owned(),
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        kind => kind.to_string(),
    };
    let problem = Problem::new(Code::OUTPUT, format!("the file can't be written: {reason}"));
    problem.file(path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::{check, check_distinct, write};
    use crate::failure::Failure;
    use std::fs;

    #[test]
    fn a_write_error_leaves_all_files_unchanged() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let (good, bad) = (
            folder.path().join("a.csv"),
            folder.path().join("none/b.csv"),
        );
        fs::write(&good, "old")?;
        assert!(write(vec![(good.clone(), b"new".to_vec()), (bad, Vec::new())]).is_err());
        assert_eq!(fs::read_to_string(&good)?, "old");
        assert!(write(vec![(good.clone(), b"new".to_vec())]).is_ok());
        assert_eq!(fs::read_to_string(&good)?, "new");
        assert_eq!(fs::read_dir(folder.path())?.count(), 1);
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn links_to_the_same_file_are_recognised() -> std::io::Result<()> {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir()?;
        let at = |name: &str| folder.path().join(name);
        fs::write(at("log.csv"), "measured")?;
        fs::create_dir(at("sub"))?;
        symlink(at("log.csv"), at("link.csv"))?;
        symlink("../log.csv", at("sub/link.csv"))?;
        symlink("nothing.csv", at("dangling.csv"))?;
        fs::hard_link(at("log.csv"), at("hard.csv"))?;
        let log = at("log.csv");
        for name in [
            "log.csv",
            "sub/../log.csv",
            "link.csv",
            "sub/link.csv",
            "hard.csv",
        ] {
            let found = check(&[&log], &[&at(name)]);
            assert!(matches!(found, Err(Failure::Usage(_))), "{name}");
            // The other way round: the input is the link.
            let found = check(&[&at(name)], &[&log]);
            assert!(matches!(found, Err(Failure::Usage(_))), "{name}");
        }
        assert!(check(&[&log], &[&at("new.csv"), &at("sub/new.csv")]).is_ok());
        for other in ["nothing.csv", "sub/../nothing.csv", "dangling.csv"] {
            let found = check(&[], &[&at("dangling.csv"), &at(other)]);
            assert!(matches!(found, Err(Failure::Usage(_))), "{other}");
        }
        assert!(check(&[], &[&at("none/new.csv")]).is_err());
        let dash = check(&[], &[std::path::Path::new("-")]);
        assert!(matches!(dash, Err(Failure::Usage(_))));
        assert!(check_distinct(&[], &[&at("none/new.csv")]).is_ok());
        let nowhere = std::path::Path::new("/dev/null");
        assert!(check(&[], &[nowhere, nowhere]).is_ok());
        // The target of the link is written, and the link stays.
        assert!(write(vec![(at("dangling.csv"), b"new".to_vec())]).is_ok());
        assert_eq!(fs::read_to_string(at("nothing.csv"))?, "new");
        assert!(fs::symlink_metadata(at("dangling.csv"))?.is_symlink());
        Ok(())
    }

    #[test]
    fn a_read_only_file_is_not_replaced() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("kept.csv");
        fs::write(&path, "kept")?;
        let mut permissions = fs::metadata(&path)?.permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions)?;
        for failure in [
            check(&[], &[&path]),
            write(vec![(path.clone(), Vec::new())]),
        ] {
            let text = failure.expect_err("a refusal").render(false);
            assert!(text.contains("it is read-only"), "{text}");
        }
        assert_eq!(fs::read_to_string(&path)?, "kept");
        Ok(())
    }
}
