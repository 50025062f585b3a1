//! The file of a layout that is being edited, and the draft beside it.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::merge::{Merge, merge};
use crate::platform;
use underfoot::schema::SaveError;
use underfoot_format::source::MAX_BYTES;

/// Name of the draft of a layout without a file.
const UNTITLED: &str = "untitled.ron";

/// The file of a layout, and its last known content.
///
/// A draft with the unsaved text stands beside the file: `.mine.ron.draft`. It remains after a crash.
#[derive(Clone, Debug)]
pub struct LayoutFile {
    /// `None` for a layout without a file.
    path: Option<PathBuf>,
    /// The folder of the draft of a layout without a file.
    folder: PathBuf,
    /// The content of the file when it was last read or written; empty once the file was found missing.
    base: String,
    /// Whether the file has not been written yet; `base` is then its initial text.
    is_new: bool,
    /// The content of the draft.
    draft: Option<String>,
}

/// The result of saving.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saving {
    /// The file holds the text.
    Saved,
    /// Another program has changed the file, and this text contains both changes. It is not saved: the caller parses
    /// it and saves again.
    Merged(String),
    /// Another program has changed the same lines or records. The file stays as that program left it.
    Conflict {
        /// The content of the file.
        theirs: String,
        /// The records that both have changed; empty if the conflict is outside records.
        records: Vec<String>,
    },
}

impl LayoutFile {
    /// A layout without a file, such as a built-in one, with its draft in `folder`. `text` counts as saved.
    #[must_use]
    pub fn untitled(folder: &Path, text: &str) -> Self {
        Self { path: None, folder: folder.into(), base: text.into(), is_new: false, draft: None }
    }

    /// A new or empty file at `path` with the initial text `text`, which counts as saved.
    #[must_use]
    pub fn begun(path: &Path, text: &str) -> Self {
        Self { path: Some(path.into()), is_new: true, ..Self::untitled(Path::new(""), text) }
    }

    /// Opens the file at `path` and returns its content; [`LayoutFile::left_over`] returns the draft, if any.
    ///
    /// # Errors
    /// The error of the system; [`ErrorKind::InvalidData`] for a text that is not UTF-8.
    pub fn open(path: &Path) -> io::Result<(Self, String)> {
        let text = platform::read(path, MAX_BYTES as u64)?;
        let file = Self { path: Some(path.into()), ..Self::untitled(Path::new(""), &text) };
        Ok((file, text))
    }

    /// Its path; `None` for a layout without a file.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Whether the file has not been written yet.
    #[must_use]
    pub fn is_new(&self) -> bool {
        self.is_new
    }

    /// Its name for users.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.path.as_deref().and_then(Path::file_name);
        name.map_or_else(|| UNTITLED.to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// The last known content of the file.
    #[must_use]
    pub fn known(&self) -> &str {
        &self.base
    }

    /// Whether `text` equals the last known content of the file.
    #[must_use]
    pub fn holds(&self, text: &str) -> bool {
        self.base == text
    }

    /// The path of its draft.
    #[must_use]
    pub fn draft_path(&self) -> PathBuf {
        let folder = match &self.path {
            Some(path) => path.parent().unwrap_or(Path::new("")),
            None => &self.folder,
        };
        folder.join(format!(".{}.draft", self.name()))
    }

    /// The draft of a window that ended without saving; `None` without a draft, or if the file holds the same text.
    ///
    /// # Errors
    /// The error of the system for a draft that cannot be read.
    pub fn left_over(&self) -> io::Result<Option<String>> {
        match platform::read(&self.draft_path(), MAX_BYTES as u64) {
            Ok(text) => Ok(Some(text).filter(|text| *text != self.base)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Saves `text` in the draft, and removes the draft of a text that is saved. Writes only after a change since the
    /// last call.
    ///
    /// # Errors
    /// [`SaveError`]; the older draft remains then.
    pub fn keep_draft(&mut self, text: &str) -> Result<(), SaveError> {
        if self.holds(text) {
            if self.draft.is_some() {
                self.drop_draft();
            }
            return Ok(());
        }
        if self.draft.as_deref() != Some(text) {
            platform::write_over(text, &self.draft_path())?;
            self.draft = Some(text.into());
        }
        Ok(())
    }

    /// Removes the draft, after it was restored or discarded.
    pub fn drop_draft(&mut self) {
        // A draft that cannot be removed is offered again next time: no data is lost.
        platform::remove(&self.draft_path());
        self.draft = None;
    }

    /// The text that another program has written to the file since it was last read or saved; `None` without a
    /// change.
    ///
    /// # Errors
    /// The error of the system; a missing file is not an error, counts as unchanged, and its known content becomes
    /// empty.
    pub fn outside(&mut self) -> io::Result<Option<String>> {
        let Some(path) = &self.path else { return Ok(None) };
        match platform::read(path, MAX_BYTES as u64) {
            // An empty file is a new layout.
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

    /// Merges `mine` with `theirs`, the present content of the file, which becomes the known content unless there is
    /// a conflict.
    pub fn take_in(&mut self, mine: &str, theirs: String) -> Saving {
        match merge(&self.base, mine, &theirs) {
            Merge::Merged(text) => {
                (self.base, self.is_new) = (theirs, false);
                Saving::Merged(text)
            }
            Merge::Conflict(records) => Saving::Conflict { theirs, records },
        }
    }

    /// Sets the known content of the file, so that it may be replaced: the user has decided.
    pub fn know(&mut self, theirs: String) {
        (self.base, self.is_new) = (theirs, false);
    }

    /// Writes `text` to the file, unless another program has changed it.
    ///
    /// After a crash or power loss at any moment, the file holds the old text or the new one, and the draft holds the
    /// unsaved text.
    ///
    /// # Errors
    /// [`SaveError`]; the file is unchanged then. Without a path, this does nothing: [`LayoutFile::save_as`] sets it.
    pub fn save(&mut self, text: &str) -> Result<Saving, SaveError> {
        let Some(path) = self.path.clone() else { return Ok(Saving::Saved) };
        let failed =
            |source| SaveError::File { path: path.clone(), doing: "looking at what it holds", source };
        if let Some(theirs) = self.outside().map_err(failed)? {
            return Ok(self.take_in(text, theirs));
        }
        platform::save(text, &path)?;
        (self.base, self.is_new) = (text.into(), false);
        self.drop_draft();
        Ok(Saving::Saved)
    }

    /// Writes `text` to `path`, which becomes its file; the previous content of `path` stays as a backup.
    ///
    /// # Errors
    /// [`SaveError`]; its file is unchanged then.
    pub fn save_as(&mut self, text: &str, path: &Path) -> Result<(), SaveError> {
        platform::save(text, path)?;
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

    /// Names the folder of the child process below; without this variable the child does nothing.
    const FOLDER: &str = "UNDERFOOT_SAVING_IN";

    /// A text that reveals a mix of two versions.
    fn numbered(number: usize) -> String {
        format!("Layout(\n{}  a: {number},\n)\n", format!("  // {number}\n").repeat(400))
    }

    fn number_in(text: &str) -> usize {
        let number = text.lines().nth(1).unwrap().trim().strip_prefix("// ").unwrap().parse().unwrap();
        assert_eq!(text, numbered(number), "a mix");
        number
    }

    /// Writes drafts and saves until it is killed, and reports each completed step. The test below runs it as a
    /// process.
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
            // Wait until it works, however slow it is; then kill it at a random moment.
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
