//! The key of a floor: 32 random bytes in a file that only its owner can read.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use blake3::Hash;
use tempfile::NamedTempFile;
use thiserror::Error;

/// Longest key file, in bytes: the digits and white space around them.
const MOST_BYTES: u64 = 256;

/// Reason for a missing key.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum KeyError {
    /// The file can't be read.
    #[error(
        "the floor's key {} can't be read: {source}. `underfoot-cluster key {}` makes one; every computer of the \
         floor needs the same",
        path.display(),
        path.display()
    )]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// Users other than its owner may read or write the file.
    #[error("others can read or write the floor's key {} (mode {mode:04o}): chmod 600 {}", path.display(), path.display())]
    Exposed {
        /// The file.
        path: PathBuf,
        /// Its permissions.
        mode: u32,
    },
    /// The file holds something else than a key.
    #[error("{} holds no key: expected 64 hexadecimal digits, as `underfoot-cluster key` writes them", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
    },
    /// A file of that name exists, and keys are not overwritten.
    #[error("{} exists already and is left as it is", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The file can't be written.
    #[error("the key {} can't be written: {source}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The system gives no random numbers.
    #[error("the system gives no random numbers: {0}")]
    Random(getrandom::Error),
}

/// The secret that all computers of a floor share.
#[derive(Clone)]
pub struct Key([u8; 32]);

impl fmt::Debug for Key {
    /// Hides the key.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Key")
    }
}

impl Key {
    /// The key of these bytes.
    #[must_use]
    pub const fn new(bytes: [u8; 32]) -> Self {
        Self(bytes)
    }

    /// The key in the file at `path`.
    ///
    /// On Unix, rejects a file that users other than its owner may read or write. Windows has no such bits: its
    /// folder protects the file there.
    ///
    /// # Errors
    /// [`KeyError::Unreadable`], [`KeyError::Exposed`] or [`KeyError::Malformed`].
    pub fn read(path: &Path) -> Result<Self, KeyError> {
        let unreadable = |source| KeyError::Unreadable { path: path.to_owned(), source };
        // Opening a pipe would block.
        if !fs::metadata(path).map_err(unreadable)?.is_file() {
            return Err(unreadable(io::Error::other("it is not a file")));
        }
        let file = File::open(path).map_err(unreadable)?;
        check_permissions(path, &file)?;
        let mut text = String::new();
        let malformed = || KeyError::Malformed { path: path.to_owned() };
        file.take(MOST_BYTES).read_to_string(&mut text).map_err(|error| match error.kind() {
            io::ErrorKind::InvalidData => malformed(),
            _ => unreadable(error),
        })?;
        let digits = Hash::from_hex(text.trim()).map_err(|_| malformed())?;
        Ok(Self(*digits.as_bytes()))
    }

    /// Makes a key and writes it to `path`, as a file that only its owner can read.
    ///
    /// # Errors
    /// [`KeyError::Exists`] if there is a file already, [`KeyError::Unwritable`], [`KeyError::Random`].
    pub fn make(path: &Path) -> Result<Self, KeyError> {
        let mut bytes = [0; 32];
        getrandom::fill(&mut bytes).map_err(KeyError::Random)?;
        let unwritable = |source| KeyError::Unwritable { path: path.to_owned(), source };
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        // A temporary file is private to its owner. It appears under its name whole, and replaces no other file.
        let mut file = NamedTempFile::new_in(folder.unwrap_or(Path::new("."))).map_err(unwritable)?;
        writeln!(file, "{}", Hash::from_bytes(bytes).to_hex()).map_err(unwritable)?;
        file.as_file().sync_all().map_err(unwritable)?;
        match file.persist_noclobber(path) {
            Ok(_) => Ok(Self(bytes)),
            Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => {
                Err(KeyError::Exists { path: path.to_owned() })
            }
            Err(failed) => Err(unwritable(failed.error)),
        }
    }

    /// The key for one purpose; each purpose has a `context` of its own.
    #[must_use]
    pub fn derived(&self, context: &str) -> [u8; 32] {
        blake3::derive_key(context, &self.0)
    }
}

#[cfg(unix)]
fn check_permissions(path: &Path, file: &File) -> Result<(), KeyError> {
    use std::os::unix::fs::MetadataExt;

    let unreadable = |source| KeyError::Unreadable { path: path.to_owned(), source };
    let mode = file.metadata().map_err(unreadable)?.mode() & 0o7777;
    let is_private = mode & 0o077 == 0;
    is_private.then_some(()).ok_or_else(|| KeyError::Exposed { path: path.to_owned(), mode })
}

#[cfg(not(unix))]
fn check_permissions(_: &Path, _: &File) -> Result<(), KeyError> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_that_was_made_is_read_from_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hall.key");
        let made = Key::make(&path).unwrap();
        assert_eq!(Key::read(&path).unwrap().0, made.0);
        assert_eq!(fs::read_to_string(&path).unwrap().trim().len(), 64);
    }

    #[test]
    fn a_key_is_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hall.key");
        let made = Key::make(&path).unwrap();
        assert!(matches!(Key::make(&path), Err(KeyError::Exists { .. })));
        assert_eq!(Key::read(&path).unwrap().0, made.0);
    }

    #[cfg(unix)]
    #[test]
    fn a_key_that_others_can_read_or_write_is_refused() {
        use std::os::unix::fs::PermissionsExt;

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hall.key");
        Key::make(&path).unwrap();
        for (mode, is_private) in
            [(0o600, true), (0o400, true), (0o640, false), (0o604, false), (0o620, false), (0o602, false)]
        {
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            let read = Key::read(&path);
            assert_eq!(read.is_ok(), is_private, "{mode:o}");
            if let Err(error) = read {
                assert!(error.to_string().contains("chmod 600"), "{error}");
            }
        }
    }

    #[test]
    fn a_file_with_something_else_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hall.key");
        let digits = "7".repeat(64);
        let cases: [(&[u8], bool); 6] = [
            (digits.as_bytes(), true),
            (b"", false),
            (b"secret", false),
            (&digits.as_bytes()[1..], false),
            (&[0xff; 64], false),
            (&[b'7'; 1000], false),
        ];
        for (text, is_key) in cases {
            let mut file = NamedTempFile::new_in(folder.path()).unwrap();
            file.write_all(text).unwrap();
            file.persist(&path).unwrap();
            let read = Key::read(&path);
            assert_eq!(read.is_ok(), is_key, "{text:?}");
            assert!(is_key || matches!(read, Err(KeyError::Malformed { .. })));
        }
        let missing = Key::read(&folder.path().join("other.key")).unwrap_err();
        assert!(missing.to_string().contains("underfoot-cluster key"), "{missing}");
        assert!(matches!(Key::read(folder.path()), Err(KeyError::Unreadable { .. })), "a folder");
    }

    #[test]
    fn keys_of_two_purposes_differ() {
        let key = Key::new([7; 32]);
        assert_ne!(key.derived("one"), key.derived("two"));
    }

    #[test]
    fn debug_output_hides_the_key() {
        assert_eq!(format!("{:?}", Key::new([7; 32])), "Key");
    }
}
