//! `drypoint calibrate`: a test sheet for a machine and its pens.

use super::arguments::{CalibrateOptions, Order, READING};
use super::failure::Failure;
use super::messages::say;
use super::pens::PenSet;
use super::{layout, toolpaths};
use crate::drawing::Page;
use crate::plot::{calibration_page, calibration_sheet, mount};
use crate::write::SvgHead;
use serde_json::json;

pub(super) fn run(options: &CalibrateOptions) -> Result<(), Failure> {
    let format = toolpaths::format_of(&options.output, options.format)?;
    let mut profile = toolpaths::profile(&options.profile, &options.toolpaths)?;
    toolpaths::check_language(format, Some(&profile))?;
    // Touches rest as long as their label says, and no longer.
    profile.motion.touch_seconds = 0.0;
    let pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, Some(&mut profile))?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    let page = match &options.page {
        None => calibration_page(&profile),
        Some(text) => layout::sheet(text).map(|(width, height)| Page::new(width, height))?,
    };
    let drawable = mount(&profile, &page)?.drawable(&page);
    let count = options.pen_count.unwrap_or(profile.pens.count);
    let sheet = calibration_sheet(&profile, page, drawable, options.pen, count)
        .map_err(|error| Failure::Work(format!("{}: {error}", profile.name)))?;
    // In the order of the sheet: what a trial shows must not depend on what was drawn before it.
    let toolpath_options = super::arguments::ToolpathOptions { order: Order::None, ..options.toolpaths.clone() };
    let prepared = toolpaths::prepare(sheet.plot, Some(&profile), &toolpath_options, &pens)?;
    let head = SvgHead {
        title: format!("Test sheet for {}", profile.name),
        description: "Tool paths in drawing order; docs/calibration.md says what to read off.".to_owned(),
        recipe: json!({ "drypoint": env!("CARGO_PKG_VERSION"), "command": "calibrate", "pen_mm": options.pen }).to_string(),
    };
    if !options.dry_run {
        toolpaths::write(&options.output, format, &prepared, Some(&profile), &head)?;
        toolpaths::write_preview_of(&prepared, &options.toolpaths, None)?;
    }
    toolpaths::warn(&prepared, Some(&profile), Some(""));
    if !options.quiet {
        let (square, summary) = (sheet.square.width(), toolpaths::summary(&prepared.report));
        say!("{}: {:.1} x {:.1} mm, a square of {square:.0} mm, {summary}", options.output, page.width, page.height);
        sheet.left_out.iter().for_each(|why| say!("{why}"));
        say!("{READING}");
    }
    Ok(())
}
