//! Cache of bodies on disk, by content: the same inputs give the same numbers, bit by bit, without computing them.
//!
//! An entry is a text file named by the SHA-256 of its inputs: checksum, inputs, value, one per line. It is
//! used only if checksum and inputs are right; everything else in the folder is ignored. An entry takes about 2 kB, that of a
//! seal seat some MB.

use crate::error::Result;
use crate::file::write_file;
use crate::scene::hash::{canonical, sha256_hex};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Environment variable that names the folder; empty or `off` = no cache.
const CACHE_VARIABLE: &str = "IMPACTCHECK_CACHE";

/// A folder of values that are dear to compute, or none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cache {
    folder: Option<PathBuf>,
}

impl Cache {
    /// The user's cache: `$IMPACTCHECK_CACHE` (empty or `off` = none), else `$XDG_CACHE_HOME/impactcheck`, else
    /// `~/.cache/impactcheck`.
    pub fn from_environment() -> Self {
        Self::from_variables(|name| std::env::var_os(name))
    }

    fn from_variables(variable: impl Fn(&str) -> Option<OsString>) -> Self {
        if let Some(folder) = variable(CACHE_VARIABLE) {
            return Cache { folder: (!folder.is_empty() && folder != "off").then(|| folder.into()) };
        }
        // The XDG base directory specification has relative paths ignored.
        let absolute = |name| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let base = absolute("XDG_CACHE_HOME").or_else(|| Some(absolute("HOME")?.join(".cache")));
        Cache { folder: base.map(|base| base.join("impactcheck")) }
    }

    /// The cache in `folder`, which is made when the first value is stored.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Cache { folder: Some(folder.into()) }
    }

    /// No cache: everything is computed.
    pub fn off() -> Self {
        Cache { folder: None }
    }

    /// The folder, if there is a cache.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The value that belongs to `inputs`, from the cache or from `build`.
    ///
    /// `inputs` must hold everything the value depends on, the revision of the method included. A cache that can't be read or
    /// written is no error. Values hold finite numbers only; others are computed every time.
    ///
    /// # Errors
    /// Those of `build`.
    pub fn get_or_build<T>(&self, inputs: &Value, build: impl FnOnce() -> Result<T>) -> Result<T>
    where
        T: Serialize + DeserializeOwned,
    {
        let Some(folder) = &self.folder else { return build() };
        let inputs = canonical(inputs);
        let path = folder.join(sha256_hex(inputs.as_bytes()));
        let stored = std::fs::read_to_string(&path).ok();
        if let Some(value) = stored.and_then(|text| value(&text, &inputs)) {
            return Ok(value);
        }
        let built = build()?;
        if let Ok(value) = serde_json::to_string(&built) {
            let content = format!("{inputs}\n{value}\n");
            let entry = format!("{}\n{content}", sha256_hex(content.as_bytes()));
            // A full disk or a folder that is read-only only costs the time of computing again.
            let _ = write_file(&path, entry.as_bytes());
        }
        Ok(built)
    }
}

/// The value of an entry for `inputs`; `None` if the entry is damaged or another's.
fn value<T: DeserializeOwned>(entry: &str, inputs: &str) -> Option<T> {
    let (checksum, content) = entry.split_once('\n')?;
    if sha256_hex(content.as_bytes()) != checksum {
        return None;
    }
    serde_json::from_str(content.strip_prefix(inputs)?.strip_prefix('\n')?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::cell::Cell;

    /// Builds `result` through the cache in `folder`; also tells whether it was computed.
    fn get(folder: &Path, inputs: &Value, result: &[f64]) -> (Vec<f64>, bool) {
        let built = Cell::new(false);
        let values = Cache::at(folder)
            .get_or_build(inputs, || {
                built.set(true);
                Ok(result.to_vec())
            })
            .expect("value");
        (values, built.get())
    }

    #[test]
    fn every_double_comes_back_bit_by_bit() {
        let folder = tempfile::tempdir().expect("folder");
        let hard = [
            0.1 + 0.2,
            5e-324,
            f64::MAX,
            -0.0,
            1.0 / 3.0,
            6.02214076e23,
            f64::MIN_POSITIVE,
            9007199254740993.0,
        ];
        // and doubles of every magnitude, from a linear congruential sequence
        let mut bits = 1u64;
        let random = std::iter::repeat_with(|| {
            bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            f64::from_bits(bits)
        });
        let values: Vec<f64> = hard.into_iter().chain(random.filter(|x| x.is_finite()).take(2000)).collect();
        assert!(get(folder.path(), &json!(1), &values).1);
        let (again, built) = get(folder.path(), &json!(1), &[]);
        assert!(!built);
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&again), bits(&values));
    }

    #[test]
    fn entries_that_are_damaged_cut_or_another_s_are_built_again() {
        let folder = tempfile::tempdir().expect("folder");
        let inputs = json!({"radius": 0.033});
        get(folder.path(), &inputs, &[1.25, 2.5]);
        let path =
            std::fs::read_dir(folder.path()).expect("read").next().expect("one").expect("entry").path();
        let good = std::fs::read(&path).expect("entry");
        let text = String::from_utf8(good.clone()).expect("text");
        let other = tempfile::tempdir().expect("folder");
        get(other.path(), &json!({"radius": 0.034}), &[7.0]);
        let foreign =
            std::fs::read_dir(other.path()).expect("read").next().expect("one").expect("entry").path();
        let bad: [Vec<u8>; 5] = [
            text.replace("1.25", "1.35").into_bytes(),
            good[..good.len() - 3].to_vec(),
            Vec::new(),
            vec![0xff, 0x00, 0x0a],
            std::fs::read(foreign).expect("entry"),
        ];
        for bytes in bad {
            std::fs::write(&path, &bytes).expect("write");
            let (values, built) = get(folder.path(), &inputs, &[1.25, 2.5]);
            assert!(built && values == [1.25, 2.5], "{}", String::from_utf8_lossy(&bytes));
            assert_eq!(std::fs::read(&path).expect("entry"), good, "and the entry is mended");
        }
    }

    #[test]
    fn a_failure_is_not_cached_and_a_read_only_cache_is_no_error() {
        let folder = tempfile::tempdir().expect("folder");
        let failed = Cache::at(folder.path())
            .get_or_build::<f64>(&json!(1), || Err(crate::Error::Solver("singular".into())));
        assert!(failed.is_err());
        assert_eq!(std::fs::read_dir(folder.path()).expect("read").count(), 0);
        // a file where the folder should be
        let file = tempfile::NamedTempFile::new().expect("file");
        assert_eq!(get(file.path(), &json!(1), &[3.0]), (vec![3.0], true));
        assert_eq!(get(&file.path().join("below"), &json!(1), &[3.0]), (vec![3.0], true));
    }

    #[test]
    fn folder_by_environment() {
        let at = |set: &[(&str, &str)]| {
            let set: Vec<(String, String)> = set.iter().map(|(n, v)| ((*n).into(), (*v).into())).collect();
            Cache::from_variables(move |name| {
                set.iter().find(|(n, _)| n == name).map(|(_, value)| OsString::from(value))
            })
        };
        let home = ("HOME", "/home/x");
        assert_eq!(at(&[home]), Cache::at("/home/x/.cache/impactcheck"));
        assert_eq!(at(&[home, ("XDG_CACHE_HOME", "/c")]), Cache::at("/c/impactcheck"));
        assert_eq!(at(&[home, ("XDG_CACHE_HOME", "")]), Cache::at("/home/x/.cache/impactcheck"));
        assert_eq!(at(&[home, (CACHE_VARIABLE, "here"), ("XDG_CACHE_HOME", "/c")]), Cache::at("here"));
        assert_eq!(at(&[home, (CACHE_VARIABLE, "")]), Cache::off());
        assert_eq!(at(&[]), Cache::off());
    }
}
