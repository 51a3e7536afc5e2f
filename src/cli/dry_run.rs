//! `draw --dry-run`: an estimate of a drawing and its plot, in a second or two.

use super::affordable::memory;
use super::arguments::DrawOptions;
use super::estimate::{Care, DrawingEstimate, Estimator, Plan};
use super::failure::Failure;
use super::messages::{self, say};
use super::pens::PenSet;
use super::task::Task;
use super::toolpaths::{self, duration};
use super::{long_waits, output};
use crate::elementary::Elementary as _;
use crate::plot::Profile;
use serde_json::{Value, json};

/// Reports the estimate and writes nothing.
pub(super) fn run(task: &Task<'_>, options: &DrawOptions, profile: Option<&Profile>, pens: &mut PenSet) -> Result<(), Failure> {
    let mut teller = Estimator { task, options, profile, pens };
    let foretold = teller.foretell(&Plan::of(task), Care::Careful)?;
    foretold.check(&mut teller)?;
    long_waits::warn(&mut teller, &foretold);
    let bytes = task.cost(&task.manner.settings, task.layout.picture).bytes;
    if options.reporting.json {
        return output::print_json(&as_json(&foretold, teller.pens, bytes));
    }
    if options.reporting.quiet {
        return Ok(());
    }
    let page = foretold.drawing.page;
    let [dots, strokes, areas] = foretold.amounts.counts();
    let areas = if areas >= 1.0 { format!(", {} areas", rounded(areas)) } else { String::new() };
    let ink: f64 = foretold.amounts.layers.iter().map(|layer| layer.ink_mm2).sum();
    say!(
        "{}: {:.1} x {:.1} mm, about {} dots, {} strokes{areas}, {} mm2 of ink; drawing takes about {} and {} of memory",
        options.output,
        page.width,
        page.height,
        rounded(dots),
        rounded(strokes),
        rounded(ink),
        duration(foretold.work_seconds.max(1.0)),
        memory(bytes)
    );
    if let Some(plot) = &foretold.amounts.plot {
        say!("about {}", toolpaths::summary(&plot.ordered));
    }
    say!("{}; nothing is written", how(foretold.share));
    Ok(())
}

/// What the estimate is based on.
fn how(share: f64) -> String {
    if share >= 1.0 {
        "drawn in full, without the search for short travel".to_owned()
    } else {
        format!("estimated from pictures of {:.1} % of its area, to about 10 %, charcoal and paint to a third", 100.0 * share)
    }
}

/// Rounds to two significant figures.
fn rounded(count: f64) -> f64 {
    if count < 100.0 {
        return count.round();
    }
    let unit = 10_f64.power(count.decimal_logarithm().floor() - 1.0);
    (count / unit).round() * unit
}

fn as_json(foretold: &DrawingEstimate, pens: &PenSet, bytes: f64) -> Value {
    let whole = |count: f64| count.round() as u64;
    let layers: Vec<Value> = foretold
        .amounts
        .layers
        .iter()
        .map(|layer| {
            let [dots, strokes, areas] = layer.counts.map(whole);
            json!({ "name": layer.name, "pen": layer.pen, "pen_mm": pens.nibs().of(layer.pen), "ink": layer.ink, "dots": dots, "strokes": strokes, "areas": areas, "ink_mm2": layer.ink_mm2 })
        })
        .collect();
    let page = foretold.drawing.page;
    let mut value = json!({
        "page_mm": [page.width, page.height],
        "layers": layers,
        "estimate": { "share_drawn": foretold.share, "drawing_seconds": foretold.work_seconds, "memory_bytes": whole(bytes) },
    });
    if let Some(plot) = &foretold.amounts.plot {
        value["pens"] = json!(plot.ordered.pens);
        value["total"] = json!(plot.ordered.total);
    }
    value["warnings"] = json!(messages::warnings());
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_have_two_figures() {
        assert_eq!([0.4, 7.0, 99.0, 123.0, 15_873.0].map(rounded), [0.0, 7.0, 99.0, 120.0, 16_000.0]);
    }
}
