//! Files saved in the ways of editors and platforms. The tests set the time.

use std::fs;
use std::path::Path;

use super::*;

/// A watched layout, and the time so far.
struct Site {
    files: LayoutArgs,
    lookout: Lookout,
    now: Instant,
}

impl Site {
    fn new(layout: &Path) -> Self {
        let files = LayoutArgs { layout: Some(layout.into()), ..LayoutArgs::default() };
        let now = Instant::now();
        let lookout = Lookout::new(Stamps::of(&files, true), now);
        Self { files, lookout, now }
    }

    /// Number of reports while the files are unchanged for this many seconds.
    fn reports_in(&mut self, seconds: f32) -> usize {
        let looks = (seconds / EVERY.as_secs_f32()) as usize;
        (0..looks)
            .filter(|_| {
                self.now += EVERY;
                let contents = self.lookout.compares_contents(self.now);
                self.lookout.look(Stamps::of(&self.files, contents), self.now)
            })
            .count()
    }
}

#[test]
fn files_that_rest_are_not_reported() {
    let folder = tempfile::tempdir().unwrap();
    let layout = folder.path().join("mine.ron");
    fs::write(&layout, "one").unwrap();
    assert_eq!(Site::new(&layout).reports_in(10.0), 0);
}

#[test]
fn a_save_is_reported_once_whatever_the_length_and_the_time_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let layout = folder.path().join("mine.ron");
    fs::write(&layout, "one").unwrap();
    let modified = fs::metadata(&layout).unwrap().modified().unwrap();
    let mut site = Site::new(&layout);
    for text in ["two", "three", "seven"] {
        fs::write(&layout, text).unwrap();
        // As on a file system whose clock has not moved on.
        fs::File::options().write(true).open(&layout).unwrap().set_modified(modified).unwrap();
        assert_eq!(site.reports_in(1.0), 1, "{text}");
    }
    assert_eq!(site.reports_in(10.0), 0);
    fs::write(&layout, "eight").unwrap();
    assert_eq!(site.reports_in(1.0), 1);
}

#[test]
fn a_file_that_is_still_written_waits() {
    let folder = tempfile::tempdir().unwrap();
    let layout = folder.path().join("mine.ron");
    fs::write(&layout, "").unwrap();
    let mut site = Site::new(&layout);
    for length in 1..20 {
        fs::write(&layout, "x".repeat(length)).unwrap();
        assert_eq!(site.reports_in(EVERY.as_secs_f32()), 0, "after {length} bytes");
    }
    assert_eq!(site.reports_in(1.0), 1);
}

#[test]
fn editors_that_put_a_new_file_in_place_of_the_old_are_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let layout = folder.path().join("mine.ron");
    fs::write(&layout, "one").unwrap();
    let mut site = Site::new(&layout);
    // By renaming.
    fs::write(folder.path().join("mine.ron~"), "two").unwrap();
    fs::rename(folder.path().join("mine.ron~"), &layout).unwrap();
    assert_eq!(site.reports_in(1.0), 1);
    // With a backup of the old one.
    fs::rename(&layout, folder.path().join("mine.bak")).unwrap();
    assert_eq!(site.reports_in(0.1), 0, "the new one is to come");
    fs::write(&layout, "three").unwrap();
    assert_eq!(site.reports_in(1.0), 1);
    // By deleting it first.
    fs::remove_file(&layout).unwrap();
    assert_eq!(site.reports_in(0.4), 0);
    fs::write(&layout, "four").unwrap();
    assert_eq!(site.reports_in(1.0), 1);
}

#[test]
fn a_file_that_stays_gone_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let layout = folder.path().join("mine.ron");
    fs::write(&layout, "one").unwrap();
    let mut site = Site::new(&layout);
    fs::remove_file(&layout).unwrap();
    assert_eq!(site.reports_in(2.0), 1);
    fs::write(&layout, "one").unwrap();
    assert_eq!(site.reports_in(2.0), 1, "it is back");
}

#[test]
fn kinds_and_effects_count_wherever_their_folder_comes_from() {
    let folder = tempfile::tempdir().unwrap();
    let layout = folder.path().join("mine.ron");
    fs::write(&layout, "one").unwrap();
    let mut site = Site::new(&layout);
    fs::create_dir(folder.path().join("widgets")).unwrap();
    assert_eq!(site.reports_in(1.0), 0, "an empty folder changes nothing");
    fs::write(folder.path().join("widgets/mine.ron"), "Kind").unwrap();
    assert_eq!(site.reports_in(1.0), 1, "a first kind");
    fs::create_dir(folder.path().join("effects")).unwrap();
    fs::write(folder.path().join("effects/mine.ron"), "Effect").unwrap();
    assert_eq!(site.reports_in(1.0), 1, "a first effect");
    fs::write(folder.path().join("effects/mine.ron"), "Effect()").unwrap();
    assert_eq!(site.reports_in(1.0), 1, "a changed effect");
    fs::remove_file(folder.path().join("widgets/mine.ron")).unwrap();
    assert_eq!(site.reports_in(1.0), 1, "a kind less");
}

#[test]
fn other_files_of_the_folder_do_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let layout = folder.path().join("mine.ron");
    fs::write(&layout, "one").unwrap();
    fs::create_dir(folder.path().join("widgets")).unwrap();
    let mut site = Site::new(&layout);
    for length in 1..20 {
        fs::write(folder.path().join("log.txt"), "x".repeat(length)).unwrap();
        fs::write(folder.path().join("other.ron"), "x".repeat(length)).unwrap();
        fs::write(folder.path().join("widgets/log.txt"), "x".repeat(length)).unwrap();
        assert_eq!(site.reports_in(0.2), 0);
    }
}

#[cfg(unix)]
mod links {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn a_file_behind_links_is_the_one_that_counts() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("real")).unwrap();
        fs::write(at("real/mine.ron"), "one").unwrap();
        // A file's link, a folder's link, and links to links.
        symlink("real/mine.ron", at("link.ron")).unwrap();
        symlink("link.ron", at("chain.ron")).unwrap();
        symlink("real", at("folder")).unwrap();
        symlink("folder", at("folders")).unwrap();
        for name in ["link.ron", "chain.ron", "folder/mine.ron", "folders/mine.ron"] {
            let mut site = Site::new(&at(name));
            fs::write(at("real/mine.ron"), format!("for {name}")).unwrap();
            assert_eq!(site.reports_in(1.0), 1, "{name}");
        }
        // Another target for the link in the middle.
        fs::write(at("other.ron"), "other").unwrap();
        let mut site = Site::new(&at("chain.ron"));
        symlink("other.ron", at("new")).unwrap();
        fs::rename(at("new"), at("link.ron")).unwrap();
        assert_eq!(site.reports_in(1.0), 1);
        fs::write(at("real/mine.ron"), "no more").unwrap();
        assert_eq!(site.reports_in(1.0), 0, "the old target");
        fs::write(at("other.ron"), "again").unwrap();
        assert_eq!(site.reports_in(1.0), 1, "the new target");
    }

    /// Container platforms mount a folder of links through `..data`, which they put in place of the old one.
    #[test]
    fn a_swap_of_data_folders_is_one_change() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let version = |name: &str| {
            fs::create_dir_all(at(name).join("widgets")).unwrap();
            fs::write(at(name).join("layout.ron"), "the same text").unwrap();
            fs::write(at(name).join("widgets/kind.ron"), "the same kind").unwrap();
        };
        version("..2026_01");
        symlink("..2026_01", at("..data")).unwrap();
        symlink("..data/layout.ron", at("layout.ron")).unwrap();
        symlink("..data/widgets", at("widgets")).unwrap();
        let mut site = Site::new(&at("layout.ron"));
        assert_eq!(site.reports_in(5.0), 0);
        for name in ["..2026_02", "..2026_03"] {
            version(name);
            symlink(name, at("..data_tmp")).unwrap();
            fs::rename(at("..data_tmp"), at("..data")).unwrap();
            assert_eq!(site.reports_in(2.0), 1, "{name}");
        }
        // The old ones are removed afterwards.
        fs::remove_dir_all(at("..2026_01")).unwrap();
        assert_eq!(site.reports_in(1.0), 0);
    }

    #[test]
    fn a_link_that_leads_nowhere_or_to_itself_is_a_file_that_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link.ron");
        fs::write(folder.path().join("mine.ron"), "one").unwrap();
        symlink("mine.ron", &link).unwrap();
        let mut site = Site::new(&link);
        fs::remove_file(&link).unwrap();
        symlink("link.ron", &link).unwrap();
        assert_eq!(site.reports_in(2.0), 1);
        fs::remove_file(&link).unwrap();
        symlink("mine.ron", &link).unwrap();
        assert_eq!(site.reports_in(2.0), 1);
    }
}
