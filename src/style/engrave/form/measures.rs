//! What the lines of a face are measured by: how well they follow the directions, how even they are, how often they end.

use super::super::Drawer;
use super::super::parameters::EngraveParameters;
use super::families::{Closeness, Extent, FINE, Family};
use crate::elementary::{Elementary as _, unit_at};
use crate::geometry::{Millimetres, Point};
use crate::raster::Raster;
use crate::source::Landmarks;
use crate::style::form::Surface;
use crate::style::form::mean_portrait;
use crate::style::{Settings, Silent};

const PITCH: f64 = 0.5;

/// The angle between a family's lines and the directions in degrees, the spacing over that wanted, and the line's ends, on the face.
struct Measures {
    off: Vec<f64>,
    spacing: Vec<f64>,
    ends_per_cm2: f64,
}

fn measured(family: &Family, directions: &Raster<f32>, face: &Landmarks, pitch: f64, turn: f64) -> Measures {
    let (middle, width) = (face.point(4), face.width());
    // Inside of the face's outline.
    let is_on_face = |p: Point| (p - middle).hypot() < 0.45 * width;
    let (mut off, mut spacing, mut ends) = (Vec::new(), Vec::new(), 0);
    for line in &family.lines {
        let last = line.points.len() - 1;
        for pair in line.points.windows(5).filter(|points| is_on_face(points[2])) {
            let way = pair[4] - pair[0];
            let p = pair[2];
            let wanted = unit_at(f64::from(directions.get(p.x as usize, p.y as usize)) + turn);
            off.push((way.cross(wanted).abs() / way.hypot().max(1e-9)).min(1.0).arc_sine().to_degrees());
            spacing.push(family.spacing(p) / pitch);
        }
        if !line.closed {
            ends += [0, last].iter().filter(|i| is_on_face(line.points[**i])).count();
        }
    }
    spacing.sort_unstable_by(f64::total_cmp);
    let area = std::f64::consts::PI * (0.45 * width * PITCH / pitch / 10.0).powi(2);
    Measures { off, spacing, ends_per_cm2: ends as f64 / area }
}

#[test]
fn lines_of_a_face_follow_its_directions_at_even_distances() {
    for turn in [0.0, 0.5] {
        let portrait = mean_portrait(6.0 / PITCH, turn, |_| 140);
        let parameters = crate::style::find("engrave").unwrap().parameters();
        let given = [("pitch".to_owned(), format!("{PITCH}mm"))];
        let settings = Settings::resolve("engrave", parameters, &given).unwrap();
        let drawer = Drawer { portrait: &portrait, parameters: EngraveParameters::new(&settings), seed: 0, observer: &Silent };
        let surfaces = drawer.surfaces(&portrait.subject);
        let directions = drawer.directions(&surfaces);
        let skin = directions.of(Surface::Skin);
        let extent = Extent::of(&surfaces.skin, 0.5, 0).unwrap();
        let pitch = portrait.placement.pixels(Millimetres(PITCH));
        // As on cloth, and as on skin with eyes and a mouth.
        let closest = [1.0, 1.0 / (1.0 - FINE)];
        for (degrees, closest) in [0.0_f64, 60.0, -37.0].into_iter().flat_map(|degrees| closest.map(|closest| (degrees, closest)))
        {
            let even = Closeness { at: &|_, _| 1.0, closest };
            let family = drawer.even_lines(&extent, skin, degrees.to_radians(), even, "test");
            let measures = measured(&family, skin, &portrait.faces[0], pitch, degrees.to_radians());
            let mean = measures.off.iter().sum::<f64>() / measures.off.len() as f64;
            let at = |share: f64| measures.spacing[(share * (measures.spacing.len() - 1) as f64) as usize];
            assert!(mean <= 2.0, "turned {turn}, family at {degrees}: off by {mean}");
            assert!(at(0.05) >= 0.8 && at(0.95) <= 1.3, "spacing {} to {}", at(0.05), at(0.95));
            // Crossing families run into the sides of the nose.
            let most = if degrees == 0.0 { 8.0 } else { 10.5 };
            assert!(measures.ends_per_cm2 <= most, "{} ends", measures.ends_per_cm2);
        }
    }
}
