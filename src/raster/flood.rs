//! Region growing without recursion: flood fill from the border, and hole filling.

use super::Raster;

/// Marks (1) the pixels that can be reached from the raster's border through steps for which `joins(from, to)` holds, beginning
/// at each border pixel for which `starts` holds. Indices are in row order; four neighbours.
pub fn flood_from_border(
    width: usize,
    height: usize,
    starts: impl Fn(usize) -> bool,
    joins: impl Fn(usize, usize) -> bool,
) -> Raster<u8> {
    let mut reached = Raster::filled(width, height, 0_u8);
    let mut stack: Vec<usize> = (0..width * height)
        .filter(|i| {
            let (x, y) = (i % width, i / width);
            (x == 0 || y == 0 || x + 1 == width || y + 1 == height) && starts(*i)
        })
        .collect();
    for &i in &stack {
        reached.pixels_mut()[i] = 1;
    }
    while let Some(i) = stack.pop() {
        let (x, y) = (i % width, i / width);
        let neighbours = [
            (x > 0).then(|| i - 1),
            (x + 1 < width).then(|| i + 1),
            (y > 0).then(|| i - width),
            (y + 1 < height).then(|| i + width),
        ];
        for next in neighbours.into_iter().flatten() {
            if reached.pixels()[next] == 0 && joins(i, next) {
                reached.pixels_mut()[next] = 1;
                stack.push(next);
            }
        }
    }
    reached
}

/// A mask with its holes filled: unmarked pixels that the border cannot reach through unmarked pixels.
pub fn without_holes(mask: &Raster<u8>) -> Raster<u8> {
    let pixels = mask.pixels();
    flood_from_border(mask.width(), mask.height(), |i| pixels[i] == 0, |_, to| pixels[to] == 0).map(|outside| 1 - outside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_filled_and_bays_are_not() {
        let ring = Raster::from_fn(9, 9, |x, y| u8::from((1..8).contains(&x) && (1..8).contains(&y) && (x, y) != (4, 4)));
        assert_eq!(without_holes(&ring).get(4, 4), 1);
        let mut open = ring;
        for y in 0..4 {
            open.set(4, y, 0);
        }
        assert_eq!(without_holes(&open).get(4, 4), 0);
    }
}
