//! `drypoint draw`: photograph to drawing to file.

use super::advice;
use super::affordable;
use super::arguments::{DrawOptions, Format};
use super::draw_report::report;
use super::dry_run;
use super::failure::Failure;
use super::formats;
use super::inking::{drawing_of, press, uncovered};
use super::interruption::{interrupt, is_interrupted};
use super::job;
use super::layer_files::{LayerFile, split_by_layer};
use super::layout::{self, reach_of};
use super::long_waits;
use super::max_time;
use super::messages::say;
use super::output;
use super::pens::PenSet;
use super::progress::Watcher;
use super::recipe::head;
use super::scene;
use super::threads::limit_threads;
use super::toolpaths;
use crate::plot::{InkModel, Job, Profile};
use crate::press::{PrintFormat, PrintJob};
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
    let (format, mut profile) = format_and_machine(options)?;
    press(options)?;
    let mut pens = PenSet::read(pens_file(options), options.pen, profile.as_mut())?;
    let task = affordable::task(&options.picture, &options.placing, reach_of(profile.as_ref()))?;
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
    report(options, &task, &drawing, &pens, (&files, &jobs), &seconds, watcher.elapsed())
}

/// The file of the pens: one for colours is one for the machine too.
fn pens_file(options: &DrawOptions) -> Option<&str> {
    options.toolpaths.pens.as_deref().or(options.picture.colours.as_deref())
}

/// The format of the output and the machine that reads it, where they go together.
fn format_and_machine(options: &DrawOptions) -> Result<(Format, Option<Profile>), Failure> {
    let format = formats::format_of(&options.output, options.format)?;
    if options.reporting.json && options.output == "-" {
        return Err(Failure::Usage("--json and -o - would both write to stdout".to_owned()));
    }
    let profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &options.toolpaths)).transpose()?;
    formats::check_language(format, profile.as_ref())?;
    if options.embed && format != Format::Svg {
        return Err(Failure::Usage("--embed is for SVG; write .svg or .svgz".to_owned()));
    }
    if profile.is_none() {
        toolpaths::check_machine_options(&options.toolpaths)?;
    }
    Ok((format, profile))
}

/// Writes one file; returns the job if the file is for a machine.
fn write_one<'a>(
    file: &LayerFile<'_>,
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
