//! Damaged files: pieces lost, doubled or swapped, numbers out of range. Readers report the fault or read the rest; they never
//! panic.

use drypoint::plot::{Language, Profile, StopPlace};
use drypoint::read::{Budget, read_svg_within};
use proptest::prelude::*;
use std::path::Path;

/// Texts that cause trouble where numbers, names or references are expected.
const STRANGE: &[&str] = &[
    "nan",
    "inf",
    "-inf",
    "1e999",
    "1e38",
    "-1e38",
    "1e30",
    "1e-45",
    "0",
    "-0",
    "1e15",
    "#",
    "url(#a)",
    "url(#c)",
    "inherit",
    "none",
    "<g>",
    "</g>",
    "<svg viewBox='0 0 1 1' width='9' height='9'>",
    "%",
    "e",
    ",",
    ";",
    "'",
    "\"",
    "&a;",
    "\u{1b}.",
    "\u{e4}",
    "\u{20ac}",
    "PE",
    "PD",
    "AA",
    "G2 ",
    "G91\n",
    "I",
    "\n",
    " ",
    "scale(1e30)",
    "matrix(0 0 0 0 0 0)",
    "rotate(1e20)",
    "objectBoundingBox",
];

const GCODE: &str = "(drypoint)\n(pen up is M3 S300)\n(pen down is M3 S700)\nG21\nG90\nM3 S300\nG4 P0.15\n(pen 1: dots 0.3)\nG0 X1 Y1\nM3 S700\nG4 P0.2\nG1 X5 Y1 F3000\nG2 X10 Y1 I2 J1\nG1 X10 Y9 Z-1\nM3 S300\n(pen 2: red 0.5)\nM0\nG0 X2 Y2\nM3 S700\nM3 S300\nG0 X0 Y0\n";
const HPGL: &str = "\u{1b}.N;19:\u{1b}.I81;;17:IN;PU;PS4;SP1;VS30;FS2;PU100,100;PD200,100,300,100;AA0,0,90,5;PD300,200,300,300;PU500,500;PD;PU;PE7abab;SP2;PR;PD1,1;PA;PU0,7721;SP0;\n";
const SVG: &str = "<!DOCTYPE svg [<!ENTITY a 'M0 0H10'>]><svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='100mm' height='100mm' viewBox='0 0 100 100'>\
<style>.k{stroke:blue;fill:none} g path{marker-end:url(#m)}</style><defs><marker id='m'><path d='M0 0L1 1'/></marker><pattern id='p' width='1' height='1'><rect width='1' height='1' fill='red'/></pattern>\
<mask id='k'><rect width='9' height='9' fill='white'/></mask><clipPath id='c'><circle cx='50' cy='50' r='20' clip-rule='evenodd'/></clipPath></defs>\
<g id='a' inkscape:groupmode='layer' inkscape:label='3 red +S40' transform='translate(5 5) scale(2)' clip-path='url(#c)'><path class='k' d='&a;' stroke-dasharray='1 2' stroke-dashoffset='3'/>\
<rect width='30' height='20' rx='3' fill='url(#p)' stroke='black' mask='url(#k)'/></g><svg x='10' y='10' width='80' height='80' viewBox='0 0 40 40'><ellipse rx='9' ry='5' fill-rule='evenodd' stroke='rebeccapurple'/></svg>\
<use xlink:href='#a' x='5'/><polygon fill-rule='evenodd' points='0,0 50,90 90,10 5,60 80,80' fill='green'/><path d='M0 0A5 5 0 1 0 9 9Q1 2 3 4T9 9z' stroke='white' stroke-width='2'/></svg>";

#[derive(Clone, Debug)]
enum Change {
    /// Remove a piece.
    Cut(f64, usize),
    /// Insert a copy of a piece elsewhere.
    Copy(f64, usize, f64),
    /// Replace a piece by a strange text.
    Put(f64, usize, usize),
    /// Replace a number by another.
    Number(f64, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let place = 0.0..1.0_f64;
    prop_oneof![
        (place.clone(), 0_usize..40).prop_map(|(at, length)| Change::Cut(at, length)),
        (place.clone(), 1_usize..200, place.clone()).prop_map(|(at, length, to)| Change::Copy(at, length, to)),
        (place.clone(), 0_usize..6, 0..STRANGE.len()).prop_map(|(at, length, what)| Change::Put(at, length, what)),
        (place, 0..STRANGE.len()).prop_map(|(at, what)| Change::Number(at, what)),
    ]
}

/// The first character boundary at or after a fraction of the text.
fn place(text: &str, part: f64) -> usize {
    let start = (part * text.len() as f64) as usize;
    (start..=text.len()).find(|at| text.is_char_boundary(*at)).unwrap_or(text.len())
}

fn changed(text: &str, changes: &[Change]) -> String {
    let mut text = text.to_owned();
    for change in changes {
        let span = |at: f64, length: usize| {
            let start = place(&text, at);
            start..(start + length..=text.len()).find(|end| text.is_char_boundary(*end)).unwrap_or(text.len()).max(start)
        };
        match *change {
            Change::Cut(at, length) => text.replace_range(span(at, length), ""),
            Change::Copy(at, length, to) => {
                let piece = text[span(at, length)].to_owned();
                let to = place(&text, to);
                text.insert_str(to, &piece);
            }
            Change::Put(at, length, what) => text.replace_range(span(at, length), STRANGE[what]),
            Change::Number(at, what) => {
                let from = place(&text, at);
                let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
                if let Some(start) = text[from..].find(is_number).map(|start| from + start) {
                    let end = text[start..].find(|c: char| !is_number(c)).map_or(text.len(), |end| start + end);
                    text.replace_range(start..end, STRANGE[what]);
                }
            }
        }
    }
    text
}

/// A tenth of a million steps, so that each case is fast.
fn budget() -> Budget {
    Budget::of_millions(0.1)
}

fn read_drawing(text: &str) {
    if let Ok(imported) = read_svg_within(text.as_bytes(), &mut budget()) {
        let drawing = imported.drawing();
        let bounds = drawing.bounding_box();
        assert!(bounds.is_none_or(|bounds| bounds.is_finite()), "{bounds:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn drawings(changes in prop::collection::vec(change(), 1..8)) {
        read_drawing(&changed(SVG, &changes));
    }

    #[test]
    fn drawings_of_other_programs(file in any::<prop::sample::Index>(), changes in prop::collection::vec(change(), 1..6)) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/foreign");
        let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        if let Ok(text) = std::fs::read_to_string(file.get(&files)) {
            read_drawing(&changed(&text, &changes));
        }
    }

    #[test]
    fn programs(changes in prop::collection::vec(change(), 1..8), stop in 1_usize..40) {
        let text = changed(GCODE, &changes);
        for machine in ["grbl-servo", "grbl-z"] {
            if let Ok(motion) = Profile::built_in(machine).unwrap().read(&text, &mut budget()) {
                prop_assert!(motion.visited.iter().all(|p| p.is_finite()));
            }
        }
        for stop in [StopPlace::Line(stop), StopPlace::Byte(10 * stop), StopPlace::Path(stop % 4)] {
            if let Ok(rest) = Language::Gcode.resume(&text, stop, 3.0) {
                let code = rest.lines().map(|line| line.split(['(', ';', '%']).next().unwrap_or(""));
                prop_assert!(!code.filter(|code| code.starts_with('G')).any(|code| code.to_ascii_lowercase().contains("nan")), "{rest}");
            }
        }
    }

    #[test]
    fn instructions(changes in prop::collection::vec(change(), 1..8), stop in 1_usize..200) {
        let text = changed(HPGL, &changes);
        if let Ok(motion) = Profile::built_in("hp7475a").unwrap().read(&text, &mut budget()) {
            prop_assert!(motion.visited.iter().all(|p| p.is_finite()));
        }
        for stop in [StopPlace::Line(stop % 3), StopPlace::Byte(stop), StopPlace::Path(stop % 4)] {
            let _ = Language::Hpgl.resume(&text, stop, 3.0);
        }
    }
}
