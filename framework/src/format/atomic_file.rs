use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

/// A file that appears under its name only when it is complete.
///
/// Bytes go to a hidden temporary file in the same folder, which [`AtomicFile::commit`] syncs and
/// renames. Dropped without a commit it is removed, and what stood under the name stays. A process
/// that is killed leaves at most the temporary file, whose name ends in `.part`; the next output into
/// the same folder removes it.
#[derive(Debug)]
pub struct AtomicFile {
    target: PathBuf,
    temporary: PathBuf,
    file: BufWriter<File>,
    /// False after a write failed: what follows would not be where it belongs.
    intact: bool,
    committed: bool,
}

impl AtomicFile {
    /// Begins a file that will be called `path`; its folder must exist.
    ///
    /// # Errors
    /// If `path` does not end in a file name, or the temporary file cannot be created.
    pub fn create(path: &Path) -> io::Result<Self> {
        let temporary = temporary_beside(path)?;
        let file = File::create(&temporary)?;
        // Tells others that somebody is at it; where there are no locks, they do not ask for one either.
        let _ = file.try_lock();
        let file = BufWriter::new(file);
        Ok(Self { target: path.to_path_buf(), temporary, file, intact: true, committed: false })
    }

    /// Makes the file durable and gives it its name, replacing any file that had it.
    ///
    /// # Errors
    /// If a write had failed before, or if writing the rest, syncing or renaming fails: then what
    /// stood under the name is still there. If the folder cannot be synced: then the file has its
    /// name, but a loss of power may take it away. A file system that does not sync folders at all is
    /// no error.
    pub fn commit(mut self) -> io::Result<()> {
        if !self.intact {
            return Err(io::Error::other("an earlier write to this file failed"));
        }
        self.file.flush()?;
        self.file.get_ref().sync_all()?;
        fs::rename(&self.temporary, &self.target)?;
        self.committed = true;
        sync_folder(&self.target)
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes);
        self.intact &= not_broken(&written);
        written
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        self.intact &= not_broken(&flushed);
        flushed
    }
}

/// An interrupted write has written nothing and is simply repeated by its caller.
fn not_broken<T>(outcome: &io::Result<T>) -> bool {
    outcome.as_ref().err().is_none_or(|error| error.kind() == io::ErrorKind::Interrupted)
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if !self.committed {
            // Nobody is left to tell; a `.part` file that stays does no harm.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// A name in the same folder, hence on the same disk, that no other writer uses.
fn temporary_beside(path: &Path) -> io::Result<PathBuf> {
    static FILES: AtomicU64 = AtomicU64::new(0);
    let name = path.file_name().ok_or_else(|| {
        io::Error::new(io::ErrorKind::InvalidInput, "the path does not end in a file name")
    })?;
    let number = FILES.fetch_add(1, Ordering::Relaxed);
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}-{number}.part", process::id()));
    Ok(path.with_file_name(hidden))
}

/// Removes what killed processes have left of their [`AtomicFile`]s in `folder`, as far as it can.
///
/// Whether the process of a file lives is told by its lock: on a file system without locks, the file
/// stays.
pub(crate) fn remove_abandoned(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten().filter(|entry| is_temporary(&entry.file_name())) {
        let file = File::options().write(true).open(entry.path());
        if file.is_ok_and(|file| file.try_lock().is_ok()) {
            // One that stays does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a name is of the form that [`temporary_beside`] gives.
fn is_temporary(name: &OsStr) -> bool {
    let marks = name.to_str().and_then(|name| name.strip_prefix('.')?.strip_suffix(".part"));
    let number = marks.and_then(|name| name.rsplit_once('.')?.1.split_once('-'));
    number.is_some_and(|(process, file)| {
        process.parse::<u32>().is_ok() && file.parse::<u64>().is_ok()
    })
}

/// Makes the renaming itself survive a loss of power.
#[cfg(unix)]
fn sync_folder(file: &Path) -> io::Result<()> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    match File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all()) {
        Err(error) if is_not_offered(error.kind()) => Ok(()),
        outcome => outcome,
    }
}

/// Whether syncing a folder is no matter of luck here: some network file systems do not have it, and
/// a folder that may be written need not be one that may be opened.
#[cfg(unix)]
fn is_not_offered(kind: io::ErrorKind) -> bool {
    use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    matches!(kind, InvalidInput | PermissionDenied | Unsupported)
}

/// Elsewhere a folder cannot be opened to be synced.
#[cfg(not(unix))]
fn sync_folder(_file: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk that is full for a moment must not leave a file with a hole in it.
    #[test]
    fn a_file_that_missed_a_write_is_never_committed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result");
        fs::write(&path, "old").unwrap();
        let mut file = AtomicFile::create(&path).unwrap();
        let sound = std::mem::replace(
            &mut file.file,
            BufWriter::new(File::open(&path).unwrap()), // open for reading: every write fails
        );
        assert!(file.write_all(&[0; 100_000]).is_err());
        file.file = sound;
        file.write_all(b"the rest").unwrap();
        assert!(file.commit().is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// `/proc` does not sync folders: it says that the argument is invalid.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_that_cannot_be_synced_is_no_error() {
        assert!(File::open("/proc/self").unwrap().sync_all().is_err());
        sync_folder(Path::new("/proc/self/file")).unwrap();
        let missing = sync_folder(Path::new("/proc/no such folder/file")).unwrap_err();
        assert_eq!(missing.kind(), io::ErrorKind::NotFound);
    }

    #[test]
    fn what_a_killed_process_left_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let under_way = AtomicFile::create(&path("result")).unwrap();
        let kept = [".x.part", ".x.1-b.part", "x.1-0.part", "result.csv"];
        for name in kept.into_iter().chain([".result.1-0.part", ".a.b.4000000000-17.part"]) {
            fs::write(path(name), "half").unwrap();
        }
        remove_abandoned(folder.path());
        assert!(kept.into_iter().all(|name| path(name).exists()));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), kept.len() + 1);
        under_way.commit().unwrap();
        assert!(path("result").exists());
    }
}
