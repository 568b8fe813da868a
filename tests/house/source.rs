//! A source file, without its comments and tests.

use regex::Regex;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Folders with the sources of product and reference.
const FOLDERS: [&str; 9] = [
    "app/src",
    "embedded/src",
    "fem_reference",
    "fmu/src",
    "live/src",
    "physics/src",
    "prediction/src",
    "python",
    "src",
];
/// The folder whose folders are the kinds of scenes.
const KINDS: &str = "physics/src/kinds";

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Language {
    Rust,
    Python,
}

/// A file of the product.
#[derive(Debug)]
pub struct Source {
    /// Path below the project, with `/`.
    pub path: String,
    pub language: Language,
    /// Its text without comments, docs and tests.
    pub code: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Names of the kinds of scenes, `plate_impact` and the like.
pub fn kinds() -> Vec<String> {
    let folders = entries(&root().join(KINDS)).into_iter().filter(|path| path.is_dir());
    folders.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect()
}

/// All sources in the order of their paths, without tests.
pub fn sources() -> impl Iterator<Item = Source> {
    let mut files = Vec::new();
    FOLDERS.iter().for_each(|folder| collect(&root().join(folder), &mut files));
    files.into_iter().filter_map(|file| Source::read(&file))
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for path in entries(folder) {
        if !path.is_dir() {
            files.push(path);
        } else if !path.ends_with("tests") && !path.ends_with("solutions") {
            collect(&path, files);
        }
    }
}

impl Source {
    /// `None` of a file in another language, and of tests.
    fn read(file: &Path) -> Option<Self> {
        let language = match file.extension()?.to_str()? {
            "rs" => Language::Rust,
            "py" => Language::Python,
            _ => return None,
        };
        if file.file_stem()? == "tests" {
            return None;
        }
        let text = fs::read_to_string(file).ok()?;
        let path = file.strip_prefix(root()).ok()?.to_str()?.replace('\\', "/");
        Some(Self { path, language, code: language.without_comments(&text) })
    }

    /// The file or folder of `package` that holds this file; `None` of the package's own root.
    pub fn room(&self, package: &str) -> Option<&str> {
        let below = self.path.strip_prefix(package)?.strip_prefix('/')?;
        let room = below.split('/').next()?;
        let room = room.strip_suffix(".rs").or(room.strip_suffix(".py")).unwrap_or(room);
        (!["lib", "main", "__init__", "__main__"].contains(&room)).then_some(room)
    }

    /// What this file imports from the top of `package`.
    pub fn imports(&self, package: &str) -> Vec<String> {
        let depth = self.path[package.len()..].matches('/').count();
        match self.language {
            Language::Rust => self.rust_imports(depth - usize::from(self.path.ends_with("/mod.rs"))),
            Language::Python => self.python_imports(package, depth),
        }
    }

    /// First names after `crate::`, and after as many `super::` as the module is `deep` in its crate.
    fn rust_imports(&self, deep: usize) -> Vec<String> {
        static PATH: LazyLock<Regex> =
            LazyLock::new(|| Regex::new(r"\b(crate::|(?:super::)+)(\w+|\{)").expect("expression"));
        let mut found = Vec::new();
        for path in PATH.captures_iter(&self.code) {
            if &path[1] != "crate::" && path[1].matches("super").count() != deep {
                continue;
            }
            if &path[2] == "{" {
                found.extend(first_names(&self.code[path.get(0).expect("match").end()..]));
            } else {
                found.push(path[2].to_owned());
            }
        }
        found
    }

    fn python_imports(&self, package: &str, deep: usize) -> Vec<String> {
        static FROM: LazyLock<Regex> = LazyLock::new(|| {
            Regex::new(r"(?m)^\s*(?:from|import) (\.*)([\w.]*)(?: import \(?([\w, \n]*))?")
                .expect("expression")
        });
        let mut found = Vec::new();
        for from in FROM.captures_iter(&self.code) {
            let below = match from[1].len() {
                0 => from[2].strip_prefix(package).and_then(|rest| rest.strip_prefix('.')),
                dots => (dots == deep).then_some(&from[2]),
            };
            match below {
                Some("") => found.extend(from[3].split(',').map(|name| name.trim().to_owned())),
                Some(module) => found.extend(module.split('.').next().map(str::to_owned)),
                None => {}
            }
        }
        found
    }

    /// Names of the types that this file defines.
    pub fn types(&self) -> Vec<String> {
        static TYPE: LazyLock<Regex> = LazyLock::new(|| {
            Regex::new(r"(?m)^\s*(?:pub(?:\([^)]*\))? )?(?:struct|enum|trait) (\w+)").expect("expression")
        });
        TYPE.captures_iter(&self.code).map(|found| found[1].to_owned()).collect()
    }

    /// Sources that this file includes as text or bytes.
    pub fn includes_of_sources(&self) -> Vec<String> {
        static INCLUDE: LazyLock<Regex> =
            LazyLock::new(|| Regex::new(r#"include_(?:str|bytes)!\("([^"]*\.rs)"\)"#).expect("expression"));
        INCLUDE.captures_iter(&self.code).map(|found| format!("{} in {}", &found[1], self.path)).collect()
    }
}

impl Language {
    fn without_comments(self, text: &str) -> String {
        static DOC: LazyLock<Regex> = LazyLock::new(|| Regex::new(r#"(?s)""".*?""""#).expect("expression"));
        let (text, mark) = match self {
            // unit tests are the last of a file
            Self::Rust => (text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text).to_owned(), "//"),
            Self::Python => (DOC.replace_all(text, "").into_owned(), "#"),
        };
        let code = |line: &str| line.find(mark).map_or_else(|| line.to_owned(), |at| line[..at].to_owned());
        text.lines().map(code).collect::<Vec<_>>().join("\n")
    }
}

/// First names of the paths of a group, `code` behind its brace: of `a::{b, c}, d}` those are `a` and `d`.
fn first_names(code: &str) -> Vec<String> {
    let (mut names, mut depth, mut start) = (Vec::new(), 0, 0);
    for (at, sign) in code.char_indices() {
        match sign {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                let path = code[start..at].trim();
                names.extend(path.split("::").next().filter(|name| !name.is_empty()).map(str::to_owned));
                start = at + 1;
                if sign == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    names
}
