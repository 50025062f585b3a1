//! The file of a layout that is being edited, and the draft beside it.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::merge::{Merge, merge};
use crate::format::file::read_bounded;
use crate::format::source::MAX_BYTES;
use crate::schema::{SaveError, save_text, write_over};

/// What a draft is called that belongs to no file yet.
const UNTITLED: &str = "untitled.ron";

/// Where a layout is kept, and what was last known of that.
///
/// Beside the file stands a draft with what has not been saved: `.mine.ron.draft`. It is there after a crash.
#[derive(Clone, Debug)]
pub struct LayoutFile {
    /// `None` until it has a name.
    path: Option<PathBuf>,
    /// The folder of the draft while there is no name.
    folder: PathBuf,
    /// What the file held when it was read or written last; nothing once it was seen to be gone.
    base: String,
    /// Whether it is to be written for the first time; `base` is then what it would begin with.
    is_new: bool,
    /// What the draft holds.
    draft: Option<String>,
}

/// What saving came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saving {
    /// The file holds the text.
    Saved,
    /// Another program has changed the file, and both changes are in this text, which is not saved: it is to be read,
    /// and saved again.
    Merged(String),
    /// Another program has changed the same. The file is as that program left it.
    Conflict {
        /// What the file holds.
        theirs: String,
        /// The records that both have changed; none where it is not about records.
        records: Vec<String>,
    },
}

impl LayoutFile {
    /// A layout without a file, such as a shipped one; its draft is in `folder`. `text` is what counts as saved.
    #[must_use]
    pub fn untitled(folder: &Path, text: &str) -> Self {
        Self { path: None, folder: folder.into(), base: text.into(), is_new: false, draft: None }
    }

    /// The file at `path`, which is not there yet, or empty, and begins with `text`; that counts as saved.
    #[must_use]
    pub fn begun(path: &Path, text: &str) -> Self {
        Self { path: Some(path.into()), is_new: true, ..Self::untitled(Path::new(""), text) }
    }

    /// The file at `path`, and what it holds; a draft is to be asked for with [`LayoutFile::left_over`].
    ///
    /// # Errors
    /// What the system says; [`ErrorKind::InvalidData`] for what is not UTF-8.
    pub fn open(path: &Path) -> io::Result<(Self, String)> {
        let text = read_bounded(path, MAX_BYTES as u64)?;
        let file = Self { path: Some(path.into()), ..Self::untitled(Path::new(""), &text) };
        Ok((file, text))
    }

    /// Its path, once it has one.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Whether it is to be written for the first time.
    #[must_use]
    pub fn is_new(&self) -> bool {
        self.is_new
    }

    /// What people call it.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.path.as_deref().and_then(Path::file_name);
        name.map_or_else(|| UNTITLED.to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// What the file is known to hold.
    #[must_use]
    pub fn known(&self) -> &str {
        &self.base
    }

    /// Whether `text` is what the file is known to hold.
    #[must_use]
    pub fn holds(&self, text: &str) -> bool {
        self.base == text
    }

    /// Where its draft is.
    #[must_use]
    pub fn draft_path(&self) -> PathBuf {
        let folder = match &self.path {
            Some(path) => path.parent().unwrap_or(Path::new("")),
            None => &self.folder,
        };
        folder.join(format!(".{}.draft", self.name()))
    }

    /// What was being edited when a window ended without saving; `None` if nothing was, or the file holds the same.
    ///
    /// # Errors
    /// What the system says of a draft that is there and can't be read.
    pub fn left_over(&self) -> io::Result<Option<String>> {
        match read_bounded(&self.draft_path(), MAX_BYTES as u64) {
            Ok(text) => Ok(Some(text).filter(|text| *text != self.base)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Keeps `text` in the draft; a text that is saved needs none. Writes only what changed since the last call.
    ///
    /// # Errors
    /// [`SaveError`]; the older draft is then still there.
    pub fn keep_draft(&mut self, text: &str) -> Result<(), SaveError> {
        if self.holds(text) {
            if self.draft.is_some() {
                self.drop_draft();
            }
            return Ok(());
        }
        if self.draft.as_deref() != Some(text) {
            write_over(text, &self.draft_path())?;
            self.draft = Some(text.into());
        }
        Ok(())
    }

    /// Removes the draft: it was taken up, or is not wanted.
    pub fn drop_draft(&mut self) {
        // One that can't be removed is offered again next time: nothing is lost.
        let _ = std::fs::remove_file(self.draft_path());
        self.draft = None;
    }

    /// What another program has written into the file since it was read or saved last.
    ///
    /// # Errors
    /// What the system says; a file that is gone has not been written into, and holds nothing of the layout any more.
    pub fn outside(&mut self) -> io::Result<Option<String>> {
        let Some(path) = &self.path else { return Ok(None) };
        match read_bounded(path, MAX_BYTES as u64) {
            // An empty file is a layout that is begun.
            Ok(text) if self.is_new && text.trim().is_empty() => Ok(None),
            Ok(text) => Ok(Some(text).filter(|text| *text != self.base)),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                if !self.is_new {
                    self.base.clear();
                }
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// What becomes of `mine` together with `theirs`, which is now in the file and counts as known from here on,
    /// unless it is a conflict.
    pub fn take_in(&mut self, mine: &str, theirs: String) -> Saving {
        match merge(&self.base, mine, &theirs) {
            Merge::Merged(text) => {
                (self.base, self.is_new) = (theirs, false);
                Saving::Merged(text)
            }
            Merge::Conflict(records) => Saving::Conflict { theirs, records },
        }
    }

    /// Says that what the file holds is known and may be replaced: the person has chosen.
    pub fn know(&mut self, theirs: String) {
        (self.base, self.is_new) = (theirs, false);
    }

    /// Writes `text` to the file, unless another program has changed that meanwhile.
    ///
    /// After a crash or power loss at any moment it holds the old text or the new one, and the draft what was not
    /// saved.
    ///
    /// # Errors
    /// [`SaveError`]; the file is then as it was. Without a path nothing is done: [`LayoutFile::save_as`] gives it one.
    pub fn save(&mut self, text: &str) -> Result<Saving, SaveError> {
        let Some(path) = self.path.clone() else { return Ok(Saving::Saved) };
        let failed =
            |source| SaveError::File { path: path.clone(), doing: "looking at what it holds", source };
        if let Some(theirs) = self.outside().map_err(failed)? {
            return Ok(self.take_in(text, theirs));
        }
        save_text(text, &path)?;
        (self.base, self.is_new) = (text.into(), false);
        self.drop_draft();
        Ok(Saving::Saved)
    }

    /// Writes `text` to `path`, which is its file from now on; what was there before is kept as a backup.
    ///
    /// # Errors
    /// [`SaveError`]; its file is then the one it was.
    pub fn save_as(&mut self, text: &str, path: &Path) -> Result<(), SaveError> {
        save_text(text, path)?;
        self.drop_draft();
        (self.path, self.base, self.is_new) = (Some(path.into()), text.into(), false);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};
    use std::time::Duration;

    use rand::{RngExt, SeedableRng};

    use super::*;

    const OLD: &str = "Layout(\n  a: 1,\n  b: 2,\n  c: 3,\n)\n";

    fn folder_with(text: &str) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.ron");
        fs::write(&path, text).unwrap();
        (folder, path)
    }

    #[test]
    fn an_unchanged_save_leaves_the_file_alone_and_a_change_keeps_a_backup() {
        let (folder, path) = folder_with(OLD);
        let (mut file, text) = LayoutFile::open(&path).unwrap();
        assert_eq!(file.save(&text).unwrap(), Saving::Saved);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert_eq!(file.save(&text.replace('1', "7")).unwrap(), Saving::Saved);
        assert_eq!(fs::read_to_string(&path).unwrap(), OLD.replace('1', "7"));
        assert_eq!(fs::read_to_string(folder.path().join("mine.ron.bak")).unwrap(), OLD);
    }

    #[test]
    fn what_another_program_saved_is_merged_or_asked_about_and_never_overwritten() {
        let (_folder, path) = folder_with(OLD);
        let (mut file, text) = LayoutFile::open(&path).unwrap();
        let mine = text.replace("a: 1", "a: 7");
        fs::write(&path, OLD.replace("c: 3", "c: 9")).unwrap();
        let both = mine.replace("c: 3", "c: 9");
        assert_eq!(file.save(&mine).unwrap(), Saving::Merged(both.clone()));
        assert_eq!(file.save(&both).unwrap(), Saving::Saved);
        assert_eq!(fs::read_to_string(&path).unwrap(), both);

        let theirs = both.replace("b: 2", "b: 5");
        fs::write(&path, &theirs).unwrap();
        let mine = both.replace("b: 2", "b: 6");
        let conflict = Saving::Conflict { theirs: theirs.clone(), records: Vec::new() };
        assert_eq!(file.save(&mine).unwrap(), conflict);
        assert_eq!(file.save(&mine).unwrap(), conflict, "asked as long as nobody has chosen");
        assert_eq!(fs::read_to_string(&path).unwrap(), theirs);
        file.know(theirs);
        assert_eq!(file.save(&mine).unwrap(), Saving::Saved);
    }

    #[test]
    fn a_file_that_is_begun_counts_as_saved_until_it_is_edited() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new.ron");
        let mut file = LayoutFile::begun(&path, OLD);
        assert!(file.is_new() && file.holds(OLD) && file.outside().unwrap().is_none());
        assert!(!path.exists(), "nothing is written unasked");
        file.keep_draft(OLD).unwrap();
        assert!(!file.draft_path().exists());
        assert_eq!(file.save(OLD).unwrap(), Saving::Saved);
        assert_eq!(fs::read_to_string(&path).unwrap(), OLD);
        assert!(!file.is_new());
    }

    #[test]
    fn a_file_that_another_program_made_meanwhile_is_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new.ron");
        let mut file = LayoutFile::begun(&path, OLD);
        fs::write(&path, OLD.replace("a: 1", "a: 9")).unwrap();
        assert!(matches!(file.save(&OLD.replace("a: 1", "a: 7")).unwrap(), Saving::Conflict { .. }));
        assert!(fs::read_to_string(&path).unwrap().contains("a: 9"));
    }

    #[test]
    fn a_file_that_is_gone_holds_nothing_any_more_and_saving_writes_it_again() {
        let (_folder, path) = folder_with(OLD);
        let (mut file, text) = LayoutFile::open(&path).unwrap();
        fs::remove_file(&path).unwrap();
        assert_eq!(file.outside().unwrap(), None);
        assert!(!file.holds(&text));
        assert_eq!(file.save(&text).unwrap(), Saving::Saved);
        assert_eq!(fs::read_to_string(&path).unwrap(), OLD);
    }

    #[test]
    fn a_draft_is_there_until_it_is_saved() {
        let (folder, path) = folder_with(OLD);
        let (mut file, text) = LayoutFile::open(&path).unwrap();
        file.keep_draft(&text).unwrap();
        assert!(!file.draft_path().exists());
        let mine = text.replace('1', "7");
        file.keep_draft(&mine).unwrap();
        let (again, _) = LayoutFile::open(&path).unwrap();
        assert_eq!(again.left_over().unwrap(), Some(mine.clone()));
        file.save(&mine).unwrap();
        assert_eq!(again.left_over().unwrap(), None);

        let mut untitled = LayoutFile::untitled(folder.path(), OLD);
        untitled.keep_draft(&mine).unwrap();
        assert_eq!(untitled.draft_path(), folder.path().join(".untitled.ron.draft"));
        untitled.save_as(&mine, &folder.path().join("new.ron")).unwrap();
        assert!(!folder.path().join(".untitled.ron.draft").exists());
        assert_eq!(untitled.name(), "new.ron");
    }

    /// Where the child below works; without it that does nothing.
    const FOLDER: &str = "UNDERFOOT_SAVING_IN";

    /// A text that is only whole if it is of one piece.
    fn numbered(number: usize) -> String {
        format!("Layout(\n{}  a: {number},\n)\n", format!("  // {number}\n").repeat(400))
    }

    fn number_in(text: &str) -> usize {
        let number = text.lines().nth(1).unwrap().trim().strip_prefix("// ").unwrap().parse().unwrap();
        assert_eq!(text, numbered(number), "a mix");
        number
    }

    /// Drafts and saves until it is killed, and says what is done. A process of the test below.
    #[test]
    fn saving_child() {
        let Some(folder) = std::env::var_os(FOLDER) else { return };
        let (mut file, text) = LayoutFile::open(&PathBuf::from(folder).join("mine.ron")).unwrap();
        let mut number = number_in(&file.left_over().unwrap().unwrap_or(text));
        loop {
            number += 1;
            file.keep_draft(&numbered(number)).unwrap();
            eprintln!("kept {number}");
            if number.is_multiple_of(2) {
                file.save(&numbered(number)).unwrap();
                eprintln!("saved {number}");
            }
        }
    }

    #[test]
    fn a_process_killed_at_any_moment_of_saving_leaves_the_old_text_or_the_new_one_and_the_draft() {
        let (folder, path) = folder_with(&numbered(1));
        let mut rng = rand_pcg::Pcg32::seed_from_u64(7);
        let (mut kept, mut saved, mut recovered) = (1, 1, 0);
        for _ in 0..200 {
            let mut child = Command::new(std::env::current_exe().unwrap())
                .args(["edit::file::tests::saving_child", "--exact", "--nocapture"])
                .env(FOLDER, folder.path())
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn()
                .unwrap();
            let mut said = BufReader::new(child.stderr.take().unwrap()).lines();
            let mut note = |line: &str| {
                let number = |line: &str| line.rsplit(' ').next().and_then(|number| number.parse().ok());
                if let (true, Some(number)) = (line.starts_with("kept"), number(line)) {
                    kept = number;
                }
                if let (true, Some(number)) = (line.starts_with("saved"), number(line)) {
                    saved = number;
                }
            };
            // Once it works, however slowly; then at a moment of its work.
            for line in said.by_ref().take(rng.random_range(1..=4)) {
                note(&line.unwrap());
            }
            std::thread::sleep(Duration::from_micros(rng.random_range(0..4000)));
            child.kill().unwrap();
            child.wait().unwrap();
            said.for_each(|line| note(&line.unwrap()));
            let (file, text) = LayoutFile::open(&path).unwrap();
            let in_file = number_in(&text);
            assert!(in_file >= saved, "{in_file} of {saved}");
            let draft = file.left_over().unwrap().map(|text| number_in(&text));
            assert!(draft.unwrap_or(in_file) >= kept, "{draft:?}, {in_file} of {kept}");
            recovered += usize::from(draft.is_some());
        }
        assert!(recovered >= 20 && saved > 20, "{recovered} drafts, {saved} saved");
    }
}
