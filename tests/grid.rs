//! The structure grid's promises.

mod common;

use drypoint::field::{StripeParameters, Wave, crossings, stripe_lines, stripes};
use drypoint::geometry::{Point, Vec2};
use drypoint::raster::Raster;

const PITCH: f64 = 6.0;

/// A field of known direction: the tangent at a place, in pixels from the centre.
type Field = fn(Vec2) -> Vec2;

fn circular(p: Vec2) -> Vec2 {
    p.turn_90().normalize()
}

fn spiral(p: Vec2) -> Vec2 {
    rotated(p.normalize(), 55.0)
}

fn saddle(p: Vec2) -> Vec2 {
    Vec2::new(p.x, -p.y).normalize()
}

fn rotated(v: Vec2, degrees: f64) -> Vec2 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec2::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos)
}

fn noise(seed: u64) -> impl Fn(u64) -> f32 + Sync {
    move |n| {
        let mut h = (n + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ seed.wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h ^= h >> 31;
        h = h.wrapping_mul(0x94d0_49bb_1331_11eb);
        h ^= h >> 29;
        (h >> 40) as f32 / (1_u64 << 24) as f32
    }
}

struct Score {
    degrees: f64,
    variation: f64,
    density: f64,
}

fn score(dots: &[Point], field: &dyn Fn(Point) -> Vec2, inside: &dyn Fn(Point) -> bool, area: f64) -> Score {
    let (mut angles, mut distances, mut count) = (Vec::new(), Vec::new(), 0);
    for a in dots.iter().filter(|p| inside(**p)) {
        count += 1;
        let mut near: Vec<(f64, Point)> =
            dots.iter().map(|b| (a.distance(*b), *b)).filter(|(d, _)| *d > 0.0 && *d < 1.6 * PITCH).collect();
        near.sort_by(|x, y| x.0.total_cmp(&y.0));
        for (d, b) in near.into_iter().take(4) {
            let t = field(a.midpoint(b));
            let way = (b - *a).normalize();
            let angle = way.cross(t).atan2(way.dot(t)).to_degrees().rem_euclid(90.0);
            angles.push(angle.min(90.0 - angle));
            distances.push(d);
        }
    }
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let m = mean(&distances);
    let variance = distances.iter().map(|d| (d - m).powi(2)).sum::<f64>() / distances.len() as f64;
    Score { degrees: mean(&angles), variation: variance.sqrt() / m, density: f64::from(count) * PITCH * PITCH / area }
}

#[test]
fn experiment() {
    let (width, height) = (450_usize, 590_usize);
    let centre = Point::new(225.3, 295.8);
    let env = |name: &str, default: f64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default);
    let parameters = StripeParameters {
        step: PITCH * env("H", 0.5),
        window: env("W", 4.0),
        rounds: env("R", 5.0) as u32,
        levels: env("L", 5.0) as u32,
    };
    let fields: Vec<(String, Box<dyn Fn(Point) -> Vec2 + Sync>)> = [0.0, 17.0, 30.0, 45.0, 71.0]
        .into_iter()
        .map(|a| {
            (
                format!("parallel {a}"),
                Box::new(move |_: Point| rotated(Vec2::new(1.0, 0.0), a)) as Box<dyn Fn(Point) -> Vec2 + Sync>,
            )
        })
        .chain([("circular", circular as Field), ("spiral", spiral), ("saddle", saddle)].map(|(n, f)| {
            (n.to_owned(), Box::new(move |p: Point| f(p - Point::new(225.3, 295.8))) as Box<dyn Fn(Point) -> Vec2 + Sync>)
        }))
        .collect();
    for (name, field) in &fields {
        let wave = |turn: bool| {
            Raster::from_fn(width, height, |x, y| {
                let t = field(Point::new(x as f64 + 0.5, y as f64 + 0.5));
                let n = if turn { t.turn_90() } else { t } / PITCH;
                [n.x as f32, n.y as f32] as Wave
            })
        };
        let (wa, wb) = (wave(true), wave(false));
        let started = std::time::Instant::now();
        let a = stripes(&wa, parameters, &noise(1), None);
        let b = stripes(&wb, parameters, &noise(2), None);
        let t1 = started.elapsed().as_secs_f64();
        let dots = crossings(&a, &b, env("D", 0.6) * PITCH);
        let t2 = started.elapsed().as_secs_f64();
        let lines = stripe_lines(&a).len() + stripe_lines(&b).len();
        let t3 = started.elapsed().as_secs_f64();
        let margin = 3.0 * PITCH;
        let inside = |p: Point| {
            p.x > margin
                && p.y > margin
                && p.x < width as f64 - margin
                && p.y < height as f64 - margin
                && (name.starts_with("par") || p.distance(centre) > 3.0 * PITCH)
        };
        let mut area = (width as f64 - 2.0 * margin) * (height as f64 - 2.0 * margin);
        if !name.starts_with("par") {
            area -= std::f64::consts::PI * 9.0 * PITCH * PITCH;
        }
        let s = score(&dots, field, &inside, area);
        println!(
            "{name:14} {:.2} deg  cv {:.4}  density {:.4}  lines {lines} seconds {t1:.3} {:.3} {:.3}",
            s.degrees,
            s.variation,
            s.density,
            t2 - t1,
            t3 - t2
        );
    }
}
