//! Displacement of a drawing's features from the photograph's.

use super::kept;
use super::print::Print;
use super::sitter::{Sitter, Skin, median};
use drypoint::geometry::{Point, Vec2};
use drypoint::interrupt::Interrupt;
use drypoint::see::look;
use drypoint::source::{Landmarks, outlines};

/// The tip of the nose.
const NOSE_TIP: usize = 1;

/// Displacement of eyes, nose and mouth, in percent of the distance between the eyes.
#[derive(Clone, Copy, Debug)]
pub struct Likeness {
    /// The mean of both irises.
    eyes: f64,
    /// The tip of the nose.
    nose: f64,
    /// The middle of the border between the lips.
    mouth: f64,
}

/// One portrait drawn in one way.
pub struct Row {
    name: String,
    skin: Skin,
    /// `None` if the face was not found again.
    likeness: Option<Likeness>,
}

impl Row {
    pub fn new(sitter: &Sitter, likeness: Option<Likeness>) -> Self {
        Self { name: sitter.name.clone(), skin: sitter.skin(), likeness }
    }
}

/// The largest face of a print compared with the photograph's; `None` if no face is found within the distance between the eyes.
pub fn likeness(sitter: &Sitter, print: &Print) -> Option<Likeness> {
    let there = sitter.face().placed(|p| print.place(p), print.scale());
    let seen = look(&print.photograph(), &Interrupt::never()).expect("a print can be looked at");
    let unit = there.eye_distance();
    let here = seen.faces.iter().map(|face| &face.landmarks).find(|here| (mouth(here) - mouth(&there)).hypot() < unit)?;
    let off = |a: Point, b: Point| 100.0 * (a - b).hypot() / unit;
    let [right, left] = [0, 1].map(|eye: usize| off(here.irises[eye].centre, there.irises[eye].centre));
    Some(Likeness {
        eyes: 0.5 * (right + left),
        nose: off(here.point(NOSE_TIP), there.point(NOSE_TIP)),
        mouth: off(mouth(here), mouth(&there)),
    })
}

fn mouth(face: &Landmarks) -> Point {
    let line = face.line(&outlines::MOUTH);
    (line.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / line.len() as f64).to_point()
}

/// A row of the table, and the portraits beyond the limit for the median.
pub fn report(way: &str, rows: &[Row], limit: f64) {
    let found: Vec<(&Row, Likeness)> = rows.iter().filter_map(|row| Some((row, row.likeness?))).collect();
    let of = |feature: fn(&Likeness) -> f64| median(found.iter().map(|(_, likeness)| feature(likeness)).collect());
    let features = [of(|l| l.eyes), of(|l| l.nose), of(|l| l.mouth)];
    let of_skin = |skin: Skin| {
        let alike = found.iter().filter(|(row, _)| row.skin == skin);
        median(alike.map(|(_, l)| (l.eyes + l.nose + l.mouth) / 3.0).collect())
    };
    let groups = [Skin::Light, Skin::Brown, Skin::Dark].map(of_skin);
    let known = || groups.iter().filter(|group| group.is_finite());
    let apart = known().copied().fold(0.0, f64::max) - known().copied().fold(f64::INFINITY, f64::min);
    let share = format!("{}/{}", found.len(), rows.len());
    let [eyes, nose, mouth] = features;
    let [light, brown, dark] = groups;
    println!(
        "{way:14} {share:>7} {eyes:6.1} {nose:6.1} {mouth:6.1}                     {light:6.1} {brown:6.1} {dark:6.1}   all found: {}, at most {limit} %: {}, groups within 1 point: {}",
        kept(found.len() == rows.len()),
        kept(features.iter().all(|feature| *feature <= limit)),
        kept(apart <= 1.0)
    );
    for row in rows {
        match row.likeness {
            None => println!("               {}: not found", row.name),
            Some(Likeness { eyes, nose, mouth }) if eyes.max(nose).max(mouth) > limit => {
                println!("               {}: eyes {eyes:.1}, nose {nose:.1}, mouth {mouth:.1}", row.name);
            }
            Some(_) => {}
        }
    }
}
