//! Directions of lines and peaks of distributions.

use super::*;

/// Parallel lines one pixel wide, `spacing` pixels apart, at an angle; then a fraction of the pixels is flipped.
fn line_drawing(size: usize, degrees: f64, spacing: f64, flipped: f64, seed: u64) -> Raster<u8> {
    let normal = (degrees + 90.0).to_radians();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let pixels = (0..size * size).map(|i| {
        let (x, y) = ((i % size) as f64, (i / size) as f64);
        let offset = (x * normal.cos() + y * normal.sin()).rem_euclid(spacing);
        u8::from(offset < 1.0) ^ u8::from(random.random_range(0.0..1.0) < flipped)
    });
    Raster::from_vec(size, size, pixels.collect())
}

#[test]
fn hough_orientation_is_right_on_lines_and_in_noise() {
    let size = 100;
    let filter = HoughFilter::new(HoughForm::Round, 10, 36);
    let region = Raster::filled(size, size, 1_u8);
    for (flipped, most) in [(0.0, 1.0), (0.2, 2.0)] {
        for spacing in [5.0, 8.0, 11.0] {
            let (mut sum, mut count) = (0.0, 0.0);
            for step in 0..36 {
                let degrees = f64::from(step) * 5.0;
                let lines = line_drawing(size, degrees, spacing, flipped, step as u64);
                let field = filter.orientations(&lines, &region).smoothed(15.0);
                for (x, y) in (30..70).step_by(4).flat_map(|y| (30..70).step_by(4).map(move |x| (x, y))) {
                    let found = field.angle(f64::from(x) + 0.5, f64::from(y) + 0.5).unwrap().to_degrees();
                    let off = (found - degrees).rem_euclid(180.0);
                    sum += off.min(180.0 - off);
                    count += 1.0;
                }
            }
            let mean = sum / count;
            println!("Hough, {:.0} % flipped, lines {spacing} px apart: {mean:.2} degrees", 100.0 * flipped);
            assert!(mean <= most, "{flipped} {spacing}: {mean}");
        }
    }
}

/// A sample of a normal distribution.
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (random.random_range(1e-12..1.0), random.random_range(0.0..std::f64::consts::TAU));
    (-2.0 * u.ln()).sqrt() * v.cos()
}

/// Two to five Gaussians as the issue states them: means, widths, weights.
fn mixture(random: &mut ChaCha8Rng) -> Vec<(f64, f64, f64)> {
    loop {
        let count = random.random_range(2..=5);
        let mut parts: Vec<(f64, f64, f64)> = (0..count)
            .map(|_| (random.random_range(20.0..235.0), random.random_range(3.0..8.0), random.random_range(0.1..1.0)))
            .collect();
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = parts.iter().map(|p| p.2).sum();
        for part in &mut parts {
            part.2 /= total;
        }
        let apart = parts.windows(2).all(|w| w[1].0 - w[0].0 >= 5.0 * w[0].1.max(w[1].1));
        if apart && parts.iter().all(|p| p.2 >= 0.1) {
            return parts;
        }
    }
}

#[test]
fn scale_space_gives_back_the_modes() {
    let mut right = 0;
    for trial in 0..100 {
        let mut random = ChaCha8Rng::seed_from_u64(trial);
        let parts = mixture(&mut random);
        let mut histogram = vec![0_u32; 256];
        for _ in 0..20_000 {
            let mut pick: f64 = random.random_range(0.0..1.0);
            let part = parts.iter().find(|p| {
                pick -= p.2;
                pick < 0.0
            });
            let (mean, sigma, _) = part.unwrap_or(&parts[0]);
            let grey = (mean + sigma * normal(&mut random)).round().clamp(0.0, 255.0);
            histogram[grey as usize] += 1;
        }
        let modes = histogram_modes(&histogram, 200);
        let matches = modes.len() == parts.len() && modes.iter().zip(&parts).all(|(m, p)| (m.at - p.0).abs() <= 3.0);
        right += usize::from(matches);
        if !matches {
            println!("trial {trial}: {parts:.1?} gave {:.1?}", modes.iter().map(|m| m.at).collect::<Vec<_>>());
        }
    }
    println!("scale space: {right} of 100");
    assert!(right >= 95, "{right}");
}
