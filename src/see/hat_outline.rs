//! The outline of a hat: it has no small bumps. What sticks out of one is the flag or the wall behind it, taken for the hat's own pattern.

use super::sight::Regions;
use crate::raster::{Raster, components, dilate, open_round};
use crate::source::Landmarks;

/// Half the width of the widest bump, in widths of the face, and the least share of headwear in one that counts as the hat's. At 0.08 the star
/// beside portrait 05's hat goes in part; much wider ones would take bows.
const BUMP: f64 = 0.1;
const OF_HAT: f64 = 0.5;
/// Smallest and largest bump in squared widths of the face: what goes from a brim's corner is smaller, brims and feathers are larger.
const SIZE: [f64; 2] = [0.002, 0.025];
/// Pixels around a bump that belong to its soft edge.
const SOFT: usize = 3;
/// Above this value a pixel of the subject is solid.
const SOLID: u8 = 127;

/// The subject and its regions without the bumps of hats; `faces` in their pixels.
pub(super) fn without_bumps_of_hats(subject: Raster<u8>, regions: Regions, faces: &[Landmarks]) -> (Raster<u8>, Regions) {
    // The smallest face's: wider bumps may be the bow of a child.
    let width = faces.iter().map(Landmarks::width).reduce(f64::min).unwrap_or(0.0);
    let radius = (BUMP * width) as usize;
    if radius == 0 || regions.headwear.pixels().iter().all(|v| *v <= SOLID) {
        return (subject, regions);
    }
    let solid = subject.map(|v| u8::from(v > SOLID));
    let opened = open_round(&solid, radius);
    let bumps = bumps(
        &solid.zip_map(&opened, |solid, opened| solid & (1 - opened)),
        &regions.headwear,
        SIZE.map(|size| size * width * width),
    );
    let other = solid.zip_map(&bumps, |solid, bump| solid & (1 - bump));
    let near = dilate(&bumps, SOFT).zip_map(&dilate(&opened, 1).zip_map(&other, |a, b| a | b), |near, kept| near & (1 - kept));
    let cut = |plane: &Raster<u8>| plane.zip_map(&near, |v, near| if near == 0 { v } else { 0 });
    (cut(&subject), regions.map(cut))
}

/// The pieces outside an opened outline that are small and mostly headwear.
fn bumps(outside: &Raster<u8>, headwear: &Raster<u8>, [least, most]: [f64; 2]) -> Raster<u8> {
    let (labels, count) = components(outside);
    let (mut areas, mut of_hat) = (vec![0_usize; count + 1], vec![0_usize; count + 1]);
    for (&label, &hat) in labels.pixels().iter().zip(headwear.pixels()) {
        areas[label as usize] += 1;
        of_hat[label as usize] += usize::from(hat > SOLID);
    }
    let is_bump = |label: usize| {
        let area = areas[label] as f64;
        label != 0 && (least..most).contains(&area) && of_hat[label] as f64 > OF_HAT * area
    };
    labels.map(|label| u8::from(is_bump(label as usize)))
}

#[cfg(test)]
mod tests {
    use super::super::regions::tests::face;
    use super::*;
    use crate::geometry::Point;

    #[test]
    fn a_star_beside_a_hat_goes_and_a_shoulder_stays() {
        let is_person = |x: usize, y: usize| (60..140).contains(&x) || y > 150;
        let is_star = |x: usize, y: usize| (54..60).contains(&x) && (20..30).contains(&y);
        let is_knob = |x: usize, y: usize| (140..146).contains(&x) && (100..110).contains(&y);
        let subject =
            Raster::from_fn(200, 200, |x, y| if is_person(x, y) || is_star(x, y) || is_knob(x, y) { 255 } else { 0_u8 });
        let headwear = Raster::from_fn(200, 200, |x, y| if y < 60 { subject.get(x, y) } else { 0 });
        let none = subject.map(|_| 0_u8);
        let skin = subject.zip_map(&headwear, |subject, hat| subject - hat);
        let [hair, facial_hair, clothing, detail] = [0; 4].map(|_| none.clone());
        let regions = Regions { skin, hair, facial_hair, headwear, clothing, detail };
        let faces = [face(Point::new(100.0, 90.0), 80.0, 0.0)];
        let (after, regions) = without_bumps_of_hats(subject, regions, &faces);
        assert_eq!((after.get(56, 25), regions.headwear.get(56, 25)), (0, 0));
        assert_eq!((after.get(62, 25), after.get(142, 105), after.get(20, 180)), (255, 255, 255), "only a hat has no bumps");
    }
}
