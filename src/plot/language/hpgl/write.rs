//! HP-GL: absolute integer plotter units, one pen after another.
//!
//! ```text
//! IN;PS4;           reset the machine, which lifts the pen; set the sheet
//! PU;SP1;VS30;FS2;  select a pen, its speed in cm/s, its force
//! PU 10,20;PD 30,40,50,60;      one path; a touch is PU x,y;PD;
//! PA;AA 30,20,90;   an arc around a centre by whole degrees, if the machine supports arcs and the error is within tolerance
//! PE...;            a path packed into differences, if the machine supports HP-GL/2
//! PU;PU 0,7721;SP0; put the pen away, clear of the drawing
//! ```
//!
//! Points are rounded before differences are taken, and moves after an arc are absolute again, so rounding errors never
//! accumulate.

use super::{HpglDialect, Orders, SPEED_STEP};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Step, Vec2, fit_arcs};
use crate::plot::{Mounting, PenChange, Profile};
use std::fmt::Write as _;
use std::io;

/// Writes a plot of which all lies within reach, and whose pens the machine has.
pub(super) fn write(dialect: &HpglDialect, orders: &Orders<'_>, out: &mut dyn io::Write) -> io::Result<()> {
    let Orders { plot, profile, mounting, .. } = *orders;
    let mut text = format!("{}IN;PU;", dialect.preamble);
    if let Some(paper) = &mounting.paper {
        text.push_str(&paper.setup);
    }
    for (i, pen) in plot.pens.iter().enumerate() {
        // With one pen holder, SP1 selects every pen and the operator changes it.
        let slot = if profile.pens.change == PenChange::Machine { pen.number } else { 1 };
        if i > 0 {
            text.push_str("PU;");
        }
        let _ = write!(text, "SP{slot};VS{};", speed(profile, pen.handling.speed(profile.motion.draw_speed)));
        if let Some(force) = dialect.force {
            let _ = write!(text, "FS{force};");
        }
        if let Some(g) = dialect.acceleration {
            let _ = write!(text, "AS{g};");
        }
        for path in &pen.paths {
            let units: Vec<Unit> = path.points().iter().map(|p| snap(mounting.place(pen.number, *p), mounting)).collect();
            let tolerance = mounting.tolerance * profile.units_per_mm;
            let room = mounting.limits.inset(-1.5 * tolerance.max(2.0));
            path_instructions(&mut text, &units, dialect, room, tolerance);
            if text.len() > 1 << 16 {
                out.write_all(text.as_bytes())?;
                text.clear();
            }
        }
    }
    let park = snap(mounting.park, mounting);
    let _ = writeln!(text, "PU;PU{},{};SP0;{}", park.0, park.1, dialect.postamble);
    out.write_all(text.as_bytes())
}

/// A point in whole plotter units.
type Unit = (i64, i64);

/// Speed in whole cm/s.
fn speed(profile: &Profile, wanted: f64) -> i64 {
    (profile.nearest_speed(wanted) / SPEED_STEP).round() as i64
}

/// Snaps to whole plotter units inside the machine's limits (the check allows less than a unit beyond them).
fn snap(m: Point, mounting: &Mounting) -> Unit {
    let limits = mounting.limits;
    (m.x.round().clamp(limits.x0, limits.x1) as i64, m.y.round().clamp(limits.y0, limits.y1) as i64)
}

/// Writes one path. `room` is the area in which an arc, which lies a little outside its chords, cannot leave the machine's
/// limits.
fn path_instructions(text: &mut String, units: &[Unit], dialect: &HpglDialect, room: Rect, tolerance: f64) {
    let mut units = units.to_vec();
    units.dedup();
    let _ = write!(text, "PU{},{};", units[0].0, units[0].1);
    if units.len() == 1 {
        text.push_str("PD;");
    } else if dialect.packed {
        packed(text, &units);
    } else if dialect.arcs && units.iter().all(|&(x, y)| room.contains(Point::new(x as f64, y as f64))) {
        with_arcs(text, &units, dialect.chunk, tolerance);
    } else {
        lines(text, &units[1..], dialect.chunk);
    }
}

/// Writes `PD` instructions, each with as many points as fit into `chunk` bytes.
fn lines(text: &mut String, units: &[Unit], chunk: usize) {
    let mut length = 0;
    for (x, y) in units {
        if length > 0 && length + 16 <= chunk {
            text.push(',');
            length += 1;
        } else {
            text.push_str(if length > 0 { ";PD" } else { "PD" });
            length = 2;
        }
        let before = text.len();
        let _ = write!(text, "{x},{y}");
        length += text.len() - before;
    }
    if length > 0 {
        text.push(';');
    }
}

/// Writes lines, and arcs of whole degrees that end within the tolerance of their vertex.
fn with_arcs(text: &mut String, units: &[Unit], chunk: usize, tolerance: f64) {
    let points: Vec<Point> = units.iter().map(|&(x, y)| Point::new(x as f64, y as f64)).collect();
    // The grid moves each vertex by up to 0.7 units, and the arc's end may be off by as much again.
    let tolerance = tolerance.max(1.0);
    let (mut straight, mut at) = (Vec::new(), 0);
    for step in fit_arcs(&points, tolerance) {
        let end = at + points[at..].iter().position(|p| *p == step.to()).unwrap_or(0);
        match step {
            Step::Arc { centre, sweep, .. } if arc_is_true(points[at], centre, sweep, tolerance) => {
                lines(text, &straight, chunk);
                let degrees = sweep.to_degrees().trunc();
                let chord = chord_degrees(points[at].distance(centre), tolerance);
                let _ = write!(text, "PD;AA{},{},{degrees},{chord};", centre.x.round(), centre.y.round());
                // The rest of the last degree is drawn in lines, to the exact vertex.
                let left = first_beyond(&points[at..=end], centre, degrees.to_radians());
                straight = units[at + left..=end].to_vec();
            }
            _ => straight.extend(&units[at + 1..=end]),
        }
        at = end;
    }
    lines(text, &straight, chunk);
}

/// True if the arc around the rounded centre, by whole degrees, stays within the tolerance of the arc around the exact centre.
fn arc_is_true(from: Point, centre: Point, sweep: f64, tolerance: f64) -> bool {
    let degrees = sweep.to_degrees().trunc();
    let strays = |part: f64| {
        let angle = (part * degrees).to_radians();
        turned(from, centre, angle).distance(turned(from, centre.round(), angle))
    };
    degrees != 0.0 && [0.25, 0.5, 0.75, 1.0].into_iter().all(|part| strays(part) <= tolerance)
}

/// A point turned around a centre, counterclockwise where y goes up, by an angle in radians.
fn turned(from: Point, centre: Point, angle: f64) -> Point {
    let ((sin, cos), v) = (angle.sine_and_cosine(), from - centre);
    centre + Vec2::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos)
}

/// The index of the first point, along an arc from point 0, past an angle in radians; the last index if none is.
fn first_beyond(points: &[Point], centre: Point, angle: f64) -> usize {
    let mut swept = 0.0;
    for (i, pair) in points.windows(2).enumerate() {
        let (a, b) = (pair[0] - centre, pair[1] - centre);
        swept += a.cross(b).angle_over(a.dot(b));
        if swept.abs() > angle.abs() {
            return i + 1;
        }
    }
    points.len() - 1
}

/// The largest whole chord angle, in degrees, at which the arc deviates from its chord by less than half the tolerance.
fn chord_degrees(radius: f64, tolerance: f64) -> i64 {
    let angle = 2.0 * (1.0 - 0.5 * tolerance / radius.max(tolerance)).arc_cosine();
    (angle.to_degrees().floor() as i64).clamp(1, 45)
}

/// Writes one path as `PE`: differences in base 32, the last digit of each number marked (HP-GL/2, polyline encoded).
fn packed(text: &mut String, units: &[Unit]) {
    // The 7 selects the 7-bit form.
    text.push_str("PD;PE7");
    let mut at = units[0];
    for &(x, y) in &units[1..] {
        for value in [x - at.0, y - at.1] {
            packed_number(text, value);
        }
        at = (x, y);
    }
    text.push(';');
}

/// Appends a number: sign in the lowest bit, then digits from the lowest. The 8-bit form has digits of 6 bits, 63 to 126 in
/// ASCII, the last one 191 to 254. This is the 7-bit form, which every serial line transmits: digits of 5 bits, 63 to 94, the
/// last one 95 to 126.
fn packed_number(text: &mut String, value: i64) {
    let mut rest = if value < 0 { 2 * value.unsigned_abs() + 1 } else { 2 * value.unsigned_abs() };
    while rest >= 32 {
        text.push(char::from(63 + (rest % 32) as u8));
        rest /= 32;
    }
    text.push(char::from(95 + rest as u8));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Page};
    use crate::plot::language::written;
    use crate::plot::{PenPaths, Plot, Toolpath};

    fn dialect(arcs: bool, packed: bool) -> HpglDialect {
        let (preamble, postamble) = (String::new(), String::new());
        HpglDialect { chunk: 100, preamble, postamble, arcs, packed, force: None, acceleration: None }
    }

    #[test]
    fn packed_numbers_are_those_of_the_reference() {
        let mut text = String::new();
        packed(&mut text, &[(0, 0), (1, -1), (101, 1000)]);
        // 1 is 2: 97; -1 is 3: 98; 100 is 200: 8 + 6 * 32; 1001 is 2002: 18 + 62 * 32, and 62 is 30 + 1 * 32.
        let digits = |text: &str| text.bytes().collect::<Vec<u8>>();
        assert_eq!(digits(&text["PD;PE7".len()..text.len() - 1]), [97, 98, 63 + 8, 95 + 6, 63 + 18, 63 + 30, 95 + 1]);
    }

    #[test]
    fn arcs_end_where_they_should() {
        let circle: Vec<Unit> = (0..=90)
            .map(|i| (f64::from(i) * 4.0).to_radians().sine_and_cosine())
            .map(|(sin, cos)| ((1000.0 * cos).round() as i64 + 5000, (1000.0 * sin).round() as i64 + 5000))
            .collect();
        let mut text = String::new();
        path_instructions(&mut text, &circle, &dialect(true, false), Rect::new(0.0, 0.0, 1e4, 1e4), 1.6);
        let of_degrees = |instruction: &&str| instruction.starts_with("AA");
        assert!(text.split(';').filter(of_degrees).count() <= 5 && text.len() < 200, "{text}");
        let drawn = &super::super::read::tests::read_hpgl(&text).unwrap().paths[0].1;
        let radius = |p: &Point| p.distance(Point::new(5000.0, 5000.0));
        assert!(drawn.iter().all(|p| (radius(p) - 1000.0).abs() < 2.0 * 1.6), "{drawn:?}");
        assert!(drawn.first() == drawn.last() && drawn.len() > 60, "{drawn:?}");
    }

    #[test]
    fn instructions_stay_short_and_repeat_nothing() {
        let units: Vec<Unit> = (0..200).map(|i| (10_000 + i / 2, 10_000)).collect();
        let mut text = String::new();
        path_instructions(&mut text, &units, &dialect(false, false), Rect::ZERO, 1.0);
        assert!(text.split(';').all(|instruction| instruction.len() <= 100), "{text}");
        assert_eq!(text.matches("10050,10000").count(), 1);
    }

    #[test]
    fn a_file_raises_the_pen_first_and_puts_it_away_last() {
        let profile = Profile::built_in("hp7475a").unwrap();
        let page = Page::new(100.0, 100.0);
        let path = |points: &[(f64, f64)]| Toolpath::new(points.iter().map(|&(x, y)| Point::new(x, y)).collect()).unwrap();
        let pen = |number, paths| PenPaths {
            number,
            name: String::new(),
            colour: Colour::BLACK,
            nib: 0.3,
            handling: crate::drawing::Handling::default(),
            paths,
        };
        let plot = Plot { page, pens: vec![pen(1, vec![path(&[(0.0, 0.0), (10.0, 0.0)])]), pen(3, vec![path(&[(50.0, 50.0)])])] };
        let text = written(&plot, &profile);
        assert!(text.starts_with("IN;PU;PS4;SP1;VS30;PU"), "{text}");
        assert!(text.contains(";PU;SP3;VS30;"), "{text}");
        assert!(text.contains(";PD;PU;PU"), "a touch: {text}");
        assert!(text.ends_with("SP0;\n"));
    }
}
