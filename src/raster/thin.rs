//! Thinning to one-pixel lines (Zhang and Suen 1984).

use super::Raster;
use crate::parallel::mapped;

/// Reduces a binary raster to lines one pixel wide that keep its connections, ends and holes.
///
/// Pixels outside the raster count as unmarked. Time grows with the area and the greatest half width.
pub fn thin(mask: &Raster<u8>) -> Raster<u8> {
    let mut lines = mask.clone();
    let mut candidates: Vec<u32> = lines.pixels().iter().enumerate().filter(|(_, v)| **v != 0).map(|(i, _)| i as u32).collect();
    loop {
        let before = candidates.len();
        for pass in [Pass::SouthEast, Pass::NorthWest] {
            let removed: Vec<bool> = mapped(&candidates, &|&i| is_removable(&lines, i as usize, pass));
            for (&i, _) in candidates.iter().zip(&removed).filter(|(_, r)| **r) {
                lines.pixels_mut()[i as usize] = 0;
            }
            let mut removed = removed.iter();
            candidates.retain(|_| !removed.next().copied().unwrap_or(false));
        }
        if candidates.len() == before {
            return lines;
        }
    }
}

/// The two half-steps of an iteration, named by the side that they peel.
#[derive(Clone, Copy)]
enum Pass {
    SouthEast,
    NorthWest,
}

/// The paper's conditions (a) to (d) on the neighbours P2..P9, clockwise from north.
///
/// ```text
///   P9 P2 P3
///   P8 P1 P4
///   P7 P6 P5
/// ```
fn is_removable(lines: &Raster<u8>, index: usize, pass: Pass) -> bool {
    let (x, y) = ((index % lines.width()) as isize, (index / lines.width()) as isize);
    let at = |dx: isize, dy: isize| lines.contains(x + dx, y + dy) && lines.clamped(x + dx, y + dy) != 0;
    let ring = [at(0, -1), at(1, -1), at(1, 0), at(1, 1), at(0, 1), at(-1, 1), at(-1, 0), at(-1, -1)];
    let marked = ring.iter().filter(|v| **v).count();
    let rises = (0..8).filter(|&i| !ring[i] && ring[(i + 1) % 8]).count();
    let [north, _, east, _, south, _, west, _] = ring;
    let peeled = match pass {
        Pass::SouthEast => !(east && south && (north || west)),
        Pass::NorthWest => !(north && west && (east || south)),
    };
    (2..=6).contains(&marked) && rises == 1 && peeled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::{components, distances_from};

    #[test]
    fn a_thick_ring_becomes_a_thin_ring() {
        let from_middle = distances_from(24.5, 50);
        let ring = from_middle.map(|r| u8::from((14.0..19.0).contains(&r)));
        let lines = thin(&ring);
        let (_, count) = components(&lines);
        assert_eq!(count, 1, "still one piece");
        let background = lines.map(|v| 1 - v);
        let centre_and_corner = {
            // Four-connected, so that the ring separates them.
            let mut seen = Raster::filled(50, 50, false);
            let mut stack = vec![(0_usize, 0_usize)];
            while let Some((x, y)) = stack.pop() {
                if seen.get(x, y) || background.get(x, y) == 0 {
                    continue;
                }
                seen.set(x, y, true);
                if x > 0 {
                    stack.push((x - 1, y));
                }
                if y > 0 {
                    stack.push((x, y - 1));
                }
                if x < 49 {
                    stack.push((x + 1, y));
                }
                if y < 49 {
                    stack.push((x, y + 1));
                }
            }
            seen.get(25, 25)
        };
        assert!(!centre_and_corner, "the hole stays closed off");
        for (r, _) in from_middle.pixels().iter().zip(lines.pixels()).filter(|(_, v)| **v != 0) {
            assert!((r - 16.5).abs() < 1.6, "pixel at radius {r}");
        }
    }
}
