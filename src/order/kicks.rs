//! Escapes local optima: small random changes, each repaired locally and undone if it did not pay.

use super::ends::End;
use super::lin_kernighan::LinKernighan;
use super::random::SplitMix;
use super::rearrangement::Rearrangement;

/// Number of links cut by a kick.
const CUTS: usize = 4;

/// Number of random steps from neighbour to neighbour between the first cut and each other one. Tuned on 10,000 dots, segments
/// and hatch lines: 4 steps take two thirds of the time and leave the order 0.2 to 1 % longer; 30 take half as long again or more
/// for 0.1 to 0.2 %.
const STEPS: usize = 10;

/// Kicks the tour `times` times and returns the millimetres gained. One kick takes about 20 microseconds regardless of the tour's
/// length, as long as the changes to its array stay short.
pub(super) fn kick(search: &mut LinKernighan, times: usize, random: &mut SplitMix) -> f64 {
    (0..times).take_while(|_| !search.sites.interrupt().is_raised()).filter_map(|_| kick_once(search, random)).sum()
}

/// Makes one kick and keeps it if the repaired tour is no longer than before. `None` if no kick was possible.
fn kick_once(search: &mut LinKernighan, random: &mut SplitMix) -> Option<f64> {
    let seats = nearby_seats(search, random)?;
    let tour = &search.tour;
    let ends: [End; 2 * CUTS] =
        std::array::from_fn(|i| if i % 2 == 0 { tour.entry(seats[i / 2]) ^ 1 } else { tour.entry(seats[i / 2] + 1) });
    let before = search.length_at(&ends);
    search.rearrange(&Rearrangement::reverse_order(search.tour.len(), seats));
    let loss = search.length_at(&ends) - before;
    for end in ends {
        search.look_at(end);
    }
    let gain = search.improve(|_| ()) - loss;
    if gain >= 0.0 {
        search.keep();
        Some(gain)
    } else {
        search.take_back();
        Some(0.0)
    }
}

/// The seats before the cuts, ascending: all near a random path on paper, anywhere in the tour.
fn nearby_seats(search: &LinKernighan, random: &mut SplitMix) -> Option<[usize; CUTS]> {
    let start = random.below(2 * search.tour.len()) as End;
    let mut seats = [search.tour.seat_of(start); CUTS];
    for seat in &mut seats[1..] {
        let mut end = start;
        for _ in 0..STEPS {
            let neighbours = search.neighbours.of(end);
            end = *neighbours.get(random.below(neighbours.len()))?;
        }
        *seat = search.tour.seat_of(end);
    }
    seats.sort_unstable();
    seats.windows(2).all(|pair| pair[0] < pair[1]).then_some(seats)
}
