//! A style of one's own: weighted Voronoi dots joined by the shortest tour, one line without a lift.
//! `cargo run --release --example custom_style -- PHOTO OUT.svg`

use drypoint::drawing::{Drawing, Layer, Mark, Stroke};
use drypoint::field::relaxed;
use drypoint::geometry::{BezPath, Point, Rect};
use drypoint::interrupt::Interrupt;
use drypoint::order::{Direction, Effort, PathEnds, order};
use drypoint::press::{PrintFormat, PrintJob};
use drypoint::source::{Crop, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Cost, DefaultLength, Kind, Parameter, Request, Settings, Silent, Style, StyleCard, StyleError};
use drypoint::write::SvgHead;

/// The style.
#[derive(Debug)]
pub struct OneLine;

/// Working pixels between dots at full ink.
const PIXELS_PER_DOT: f64 = 3.0;

/// What it is.
const CARD: StyleCard = StyleCard {
    name: "one-line",
    summary: "dots spread by tone, joined by the shortest tour",
    source: "Kaplan and Bosch 2005, TSP Art",
    parameters: &[
        Parameter {
            name: "dots",
            kind: Kind::Count { default: 1500, least: 10, most: 100_000 },
            meaning: "number of dots that the line would join in a black picture",
            source: "",
            needs: &[],
        },
        Parameter {
            name: "line",
            kind: Kind::Length { default: DefaultLength::Millimetres(0.3), least: 0.05, most: 5.0 },
            meaning: "width of the line",
            source: "",
            needs: &[],
        },
    ],
    masks: &[MaskRole::Subject],
    uses_depth: false,
    leaves_out_background: false,
};

impl Style for OneLine {
    fn card(&self) -> &StyleCard {
        &CARD
    }

    fn pixels_per_mm(&self, _: &Settings, _: &[MaskRole]) -> f64 {
        4.0
    }

    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost {
        let pixels = picture.area() * pixels_per_mm * pixels_per_mm;
        Cost { pixels, bytes: 40.0 * pixels + 1000.0 * settings.number("dots"), seconds: 1e-6 * pixels }
    }

    fn sketch(&self, request: &Request<'_>) -> Result<Drawing, StyleError> {
        let Request { portrait, settings, seed, observer } = *request;
        let ink = portrait.ink();
        let total: f64 = ink.pixels().iter().map(|ink| f64::from(*ink)).sum();
        if total <= 0.0 {
            return Err(StyleError::NothingToDraw("the picture is white all over".to_owned()));
        }
        observer.begin("dots");
        let mut dots = scattered(&ink, settings.number("dots") / ink.pixels().len() as f64, seed);
        if dots.is_empty() {
            return Err(StyleError::NothingToDraw("the picture is too light for one dot".to_owned()));
        }
        let weight = ink.map(|ink| ink * ink);
        for _ in 0..20 {
            if observer.is_interrupted() {
                return Err(StyleError::Interrupted);
            }
            dots = relaxed(&dots, &weight, PIXELS_PER_DOT);
        }
        observer.begin("tour");
        let ends: Vec<PathEnds> = dots.iter().map(|dot| PathEnds { start: *dot, end: *dot }).collect();
        let tour = order(&ends, Point::ORIGIN, Effort::Fast, Direction::Either);
        let mut line = BezPath::new();
        for (i, visit) in tour.iter().enumerate() {
            let p = portrait.placement.to_page(dots[visit.path]);
            if i == 0 { line.move_to(p) } else { line.line_to(p) }
        }
        if tour.len() == 1 {
            line.line_to(portrait.placement.to_page(dots[0]));
        }
        let mut layer = Layer::new("line", 1);
        layer.marks.push(Mark::Stroke(Stroke::even(line, settings.number("line"))));
        Ok(Drawing { page: portrait.page, layers: vec![layer] })
    }
}

/// Dots where the ink asks for them: each pixel's share is carried on until it makes a dot, along rows in turns.
fn scattered(ink: &drypoint::raster::Raster<f32>, per_ink: f64, seed: u64) -> Vec<Point> {
    let mut owed = (seed % 97) as f64 / 97.0;
    let mut dots = Vec::new();
    for y in 0..ink.height() {
        for i in 0..ink.width() {
            let x = if y % 2 == 0 { i } else { ink.width() - 1 - i };
            owed += f64::from(ink.get(x, y)) * per_ink;
            while owed >= 1.0 {
                owed -= 1.0;
                dots.push(Point::new(x as f64 + 0.5 + 0.4 * owed.min(1.0), y as f64 + 0.5));
            }
        }
    }
    dots
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [photo, out] = &std::env::args().skip(1).collect::<Vec<_>>()[..] else {
        return Err("give a photograph and the name of an SVG".into());
    };
    let photograph = Photograph::decode(&std::fs::read(photo)?, Limits::default())?;
    let settings = Settings::resolve("one-line", OneLine.parameters(), &[("dots".into(), "4000".into())])?;
    let width = 100.0;
    let height = (width * f64::from(photograph.height()) / f64::from(photograph.width())).round();
    let placement = Placement::new(Rect::new(0.0, 0.0, width, height), OneLine.pixels_per_mm(&settings, &[]));
    let page = drypoint::drawing::Page::new(width, height);
    let curve = ToneCurve::default();
    let portrait = Portrait::new(&photograph, Crop::all(&photograph), page, placement, ToneTarget::Lightness, curve)?;
    let drawing = OneLine.draw(&portrait, &settings, 0, &Silent)?;
    let job = PrintJob::new(&drawing, None, &Interrupt::never())?;
    job.write(PrintFormat::Svg, &SvgHead { title: "One line".into(), ..SvgHead::default() }, std::fs::File::create(out)?)?;
    Ok(())
}
