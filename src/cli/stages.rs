//! `drypoint stages`: writes what was found and every intermediate result, numbered and named.

use super::affordable;
use super::arguments::{PlacingOptions, StagesOptions};
use super::failure::Failure;
use super::messages::say;
use super::output;
use super::png::png;
use super::progress::Watcher;
use super::threads::limit_threads;
use super::tone_error;
use super::words::counted;
use crate::drawing::Drawing;
use crate::raster::Raster;
use crate::source::MaskRole;
use crate::source::grey_image;
use crate::style::{Observer, Picture};
use crate::write::{SvgHead, write_svg};
use image::{Rgb, RgbImage};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

pub(super) fn run(options: &StagesOptions) -> Result<(), Failure> {
    limit_threads(options.picture.threads)?;
    let task = affordable::task(&options.picture, &PlacingOptions::default(), |_| None)?;
    let folder = options.output.to_string_lossy().into_owned();
    if folder == "-" {
        return Err(Failure::Usage("stages are many files; give a folder with -o".to_owned()));
    }
    std::fs::create_dir_all(&options.output).map_err(|error| Failure::Work(format!("{folder} cannot be created: {error}")))?;
    let recorder =
        Recorder { watcher: Watcher::new(options.quiet), folder: options.output.clone(), taken: Mutex::new(Taken::default()) };
    for (name, picture) in task.seen()? {
        recorder.write(name, |stem| png(&format!("{stem}.png"), &picture));
    }
    let drawn = task.draw(&recorder);
    if let Ok(drawing) = &drawn
        && let Some(error) = tone_error::picture(&task, drawing)?
    {
        recorder.write("tone-error", |stem| png(&format!("{stem}.png"), &error));
    }
    recorder.watcher.finish();
    let taken = recorder.taken.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(failure) = taken.failure {
        return Err(failure);
    }
    drawn?;
    task.tell(options.quiet);
    if !options.quiet {
        say!("{folder}: {} of {}", counted(taken.count, "stage"), task.manner.style.name());
    }
    Ok(())
}

/// An observer that writes each picture.
struct Recorder {
    watcher: Watcher,
    folder: PathBuf,
    taken: Mutex<Taken>,
}

#[derive(Default)]
struct Taken {
    count: usize,
    failure: Option<Failure>,
}

impl Recorder {
    /// Writes the next picture; does nothing after a failure.
    fn write(&self, name: &str, write: impl FnOnce(&str) -> Result<(), Failure>) {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        if taken.failure.is_some() {
            return;
        }
        taken.count += 1;
        let stem = self.folder.join(format!("{:02}-{name}", taken.count)).to_string_lossy().into_owned();
        taken.failure = write(&stem).err();
    }
}

impl Observer for Recorder {
    fn begin(&self, step: &str) {
        self.watcher.begin(step);
    }

    fn progress(&self, fraction: f64) {
        self.watcher.progress(fraction);
    }

    fn picture(&self, name: &str, make: &dyn Fn() -> Picture) {
        self.write(name, |stem| match make() {
            Picture::Drawing(drawing) => svg(&format!("{stem}.svg"), &drawing, name),
            Picture::Grey(raster) => png(&format!("{stem}.png"), &grey(&raster)),
            Picture::Mask(raster) => png(&format!("{stem}.png"), &grey(&raster.map(|v| if v == 0 { 1.0 } else { 0.0 }))),
            Picture::Labels(raster) => png(&format!("{stem}.png"), &coloured(&raster)),
        });
    }

    fn warn(&self, message: &str) {
        self.watcher.warn(message);
    }

    fn want_mask(&self, role: MaskRole, message: &str) {
        self.watcher.want_mask(role, message);
    }

    fn is_interrupted(&self) -> bool {
        self.watcher.is_interrupted() || self.taken.lock().is_ok_and(|taken| taken.failure.is_some())
    }
}

fn svg(name: &str, drawing: &Drawing, title: &str) -> Result<(), Failure> {
    let head = SvgHead { title: title.to_owned(), ..SvgHead::default() };
    output::write(name, |mut out| write_svg(drawing, &head, &mut out))
}

fn grey(raster: &Raster<f32>) -> image::DynamicImage {
    grey_image(&raster.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8)).into()
}

/// A colour for each label; neighbouring labels get very different colours.
fn coloured(raster: &Raster<i32>) -> image::DynamicImage {
    let colour = |x: u32, y: u32| {
        let hash = (raster.get(x as usize, y as usize) as u32).wrapping_mul(0x9e37_79b1);
        Rgb([(hash >> 24) as u8 | 0x40, (hash >> 16) as u8 | 0x40, (hash >> 8) as u8 | 0x40])
    };
    RgbImage::from_fn(raster.width() as u32, raster.height() as u32, colour).into()
}
