//! A task's drawing with its layers chosen, inked and given to pens.

use super::arguments::DrawOptions;
use super::failure::Failure;
use super::interruption::interrupt;
use super::pens::PenSet;
use super::task::Task;
use crate::drawing::{Drawing, Layer, Mixing, Painted};
use crate::plot::{Hides, Profile, occluded};
use crate::press::Press;
use crate::style::Observer;
use std::borrow::Cow;

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
    if let Some(palette) = &task.palette {
        palette.ink(&mut drawing);
        if profile.is_none() {
            palette.cover(&mut drawing);
        }
    }
    Ok((drawing, painting))
}

/// The selected layers, each with its ink, compensated for the press.
pub(super) fn inked(
    mut drawing: Drawing,
    task: &Task<'_>,
    options: &DrawOptions,
    observer: &dyn Observer,
) -> Result<Drawing, Failure> {
    for layer in drawing.layers.iter_mut().filter(|_| task.palette.is_none()) {
        layer.ink = task.own_ink(layer).unwrap_or(&options.ink).clone();
    }
    drawing.layers = chosen(drawing.layers, &options.layers)?;
    if let Some(press) = press(options)? {
        observer.begin("press");
        drawing = press.compensated_until(&drawing, interrupt())?;
    }
    Ok(drawing)
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
pub(super) fn press(options: &DrawOptions) -> Result<Option<Press>, Failure> {
    if options.dot_gain == 0.0 && options.min_mark == 0.0 {
        return Ok(None);
    }
    if options.profile.is_some() {
        return Err(Failure::Usage("--dot-gain and --min-mark are for print; a plotter's nib is set with --pen".to_owned()));
    }
    Ok(Some(Press::new(options.dot_gain, options.dot_gain_screen, options.min_mark)))
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
