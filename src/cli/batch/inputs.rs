//! The photographs of a batch, from files, folders and manifests, each with a name.

use super::super::claims;
use super::super::failure::Failure;
use std::collections::VecDeque;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Component, Path, PathBuf};

/// Endings of the pictures that are taken from folders.
const PICTURES: [&str; 12] = ["jpg", "jpeg", "png", "webp", "tif", "tiff", "bmp", "gif", "pnm", "tga", "qoi", "hdr"];
/// Longest line of a manifest in bytes; a longer one is no manifest.
const MOST_LINE: u64 = 1 << 16;

/// A photograph and the name of its picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Named {
    pub photo: String,
    /// Relative, without an ending; `/` between folders.
    pub name: String,
}

/// One argument of the command line.
#[derive(Clone, Debug)]
enum Input {
    Photo(String),
    Folder(PathBuf),
    Manifest(PathBuf),
    Stdin,
}

/// All photographs, in order.
pub(super) struct Pictures(Vec<Input>);

impl Pictures {
    pub(super) fn of(inputs: &[String]) -> Result<Self, Failure> {
        if inputs.iter().filter(|input| *input == "-").count() > 1 {
            return Err(Failure::Usage("- is given twice; stdin can be read only once".to_owned()));
        }
        inputs.iter().map(|input| Input::of(input)).collect::<Result<_, _>>().map(Self)
    }

    /// How many of them are wanted; none if that can be known only by reading stdin.
    pub(super) fn count(&self, is_wanted: impl Fn(&str) -> bool) -> Result<Option<u64>, Failure> {
        if self.0.iter().any(|input| matches!(input, Input::Stdin)) {
            return Ok(None);
        }
        let mut count = 0;
        for named in Iter::of(self.0.clone()) {
            match named {
                Ok(named) if !is_wanted(&named.name) => {}
                // A folder or manifest that cannot be read at the start is a mistake of the command line.
                Err(failure @ Unnamed { is_file: true, .. }) => return Err(Failure::Work(failure.reason)),
                _ => count += 1,
            }
        }
        Ok(Some(count))
    }

    pub(super) fn into_iter(self) -> Iter {
        Iter::of(self.0)
    }
}

impl Input {
    fn of(input: &str) -> Result<Self, Failure> {
        if input == "-" {
            return Ok(Self::Stdin);
        }
        let path = PathBuf::from(input);
        let found = fs::metadata(&path).map_err(|_| Failure::Work(format!("{input} does not exist; check its name")))?;
        if found.is_dir() {
            return Ok(Self::Folder(path));
        }
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("tsv")) {
            claims::reads(input, &path, &found);
            return Ok(Self::Manifest(path));
        }
        Ok(Self::Photo(input.to_owned()))
    }
}

/// A photograph that cannot be named.
#[derive(Clone, Debug)]
pub(super) struct Unnamed {
    pub photo: String,
    pub reason: String,
    /// True if a folder or manifest cannot be read, false for one line of it.
    pub is_file: bool,
}

impl Unnamed {
    fn unreadable(path: &Path, error: &std::io::Error) -> Self {
        let photo = path.to_string_lossy().into_owned();
        Self { reason: format!("{photo} cannot be read: {error}"), photo, is_file: true }
    }
}

/// Yields the photographs one by one; a folder's entries in the order of their names.
pub(super) struct Iter {
    inputs: VecDeque<Input>,
    /// Folders under way: the folder, and what is left of it in reverse order.
    folders: Vec<Vec<PathBuf>>,
    /// The folder given by the user, to which names are relative.
    root: PathBuf,
    manifest: Option<Manifest>,
}

struct Manifest {
    lines: BufReader<Box<dyn Read + Send>>,
    /// Paths are relative to it.
    folder: PathBuf,
    shown: String,
    number: usize,
}

impl Iter {
    fn of(inputs: Vec<Input>) -> Self {
        Self { inputs: inputs.into(), folders: Vec::new(), root: PathBuf::new(), manifest: None }
    }

    fn open(&mut self, input: Input) -> Option<Result<Named, Unnamed>> {
        match input {
            Input::Photo(photo) => {
                let name = Path::new(&photo).file_stem().unwrap_or_default().to_string_lossy().into_owned();
                return Some(named(photo, name));
            }
            Input::Folder(folder) => {
                self.root.clone_from(&folder);
                return self.enter(&folder).err().map(Err);
            }
            Input::Manifest(path) => match fs::File::open(&path) {
                Ok(file) => {
                    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
                    self.manifest = Some(Manifest::new(Box::new(file), folder, &path.to_string_lossy()));
                }
                Err(error) => return Some(Err(Unnamed::unreadable(&path, &error))),
            },
            Input::Stdin => self.manifest = Some(Manifest::new(Box::new(std::io::stdin()), PathBuf::new(), "stdin")),
        }
        None
    }

    fn enter(&mut self, folder: &Path) -> Result<(), Unnamed> {
        let entries = fs::read_dir(folder).map_err(|error| Unnamed::unreadable(folder, &error))?;
        let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        paths.sort_unstable_by(|a, b| b.cmp(a));
        self.folders.push(paths);
        Ok(())
    }

    /// The next picture of the folders under way.
    fn of_folders(&mut self) -> Option<Result<Named, Unnamed>> {
        while let Some(left) = self.folders.last_mut() {
            let Some(path) = left.pop() else {
                self.folders.pop();
                continue;
            };
            let is_hidden = path.file_name().is_none_or(|name| name.to_string_lossy().starts_with('.'));
            if is_hidden {
                continue;
            }
            // A link to a folder could lead round in a circle.
            if path.is_dir() {
                if !path.is_symlink()
                    && let Err(unread) = self.enter(&path)
                {
                    return Some(Err(Unnamed { is_file: false, ..unread }));
                }
                continue;
            }
            let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
            if PICTURES.contains(&ending.as_str()) {
                let name = path.strip_prefix(&self.root).unwrap_or(&path).with_extension("");
                let name = name.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/");
                return Some(named(path.to_string_lossy().into_owned(), name));
            }
        }
        None
    }
}

impl Iterator for Iter {
    type Item = Result<Named, Unnamed>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let next = self.of_folders().or_else(|| self.manifest.as_mut().and_then(Manifest::next));
            if next.is_some() {
                return next;
            }
            self.manifest = None;
            let input = self.inputs.pop_front()?;
            let opened = self.open(input);
            if opened.is_some() {
                return opened;
            }
        }
    }
}

impl Manifest {
    fn new(file: Box<dyn Read + Send>, folder: PathBuf, shown: &str) -> Self {
        Self { lines: BufReader::new(file), folder, shown: shown.to_owned(), number: 0 }
    }

    fn next(&mut self) -> Option<Result<Named, Unnamed>> {
        loop {
            self.number += 1;
            let mut line = Vec::new();
            let read = (&mut self.lines).take(MOST_LINE).read_until(b'\n', &mut line);
            let place = || format!("{}, line {}", self.shown, self.number);
            let refused = |reason: String| Some(Err(Unnamed { photo: String::new(), reason, is_file: false }));
            match read {
                Ok(0) => return None,
                Ok(_) if line.len() as u64 >= MOST_LINE => {
                    // The rest of it is no line either.
                    self.lines = BufReader::new(Box::new(std::io::empty()));
                    return refused(format!("{} is longer than {MOST_LINE} bytes; the rest is not read", place()));
                }
                Ok(_) => {}
                Err(error) => {
                    let reason = format!("{}: {error}; the rest is not read", place());
                    self.lines = BufReader::new(Box::new(std::io::empty()));
                    return refused(reason);
                }
            }
            let Ok(text) = String::from_utf8(line) else {
                return refused(format!("{} is not UTF-8 text", place()));
            };
            let text = text.trim_end_matches(['\n', '\r']);
            if !text.trim().is_empty() && !text.starts_with('#') {
                return Some(self.named(text));
            }
        }
    }

    fn named(&self, line: &str) -> Result<Named, Unnamed> {
        let mut fields = line.split('\t');
        let path = fields.next().unwrap_or_default();
        let photo = self.folder.join(path).to_string_lossy().into_owned();
        let stem = || Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = fields.next().filter(|name| !name.is_empty()).map_or_else(stem, str::to_owned);
        named(photo, name)
    }
}

/// A picture whose name is a path below the folder of outputs.
fn named(photo: String, name: String) -> Result<Named, Unnamed> {
    let path = Path::new(&name);
    let stays_below = path.components().all(|part| matches!(part, Component::Normal(_)));
    if name.is_empty() || !stays_below || name.contains(char::is_control) {
        let reason = format!("'{name}' is no name for a picture; it must be a file name without an ending, or folders and one");
        return Err(Unnamed { photo, reason, is_file: false });
    }
    Ok(Named { photo, name })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(inputs: &[&Path]) -> Vec<String> {
        let inputs: Vec<String> = inputs.iter().map(|input| input.to_string_lossy().into_owned()).collect();
        let shown =
            |named: Result<Named, Unnamed>| named.map_or_else(|unnamed| format!("! {}", unnamed.reason), |named| named.name);
        Pictures::of(&inputs).unwrap().into_iter().map(shown).collect()
    }

    #[test]
    fn folders_are_walked_in_order_and_pictures_named_by_their_path() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("b/.hidden")).unwrap();
        for file in ["b/z.jpg", "b/a.PNG", "a.webp", "notes.txt", ".x.jpg", "b/.hidden/y.jpg", "c.tar.jpg"] {
            fs::write(folder.path().join(file), "").unwrap();
        }
        assert_eq!(names(&[folder.path()]), ["a", "b/a", "b/z", "c.tar"]);
        assert_eq!(names(&[&folder.path().join("b/z.jpg")]), ["z"]);
    }

    #[test]
    fn a_manifest_s_lines_are_read_and_wrong_ones_told() {
        let folder = tempfile::tempdir().unwrap();
        let manifest = folder.path().join("list.tsv");
        fs::write(&manifest, "in/a.jpg\n# note\n\nin/b.jpg\t1920/b\r\n/c.jpg\t../c\nd.jpg\t\n").unwrap();
        let named = Pictures::of(&[manifest.to_string_lossy().into_owned()]).unwrap();
        assert_eq!(named.count(|_| true).unwrap(), Some(4));
        let all: Vec<_> = named.into_iter().collect();
        let photo = folder.path().join("in/a.jpg").to_string_lossy().into_owned();
        assert_eq!(all[0].as_ref().unwrap(), &Named { photo, name: "a".to_owned() });
        assert_eq!(all[1].as_ref().unwrap().name, "1920/b");
        assert!(all[2].as_ref().unwrap_err().reason.contains("'../c' is no name"));
        assert_eq!(all[3].as_ref().unwrap().name, "d");
        fs::write(&manifest, [&[0xff, b'\n'][..], &vec![b'x'; 70_000]].concat()).unwrap();
        let told = names(&[&manifest]);
        assert!(told[0].contains("line 1 is not UTF-8") && told[1].contains("longer than") && told.len() == 2, "{told:?}");
    }
}
