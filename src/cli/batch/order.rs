//! What is ordered for every picture: the options of `draw`, those of a recipe among them.

use super::super::arguments::{BatchOptions, Format};
use super::super::failure::Failure;
use super::super::scene::named_files;
use super::super::toolpaths;
use super::super::{formats, manner};
use super::inputs::Named;
use super::{check_output, hashed, hashed_input, memory};
use crate::geometry::Rect;
use crate::style::Settings;
use clap::ValueEnum;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Stands for a picture's name in the values of options.
pub(super) const NAME: &str = "{name}";
/// The box of a picture without `--size`, in millimetres, for foretelling its memory.
const USUAL_BOX: (f64, f64) = (90.0, 120.0);

pub(super) struct Order {
    output: String,
    format: Format,
    /// Long options with their values, as they would be typed; a switch has none.
    options: Vec<(String, Vec<String>)>,
    /// Options that say how to work, not what is drawn.
    run: Vec<(String, String)>,
    /// Bytes of memory for drawing, without the photograph.
    drawing_bytes: f64,
}

impl Order {
    /// Checks what can be checked without a photograph.
    pub(super) fn of(options: &BatchOptions) -> Result<Self, Failure> {
        let draw = &options.draw;
        check_output(&draw.output)?;
        if draw.toolpaths.preview.as_ref().is_some_and(|preview| !preview.contains(NAME)) {
            return Err(Failure::Usage("all previews would be one file; put {name} into --preview".to_owned()));
        }
        if draw.save_scene.is_some() || draw.dry_run {
            let option = if draw.dry_run { "--dry-run" } else { "--save-scene" };
            return Err(Failure::Usage(format!("{option} is for one photograph; use `drypoint draw`")));
        }
        #[cfg(feature = "drive")]
        if draw.toolpaths.send.is_some() {
            return Err(Failure::Usage("--send is for one drawing; use `drypoint draw`".to_owned()));
        }
        let format = formats::format_of(&draw.output, draw.format)?;
        let machine = draw.profile.as_deref().filter(|profile| !profile.contains(NAME));
        let profile = machine.map(|name| toolpaths::profile(name, &draw.toolpaths)).transpose()?;
        formats::check_language(format, profile.as_ref())?;
        let word = draw.format.and_then(|format| Some(format.to_possible_value()?.get_name().to_owned()));
        let preview = draw.toolpaths.preview.clone().map(|preview| ("preview".to_owned(), preview));
        Ok(Self {
            output: draw.output.clone(),
            format,
            options: draw.spelled.0.clone(),
            run: word.map(|word| ("format".to_owned(), word)).into_iter().chain(preview).collect(),
            drawing_bytes: drawing_bytes(options)?,
        })
    }

    pub(super) fn output(&self, name: &str) -> String {
        self.output.replace(NAME, name)
    }

    /// The words of the command that draws a picture.
    pub(super) fn words(&self, named: &Named, output: &str, threads: usize) -> Vec<String> {
        let option = |option: &str, value: &str| format!("--{option}={}", value.replace(NAME, &named.name));
        let mut words =
            vec!["draw".to_owned(), "--quiet".to_owned(), format!("--threads={threads}"), format!("--output={output}")];
        words.extend(self.run.iter().map(|(name, value)| option(name, value)));
        for (name, values) in &self.options {
            match &values[..] {
                [] => words.push(format!("--{name}")),
                values => words.extend(values.iter().map(|value| option(name, value))),
            }
        }
        words.extend(["--".to_owned(), named.photo.clone()]);
        words
    }

    /// A hash of everything that decides a picture's bytes: photograph, options, the files that they name, version.
    pub(super) fn key(&self, named: &Named) -> Result<String, Failure> {
        let mut hasher = Sha256::new();
        let mut add = |part: &str| {
            hasher.update((part.len() as u64).to_be_bytes());
            hasher.update(part.as_bytes());
        };
        add(env!("CARGO_PKG_VERSION"));
        add(&hashed_input(&named.photo)?.0);
        add(&format!("{:?}", self.format));
        add(&std::env::var("SOURCE_DATE_EPOCH").unwrap_or_default());
        for (option, values) in &self.options {
            add(option);
            for value in values {
                let value = value.replace(NAME, &named.name);
                add(&value);
                let files = named_files(option, &value);
                contents(&files)?.iter().for_each(|hash| add(hash));
            }
        }
        Ok(crate::source::hexadecimal(&hasher.finalize()))
    }

    /// Memory in bytes that drawing a photograph is foretold to take at its peak.
    pub(super) fn foretold_bytes(&self, photo: &str) -> u64 {
        (self.drawing_bytes + memory::photograph_bytes(Path::new(photo))) as u64
    }
}

/// Hashes of files, and of the files in folders.
fn contents(files: &[PathBuf]) -> Result<Vec<String>, Failure> {
    let mut hashes = Vec::new();
    for file in files {
        if !file.is_dir() {
            hashes.push(hashed_input(&file.to_string_lossy())?.0);
            continue;
        }
        let unread = |error| Failure::Work(format!("{} cannot be read: {error}", file.display()));
        let entries = std::fs::read_dir(file).map_err(unread)?;
        let mut inside: Vec<PathBuf> =
            entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_file()).collect();
        inside.sort_unstable();
        for path in inside {
            hashes.push(path.file_name().unwrap_or_default().to_string_lossy().into_owned());
            hashes.push(hashed(&path).map_err(unread)?.0);
        }
    }
    Ok(hashes)
}

/// Memory of drawing a picture that fills its box.
fn drawing_bytes(options: &BatchOptions) -> Result<f64, Failure> {
    let picture = &options.draw.picture;
    let style = manner::find_style(&picture.style)?;
    let settings = Settings::resolve(style.name(), style.parameters(), &manner::given(picture))?;
    let sheet = picture.page.as_deref().and_then(|page| super::super::layout::sheet(page).ok());
    let (width, height) = picture.size.or(sheet).unwrap_or(USUAL_BOX);
    let picture_box = Rect::new(0.0, 0.0, width, height);
    let resolution = style.resolution(&settings, &[], picture_box);
    Ok(memory::STANDING + style.cost(&settings, picture_box, resolution).bytes)
}
