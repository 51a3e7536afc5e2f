//! The test sheet of a machine: `drypoint calibrate --profile P`.

use crate::cli::advice;
use crate::cli::arguments::{CalibrateOptions, Order, READING, ToolpathOptions};
use crate::cli::failure::Failure;
use crate::cli::formats;
use crate::cli::messages::say;
use crate::cli::pens::PenSet;
use crate::cli::remedies::advised;
use crate::cli::{job, layout, toolpaths};
use crate::drawing::Page;
use crate::plot::{calibration_page, calibration_sheet, mount};
use crate::write::SvgHead;
use serde_json::json;

pub(super) fn run(options: &CalibrateOptions, profile: &str) -> Result<(), Failure> {
    let format = formats::format_of(&options.output, options.format)?;
    let mut profile = toolpaths::profile(profile, &options.toolpaths)?;
    formats::check_language(format, Some(&profile))?;
    // Touches rest exactly as long as their label says.
    profile.motion.touch_seconds = 0.0;
    let pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, Some(&mut profile))?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    let page = match &options.page {
        None => calibration_page(&profile),
        Some(text) => layout::sheet(text).map(|(width, height)| Page::new(width, height))?,
    };
    let mounting = mount(&profile, &page).map_err(|error| advice::for_test_sheet(error.into()))?;
    let drawable = mounting.drawable(&page);
    let count = options.pen_count.unwrap_or(profile.pens.count);
    let sheet = calibration_sheet(&profile, page, drawable, options.pen, count)
        .map_err(|error| Failure::Work(format!("{}: {}", profile.name, advised(&error))))?;
    // Keep the sheet's order: the result of a trial must not depend on what was drawn before it.
    let toolpath_options = ToolpathOptions { order: Order::None, ..options.toolpaths.clone() };
    let job = job::of_paths(sheet.plot, Some(&profile), &toolpath_options, &pens).map_err(advice::for_test_sheet)?;
    let head = SvgHead {
        title: format!("Test sheet for {}", profile.name),
        description: "Tool paths in drawing order; docs/calibration.md says what to read off.".to_owned(),
        recipe: json!({ "drypoint": env!("CARGO_PKG_VERSION"), "command": "calibrate", "pen_mm": options.pen }).to_string(),
    };
    if !options.dry_run {
        toolpaths::write(&options.output, format, &job, &head)?;
        toolpaths::write_preview_of(&job, &options.toolpaths, None)?;
    }
    toolpaths::warn(&job, Some(""));
    if !options.quiet {
        let (square, summary) = (sheet.square.width(), toolpaths::summary(job.report()));
        say!("{}: {:.1} x {:.1} mm, a square of {square:.0} mm, {summary}", options.output, page.width, page.height);
        sheet.left_out.iter().for_each(|why| say!("{why}"));
        say!("{READING}");
    }
    Ok(())
}
