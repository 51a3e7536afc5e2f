//! Greyscale opening.

use super::Raster;

/// The raster without high parts into which a square of `2 radius + 1` pixels does not fit: they sink to what is around them.
pub(crate) fn opening(raster: &Raster<f32>, radius: usize) -> Raster<f32> {
    let lowest = within(raster, radius, f32::min);
    within(&lowest, radius, f32::max)
}

/// The picked value of the square around each pixel.
fn within(raster: &Raster<f32>, radius: usize, pick: fn(f32, f32) -> f32) -> Raster<f32> {
    let rows = along_rows(raster, radius, pick).transposed();
    along_rows(&rows, radius, pick).transposed()
}

fn along_rows(raster: &Raster<f32>, radius: usize, pick: fn(f32, f32) -> f32) -> Raster<f32> {
    Raster::from_fn(raster.width(), raster.height(), |x, y| {
        let row = raster.row(y);
        row[x.saturating_sub(radius)..(x + radius + 1).min(row.len())].iter().copied().fold(row[x], pick)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thin_line_sinks_and_a_broad_stripe_and_a_step_stay() {
        let picture = Raster::from_fn(60, 20, |x, _| match x {
            8..=11 => 0.9,
            20..=30 => 0.7,
            40.. => 0.4,
            _ => 0.1,
        });
        let opened = opening(&picture, 3);
        let expected = picture.map(|v| if v == 0.9 { 0.1 } else { v });
        assert_eq!(opened, expected);
    }
}
