//! A drawing invented from the bytes goes through press, hidden parts, clipping, lowering, order, a machine and every writer. All
//! numbers stay finite, nothing is lost by the order, a machine's file stays within its reach, and what is written can be read.

use super::invented::{drawing, length, window};
use super::machine::{Written, is_sound, written};
use super::svg::is_finite;
use arbitrary::{Result, Unstructured};
use drypoint::drawing::{Colour, Drawing, Painted};
use drypoint::geometry::{Point, Rect};
use drypoint::interrupt::Interrupt;
use drypoint::order::{Direction, Effort};
use drypoint::plot::{
    Course, Dialect, DrawingCorner, Duplicates, Hides, InkModel, Job, JobOptions, Language, Nibs, Plot, Profile, Seam, Sequence,
    Swell, built_in_names, clip_to, coverage, lower, mount, occluded, write_inkml,
};
use drypoint::press::Press;
use drypoint::read::{Budget, read_svg};
use drypoint::write::{SvgHead, write_pdf, write_svg};
use std::io::Read;

pub fn check(bytes: &[u8]) {
    // Bytes that run out are zeros, so that every input is a drawing.
    let _ = through(&mut Unstructured::new(bytes));
}

fn through(u: &mut Unstructured<'_>) -> Result<()> {
    let options = Options::invented(u)?;
    let mut drawing = drawing(u)?;
    is_finite(&drawing);
    if u.ratio(1, 4)? {
        drawing = drawing.clipped(window(u, drawing.page)?);
        is_finite(&drawing);
    }
    if u.ratio(1, 4)? {
        drawing = Press::new(length(u, 0.0, 0.4)?, 60.0, length(u, 0.0, 0.5)?).compensated(&drawing);
        is_finite(&drawing);
    }
    if let Some(hides) = options.hides {
        drawing = visible(&drawing, hides);
        is_finite(&drawing);
    }
    are_written(&drawing);
    let plot = lowered(&drawing, &options);
    let plot = in_order(plot, &options);
    on_machine(plot, &options);
    Ok(())
}

/// How it is drawn.
struct Options {
    nibs: Nibs,
    tolerance: f64,
    model: InkModel,
    hides: Option<Hides>,
    sequence: Sequence,
    profile: Profile,
    does_clip: bool,
}

impl Options {
    fn invented(u: &mut Unstructured<'_>) -> Result<Self> {
        let names = built_in_names();
        let mut profile = Profile::built_in(u.choose(&names)?).expect("a built-in profile is sound");
        let mut nibs = Nibs::all(length(u, 0.1, 3.0)?);
        if u.ratio(1, 8)? {
            nibs.by_pen.insert(2, length(u, 0.1, 3.0)?);
        }
        if u.ratio(1, 8)? {
            profile.swell = Some(swell(&profile));
            nibs.swell.clone_from(&profile.swell);
        }
        let hides = [None, None, Some(Hides::OtherColours), Some(Hides::AllLines), Some(Hides::PaintOnOtherColours)];
        Ok(Self {
            nibs,
            tolerance: length(u, 0.005, 0.2)?,
            model: if u.ratio(3, 4)? { InkModel::Ink } else { InkModel::Lines },
            hides: *u.choose(&hides)?,
            sequence: sequence(u)?,
            profile,
            does_clip: u.arbitrary()?,
        })
    }
}

/// A brush that touches the paper above where the pen is lowered, and swells below it.
fn swell(profile: &Profile) -> Swell {
    let (up, down) = profile.height().map_or((2.0, 0.0), |height| (height.up, height.down));
    let at = |share: f64| down + share * (up - down);
    Swell { table: vec![[0.2, at(0.7)], [0.4, down], [1.0, at(-1.5)]] }
}

fn sequence(u: &mut Unstructured<'_>) -> Result<Sequence> {
    let seams = [Seam::Nearest, Seam::Drawn, Seam::Top, Seam::Bottom, Seam::Left, Seam::Right, Seam::Corner];
    let corners = [None, None, Some(DrawingCorner::TopRight), Some(DrawingCorner::BottomLeft)];
    Ok(Sequence {
        // The full search spends a second on whatever it is given.
        effort: *u.choose(&[Effort::None, Effort::Fast, Effort::Fast])?,
        direction: *u.choose(&[Direction::Either, Direction::AsDrawn])?,
        merge: *u.choose(&[0.0, 0.05, 1.0])?,
        duplicates: *u.choose(&[Duplicates::Drop, Duplicates::Keep])?,
        seam: *u.choose(&seams)?,
        course: *u.choose(&[Course::Forwards, Course::Backwards, Course::Shuffled(7)])?,
        start: *u.choose(&corners)?,
    })
}

/// What is left where marks hide one another, painted layer by layer.
fn visible(drawing: &Drawing, hides: Hides) -> Drawing {
    let marks = |(layer, marks): (usize, usize)| (0..marks).map(move |mark| Painted::Mark { layer, mark });
    let counts = drawing.layers.iter().map(|layer| layer.marks.len()).enumerate();
    let painting: Vec<Painted> = counts.flat_map(marks).collect();
    occluded(drawing, &painting, hides, &Interrupt::never()).expect("nobody interrupts")
}

/// Every format for print, with finite numbers; the SVG is read back within the same box.
fn are_written(drawing: &Drawing) {
    let head = SvgHead { title: "t & <t>".to_owned(), description: String::new(), recipe: String::new() };
    let svg = text(|out| write_svg(drawing, &head, out));
    is_numeric(&svg);
    let again = read_svg(svg.as_bytes()).unwrap_or_else(|error| panic!("{error}: {svg}")).drawing();
    is_finite(&again);
    if let Some(box_again) = again.bounding_box() {
        let asked = drawing.bounding_box().expect("what is read was written");
        assert!(holds(asked.inflate(0.05, 0.05), box_again), "{box_again:?} is not in {asked:?}: {svg}");
    }
    is_numeric(&text(|out| write_inkml(drawing, "t & <t>", out)));
    let mut pdf = Vec::new();
    write_pdf(drawing, &head, Some(0), &mut pdf).expect("memory takes all that is written");
    streams(&pdf).iter().for_each(|stream| is_numeric(stream));
}

fn text(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("memory takes all that is written");
    String::from_utf8(bytes).expect("what is written is text")
}

/// No word of it is a number that is none or infinite.
fn is_numeric(text: &str) {
    let is_none = |word: &str| ["nan", "inf", "infinity"].iter().any(|none| word.eq_ignore_ascii_case(none));
    assert!(!text.split(|c: char| !c.is_ascii_alphanumeric()).any(is_none), "{text}");
}

/// A PDF's compressed contents.
fn streams(pdf: &[u8]) -> Vec<String> {
    let places = pdf.windows(7).enumerate().filter(|(_, word)| word == b"stream\n").map(|(i, _)| i + 7);
    let unpacked = |at: usize| {
        let mut text = Vec::new();
        flate2::read::ZlibDecoder::new(&pdf[at..]).read_to_end(&mut text).ok()?;
        String::from_utf8(text).ok()
    };
    places.filter_map(unpacked).collect()
}

/// Tool paths that stay with the ink.
fn lowered(drawing: &Drawing, options: &Options) -> Plot {
    let never = Interrupt::never();
    let plot = lower(drawing, options.model, &options.nibs, options.tolerance, &never).expect("nobody interrupts");
    // A nib wider than a mark draws its middle, and lines that swell are drawn where they are.
    let reach = drawing.bounding_box().map_or(Rect::ZERO, |ink| ink.inflate(0.3, 0.3));
    for path in plot.pens.iter().flat_map(|pen| &pen.paths) {
        assert!(
            path.points().iter().all(|p| p.is_finite() && holds(reach, Rect::from_points(*p, *p))),
            "{path:?} leaves {reach:?}"
        );
    }
    for part in coverage(drawing, &plot, &options.nibs, &never).expect("nobody interrupts") {
        let all = [part.asked, part.covered, part.spilt, part.covered_fraction(), part.spill_fraction()];
        assert!(all.iter().all(|v| v.is_finite() && *v >= 0.0), "{part:?}");
    }
    plot
}

fn holds(outer: Rect, inner: Rect) -> bool {
    inner.x0 >= outer.x0 && inner.y0 >= outer.y0 && inner.x1 <= outer.x1 && inner.y1 <= outer.y1
}

/// In order; where nothing may be joined or left out, the same paths.
fn in_order(mut plot: Plot, options: &Options) -> Plot {
    let sum =
        |plot: &Plot| plot.pens.iter().flat_map(|pen| &pen.paths).fold((0, 0.0), |(n, mm), path| (n + 1, mm + path.length()));
    let before = sum(&plot);
    let sequence = &options.sequence;
    plot.put_in_order(Point::ORIGIN, sequence, &Interrupt::never()).expect("nobody interrupts");
    let after = sum(&plot);
    if sequence.merge == 0.0 && sequence.duplicates == Duplicates::Keep {
        assert_eq!(after.0, before.0, "paths");
        assert!((after.1 - before.1).abs() < 1e-6 * (1.0 + before.1), "{} mm became {}", before.1, after.1);
    }
    plot
}

/// On a machine, cut to what it reaches; the file is read back within the machine's limits, every path of it.
fn on_machine(mut plot: Plot, options: &Options) {
    let profile = &options.profile;
    plot.pens.retain(|pen| pen.number <= profile.pens.count);
    if options.does_clip {
        let Ok(mounting) = mount(profile, &plot.page) else { return };
        let drawable = mounting.drawable(&plot.page);
        clip_to(&mut plot, drawable);
    }
    plot.pens.retain(|pen| !pen.paths.is_empty());
    let as_it_stands = JobOptions {
        sequence: Sequence { effort: Effort::None, duplicates: Duplicates::Keep, ..Sequence::default() },
        ..JobOptions::default()
    };
    let job = Job::of_paths(plot.clone(), None, &as_it_stands, &Interrupt::never()).expect("paper refuses nothing");
    are_read_back(&text(|out| job.write(&SvgHead::default(), out)), &plot);
    let Some(Written { text, plot, mounting }) = written(profile, plot) else {
        assert!(!options.does_clip, "what is cut to the machine's reach is refused");
        return;
    };
    let count: usize = plot.pens.iter().map(|pen| pen.paths.len()).sum();
    // Arcs are followed with some error, and end on the grid of the file.
    let reach = mounting
        .limits
        .union(Rect::from_points(mounting.park, mounting.park))
        .union(Rect::from_points(Point::ORIGIN, Point::ORIGIN));
    let reach = reach.inflate(0.01 + 0.02 * profile.units_per_mm, 0.01 + 0.02 * profile.units_per_mm);
    if profile.language() != Language::Svg {
        let motion = profile.read(&text, &mut Budget::default()).unwrap_or_else(|error| panic!("{error}: {text}"));
        is_sound(&motion, Some(reach));
        assert!(motion.ends_up && motion.paths.len() == count, "{} of {count} paths: {text}", motion.paths.len());
    }
    if let Dialect::Gcode(dialect) = &profile.dialect {
        assert!(text.lines().all(|line| line.len() <= dialect.line_length && line.is_ascii()), "{text}");
    }
}

/// Tool paths as SVG come back as long as they were, but for white ones, which are paper where they are read.
fn are_read_back(svg: &str, plot: &Plot) {
    is_numeric(svg);
    let again = read_svg(svg.as_bytes()).unwrap_or_else(|error| panic!("{error}: {svg}"));
    let lines = lower(&again.drawing(), InkModel::Lines, &Nibs::all(0.3), 0.01, &Interrupt::never()).expect("nobody interrupts");
    let length = |plot: &Plot| plot.pens.iter().flat_map(|pen| &pen.paths).map(drypoint::plot::Toolpath::length).sum::<f64>();
    let mut inked = plot.clone();
    inked.pens.retain(|pen| pen.colour != Colour::WHITE);
    let vertices = inked.pens.iter().flat_map(|pen| &pen.paths).map(|path| path.points().len()).sum::<usize>();
    let (asked, told) = (length(&inked), length(&lines));
    assert!((asked - told).abs() <= 0.02 + 0.004 * vertices as f64, "{asked} mm came back as {told} mm: {svg}");
}
