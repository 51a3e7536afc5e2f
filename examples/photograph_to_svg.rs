//! A photograph as a hedcut in SVG, the shortest way through the library:
//! `cargo run --release --example photograph_to_svg -- PHOTO OUT.svg`

use drypoint::drawing::Page;
use drypoint::geometry::Rect;
use drypoint::interrupt::Interrupt;
use drypoint::press::{PrintFormat, PrintJob};
use drypoint::source::{Crop, Limits, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Settings, Silent, find};
use drypoint::write::SvgHead;
use std::fs::{File, read};

/// Width of the picture, in millimetres.
const WIDTH: f64 = 90.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [photo, out] = &std::env::args().skip(1).collect::<Vec<_>>()[..] else {
        return Err("give a photograph and the name of an SVG".into());
    };
    let photograph = Photograph::decode(&read(photo)?, Limits::default())?;
    let style = find("hedcut").ok_or("there is no such style")?;
    let settings = Settings::resolve(style.name(), style.parameters(), &[("pitch".into(), "0.6mm".into())])?;

    let picture = Rect::new(0.0, 0.0, WIDTH, WIDTH * f64::from(photograph.height()) / f64::from(photograph.width()));
    let page = Page::new(picture.width(), picture.height());
    let placement = Placement::new(picture, style.resolution(&settings, &[], picture));
    let (crop, curve) = (Crop::all(&photograph), ToneCurve::default());
    let portrait = Portrait::new(&photograph, crop, page, placement, ToneTarget::Lightness, curve)?;

    let drawing = style.draw(&portrait, &settings, 0, &Silent)?;
    let job = PrintJob::new(&drawing, None, &Interrupt::never())?;
    let head = SvgHead { title: "A hedcut".into(), ..SvgHead::default() };
    job.write(PrintFormat::Svg, &head, File::create(out)?)?;
    Ok(())
}
