//! Which pen draws which mark: the marks of a drawing that all pens make together are dealt out to them.
//!
//! Each pen's marks are as evenly spaced as their number allows, and so are all of them, since they are those of one drawing. A mark
//! goes to the pen that is missed most around it, by direct search: every mark may change to another pen while that lessens
//!
//! ```text
//!   sum over the marks j around i of   ink_j (1 if j is the pen's, less the pen's share at j) * bell(distance / reach of the pen)
//! ```
//!
//! for its pen, where a pen's reach grows as its marks get rarer. (Direct binary search of halftoning: Analoui and Allebach 1992, for
//! several inks and on marks instead of pixels.)

use super::pens::MOST_PENS;
use crate::geometry::{Point, Vec2};
use crate::parallel::{collected, mapped};
use std::collections::BTreeMap;

/// How far marks of one pen act on one another, in mean distances of that pen's marks. Tuned on even patches of three and four pens:
/// at 1.4 rare pens clump, at 2.8 common ones line up in streaks.
const REACH: f64 = 1.8;
/// Neighbours are looked for within so many mean distances of marks; those of rarer pens would take too long.
const FARTHEST: f64 = 5.5;

/// A mark that may go to any pen.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Its middle, in millimetres.
    pub at: Point,
    /// Its ink in square millimetres.
    pub ink: f64,
    /// The share of each pen in the ink around it, 0 to 1; together 1.
    pub shares: Vec<f32>,
    /// Marks of one round were placed together and lie evenly; those of another round may lie on them, and are moved away.
    pub round: u8,
}

/// A mark given to a pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dealt {
    /// The pen, by its index in the shares.
    pub pen: usize,
    /// Where its middle lies now: a third of the distance to the next mark farther at most.
    pub at: Point,
    /// By how much its ink must grow or shrink so that its pen has its share there.
    pub ink_factor: f64,
}

/// Marks change pens at most so often; after 8 rounds fewer than one in a thousand does.
const ROUNDS: usize = 10;

/// Deals the marks out, and moves them a little apart. The same on any number of threads.
pub fn deal(marks: &[Candidate]) -> Vec<Dealt> {
    let Some(pens) = marks.first().map(|mark| mark.shares.len()) else { return Vec::new() };
    if pens < 2 {
        return marks.iter().map(|mark| Dealt { pen: 0, at: mark.at, ink_factor: 1.0 }).collect();
    }
    let around = Neighbours::of(marks);
    let shares = Shares { pens, all: marks.iter().flat_map(|mark| mark.shares.iter().copied()).collect() };
    let mut search = Search::of(marks, &shares, &around);
    for _ in 0..ROUNDS {
        let changed = around.order.iter().filter(|mark| search.improve(**mark)).count();
        if changed * 1000 < marks.len() {
            break;
        }
    }
    let pens: Vec<usize> = search.pen.into_iter().map(Option::unwrap_or_default).collect();
    let places = moved_apart(marks, &shares, &pens, &around);
    let factor = |mark: usize| ink_factor(marks, &pens, &around, mark);
    collected(marks.len(), &|mark| Dealt { pen: pens[mark], at: places[mark], ink_factor: factor(mark) })
}

/// Most that a mark's ink grows or shrinks.
const MOST_CHANGE: f64 = 1.5;

/// The ink that a mark's pen should have around it, divided by what it has.
fn ink_factor(marks: &[Candidate], pens: &[usize], around: &Neighbours, mark: usize) -> f64 {
    let pen = pens[mark];
    let wide = (1.0 / (FARTHEST * around.spacing[mark]).powi(2)) as f32;
    let [mut wanted, mut present] = [marks[mark].ink * f64::from(marks[mark].shares[pen]), marks[mark].ink];
    for (other, distance) in &around.near[mark] {
        let j = *other as usize;
        let ink = marks[j].ink * f64::from(bell(distance * wide));
        wanted += ink * f64::from(marks[j].shares[pen]);
        present += if pens[j] == pen { ink } else { 0.0 };
    }
    (wanted / present).clamp(MOST_CHANGE.recip(), MOST_CHANGE)
}

/// The marks around each mark.
struct Neighbours {
    /// Index and squared distance of each.
    near: Vec<Vec<(u32, f32)>>,
    /// Mean distance of marks around each.
    spacing: Vec<f64>,
    /// Row by row, so that each round reads like a page.
    order: Vec<usize>,
}

impl Neighbours {
    fn of(marks: &[Candidate]) -> Self {
        let bounds = marks.iter().fold([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY], |b, mark| {
            [b[0].min(mark.at.x), b[1].min(mark.at.y), b[2].max(mark.at.x), b[3].max(mark.at.y)]
        });
        let area = ((bounds[2] - bounds[0]) * (bounds[3] - bounds[1])).max(1e-6);
        let mean = (area / marks.len() as f64).sqrt();
        let cell = |p: Point| ((p.x / (FARTHEST * mean)).floor() as i64, (p.y / (FARTHEST * mean)).floor() as i64);
        let mut cells: BTreeMap<(i64, i64), Vec<u32>> = BTreeMap::new();
        marks.iter().enumerate().for_each(|(i, mark)| cells.entry(cell(mark.at)).or_default().push(i as u32));
        let reach = (FARTHEST * mean).powi(2);
        let near: Vec<Vec<(u32, f32)>> = collected(marks.len(), &|i| {
            let at = marks[i].at;
            let (x, y) = cell(at);
            let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
            let all = around.filter_map(|key| cells.get(&key)).flatten();
            let distances = all.filter(|j| **j != i as u32).map(|j| (*j, (marks[*j as usize].at - at).hypot2()));
            distances.filter(|(_, d)| *d < reach).map(|(j, d)| (j, d as f32)).collect()
        });
        // Six neighbours of an even pattern lie nearest; their mean distance is that of marks.
        let spacing = mapped(&near, &|near| mean_of_nearest(near).unwrap_or(mean));
        let near = collected(marks.len(), &|i| {
            let met = |j: u32, d: f32| f64::from(d) <= within(FARTHEST * spacing[i], spacing[i], spacing[j as usize]);
            near[i].iter().copied().filter(|(j, d)| met(*j, *d)).collect()
        });
        let mut order: Vec<usize> = (0..marks.len()).collect();
        let row = |i: usize| ((marks[i].at.y / mean) as i64, marks[i].at.x);
        order.sort_by(|a, b| {
            let ((above, left), (below, right)) = (row(*a), row(*b));
            above.cmp(&below).then(left.total_cmp(&right)).then(a.cmp(b))
        });
        Self { near, spacing, order }
    }
}

/// The root mean square distance of the six nearest.
fn mean_of_nearest(near: &[(u32, f32)]) -> Option<f64> {
    const NEAREST: usize = 6;
    let mut distances: Vec<f32> = near.iter().map(|(_, d)| *d).collect();
    let count = NEAREST.min(distances.len());
    if count == 0 {
        return None;
    }
    let (nearest, _, _) = distances.select_nth_unstable_by(count - 1, f32::total_cmp);
    let last = nearest.len();
    let sum: f32 = distances[..=last].iter().sum();
    Some(f64::from(sum / count as f32).sqrt())
}

/// The shares of all marks, side by side.
struct Shares {
    pens: usize,
    all: Vec<f32>,
}

impl Shares {
    #[inline]
    fn of(&self, mark: usize) -> &[f32] {
        &self.all[mark * self.pens..][..self.pens]
    }
}

struct Search<'a> {
    marks: &'a [Candidate],
    shares: &'a Shares,
    around: &'a Neighbours,
    pen: Vec<Option<usize>>,
    /// When each mark changed its pen, and when it was last looked at, by the number of looks until then.
    changed: Vec<u32>,
    looked: Vec<u32>,
    looks: u32,
}

impl<'a> Search<'a> {
    fn of(marks: &'a [Candidate], shares: &'a Shares, around: &'a Neighbours) -> Self {
        let never = vec![0; marks.len()];
        Self { marks, shares, around, pen: vec![None; marks.len()], changed: never.clone(), looked: never, looks: 0 }
    }

    /// Gives a mark to the pen that is missed most around it; true if it changed.
    fn improve(&mut self, mark: usize) -> bool {
        /// Where a pen has a smaller share of the ink it gets no mark.
        const LEAST_SHARE: f32 = 0.01;
        // What surrounds most marks stays as it was after the second round.
        let before = self.looked[mark];
        if before > 0 && self.around.near[mark].iter().all(|(other, _)| self.changed[*other as usize] <= before) {
            return false;
        }
        self.looks += 1;
        self.looked[mark] = self.looks;
        let shares = self.shares.of(mark);
        let excess = self.excess(mark);
        let wanted = (0..shares.len()).filter(|pen| shares[*pen] >= LEAST_SHARE);
        let best = wanted.min_by(|a, b| excess[*a].total_cmp(&excess[*b]));
        let best = best.or_else(|| (0..shares.len()).max_by(|a, b| shares[*a].total_cmp(&shares[*b]).then(b.cmp(a))));
        let has_changed = self.pen[mark] != best;
        self.pen[mark] = best;
        if has_changed {
            self.changed[mark] = self.looks;
        }
        has_changed
    }

    /// How much more of each pen's ink lies around a mark than should, relative to what the mark itself would add.
    fn excess(&self, mark: usize) -> [f64; MOST_PENS] {
        /// The weight of keeping a pen's share of all ink within `FARTHEST`.
        const KEEPING: f32 = 0.8;
        let shares = self.shares.of(mark);
        let spacing = self.around.spacing[mark];
        let mut own = [0.0_f32; MOST_PENS];
        own.iter_mut().zip(shares).for_each(|(own, share)| *own = (1.0 / reach_of(f64::from(*share), spacing).powi(2)) as f32);
        let wide = (1.0 / (FARTHEST * spacing).powi(2)) as f32;
        let mut sums = [0.0; MOST_PENS];
        for (other, distance) in &self.around.near[mark] {
            // A mark not yet dealt counts as it will be on average.
            let Some(its) = self.pen[*other as usize] else { continue };
            let kept = KEEPING * bell(distance * wide);
            if kept <= 0.0 {
                continue;
            }
            let ink = self.marks[*other as usize].ink;
            for (pen, share) in self.shares.of(*other as usize).iter().enumerate() {
                let present = if its == pen { 1.0 } else { 0.0 };
                sums[pen] += ink * f64::from(bell(distance * own[pen]) + kept) * (present - f64::from(*share));
            }
        }
        for (sum, share) in sums.iter_mut().zip(shares) {
            *sum /= f64::from((1.0 - share).max(0.02)) * self.marks[mark].ink;
        }
        sums
    }
}

/// Rounds in which marks move apart, and how far they go in one, as a share of the forces on them.
const MOVES: usize = 24;
const STEP: f64 = 0.2;
/// Farthest that a mark moves, in mean distances of marks: rows stay rows.
const FARTHEST_MOVE: f64 = 0.35;
/// Weight of the distances of all marks against those of one pen's.
const UNION: f64 = 2.0;

/// Marks moved a little so that those of each pen lie evenly, and all of them still do.
fn moved_apart(marks: &[Candidate], shares: &Shares, pens: &[usize], around: &Neighbours) -> Vec<Point> {
    let first: Vec<Point> = marks.iter().map(|mark| mark.at).collect();
    let crowds = collected(marks.len(), &|mark| Crowd::of(mark, shares, pens, around));
    let together = |mark: usize, other: usize| marks[mark].round == marks[other].round;
    let rest: Vec<_> = collected(marks.len(), &|mark| crowds[mark].at_rest(&first, mark, together));
    let mut places = first.clone();
    for _ in 0..MOVES {
        places = collected(marks.len(), &|mark| {
            let [own, all] = crowds[mark].forces(&places, mark);
            let moved = places[mark] + (own + (all - rest[mark]) * UNION) * STEP - first[mark];
            let most = FARTHEST_MOVE * around.spacing[mark];
            first[mark] + if moved.hypot() > most { moved * (most / moved.hypot()) } else { moved }
        });
    }
    places
}

/// The marks that can come within reach of a mark while all of them move.
struct Crowd {
    /// Each mark, with 1 if it is of the same pen, less that pen's share there.
    others: Vec<(u32, f64)>,
    /// Squared reach of the pen; and, inverted, of the pen and of all marks together.
    reach: f64,
    own: f64,
    all: f64,
}

impl Crowd {
    fn of(mark: usize, shares: &Shares, pens: &[usize], around: &Neighbours) -> Self {
        let (pen, spacing) = (pens[mark], around.spacing[mark]);
        let reach = reach_of(f64::from(shares.of(mark)[pen]), spacing);
        let near = around.near[mark].iter().map(|(other, distance)| (*other as usize, f64::from(*distance)));
        let met = near.filter(|(j, distance)| *distance <= within(reach, spacing, around.spacing[*j]));
        let others = met.map(|(j, _)| {
            let present = if pens[j] == pen { 1.0 } else { 0.0 };
            (j as u32, present - f64::from(shares.of(j)[pen]))
        });
        Self { others: others.collect(), reach: reach * reach, own: 1.0 / reach.powi(2), all: 1.0 / (REACH * spacing).powi(2) }
    }

    /// The force of the pen's marks on a mark, and that of all marks.
    fn forces(&self, places: &[Point], mark: usize) -> [Vec2; 2] {
        let mut sum = [Vec2::ZERO; 2];
        for (other, missed) in &self.others {
            let way = places[mark] - places[*other as usize];
            let distance = way.hypot2();
            if distance < self.reach {
                sum[0] += way * (f64::from(bell((distance * self.own) as f32)) * missed);
                sum[1] += way * f64::from(bell((distance * self.all) as f32));
            }
        }
        sum
    }

    /// The force of all marks that were placed together with a mark, which is what they had when they lay evenly.
    fn at_rest(&self, places: &[Point], mark: usize, together: impl Fn(usize, usize) -> bool) -> Vec2 {
        let others = self.others.iter().map(|(other, _)| *other as usize).filter(|other| together(mark, *other));
        let ways = others.map(|other| places[mark] - places[other]).filter(|way| way.hypot2() < self.reach);
        ways.fold(Vec2::ZERO, |sum, way| sum + way * f64::from(bell((way.hypot2() * self.all) as f32)))
    }
}

/// The squared distance within which a mark of one spacing can come within `reach` of one of another while both move.
fn within(reach: f64, spacing: f64, other: f64) -> f64 {
    /// Distances are kept in single precision.
    const ROOM: f64 = 1.000_01;
    ((reach + FARTHEST_MOVE * (spacing + other)) * ROOM).powi(2)
}

/// How far marks of a pen act on one another.
fn reach_of(share: f64, spacing: f64) -> f64 {
    (REACH * spacing / share.max(0.001).sqrt()).min(FARTHEST * spacing)
}

/// A bell from 1 at 0 to 0 at 1, of a squared distance: much like a Gaussian, without its tail.
fn bell(squared: f32) -> f32 {
    let rest = (1.0 - squared).max(0.0);
    rest * rest * (rest * rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marks in a slightly irregular hexagonal pattern, 40 x 40 mm.
    fn even_patch(shares: &[f32]) -> Vec<Candidate> {
        let mut marks = Vec::new();
        for row in 0..75 {
            for column in 0..66 {
                let wobble = |k: i64| 0.04 * (((row * 92_821 + column * 68_917 + k * 31) % 101) as f64 / 50.0 - 1.0);
                let at = Point::new(
                    0.6 * (column as f64 + if row % 2 == 0 { 0.0 } else { 0.5 }) + wobble(1),
                    0.52 * row as f64 + wobble(2),
                );
                marks.push(Candidate { at, ink: 0.1, shares: shares.to_vec(), round: 0 });
            }
        }
        marks
    }

    /// Variation of the distance to the nearest mark, away from the border.
    fn variation(points: &[Point]) -> f64 {
        let inside = points.iter().filter(|p| (5.0..35.0).contains(&p.x) && (5.0..34.0).contains(&p.y));
        let nearest = |p: &Point| {
            let others = points.iter().filter(|q| *q != p);
            others.map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min)
        };
        let distances: Vec<f64> = inside.map(nearest).collect();
        let mean = distances.iter().sum::<f64>() / distances.len() as f64;
        (distances.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>() / distances.len() as f64).sqrt() / mean
    }

    #[test]
    fn each_pen_gets_its_share_evenly() {
        for shares in [[0.334, 0.333, 0.333], [0.5, 0.3, 0.2], [0.6, 0.3, 0.1], [0.25, 0.7, 0.05]] {
            let marks = even_patch(&shares);
            let dealt = deal(&marks);
            let all = variation(&dealt.iter().map(|mark| mark.at).collect::<Vec<_>>());
            assert!(all <= 0.2, "{shares:?} together: {all}");
            for (pen, share) in shares.into_iter().enumerate() {
                let own = || dealt.iter().filter(|mark| mark.pen == pen);
                let uneven = variation(&own().map(|mark| mark.at).collect::<Vec<_>>());
                let ink = own().map(|mark| mark.ink_factor).sum::<f64>() / marks.len() as f64;
                assert!((ink - f64::from(share)).abs() < 0.01, "{shares:?}: {ink} of {share}");
                assert!(uneven <= 0.2, "{shares:?} pen {pen}: {uneven}");
            }
        }
    }

    #[test]
    fn a_pen_that_is_not_wanted_draws_nothing() {
        let mut marks = even_patch(&[1.0, 0.0]);
        marks.iter_mut().filter(|mark| mark.at.x > 20.0).for_each(|mark| mark.shares = vec![0.0, 1.0]);
        let dealt = deal(&marks);
        assert!(marks.iter().zip(dealt).all(|(mark, dealt)| dealt.pen == usize::from(mark.at.x > 20.0)));
        assert_eq!(deal(&[]), Vec::<Dealt>::new());
    }
}
