//! Atomic saving: the file always holds the old or the new text, and the old text is kept.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use tempfile::NamedTempFile;

use super::file::read_bytes;
use super::{SaveError, Saved, parse_floor, write_floor};
use crate::floor::Floor;

/// Writes the floor to `path` as [`write_floor`] does, after a check that it reads back.
///
/// It saves as [`save_text`] does, with the same guarantees.
///
/// # Errors
/// [`SaveError`]; the old file, if there was one, is then unchanged.
pub fn save_floor(floor: &Floor, path: &Path) -> Result<Saved, SaveError> {
    let text = write_floor(floor);
    match parse_floor(&text, &path.display().to_string()) {
        Ok(_) => save_text(&text, path),
        Err(diagnostics) => Err(SaveError::Unreadable(diagnostics)),
    }
}

/// Writes `text` to `path`; after a crash or power failure at any time the file holds the old or the new text.
///
/// The text goes to a new file next to it, which replaces the old file once it is on the disk. The previous content
/// is kept as `name.bak`, or `name.bak2` and so on up to `name.bak10`; after that, the oldest backup except the first
/// is removed. A symbolic link stays one: the file that it points to is replaced.
///
/// # Errors
/// [`SaveError::File`]; the old file, if there was one, is then unchanged.
pub fn save_text(text: &str, path: &Path) -> Result<Saved, SaveError> {
    write(text, path, true)
}

/// As [`save_text`], but without a backup.
///
/// # Errors
/// Those of [`save_text`].
pub fn write_over(text: &str, path: &Path) -> Result<(), SaveError> {
    write(text, path, false).map(|_| ())
}

fn write(text: &str, path: &Path, keeps_old: bool) -> Result<Saved, SaveError> {
    let failed = |doing| move |source| SaveError::File { path: path.to_path_buf(), doing, source };
    let target = match fs::canonicalize(path) {
        Ok(target) => target,
        Err(error) if error.kind() == ErrorKind::NotFound => path.to_path_buf(),
        Err(error) => return Err(failed("looking for it")(error)),
    };
    // A longer old file is not read completely: it differs from the new text.
    let old = match read_bytes(&target, text.len() as u64) {
        Ok(old) if old == text.as_bytes() => return Ok(Saved::Unchanged),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) if error.kind() != ErrorKind::FileTooLarge => {
            return Err(failed("reading the old one")(error));
        }
        Ok(_) | Err(_) => Some(fs::metadata(&target).map_err(failed("looking at the old one"))?),
    };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    // Deleted automatically if a step below fails.
    remove_left_over(folder);
    let mut file = fresh(folder).map_err(failed("making a file beside it"))?;
    // Locked while it is written, so that another process does not remove it as a left-over file.
    let _ = file.as_file().try_lock();
    file.write_all(text.as_bytes()).map_err(failed("writing"))?;
    if let Some(old) = &old {
        file.as_file().set_permissions(old.permissions()).map_err(failed("setting its permissions"))?;
    }
    file.as_file().sync_all().map_err(failed("bringing it to the disk"))?;
    let backup = old
        .filter(|_| keeps_old)
        .map(|_| back_up(&target))
        .transpose()
        .map_err(failed("keeping the old one"))?;
    file.persist(&target).map_err(|error| failed("putting it in its place")(error.error))?;
    sync_folder(folder).map_err(failed("bringing its folder to the disk"))?;
    Ok(backup.map_or(Saved::New, |backup| Saved::Replaced { backup }))
}

/// Names of temporary files.
const PREFIX: &str = ".underfoot-";
const SUFFIX: &str = ".tmp";

/// Minimum age of a left-over file: a running writer has locked its file long before.
const LEFT_OVER: Duration = Duration::from_secs(60);

/// Removes temporary files in `folder` of processes that were killed while saving; the next save retries failures.
fn remove_left_over(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        let Ok(metadata) = entry.metadata() else { continue };
        let age = metadata.modified().ok().and_then(|changed| changed.elapsed().ok());
        if !is_ours || !metadata.is_file() || age.is_none_or(|age| age < LEFT_OVER) {
            continue;
        }
        if File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Creates an empty file in `folder` with the permissions of any new file.
fn fresh(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Maximum number of backups of one file.
const MOST_BACKUPS: u32 = 10;

/// Returns the name of backup `number` of `target`.
fn backup_name(target: &Path, number: u32) -> PathBuf {
    let mut name = OsString::from(target.as_os_str());
    name.push(".bak");
    if number > 1 {
        name.push(number.to_string());
    }
    name.into()
}

/// Backs up `target` under an unused name, and returns that name. If there are too many backups, it removes the
/// oldest except the first, which holds the content before any change by this program.
fn back_up(target: &Path) -> io::Result<PathBuf> {
    let names = || (1..=MOST_BACKUPS).map(|number| backup_name(target, number));
    if names().all(|name| name.exists()) {
        let changed = |name: &PathBuf| fs::metadata(name).and_then(|metadata| metadata.modified()).ok();
        if let Some(oldest) = names().skip(1).min_by_key(changed) {
            fs::remove_file(oldest)?;
        }
    }
    for backup in names() {
        let kept = match fs::hard_link(target, &backup) {
            // Some file systems do not support links.
            Err(error) if error.kind() != ErrorKind::AlreadyExists => copied(target, &backup),
            linked => linked,
        };
        match kept {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            kept => return kept.map(|()| backup),
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

fn copied(target: &Path, backup: &Path) -> io::Result<()> {
    let mut copy = File::create_new(backup)?;
    let copied = File::open(target).and_then(|mut old| io::copy(&mut old, &mut copy));
    match copied.and_then(|_| copy.sync_all()) {
        Ok(()) => Ok(()),
        Err(error) => {
            // An incomplete backup is useless.
            let _ = fs::remove_file(backup);
            Err(error)
        }
    }
}

#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

/// Other systems do not open folders; they sync them without a call.
#[cfg(not(unix))]
fn sync_folder(_folder: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn every_older_file_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.ron");
        assert_eq!(save_text("one", &path).unwrap(), Saved::New);
        assert_eq!(save_text("one", &path).unwrap(), Saved::Unchanged);
        let Saved::Replaced { backup } = save_text("two", &path).unwrap() else { panic!("a backup") };
        assert_eq!(fs::read_to_string(backup).unwrap(), "one");
        save_text("three", &path).unwrap();
        assert_eq!(names(folder.path()), ["floor.ron", "floor.ron.bak", "floor.ron.bak2"]);
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        assert_eq!(
            [read("floor.ron"), read("floor.ron.bak"), read("floor.ron.bak2")],
            ["three", "one", "two"]
        );
    }

    /// Row F8. Two editors have read the same file; each saves its own changes.
    #[test]
    fn what_another_editor_saved_meanwhile_is_found_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.ron");
        assert_eq!(save_text("as both have read it", &path).unwrap(), Saved::New);
        assert!(matches!(save_text("the first one's", &path).unwrap(), Saved::Replaced { .. }));
        let Saved::Replaced { backup } = save_text("the second one's", &path).unwrap() else {
            panic!("it says that it replaced something")
        };
        assert_eq!(fs::read_to_string(backup).unwrap(), "the first one's");
        assert_eq!(fs::read_to_string(&path).unwrap(), "the second one's");
    }

    #[test]
    fn backups_are_bounded_and_the_first_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.ron");
        for number in 0..30_u64 {
            save_text(&number.to_string(), &path).unwrap();
            // Files written within one tick of the clock have equal times.
            let day = std::time::UNIX_EPOCH + Duration::from_secs(86_400 * (number + 1));
            File::options().write(true).open(&path).unwrap().set_modified(day).unwrap();
        }
        assert_eq!(names(folder.path()).len(), 1 + 10);
        let mut kept: Vec<u32> = (1..=10)
            .map(|number| fs::read_to_string(backup_name(&path, number)).unwrap().parse().unwrap())
            .collect();
        kept.sort_unstable();
        assert_eq!(kept, [0, 20, 21, 22, 23, 24, 25, 26, 27, 28]);
    }

    // F2
    #[test]
    fn what_a_killed_save_left_is_removed_by_the_next_and_what_another_writes_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let make = |name: &str, age: Duration| {
            let file = File::create(folder.path().join(name)).unwrap();
            file.set_modified(std::time::SystemTime::now() - age).unwrap();
            file
        };
        drop(make(".underfoot-left.tmp", 2 * LEFT_OVER));
        drop(make(".underfoot-young.tmp", Duration::ZERO));
        drop(make("other.tmp", 2 * LEFT_OVER));
        let held = make(".underfoot-held.tmp", 2 * LEFT_OVER);
        held.lock().unwrap();
        save_text("one", &folder.path().join("floor.ron")).unwrap();
        assert_eq!(
            names(folder.path()),
            [".underfoot-held.tmp", ".underfoot-young.tmp", "floor.ron", "other.tmp"]
        );
    }

    // F3
    #[test]
    fn a_save_that_fails_leaves_everything_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("nowhere").join("floor.ron");
        assert!(matches!(save_text("one", &missing), Err(SaveError::File { .. })));
        // A folder blocks the name.
        let path = folder.path().join("floor.ron");
        fs::create_dir(&path).unwrap();
        assert!(matches!(save_text("one", &path), Err(SaveError::File { .. })));
        assert_eq!(names(folder.path()), ["floor.ron"]);
    }

    #[test]
    fn a_floor_that_could_not_be_read_back_is_not_saved() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.ron");
        let mut floor = Floor::default();
        assert_eq!(save_floor(&floor, &path).unwrap(), Saved::New);
        floor.calibration[3][0] = crate::floor::Calibration::exponential(-1.0, 1.34);
        assert!(matches!(save_floor(&floor, &path), Err(SaveError::Unreadable(_))));
        assert_eq!(super::super::load_floor(&path).unwrap(), Floor::default());
        assert_eq!(names(folder.path()), ["floor.ron"]);
    }

    #[cfg(unix)]
    // F7
    #[test]
    fn a_link_stays_a_link_and_permissions_stay() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("lab.ron"), folder.path().join("floor.ron"));
        fs::write(&path, "one").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        save_text("two", &link).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(names(folder.path()), ["floor.ron", "lab.ron", "lab.ron.bak"]);
    }
}
