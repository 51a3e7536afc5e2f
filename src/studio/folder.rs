//! The folder of a scene: the only place from which the studio reads, and to which it writes.

use super::error::StudioError;
use std::fs;
use std::io::Write;
use std::path::{Component, Path, PathBuf};

/// Keys of a scene whose values name files or folders.
const NAMING: [&str; 9] = ["photograph", "sight", "depth", "pens", "colours", "profile", "preview", "output", "mask"];
/// Keys by which a scene would move a machine; on the page that is asked for by hand.
const MOVING: [&str; 2] = ["send", "yes"];

/// Refuses a scene that names a file outside its folder.
pub(super) fn check_names(scene: &toml_edit::DocumentMut, folder: &Path) -> Result<(), StudioError> {
    for (key, item) in scene.iter() {
        if MOVING.contains(&key) {
            return Err(StudioError::Refused(format!("{key}: the studio moves no machine by a key of the scene; take it out")));
        }
        match item {
            toml_edit::Item::Value(value) if NAMING.contains(&key) => check_value(key, value, folder)?,
            toml_edit::Item::Table(table) if key == "mask" => {
                table.iter().filter_map(|(_, item)| item.as_value()).try_for_each(|value| check_value(key, value, folder))?;
            }
            toml_edit::Item::ArrayOfTables(regions) if key == "region" => {
                for region in regions {
                    region
                        .get("mask")
                        .and_then(|item| item.as_value())
                        .map_or(Ok(()), |value| check_value("mask", value, folder))?;
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn check_value(key: &str, value: &toml_edit::Value, folder: &Path) -> Result<(), StudioError> {
    if let Some(table) = value.as_inline_table() {
        return table.iter().try_for_each(|(_, value)| check_value(key, value, folder));
    }
    if let Some(array) = value.as_array() {
        return array.iter().try_for_each(|value| check_value(key, value, folder));
    }
    let Some(name) = value.as_str() else { return Ok(()) };
    let is_plain = Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if is_plain && is_below(&folder.join(name), folder) {
        return Ok(());
    }
    Err(StudioError::Refused(format!("{key} = \"{name}\": the studio reads only files in the scene's folder; copy it there")))
}

/// True unless links lead out of the folder.
fn is_below(file: &Path, folder: &Path) -> bool {
    match (file.canonicalize(), folder.canonicalize()) {
        (Ok(file), Ok(folder)) => file.starts_with(folder),
        // What is not there leads nowhere.
        _ => true,
    }
}

/// The file in the folder with a name given by the page: a name alone, without folders.
pub(super) fn inside(folder: &Path, name: &str) -> Result<PathBuf, StudioError> {
    let mut parts = Path::new(name).components();
    let is_name = matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None));
    if !is_name || name.contains(['/', '\\', '\0', ':']) || name.starts_with(['.', '-']) || name.len() > 200 {
        return Err(StudioError::Refused(format!(
            "'{name}' is no name for a file beside the scene; give letters, a dot and the format"
        )));
    }
    let file = folder.join(name);
    if is_below(&file, folder) {
        return Ok(file);
    }
    Err(StudioError::Refused(format!("{name} leads out of the scene's folder")))
}

/// A name that no file has yet: `portrait.jpg`, `portrait-2.jpg`, ...
pub(super) fn unused(folder: &Path, name: &str) -> Result<PathBuf, StudioError> {
    let first = inside(folder, name)?;
    let stem = first.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let ending = first.extension().map_or_else(String::new, |ending| format!(".{}", ending.to_string_lossy()));
    let others = (2..10_000).map(|number| folder.join(format!("{stem}-{number}{ending}")));
    let free = std::iter::once(first.clone()).chain(others).find(|file| !file.exists());
    free.ok_or_else(|| StudioError::Refused(format!("there are too many files named {name}")))
}

/// Writes a file whole or not at all.
pub(super) fn write(file: &Path, bytes: &[u8]) -> Result<(), StudioError> {
    let folder = file.parent().unwrap_or(Path::new("."));
    let write = || {
        fs::create_dir_all(folder)?;
        let mut temporary = tempfile::NamedTempFile::new_in(folder)?;
        temporary.write_all(bytes)?;
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = fs::metadata(file).map_or(0o644, |found| found.permissions().mode());
            temporary.as_file().set_permissions(fs::Permissions::from_mode(mode))?;
        }
        temporary.persist(file).map_err(|error| error.error).map(drop)
    };
    write().map_err(StudioError::about(file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_nowhere_else() {
        let folder = tempfile::tempdir().unwrap();
        assert!(inside(folder.path(), "portrait.svg").is_ok());
        for wrong in ["", ".", "..", "../a.svg", "/etc/passwd", "a/b.svg", "a\\b.svg", ".hidden", "-o", "c:a.svg"] {
            assert!(inside(folder.path(), wrong).is_err(), "{wrong}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("/etc/passwd", folder.path().join("link.jpg")).unwrap();
            assert!(inside(folder.path(), "link.jpg").is_err());
        }
    }

    #[test]
    fn scenes_name_no_other_folder() {
        let folder = tempfile::tempdir().unwrap();
        let check = |text: &str| check_names(&text.parse().unwrap(), folder.path());
        assert!(
            check("photograph = 'a.jpg'\nsight = 'a-sight'\n[mask]\nhair = 'masks/hair.png'\n[[region]]\nmask = 'hair'\n")
                .is_ok()
        );
        for wrong in [
            "photograph = '/etc/passwd'",
            "photograph = '../a.jpg'",
            "mask = { hair = '/etc/passwd' }",
            "[mask]\nhair = '../../x.png'",
            "[[region]]\nmask = '/etc/passwd'",
            "pens = '../pens.toml'",
            "preview = '/tmp/x.svg'",
            "send = '/dev/ttyUSB0'",
        ] {
            assert!(check(wrong).is_err(), "{wrong}");
        }
    }
}
