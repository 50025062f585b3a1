//! Reading of ordinary files up to a size that the caller sets.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// An open file with a limit on the bytes that can be read.
///
/// Reading beyond the limit fails with [`ErrorKind::FileTooLarge`]. A file that grows, or of unknown size, is
/// therefore rejected like one that was too large from the beginning.
#[derive(Debug)]
pub struct BoundedFile {
    file: File,
    most: u64,
    left: u64,
}

/// Opens the file at `path` for reading at most `most` bytes. All readers open files this way.
///
/// # Errors
/// The error of the system; [`ErrorKind::IsADirectory`] for a folder; an error for a device, pipe or socket, which
/// are not opened at all, since reading them may block or never end; [`ErrorKind::FileTooLarge`] for a file of more
/// than `most` bytes.
pub fn open_bounded(path: &Path, most: u64) -> io::Result<BoundedFile> {
    let file = open_ordinary(path)?;
    if file.metadata()?.len() > most {
        return Err(too_large(most));
    }
    Ok(BoundedFile { file, most, left: most })
}

/// Opens the file at `path`, of any size, for callers that read it piece by piece.
///
/// # Errors
/// Those of [`open_bounded`] except the one for the size.
pub fn open_ordinary(path: &Path) -> io::Result<File> {
    // The file type is checked before opening: opening a pipe waits for a writer.
    let metadata = path.metadata()?;
    if metadata.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !metadata.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is not an ordinary file"));
    }
    File::open(path)
}

/// Reads the bytes of the file at `path`, `most` at most.
///
/// # Errors
/// Those of [`open_bounded`].
pub fn read_bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_bounded(path, most)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads the text of the file at `path`, `most` bytes at most.
///
/// # Errors
/// Those of [`open_bounded`]; [`ErrorKind::InvalidData`] if it is not UTF-8.
pub fn read_bounded(path: &Path, most: u64) -> io::Result<String> {
    let mut text = String::new();
    open_bounded(path, most)?.read_to_string(&mut text)?;
    Ok(text)
}

impl Read for BoundedFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        // Reads one byte more than allowed to distinguish a file that goes on from one that ends.
        let room = usize::try_from(self.left.saturating_add(1)).unwrap_or(usize::MAX).min(buffer.len());
        let read = self.file.read(buffer.get_mut(..room).unwrap_or_default())?;
        self.left = self.left.checked_sub(read as u64).ok_or_else(|| too_large(self.most))?;
        Ok(read)
    }
}

fn too_large(most: u64) -> io::Error {
    let size = if most < 1 << 20 { format!("{most} bytes") } else { format!("{} MB", most >> 20) };
    io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than {size}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file_of(bytes: usize) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), vec![b'a'; bytes]).unwrap();
        file
    }

    #[test]
    fn a_file_may_have_as_many_bytes_as_allowed_and_no_more() {
        let file = file_of(100);
        assert_eq!(read_bounded(file.path(), 100).unwrap().len(), 100);
        assert_eq!(read_bytes(file.path(), 100).unwrap().len(), 100);
        let error = read_bounded(file.path(), 99).unwrap_err();
        assert_eq!(
            (error.kind(), error.to_string()),
            (ErrorKind::FileTooLarge, "it is larger than 99 bytes".into())
        );
    }

    #[test]
    fn a_file_that_grows_while_it_is_read_is_refused() {
        let file = file_of(10);
        let mut open = open_bounded(file.path(), 20).unwrap();
        std::fs::write(file.path(), vec![b'a'; 30]).unwrap();
        let mut bytes = Vec::new();
        assert_eq!(open.read_to_end(&mut bytes).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert!(bytes.len() <= 21);
    }

    #[test]
    fn folders_and_devices_are_refused_without_being_opened() {
        assert_eq!(read_bytes(Path::new("."), 10).unwrap_err().kind(), ErrorKind::IsADirectory);
        #[cfg(unix)]
        for device in ["/dev/zero", "/dev/null"] {
            let error = read_bytes(Path::new(device), 10).unwrap_err();
            assert_eq!(error.to_string(), "it is not an ordinary file");
        }
        // The system reports no size for such a file: the limit applies while it is read.
        #[cfg(target_os = "linux")]
        assert_eq!(
            read_bytes(Path::new("/proc/self/status"), 10).unwrap_err().kind(),
            ErrorKind::FileTooLarge
        );
    }
}
