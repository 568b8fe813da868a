//! Errors and the exit status each one ends the program with.

use std::io::ErrorKind;
use std::path::PathBuf;

/// Exit status of the program; every status there is stands here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum ExitStatus {
    /// Everything asked for was done, and the verdict, if there is one, is pass.
    Pass = 0,
    /// An error of the program or of the machine it runs on (a disk that is full, a folder that can't be written).
    Internal = 1,
    /// The command line makes no sense.
    Usage = 2,
    /// The scene is not valid.
    InvalidScene = 3,
    /// A tolerance is exceeded.
    ToleranceExceeded = 10,
    /// The reference is missing, stale or damaged.
    Reference = 11,
    /// A solver failed: diverged, unstable time step, a missing program.
    Solver = 12,
}

/// Everything that can go wrong, in terms a user can act on.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line asks for something that does not exist.
    #[error("{0}")]
    Usage(String),
    /// The scene is not valid; the report carries the place in the file.
    #[error("{0:?}")]
    Scene(miette::Report),
    /// The stored reference is missing, stale or damaged.
    #[error("{0}")]
    Reference(String),
    /// A solver failed.
    #[error("{0}")]
    Solver(String),
    /// The bodies do what the model does not know of, or more often than it follows.
    #[error("{0}")]
    BeyondModel(String),
    /// A file or folder can't be read or written.
    #[error("{action} {path}: {source}")]
    Io {
        /// What was tried, e.g. "writing".
        action: &'static str,
        /// File or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A defect of the program.
    #[error("internal error: {0}")]
    Internal(String),
    /// Another error, with what the user can do.
    #[error("{error}")]
    Hinted {
        /// What is wrong.
        error: Box<Error>,
        /// What to do, a sentence each.
        hints: Vec<String>,
    },
}

impl Error {
    /// The exit status this error ends the program with.
    pub fn exit_status(&self) -> ExitStatus {
        match self {
            Error::Usage(_) => ExitStatus::Usage,
            Error::Scene(_) => ExitStatus::InvalidScene,
            Error::Reference(_) => ExitStatus::Reference,
            Error::Solver(_) | Error::BeyondModel(_) => ExitStatus::Solver,
            // Somebody named a file where a folder is needed, or the other way round.
            Error::Io { source, .. } if is_of_the_wrong_kind(source.kind()) => ExitStatus::Usage,
            Error::Io { .. } | Error::Internal(_) => ExitStatus::Internal,
            Error::Hinted { error, .. } => error.exit_status(),
        }
    }

    /// The same error with `hints`: what the user can do.
    #[must_use]
    pub fn hint(self, hints: impl IntoIterator<Item = String>) -> Self {
        let (error, mut all) = match self {
            Error::Hinted { error, hints } => (error, hints),
            other => (Box::new(other), Vec::new()),
        };
        all.extend(hints);
        Error::Hinted { error, hints: all }
    }

    /// What the user can do, a sentence each.
    pub fn hints(&self) -> &[String] {
        if let Error::Hinted { hints, .. } = self { hints } else { &[] }
    }

    /// Wraps what the system said about `path`.
    pub fn io(action: &'static str, path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Error::Io { action, path: path.into(), source }
    }
}

fn is_of_the_wrong_kind(error: ErrorKind) -> bool {
    matches!(error, ErrorKind::NotADirectory | ErrorKind::IsADirectory | ErrorKind::AlreadyExists)
}

/// Result of anything that can fail for a user.
pub type Result<T> = std::result::Result<T, Error>;
