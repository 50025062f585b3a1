//! The pages for readers: `README.md`, those under `docs/`, and the two for developers.
#![allow(dead_code)]

use std::path::Path;

/// One page.
pub struct Page {
    /// Its path from the root of the repository.
    pub name: String,
    pub text: String,
}

/// Languages of fenced blocks: `ron`, `sh` and `layers` are tested, `rust` is a doctest, the others are only shown.
const LANGUAGES: [&str; 12] =
    ["ron", "sh", "layers", "rust", "json", "toml", "console", "text", "c", "js", "python", "html"];

/// All pages, in order of their names.
pub fn pages() -> Vec<Page> {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let root = folders.find(|folder| folder.join("ARCHITECTURE.md").is_file()).unwrap();
    let mut names: Vec<String> = ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"].map(String::from).into();
    for file in root.join("docs").read_dir().unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".md") {
            names.push(format!("docs/{name}"));
        }
    }
    names.sort();
    let read = |name: String| Page { text: std::fs::read_to_string(root.join(&name)).unwrap(), name };
    names.into_iter().map(read).collect()
}

impl Page {
    /// The fenced blocks in `language`, in order.
    pub fn blocks(&self, language: &str) -> Vec<String> {
        let fenced = self.parts().into_iter().filter(|(fence, _)| fence.as_deref() == Some(language));
        fenced.map(|(_, text)| text).collect()
    }

    /// The texts in backquotes outside of fenced blocks.
    pub fn code(&self) -> Vec<String> {
        let prose = self.parts().into_iter().filter(|(fence, _)| fence.is_none());
        let spans = |(_, text): (_, String)| {
            text.split('`').skip(1).step_by(2).map(|span| span.replace('\n', " ")).collect::<Vec<_>>()
        };
        prose.flat_map(spans).collect()
    }

    /// The targets of its links.
    pub fn links(&self) -> Vec<String> {
        let prose = self.parts().into_iter().filter(|(fence, _)| fence.is_none());
        let targets = |(_, text): (_, String)| {
            let ends = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
            ends.map(|(target, _)| target.to_owned()).collect::<Vec<_>>()
        };
        prose.flat_map(targets).collect()
    }

    /// Prose, without a language, and fenced blocks, in order.
    fn parts(&self) -> Vec<(Option<String>, String)> {
        let mut parts = vec![(None, String::new())];
        for line in self.text.lines() {
            let (fence, text) = parts.last_mut().unwrap();
            match (line.strip_prefix("```"), &fence) {
                (Some(language), None) => {
                    assert!(LANGUAGES.contains(&language), "{}: nobody tries ```{language}", self.name);
                    parts.push((Some(language.to_owned()), String::new()));
                }
                (Some(_), Some(_)) => parts.push((None, String::new())),
                (None, _) => {
                    text.push_str(line);
                    text.push('\n');
                }
            }
        }
        assert!(parts.len() % 2 == 1, "{}: a fenced block does not end", self.name);
        parts
    }
}
