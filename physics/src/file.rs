//! Files that are there whole or not at all.

use crate::error::{Error, Result};
use std::path::Path;

/// Writes one file by way of a temporary one beside it, so that it is never seen half-written.
///
/// # Errors
/// [`Error::Io`] naming the file.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let fail = |e| Error::io("writing", path, e);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(fail)?;
    let mut builder = tempfile::Builder::new();
    // others may read it, as far as the user's umask permits: by default a temporary file is private
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut partial = builder.prefix(".partial-").tempfile_in(folder).map_err(fail)?;
    std::io::Write::write_all(&mut partial, bytes).map_err(fail)?;
    partial.persist(path).map_err(|e| fail(e.error))?;
    Ok(())
}
