//! Edges against those of other filters.

use super::*;

/// A plate of discs and stripes of flat greys, and the distance of each pixel from an edge (up to 40).
fn plate(size: usize) -> (Raster<f32>, Raster<f32>) {
    let plate = Raster::from_fn(size, size, |x, y| {
        let (x, y) = (x as f32, y as f32);
        let r = (x - 128.0).hypot(y - 128.0);
        if r < 45.0 {
            0.8
        } else if r < 90.0 {
            0.25
        } else if x + 0.4 * y > 330.0 {
            0.9
        } else if x - 0.7 * y < -40.0 {
            0.1
        } else {
            0.55
        }
    });
    let is_edge = |x: usize, y: usize| {
        let (x, y) = (x as isize, y as isize);
        plate.clamped(x, y) != plate.clamped(x + 1, y) || plate.clamped(x, y) != plate.clamped(x, y + 1)
    };
    let edges: Vec<(usize, usize)> = (0..size * size).map(|i| (i % size, i / size)).filter(|&(x, y)| is_edge(x, y)).collect();
    let distance = Raster::from_fn(size, size, |x, y| {
        edges.iter().map(|e| (e.0 as f32 - x as f32).hypot(e.1 as f32 - y as f32)).fold(40.0, f32::min)
    });
    (plate, distance)
}

/// A plain Gaussian-Kuwahara filter: the mean of the window within 3 sigma with the least deviation.
fn kuwahara(picture: &Raster<f32>, sigma: f32) -> Raster<f32> {
    let mean = fast_gaussian(picture, sigma);
    let squares = fast_gaussian(&picture.map(|v| v * v), sigma);
    let variance = squares.zip_map(&mean, |s, m| s - m * m);
    let reach = (3.0 * sigma) as isize;
    Raster::from_fn(picture.width(), picture.height(), |x, y| {
        let mut best = (f32::INFINITY, 0.0);
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                if dx * dx + dy * dy <= reach * reach {
                    let at = (x as isize + dx, y as isize + dy);
                    let v = variance.clamped(at.0, at.1);
                    if v < best.0 {
                        best = (v, mean.clamped(at.0, at.1));
                    }
                }
            }
        }
        best.1
    })
}

#[test]
fn figure_7_18_remade() {
    let (size, sigma) = (256, 3.0_f32);
    let (clean, distance) = plate(size);
    let noisy = clean.zip_map(&white_noise(size, size, 3), |v, n| v + 0.05 * n);
    let count = distance.pixels().iter().filter(|d| **d < 1.0).count() as f64;
    let measure = |smooth: &Raster<f32>| {
        let (mut far, mut far_count, mut near) = (0.0, 0.0, 0.0);
        for ((s, c), d) in smooth.pixels().iter().zip(clean.pixels()).zip(distance.pixels()) {
            let square = f64::from(s - c).powi(2);
            if *d > 5.0 * sigma {
                far += square;
                far_count += 1.0;
            } else {
                near += square;
            }
        }
        (-10.0 * (far / far_count).log10(), near / count)
    };
    let report = |name: &str, (psnr, edge): (f64, f64)| println!("| {name} | {psnr:.1} | {edge:.4} |");
    let gauss = measure(&edge_preserving(std::slice::from_ref(&noisy), sigma, 0.0)[0]);
    report("0 (Gaussian)", gauss);
    let mut at_four = gauss;
    for q in [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 16.0] {
        let figures = measure(&edge_preserving(std::slice::from_ref(&noisy), sigma, q)[0]);
        report(&q.to_string(), figures);
        if q == 4.0 {
            at_four = figures;
        }
    }
    let hard = measure(&kuwahara(&noisy, sigma));
    report("Gaussian-Kuwahara", hard);
    assert!(gauss.0 - at_four.0 <= 1.0, "noise: {} dB of {}", at_four.0, gauss.0);
    assert!(at_four.1 <= 1.1 * hard.1, "edges: {} of {}", at_four.1, hard.1);
}
