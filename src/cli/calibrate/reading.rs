//! A picture of a colour sheet, read: `drypoint calibrate --colours PENS --read PHOTO`.

use super::measured_file::{MeasuredPen, with_colours};
use super::pen_box::PenBox;
use crate::cli::arguments::CalibrateOptions;
use crate::cli::claims;
use crate::cli::failure::Failure;
use crate::cli::masks::photograph;
use crate::cli::messages::{say, warning};
use crate::cli::output;
use crate::cli::progress::Watcher;
use crate::cli::words::counted;
use crate::colour::sheet::{Known, PenReading, Picture, ReadWarning, SheetReading, read_sheet};
use crate::colour::{ColourPen, Lab, Opacity, Paper, PenSet, on_screen};
use crate::source::{Crop, Photograph};
use crate::style::Observer as _;

/// Two pens are taken for swapped if that brings their colours this much nearer to the file's (CIEDE2000).
const SWAPPED: f64 = 30.0;

pub(super) fn run(options: &CalibrateOptions, file: &str, picture: &str) -> Result<(), Failure> {
    let pen_box = PenBox::read(options, file)?;
    if pen_box.pens.is_empty() {
        return Err(Failure::Work(format!("{file}: there are no pens; give the file with which the sheet was drawn")));
    }
    let watcher = Watcher::new(options.quiet);
    watcher.begin("reading");
    let photograph = photograph(picture)?;
    claims::check_distinct([options.output.as_str()])?;
    watcher.begin("measuring");
    let reading = read(options, &pen_box, &photograph, picture)?;
    watcher.finish();
    photograph.info.warnings.iter().for_each(|told| warning!("{picture}: {told}"));
    reading.warnings.iter().for_each(|told| warning!("{picture}: {told}{}", names(told, &pen_box)));
    warn_of_swapped(&pen_box, &reading);
    warn_of_unusable(&pen_box, &reading, &options.output);
    let text = with_colours(&pen_box.text, &measured(&pen_box, &reading)).ok_or_else(|| {
        Failure::Work(format!("{file} cannot be written anew; write each pen as a table of its own, such as [black]"))
    })?;
    if !options.dry_run {
        output::write(&options.output, |out| out.write_all(text.as_bytes()))?;
    }
    if !options.quiet {
        tell(options, &pen_box, &reading);
    }
    Ok(())
}

fn read(options: &CalibrateOptions, pen_box: &PenBox, photograph: &Photograph, name: &str) -> Result<SheetReading, Failure> {
    let about = Failure::about(if name == "-" { "stdin" } else { name });
    let (width, height) = (photograph.width() as usize, photograph.height() as usize);
    let pixels = photograph.encoded(Crop::all(photograph), width, height).map_err(|error| about(&error))?;
    let nibs = pen_box.nibs();
    let known = Known { nibs: &nibs, paper: options.paper.map(|_| pen_box.paper.colour), grey: options.grey_card };
    read_sheet(Picture::Encoded(&pixels), &known).map_err(|error| about(&error))
}

/// The pens' colours, alone and over one another.
fn measured<'a>(pen_box: &'a PenBox, reading: &SheetReading) -> Vec<MeasuredPen<'a>> {
    let name = |pen: usize| pen_box.pens[pen].entry.key.as_str();
    let over = |upper: usize| {
        let pairs = reading.pairs.iter().filter(move |pair| pair.pens[1] == upper);
        pairs.map(|pair| (name(pair.pens[0]), bounded(pair.colour.lab))).collect()
    };
    let all = |pen: usize| reading.all.as_ref().filter(|_| pen + 1 == reading.pens.len()).map(|all| bounded(all.lab));
    let pen = |(i, read): (usize, &PenReading)| MeasuredPen {
        name: name(i),
        colour: bounded(read.solid.lab),
        over: over(i),
        over_all: all(i),
    };
    reading.pens.iter().enumerate().map(pen).collect()
}

/// As a file of pens takes it.
fn bounded([l, a, b]: [f64; 3]) -> [f64; 3] {
    [l.clamp(0.0, 100.0), a, b]
}

fn lab([l, a, b]: [f64; 3]) -> Lab {
    Lab { l, a, b }
}

/// The names of the pens that a warning numbers.
fn names(warning: &ReadWarning, pen_box: &PenBox) -> String {
    match warning {
        ReadWarning::Bare { pen, .. }
        | ReadWarning::Differs { pen, .. }
        | ReadWarning::Pale { pen }
        | ReadWarning::BeyondGamut { pen }
        | ReadWarning::Ramp { pen } => format!(" (pen {} is {})", pen + 1, pen_box.name(*pen)),
        ReadWarning::Alike { pens: [one, two] } => {
            format!(" (pen {} is {}, pen {} is {})", one + 1, pen_box.name(*one), two + 1, pen_box.name(*two))
        }
        _ => String::new(),
    }
}

/// Warns of two pens each of which has the other's colour.
fn warn_of_swapped(pen_box: &PenBox, reading: &SheetReading) {
    let read = |pen: usize| lab(reading.pens[pen].solid.lab);
    let given = |pen: usize| pen_box.pens[pen].ink.lab();
    let gain = |one: usize, two: usize| {
        let (own, others) = ([(one, one), (two, two)], [(one, two), (two, one)]);
        let sum = |pairs: [(usize, usize); 2]| pairs.map(|(a, b)| read(a).difference(given(b))).iter().sum::<f64>();
        sum(own) - sum(others)
    };
    let pairs = (0..reading.pens.len()).flat_map(|one| (one + 1..reading.pens.len()).map(move |two| (one, two)));
    let most = pairs.map(|(one, two)| (gain(one, two), one, two)).max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((gain, one, two)) = most
        && gain > SWAPPED
    {
        let [one, two] = [one, two].map(|pen| pen_box.name(pen));
        warning!(
            "{one} has the colour that {} gives {two}, and {two} that of {one}: were the pens swapped, or was the sheet drawn with another file?",
            pen_box.file
        );
    }
}

/// Warns of what `draw --colours` would refuse or say of these pens.
fn warn_of_unusable(pen_box: &PenBox, reading: &SheetReading, output: &str) {
    let measured = pen_box.pens.iter().zip(&reading.pens).map(|(pen, read)| {
        let measured = ColourPen::measured(&pen.ink.name, pen.ink.width_mm, lab(bounded(read.solid.lab)));
        if pen.ink.opacity == Opacity::Opaque { measured.opaque() } else { measured }
    });
    match PenSet::new(measured.collect(), Paper { colour: reading.paper }, Vec::new()) {
        Ok(set) => set.warnings().iter().for_each(|told| warning!("{output}: {told}")),
        Err(error) => warning!("{output} cannot be drawn with as it is: {error}"),
    }
}

fn tell(options: &CalibrateOptions, pen_box: &PenBox, reading: &SheetReading) {
    say!("{}: the colours of {} as measured", options.output, counted(reading.pens.len(), "pen"));
    let longest = pen_box.pens.iter().map(|pen| pen.ink.name.chars().count()).max().unwrap_or(0);
    for (i, (pen, read)) in pen_box.pens.iter().zip(&reading.pens).enumerate() {
        // Without a minus before a 0.
        let [l, a, b] = bounded(read.solid.lab).map(|v| (10.0 * v).round() / 10.0 + 0.0);
        let (name, off) = (&pen.ink.name, lab(read.solid.lab).difference(pen.ink.lab()));
        say!("  {} {name:longest$}  L* {l:5.1}  a* {a:5.1}  b* {b:5.1}  {off:.1} from the colour in {}", i + 1, pen_box.file);
    }
    let paper = on_screen(reading.paper);
    let paper =
        if options.paper.is_none() && options.grey_card.is_none() { String::new() } else { format!(" --paper '{paper}'") };
    let pens = if options.output == "-" { "measured.toml" } else { &options.output };
    say!("  drypoint draw photo.jpg -o drawing.svg --colours {pens}{paper}");
}
