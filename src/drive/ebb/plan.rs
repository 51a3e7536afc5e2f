//! The speed along a path: as fast as corners and acceleration allow, from rest to rest.
//!
//! The rule at a corner is the one of the machine's own program, by which [`crate::plot`] tells the time: the speed at which a circle that
//! cuts the corner by the junction deviation needs no more than the acceleration.

use crate::geometry::Point;

/// Limits of a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Greatest speed, mm/s.
    pub speed: f64,
    /// Acceleration along the path, mm/s^2.
    pub acceleration: f64,
    /// Junction deviation, mm.
    pub deviation: f64,
}

/// A straight piece at constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// Its end.
    pub to: Point,
    /// Speeds at its ends, mm/s.
    pub speeds: [f64; 2],
    /// How long it takes.
    pub seconds: f64,
}

/// A piece lasts no longer, so that a stop waits for no long one.
const LONGEST: f64 = 0.08;
/// Segments that take less are one piece: the board takes a few hundred commands a second.
const SHORTEST: f64 = 0.006;
/// The slowest that anything moves, mm/s.
const SLOWEST: f64 = 0.5;
/// Cosines above this are straight on, or back.
const STRAIGHT: f64 = 0.999_999;

/// The pieces of a path, which begins at its first point.
pub(super) fn plan(points: &[Point], limits: Limits) -> Vec<Piece> {
    let mut places = points.to_vec();
    places.dedup_by(|a, b| a.distance(*b) < 1e-6);
    let lengths: Vec<f64> = places.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let speeds = corner_speeds(&places, &lengths, limits);
    let mut pieces = Vec::new();
    for (i, length) in lengths.iter().enumerate() {
        segment(&mut pieces, [places[i], places[i + 1]], *length, [speeds[i], speeds[i + 1]], limits);
    }
    merged(pieces)
}

/// Pieces of which none is shorter than the board can take, but for a single one: short ones go with those after them, the last with the
/// one before. At the speeds of a pen they are fractions of a millimetre, and none but a smooth bend is passed in so short a time.
fn merged(pieces: Vec<Piece>) -> Vec<Piece> {
    let mut whole: Vec<Piece> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        match whole.last_mut() {
            Some(last) if last.seconds < SHORTEST => {
                *last = Piece { to: piece.to, speeds: [last.speeds[0], piece.speeds[1]], seconds: last.seconds + piece.seconds };
            }
            _ => whole.push(piece),
        }
    }
    if let [.., before, last] = &mut whole[..]
        && last.seconds < SHORTEST
    {
        *before = Piece { to: last.to, speeds: [before.speeds[0], last.speeds[1]], seconds: before.seconds + last.seconds };
        whole.pop();
    }
    whole
}

/// The speed at each point: limited by its corner, and by what can be reached from both ends.
fn corner_speeds(places: &[Point], lengths: &[f64], limits: Limits) -> Vec<f64> {
    let mut squared = vec![0.0; places.len()];
    for i in 1..places.len().saturating_sub(1) {
        squared[i] = corner_squared(places[i - 1], places[i], places[i + 1], limits).min(limits.speed * limits.speed);
    }
    for i in (0..lengths.len()).rev() {
        squared[i] = f64::min(squared[i], squared[i + 1] + 2.0 * limits.acceleration * lengths[i]);
    }
    for i in 0..lengths.len() {
        squared[i + 1] = f64::min(squared[i + 1], squared[i] + 2.0 * limits.acceleration * lengths[i]);
    }
    squared.into_iter().map(f64::sqrt).collect()
}

fn corner_squared(before: Point, at: Point, after: Point, limits: Limits) -> f64 {
    let (a, b) = ((at - before).normalize(), (after - at).normalize());
    let cosine = -a.dot(b);
    if cosine > STRAIGHT {
        return 0.0;
    }
    if cosine < -STRAIGHT {
        return f64::INFINITY;
    }
    let half_sine = (0.5 * (1.0 - cosine)).sqrt();
    limits.acceleration * limits.deviation * half_sine / (1.0 - half_sine)
}

/// Acceleration, level motion and braking on one segment, in pieces that are neither long nor very short.
fn segment(pieces: &mut Vec<Piece>, [from, to]: [Point; 2], length: f64, [entry, exit]: [f64; 2], limits: Limits) {
    let a = limits.acceleration;
    let peak = (0.5 * (entry * entry + exit * exit) + a * length).sqrt().min(limits.speed).max(entry).max(exit).max(SLOWEST);
    let rise = ((peak * peak - entry * entry) / (2.0 * a)).min(length);
    let fall = ((peak * peak - exit * exit) / (2.0 * a)).min(length - rise);
    let level = (length - rise - fall).max(0.0);
    let time = |way: f64, speeds: [f64; 2]| 2.0 * way / (speeds[0] + speeds[1]).max(2.0 * SLOWEST);
    let parts = [(rise, [entry, peak]), (level, [peak, peak]), (fall, [peak, exit])];
    let all: f64 = parts.iter().map(|(way, speeds)| time(*way, *speeds)).sum();
    if all < SHORTEST {
        pieces.push(Piece { to, speeds: [entry, exit].map(|speed| speed.max(SLOWEST)), seconds: all });
        return;
    }
    let mut done = 0.0;
    for (way, speeds) in parts.into_iter().filter(|(way, _)| *way > 1e-9) {
        let seconds = time(way, speeds);
        let count = (seconds / LONGEST).ceil().max(1.0);
        for i in 1..=count as usize {
            // Of a uniformly accelerated way, the part after a part of the time.
            let at = |part: f64| {
                let speed = speeds[0] + part * (speeds[1] - speeds[0]);
                (speed, 0.5 * (speeds[0] + speed) * part * seconds)
            };
            let ((before, _), (after, gone)) = (at((i - 1) as f64 / count), at(i as f64 / count));
            let share = ((done + gone.min(way)) / length).min(1.0);
            let end = if i as f64 == count { from.lerp(to, (done + way) / length) } else { from.lerp(to, share) };
            pieces.push(Piece { to: end, speeds: [before, after], seconds: seconds / count });
        }
        done += way;
    }
    if let Some(last) = pieces.last_mut() {
        last.to = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { speed: 50.0, acceleration: 762.0, deviation: 0.05 };

    #[test]
    fn a_line_rises_runs_and_falls() {
        let pieces = plan(&[Point::new(0.0, 0.0), Point::new(30.0, 0.0)], LIMITS);
        let seconds: f64 = pieces.iter().map(|piece| piece.seconds).sum();
        assert!((seconds - (30.0 / 50.0 + 50.0 / 762.0)).abs() < 1e-6, "{seconds}");
        assert_eq!((pieces[0].speeds[0], pieces[pieces.len() - 1].speeds[1]), (0.0, 0.0));
        assert!(pieces.iter().all(|piece| piece.seconds <= LONGEST + 1e-9));
        assert_eq!(pieces[pieces.len() - 1].to, Point::new(30.0, 0.0));
        assert!(pieces.windows(2).all(|pair| (pair[0].speeds[1] - pair[1].speeds[0]).abs() < 1e-9), "no jump of speed");
    }

    #[test]
    fn a_corner_is_slower_than_a_bend() {
        let bend = |y: f64| {
            let places = [Point::new(0.0, 0.0), Point::new(20.0, 0.0), Point::new(40.0, y)];
            let pieces = plan(&places, LIMITS);
            pieces.iter().find(|piece| piece.to == places[1]).unwrap().speeds[1]
        };
        assert!(bend(0.0) > 49.9 && bend(2.0) > bend(20.0) && bend(20.0) > 0.5, "{} {} {}", bend(0.0), bend(2.0), bend(20.0));
    }
}
