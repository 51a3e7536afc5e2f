//! `drypoint draw`: photograph to drawing to file.

use super::advice;
use super::affordable;
use super::arguments::{DrawOptions, Format};
use super::draw_report::report;
use super::dry_run;
use super::failure::Failure;
use super::formats;
use super::interruption::{interrupt, is_interrupted};
use super::job;
use super::layer_files::{LayerFile, split_by_layer};
use super::layout;
use super::long_waits;
use super::max_time;
use super::messages::say;
use super::output;
use super::pens::PenSet;
use super::progress::Watcher;
use super::recipe::head;
use super::scene;
use super::task::Task;
use super::toolpaths;
use crate::drawing::{Drawing, Layer, Mixing, Page, Painted};
use crate::geometry::Rect;
use crate::plot::{Hides, InkModel, Job, Profile, mount, occluded};
use crate::press::{Press, PrintFormat, PrintJob};
use crate::style::Observer;
use crate::write::SvgHead;
use std::borrow::Cow;

pub(super) fn run(options: &DrawOptions) -> Result<(), Failure> {
    limit_threads(options.picture.threads)?;
    match options.max_time {
        Some(limit) => draw(&max_time::within(options, limit)?),
        None => draw(options),
    }
}

fn draw(options: &DrawOptions) -> Result<(), Failure> {
    let format = formats::format_of(&options.output, options.format)?;
    if options.reporting.json && options.output == "-" {
        return Err(Failure::Usage("--json and -o - would both write to stdout".to_owned()));
    }
    let mut profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &options.toolpaths)).transpose()?;
    formats::check_language(format, profile.as_ref())?;
    if options.embed && format != Format::Svg {
        return Err(Failure::Usage("--embed is for SVG; write .svg or .svgz".to_owned()));
    }
    press(options)?;
    if profile.is_none() {
        toolpaths::check_machine_options(&options.toolpaths)?;
    }
    let mut pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, profile.as_mut())?;
    let task = Task::placed(&options.picture, &options.placing, reach_of(profile.as_ref()))?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    let notice = layout::empty_box_notice(&options.picture, &task.layout).filter(|_| !options.reporting.quiet);
    let tell = || notice.iter().for_each(|notice| say!("drypoint: {notice}"));
    if options.dry_run {
        task.tell(options.reporting.quiet);
        let told = dry_run::run(&task, options, profile.as_ref(), &mut pens);
        return told.map_err(|failure| advice::for_draw(failure, options, &task, profile.as_ref())).inspect(|()| tell());
    }
    let is_warned = long_waits::warn_if_long(&task, options, profile.as_ref(), &mut pens)?;
    let watcher = Watcher::new(options.reporting.quiet);
    let (drawing, painting) = drawing_of(&task, options, profile.as_ref(), &mut pens, &watcher)?;
    let visible = match profile {
        Some(_) => uncovered(&drawing, &painting)?,
        None => Cow::Borrowed(&drawing),
    };
    let head = head(options, &task.recipe(options));
    let files = split_by_layer(&visible, &options.output);
    toolpaths::check_layer_files(&files, &options.toolpaths)?;
    let mut jobs = Vec::new();
    for file in &files {
        if is_interrupted() {
            return Err(Failure::Interrupted);
        }
        let machine = profile.as_ref().map(|profile| (profile, &pens));
        let written = write_one(file, format, machine, options, &head, &watcher);
        jobs.extend(written.map_err(|failure| advice::for_draw(failure, options, &task, profile.as_ref()))?);
    }
    if let Some(scene) = &options.save_scene {
        scene::save(options, scene)?;
    }
    let seconds = watcher.finish();
    for job in &jobs {
        toolpaths::warn(job, if is_warned { None } else { Some("; a larger --pitch makes it shorter") });
    }
    max_time::warn_if_longer(&jobs, options.max_time);
    tell();
    task.tell(options.reporting.quiet);
    report(options, &drawing, &pens, (&files, &jobs), &seconds, watcher.elapsed())
}

/// A function that gives the part of a page that the machine reaches.
pub(super) fn reach_of(profile: Option<&Profile>) -> impl Fn(&Page) -> Option<Rect> {
    move |page| Some(mount(profile?, page).ok()?.reach_on_page())
}

/// The selected layers, each with its ink and its pen, and the painting order of their marks.
pub(super) fn drawing_of(
    task: &Task<'_>,
    options: &DrawOptions,
    profile: Option<&Profile>,
    pens: &mut PenSet,
    observer: &dyn Observer,
) -> Result<(Drawing, Vec<Painted>), Failure> {
    let mut drawing = inked(task.draw(observer)?, task, options, observer)?;
    let painting = pens.assign(&mut drawing, profile)?;
    Ok((drawing, painting))
}

/// The selected layers, each with its ink, compensated for the press.
pub(super) fn inked(
    mut drawing: Drawing,
    task: &Task<'_>,
    options: &DrawOptions,
    observer: &dyn Observer,
) -> Result<Drawing, Failure> {
    for layer in &mut drawing.layers {
        layer.ink = task.own_ink(layer).unwrap_or(&options.ink).clone();
    }
    drawing.layers = chosen(drawing.layers, &options.layers)?;
    if let Some(press) = press(options)? {
        observer.begin("press");
        drawing = press.compensated_until(&drawing, interrupt())?;
    }
    Ok(drawing)
}

/// Writes one file; returns the job if the file is for a machine.
fn write_one<'a>(
    file: &LayerFile,
    format: Format,
    machine: Option<(&'a Profile, &PenSet)>,
    options: &DrawOptions,
    head: &SvgHead,
    observer: &dyn Observer,
) -> Result<Option<Job<'a>>, Failure> {
    let LayerFile { name, drawing, .. } = file;
    let Some((profile, pens)) = machine else {
        observer.begin("writing");
        let format = if options.embed { PrintFormat::EmbeddedSvg } else { format.of_print()? };
        let job = PrintJob::new(drawing, None, interrupt())?;
        output::write(name, |out| job.write(format, head, out))?;
        return Ok(None);
    };
    affordable::check_line(drawing, pens.nibs(), InkModel::Ink, 1.0)?;
    let job = job::of_drawing(drawing, InkModel::Ink, Some(profile), &options.toolpaths, pens, observer)?;
    observer.begin("writing");
    toolpaths::write(name, format, &job, head)?;
    toolpaths::write_preview_of(&job, &options.toolpaths, Some(&file.layer))?;
    Ok(Some(job))
}

/// The drawing without the parts of opaque paint that other paint covers.
pub(super) fn uncovered<'a>(drawing: &'a Drawing, painting: &[Painted]) -> Result<Cow<'a, Drawing>, Failure> {
    if drawing.layers.iter().any(|layer| layer.mixing == Mixing::Paint) {
        Ok(Cow::Owned(occluded(drawing, painting, Hides::PaintOnOtherColours, interrupt())?))
    } else {
        Ok(Cow::Borrowed(drawing))
    }
}

/// The press to compensate for; `None` if no compensation is requested.
fn press(options: &DrawOptions) -> Result<Option<Press>, Failure> {
    if options.dot_gain == 0.0 && options.min_mark == 0.0 {
        return Ok(None);
    }
    if options.profile.is_some() {
        return Err(Failure::Usage("--dot-gain and --min-mark are for print; a plotter's nib is set with --pen".to_owned()));
    }
    Ok(Some(Press::new(options.dot_gain, options.dot_gain_screen, options.min_mark)))
}

pub(super) fn limit_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build_global()
        .map_err(|error| Failure::Work(format!("cannot start {threads} threads: {error}")))
}

/// The selected layers, in the drawing's order.
fn chosen(layers: Vec<Layer>, wanted: &[String]) -> Result<Vec<Layer>, Failure> {
    if wanted.is_empty() {
        return Ok(layers);
    }
    let matches = |layer: &Layer, name: &String| layer.name == *name || layer.pen.to_string() == *name;
    if let Some(missing) = wanted.iter().find(|name| !layers.iter().any(|layer| matches(layer, name))) {
        let names: Vec<&str> = layers.iter().map(|l| l.name.as_str()).collect();
        return Err(Failure::Usage(format!("there is no layer '{missing}'; there are {}", names.join(", "))));
    }
    Ok(layers.into_iter().filter(|layer| wanted.iter().any(|name| matches(layer, name))).collect())
}
