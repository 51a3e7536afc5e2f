//! The print job: a drawing, what the press does to it, and the format in which it leaves.

use super::Press;
use crate::drawing::Drawing;
use crate::interrupt::{Interrupt, Interrupted};
use crate::plot::write_inkml;
use crate::write::{SvgHead, write_embedded_svg, write_marks, write_pdf, write_svg};
use std::borrow::Cow;
use std::io;

/// A format for print, for the screen or for a painting program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PrintFormat {
    /// SVG in millimetres.
    Svg,
    /// SVG without its sheet, to be placed in a page.
    EmbeddedSvg,
    /// PDF with its boxes and its ink in separations.
    Pdf {
        /// When it was made, in seconds since 1970; none leaves the date out.
        seconds: Option<u64>,
    },
    /// `InkML`: strokes with pressure, without dots' outlines.
    Inkml,
    /// The marks as JSON: dots, strokes and areas of each layer, in millimetres.
    Json,
}

/// A drawing as it goes onto the plate.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintJob<'a> {
    drawing: Cow<'a, Drawing>,
}

impl<'a> PrintJob<'a> {
    /// The job of a drawing; without a press its marks are printed as they are.
    ///
    /// ```
    /// use drypoint::drawing::{Dot, Drawing, Layer, Mark, Page};
    /// use drypoint::geometry::Point;
    /// use drypoint::interrupt::Interrupt;
    /// use drypoint::press::{Press, PrintFormat, PrintJob};
    /// use drypoint::write::SvgHead;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut layer = Layer::new("dots", 1);
    /// layer.marks.push(Mark::Dot(Dot::circle(Point::new(20.0, 20.0), 1.5)));
    /// let drawing = Drawing { page: Page::new(40.0, 40.0), layers: vec![layer] };
    /// let newsprint = Press::new(0.25, 40.0, 0.1);
    /// let job = PrintJob::new(&drawing, Some(&newsprint), &Interrupt::never())?;
    /// let mut svg = Vec::new();
    /// job.write(PrintFormat::Svg, &SvgHead::default(), &mut svg)?;
    /// assert!(svg.starts_with(b"<svg"));
    /// # Ok(())
    /// # }
    /// ```
    pub fn new(drawing: &'a Drawing, press: Option<&Press>, interrupt: &Interrupt) -> Result<Self, Interrupted> {
        let drawing = match press {
            Some(press) => Cow::Owned(press.compensated_until(drawing, interrupt)?),
            None => Cow::Borrowed(drawing),
        };
        Ok(Self { drawing })
    }

    /// What is printed.
    pub fn drawing(&self) -> &Drawing {
        &self.drawing
    }

    /// Writes it.
    pub fn write(&self, format: PrintFormat, head: &SvgHead, mut out: impl io::Write) -> io::Result<()> {
        match format {
            PrintFormat::Svg => write_svg(&self.drawing, head, &mut out),
            PrintFormat::EmbeddedSvg => write_embedded_svg(&self.drawing, head, &mut out),
            PrintFormat::Pdf { seconds } => write_pdf(&self.drawing, head, seconds, &mut out),
            PrintFormat::Inkml => write_inkml(&self.drawing, &head.title, &mut out),
            PrintFormat::Json => write_marks(&self.drawing, |_| 0.0, &mut out),
        }
    }
}
