//! The unit files of `packaging/systemd`, as tests read them.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::{Path, PathBuf};

/// One unit file.
pub struct Unit {
    /// Its file name, such as `underfoot.service`.
    pub name: String,
    pub text: String,
}

/// The folder of all units.
pub fn folder() -> PathBuf {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    folders.find_map(|folder| Some(folder.join("packaging/systemd")).filter(|path| path.is_dir())).unwrap()
}

impl Unit {
    /// All units, by name.
    pub fn all() -> Vec<Self> {
        let files = folder().read_dir().unwrap().map(|entry| entry.unwrap().path());
        let mut units: Vec<Self> = files.map(|path| Self::read(&path)).collect();
        units.sort_by(|a, b| a.name.cmp(&b.name));
        units
    }

    /// The unit of that file name.
    pub fn named(name: &str) -> Self {
        Self::read(&folder().join(name))
    }

    fn read(path: &Path) -> Self {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        Self { name, text: std::fs::read_to_string(path).unwrap() }
    }

    /// Its settings in order: section, key and value.
    pub fn settings(&self) -> Vec<(&str, &str, &str)> {
        let mut section = "";
        let mut all = Vec::new();
        for line in self.text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
        {
            match line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
                Some(name) => section = name,
                None => {
                    let (key, value) =
                        line.split_once('=').unwrap_or_else(|| panic!("{}: {line}", self.name));
                    all.push((section, key, value));
                }
            }
        }
        all
    }

    /// The value of a setting that occurs once in the unit.
    pub fn value(&self, key: &str) -> &str {
        let settings = self.settings();
        let found: Vec<&str> =
            settings.iter().filter(|setting| setting.1 == key).map(|setting| setting.2).collect();
        let [value] = found.as_slice() else {
            panic!("{}: {key} stands there {} times", self.name, found.len())
        };
        value
    }

    /// The words of its command: `%E` is `configuration`, `%i` is `instance`, `$UNDERFOOT_OPTIONS` is `options`.
    pub fn command(&self, configuration: &Path, instance: &str, options: &[&str]) -> Vec<String> {
        let words = self.value("ExecStart").split_whitespace();
        words
            .flat_map(|word| match word {
                "$UNDERFOOT_OPTIONS" => options.iter().map(|option| (*option).to_owned()).collect(),
                word => vec![word.replace("%E", configuration.to_str().unwrap()).replace("%i", instance)],
            })
            .collect()
    }
}
