//! HP-GL: absolute integer plotter units, one pen after another.
//!
//! ```text
//! IN;PS4;           the machine is reset, which lifts the pen; the sheet
//! PU;SP1;VS30;      a pen is fetched, its speed in cm/s
//! PU 10,20;PD 30,40,50,60;      one path; a touch is PU x,y;PD;
//! PU;PU 0,7721;SP0; the pen is put away beyond the drawing
//! ```

use crate::plot::{Mounting, PenChange, Plot, Profile};
use std::fmt::Write as _;
use std::io;

/// Writes a plot for a machine; the mounting says where the page lies. The caller has checked that all of it is within reach and
/// that the machine has the pens.
pub fn write_hpgl(plot: &Plot, profile: &Profile, mounting: &Mounting, out: &mut impl io::Write) -> io::Result<()> {
    let chunk = profile.hpgl.as_ref().map_or(240, |dialect| dialect.chunk);
    let mut text = String::from("IN;PU;");
    if let Some(paper) = &mounting.paper {
        text.push_str(&paper.setup);
    }
    for (i, pen) in plot.pens.iter().enumerate() {
        // One pen holder and a new pen: SP0 parks what is there, and the operator changes it.
        let slot = if profile.pens.change == PenChange::Machine { pen.number } else { 1 };
        if i > 0 {
            text.push_str("PU;");
        }
        let _ = write!(text, "SP{slot};VS{};", speed(profile, pen.handling.speed(profile.motion.draw_speed)));
        for path in &pen.paths {
            let units: Vec<(i64, i64)> = path.points.iter().map(|p| snap(*p, mounting)).collect();
            path_instructions(&mut text, &units, chunk);
            if text.len() > 1 << 16 {
                out.write_all(text.as_bytes())?;
                text.clear();
            }
        }
    }
    let _ = writeln!(text, "PU;PU{},{};SP0;", mounting.limits.x1.round(), mounting.limits.y1.round());
    out.write_all(text.as_bytes())
}

/// Centimetres a second, whole, within what the machine takes.
fn speed(profile: &Profile, wanted: f64) -> i64 {
    let limit = profile.motion.draw_speed_limit.unwrap_or(profile.motion.draw_speed);
    ((wanted.min(limit) / 10.0).floor() as i64).max(1)
}

/// A point of the page in whole plotter units inside the machine's limits (the check has forgiven less than a unit).
fn snap(p: crate::geometry::Point, mounting: &Mounting) -> (i64, i64) {
    let m = mounting.to_machine * p;
    let limits = mounting.limits;
    (m.x.round().clamp(limits.x0, limits.x1) as i64, m.y.round().clamp(limits.y0, limits.y1) as i64)
}

fn path_instructions(text: &mut String, units: &[(i64, i64)], chunk: usize) {
    let _ = write!(text, "PU{},{};PD", units[0].0, units[0].1);
    let mut length = 2;
    let mut last = units[0];
    for &(x, y) in &units[1..] {
        if (x, y) == last {
            continue;
        }
        last = (x, y);
        if length > 2 {
            text.push(if length + 14 > chunk { ';' } else { ',' });
            if length + 14 > chunk {
                text.push_str("PD");
                length = 2;
            }
        }
        let before = text.len();
        let _ = write!(text, "{x},{y}");
        length += text.len() - before + 1;
    }
    text.push(';');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Colour, Page};
    use crate::geometry::Point;
    use crate::plot::{PenPaths, Toolpath, mount};

    #[test]
    fn instructions_stay_short_and_repeat_nothing() {
        let units: Vec<(i64, i64)> = (0..200).map(|i| (10_000 + i / 2, 10_000)).collect();
        let mut text = String::new();
        path_instructions(&mut text, &units, 100);
        assert!(text.split(';').all(|instruction| instruction.len() <= 100), "{text}");
        assert_eq!(text.matches("10050,10000").count(), 1);
    }

    #[test]
    fn a_file_raises_the_pen_first_and_puts_it_away_last() {
        let profile = Profile::built_in("hp7475a").unwrap();
        let page = Page::new(100.0, 100.0);
        let path = |points: &[(f64, f64)]| Toolpath::new(points.iter().map(|&(x, y)| Point::new(x, y)).collect());
        let pen = |number, paths| PenPaths {
            number,
            name: String::new(),
            colour: Colour::BLACK,
            nib: 0.3,
            handling: crate::drawing::Handling::default(),
            paths,
        };
        let plot = Plot { page, pens: vec![pen(1, vec![path(&[(0.0, 0.0), (10.0, 0.0)])]), pen(3, vec![path(&[(50.0, 50.0)])])] };
        let mounting = mount(&profile, &page).unwrap();
        let mut bytes = Vec::new();
        write_hpgl(&plot, &profile, &mounting, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.starts_with("IN;PU;PS4;SP1;VS30;PU"), "{text}");
        assert!(text.contains(";PU;SP3;VS30;"), "{text}");
        assert!(text.contains(";PD;PU;PU"), "a touch: {text}");
        assert!(text.ends_with("SP0;\n"));
    }
}
