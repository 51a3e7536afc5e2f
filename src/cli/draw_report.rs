//! What `drypoint draw` says of its work.

use super::arguments::DrawOptions;
use super::failure::Failure;
use super::layer_files::{self, LayerFile};
use super::messages::{self, say};
use super::palette::explained;
use super::pens::PenSet;
use super::task::Task;
use super::words::counted;
use super::{output, toolpaths};
use crate::drawing::{Drawing, Layer};
use crate::plot::Job;
use serde_json::{Value, json};

pub(super) fn report(
    options: &DrawOptions,
    task: &Task<'_>,
    drawing: &Drawing,
    pens: &PenSet,
    (files, jobs): (&[LayerFile<'_>], &[Job<'_>]),
    seconds: &[(String, f64)],
    elapsed: f64,
) -> Result<(), Failure> {
    if options.reporting.json {
        return output::print_json(&report_json(task, drawing, pens, (files, jobs), seconds));
    }
    if !options.reporting.quiet {
        let counts =
            drawing.layers.iter().map(Layer::counts).fold([0; 3], |sum, c| [sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]]);
        let ink: f64 = drawing.ink_mm2().iter().sum();
        let areas = if counts[2] > 0 { format!(", {}", counted(counts[2], "area")) } else { String::new() };
        say!(
            "{}: {:.1} x {:.1} mm, {}, {}{areas}, {ink:.0} mm2 of ink, in {elapsed:.1} s",
            layer_files::names(files),
            drawing.page.width,
            drawing.page.height,
            counted(counts[0], "dot"),
            counted(counts[1], "stroke")
        );
        if options.explain {
            explained(drawing, pens.nibs()).iter().for_each(|line| say!("{line}"));
        }
        for (file, job) in files.iter().zip(jobs) {
            let name = if files.len() > 1 { format!("{}: ", file.name) } else { String::new() };
            say!("{name}{}", toolpaths::summary(job.report()));
            toolpaths::pen_lines(job).iter().for_each(|line| say!("{line}"));
        }
    }
    Ok(())
}

fn report_json(
    task: &Task<'_>,
    drawing: &Drawing,
    pens: &PenSet,
    (files, jobs): (&[LayerFile<'_>], &[Job<'_>]),
    seconds: &[(String, f64)],
) -> Value {
    let layers: Vec<Value> = drawing.layers.iter().zip(drawing.ink_mm2()).map(|(layer, ink)| {
        let [dots, strokes, areas] = layer.counts();
        json!({ "name": layer.name, "pen": layer.pen, "pen_mm": pens.nibs().of(layer.pen), "ink": layer.ink.to_string(), "dots": dots, "strokes": strokes, "areas": areas, "ink_mm2": ink })
    }).collect();
    let placed = task.layout.placed();
    let mut value = json!({
        "files": files.iter().map(|file| &file.name).collect::<Vec<_>>(),
        "page_mm": [drawing.page.width, drawing.page.height],
        // The photograph's pixel (x, y) lies at (a x + c y + e, b x + d y + f) mm; the box is of the part drawn.
        "picture": { "pixels": task.size, "to_sheet": task.to_sheet().as_coeffs(), "box": [placed.x0, placed.y0, placed.width(), placed.height()] },
        "layers": layers,
        "seconds": seconds_of_steps(seconds),
    });
    if let Some(report) = toolpaths::combined_report(jobs) {
        value["pens"] = json!(report.pens);
        value["total"] = json!(report.total);
        value["duplicates"] = json!(jobs.iter().map(Job::duplicates).sum::<usize>());
    }
    value["warnings"] = json!(messages::warnings());
    value
}

/// Seconds by step; steps repeated for several files are summed.
pub(super) fn seconds_of_steps(seconds: &[(String, f64)]) -> serde_json::Map<String, Value> {
    seconds.iter().fold(serde_json::Map::new(), |mut sums, (step, taken)| {
        let before = sums.get(step).and_then(Value::as_f64).unwrap_or(0.0);
        sums.insert(step.clone(), json!(before + taken));
        sums
    })
}
