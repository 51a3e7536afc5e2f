//! SLIC superpixels: connected clusters of similar colour and position (Achanta et al. 2012).

use crate::parallel::{collected, shares};
use crate::raster::Raster;

/// Bands in which centres are summed: a fixed number, so that sums do not depend on the number of threads.
const SUM_BANDS: usize = 8;
/// Pieces smaller than a superpixel's usual area divided by this join a neighbour.
const LEAST_SHARE: usize = 4;

/// A cluster's mean colour and place.
#[derive(Clone, Copy, Debug, Default)]
struct Centre {
    colour: [f32; 3],
    x: f32,
    y: f32,
}

/// Colour channels as planes, so that distances are computed for several pixels at a time.
struct Planes {
    width: usize,
    height: usize,
    channels: [Vec<f32>; 3],
}

/// Labels 0, 1, 2, ... of superpixels about `size` pixels wide. A colour difference of `compactness` (in the colours' own unit; for CIE
/// Lab 10 is usual) counts like a distance of `size`. `rounds` is the number of clustering rounds; 10 is usual.
pub fn superpixels(colours: &Raster<[f32; 3]>, size: usize, compactness: f32, rounds: u32) -> Raster<i32> {
    let (width, height) = (colours.width(), colours.height());
    if colours.is_empty() {
        return colours.map(|_| 0);
    }
    let size = size.max(2);
    let channel = |c: usize| colours.pixels().iter().map(|p| p[c]).collect();
    let planes = Planes { width, height, channels: [channel(0), channel(1), channel(2)] };
    let mut centres = first_centres(&planes, size);
    let mut labels = vec![0_i32; width * height];
    let weight = (compactness / size as f32).powi(2);
    for _ in 0..rounds.max(1) {
        assign(&planes, &centres, size, weight, &mut labels);
        move_centres(&planes, &labels, &mut centres);
    }
    connected(&Raster::from_vec(width, height, labels), size * size / LEAST_SHARE)
}

fn first_centres(planes: &Planes, size: usize) -> Vec<Centre> {
    let (columns, rows) = ((planes.width / size).max(1), (planes.height / size).max(1));
    (0..columns * rows)
        .map(|i| {
            let x = ((i % columns) as f32 + 0.5) * planes.width as f32 / columns as f32;
            let y = ((i / columns) as f32 + 0.5) * planes.height as f32 / rows as f32;
            let at = (y as usize).min(planes.height - 1) * planes.width + (x as usize).min(planes.width - 1);
            Centre { colour: [planes.channels[0][at], planes.channels[1][at], planes.channels[2][at]], x, y }
        })
        .collect()
}

/// Gives each pixel the nearest of the centres within `size` of it in each direction, band by band.
fn assign(planes: &Planes, centres: &[Centre], size: usize, weight: f32, labels: &mut [i32]) {
    let width = planes.width;
    let reach = size as f32;
    shares(labels, width * size, &|band, labels| {
        let mut nearest = vec![f32::INFINITY; labels.len()];
        let top = band * size;
        let bottom = top + labels.len() / width;
        for (k, centre) in centres.iter().enumerate() {
            let first = ((centre.y - reach).ceil().max(0.0) as usize).max(top);
            let end = ((centre.y + reach) as usize + 1).min(bottom);
            let left = (centre.x - reach).ceil().max(0.0) as usize;
            let right = ((centre.x + reach) as usize + 1).min(width);
            for y in first..end.max(first) {
                let row = y * width;
                let out = (y - top) * width;
                let dy = y as f32 + 0.5 - centre.y;
                let span = [
                    &planes.channels[0][row + left..row + right],
                    &planes.channels[1][row + left..row + right],
                    &planes.channels[2][row + left..row + right],
                ];
                nearer(
                    span,
                    centre,
                    (left as f32 + 0.5 - centre.x, dy * dy, weight),
                    &mut nearest[out + left..out + right],
                    (&mut labels[out + left..out + right], k as i32),
                );
            }
        }
    });
}

/// Marks the pixels of a row that are nearer to this centre than to any before.
fn nearer(
    [a, b, c]: [&[f32]; 3],
    centre: &Centre,
    (first_dx, dy2, weight): (f32, f32, f32),
    nearest: &mut [f32],
    (labels, label): (&mut [i32], i32),
) {
    let count = nearest.len();
    let (a, b, c, labels) = (&a[..count], &b[..count], &c[..count], &mut labels[..count]);
    for i in 0..count {
        let dx = first_dx + i as i32 as f32;
        let (da, db, dc) = (a[i] - centre.colour[0], b[i] - centre.colour[1], c[i] - centre.colour[2]);
        let distance = da * da + db * db + dc * dc + weight * (dx * dx + dy2);
        let is_nearer = distance < nearest[i];
        nearest[i] = if is_nearer { distance } else { nearest[i] };
        labels[i] = if is_nearer { label } else { labels[i] };
    }
}

fn move_centres(planes: &Planes, labels: &[i32], centres: &mut [Centre]) {
    let rows = planes.height.div_ceil(SUM_BANDS).max(1);
    let sums: Vec<Vec<[f64; 6]>> = collected(planes.height.div_ceil(rows), &|band| {
        let labels = &labels[band * rows * planes.width..((band + 1) * rows * planes.width).min(labels.len())];
        let mut sums = vec![[0.0_f64; 6]; centres.len()];
        for (i, &label) in labels.iter().enumerate() {
            let at = band * rows * planes.width + i;
            let sum = &mut sums[label as usize];
            sum[0] += f64::from(planes.channels[0][at]);
            sum[1] += f64::from(planes.channels[1][at]);
            sum[2] += f64::from(planes.channels[2][at]);
            sum[3] += (at % planes.width) as f64 + 0.5;
            sum[4] += (at / planes.width) as f64 + 0.5;
            sum[5] += 1.0;
        }
        sums
    });
    for (k, centre) in centres.iter_mut().enumerate() {
        let sum = sums.iter().fold([0.0_f64; 6], |all, band| std::array::from_fn(|i| all[i] + band[k][i]));
        if sum[5] > 0.0 {
            let mean = |i: usize| (sum[i] / sum[5]) as f32;
            *centre = Centre { colour: [mean(0), mean(1), mean(2)], x: mean(3), y: mean(4) };
        }
    }
}

/// New labels for the connected pieces; those of fewer than `least` pixels take the label of the preceding piece.
fn connected(labels: &Raster<i32>, least: usize) -> Raster<i32> {
    let (width, height) = (labels.width(), labels.height());
    let old = labels.pixels();
    let mut out = vec![-1_i32; old.len()];
    let (mut next, mut piece) = (0_i32, Vec::new());
    for start in 0..old.len() {
        if out[start] >= 0 {
            continue;
        }
        // The neighbour above or to the left has its final label.
        let before = [(start % width > 0).then(|| out[start - 1]), start.checked_sub(width).map(|i| out[i])];
        let neighbour = before.into_iter().flatten().find(|label| *label >= 0);
        piece.clear();
        piece.push(start);
        out[start] = next;
        let mut done = 0;
        while done < piece.len() {
            let at = piece[done];
            done += 1;
            let (x, y) = (at % width, at / width);
            let sides = [
                (x > 0, at.wrapping_sub(1)),
                (x + 1 < width, at + 1),
                (y > 0, at.wrapping_sub(width)),
                (y + 1 < height, at + width),
            ];
            for (_, side) in sides.into_iter().filter(|(is_there, _)| *is_there) {
                if out[side] < 0 && old[side] == old[start] {
                    out[side] = next;
                    piece.push(side);
                }
            }
        }
        match neighbour {
            Some(label) if piece.len() < least => piece.iter().for_each(|&at| out[at] = label),
            _ => next += 1,
        }
    }
    Raster::from_vec(width, height, out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn superpixels_keep_to_a_border_and_are_about_as_large_as_asked() {
        // Two fields of colour with a slanted border.
        let is_left = |x: usize, y: usize| x < 40 + y / 4;
        let colours = Raster::from_fn(120, 90, |x, y| if is_left(x, y) { [20.0, 5.0, 5.0] } else { [70.0, -5.0, 10.0] });
        let labels = superpixels(&colours, 15, 10.0, 10);
        let count = labels.pixels().iter().max().unwrap() + 1;
        assert!((36..=60).contains(&count), "{count}");
        let mut sides = vec![[0_u32; 2]; count as usize];
        for y in 0..90 {
            for x in 0..120 {
                sides[labels.get(x, y) as usize][usize::from(is_left(x, y))] += 1;
            }
        }
        let astray: u32 = sides.iter().map(|s| s[0].min(s[1])).sum();
        assert!(astray < 30, "{astray} pixels on the wrong side");
        assert!(sides.iter().all(|s| s[0] + s[1] >= 56));
    }
}
