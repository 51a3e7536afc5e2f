//! Three runs of the person network on different windows and tones, and how their results are combined.

use super::SeeError;
use super::head::Head;
use super::networks::Network;
use super::view::{Outside, View, Window};
use crate::geometry::Rect;
use crate::parallel::{both, mapped};
use crate::raster::Raster;

/// Side of the padded window in longer sides of the picture: the network expects the head away from the frame. The padding is
/// black: next to grey the network takes flags and curtains for people. For close-ups it is grey: black loses cheeks.
const PADDED: f64 = 1.25;
const GREY: f32 = 127.0;
const BLACK: f32 = 0.0;

/// The network's results for each pixel of a grid, as probabilities in steps of 1/255.
pub(super) struct PersonMaps {
    /// The median of the three.
    pub middle: Raster<f32>,
    /// The minimum of the three.
    pub least: Raster<f32>,
}

impl PersonMaps {
    /// Runs the network on a view, resampled to a grid of `size` columns and rows: near the heads, on the whole with black
    /// padding, and on the whole in brighter tone. Hardly anything but a person is found by all three; where one misses a person,
    /// it is the only one.
    pub(super) fn new(network: &Network, view: &View, heads: &[Head], size: [usize; 2]) -> Result<Self, SeeError> {
        let look = Look { network, view, size };
        let picture = view.part;
        if heads.first().is_some_and(|head| head.is_close_up(picture)) {
            // Each of these two loses pieces of a face that fills the frame, and neither adds any.
            let whole = || look.at(picture, Outside::Repeated, Tone::Own);
            let (whole, padded) = both(whole, || look.at(with_room(picture), Outside::Grey(GREY), Tone::Own));
            let either = whole?.zip_map(&padded?, f32::max);
            return Ok(Self { middle: either.clone(), least: either });
        }
        let brighter = || look.at(picture, Outside::Repeated, Tone::Brighter);
        let padded = || look.at(with_room(picture), Outside::Grey(BLACK), Tone::Own);
        let ((brighter, padded), round) = both(|| both(brighter, padded), || look.round(heads));
        let (brighter, padded) = (brighter?, padded?);
        let near = look.near(&round?, &brighter);
        let least = near.zip_map(&padded, f32::min).zip_map(&brighter, f32::min);
        let pairs = near.zip_map(&padded, |a, b| [a.min(b), a.max(b)]);
        let middle = pairs.zip_map(&brighter, |[low, high], c| low.max(high.min(c)));
        Ok(Self { middle, least })
    }
}

/// A square resting on the picture's lower side. All padding is above and beside: bodies continue below the frame.
fn with_room(picture: Rect) -> Rect {
    let side = PADDED * picture.width().max(picture.height());
    let left = 0.5 * (picture.x0 + picture.x1 - side);
    Rect::new(left, picture.y1 - side, left + side, picture.y1)
}

/// The tone of a network's input.
#[derive(Clone, Copy)]
enum Tone {
    Own,
    /// The square root of each value: separates dark hair from dark walls.
    Brighter,
}

struct Look<'a> {
    network: &'a Network,
    view: &'a View,
    size: [usize; 2],
}

impl Look<'_> {
    /// The network's result for a window, which may extend beyond the picture.
    fn at(&self, part: Rect, outside: Outside, tone: Tone) -> Result<Raster<f32>, SeeError> {
        let side = self.network.side;
        let shown = self.view.through(&Window::stretched(part), side, outside);
        let shown = match tone {
            Tone::Own => shown,
            Tone::Brighter => shown.map(|colour| colour.map(|v| (255.0 * v).sqrt())),
        };
        let [numbers] = self.network.run(&shown, 1.0 / 255.0, 0.0)?;
        if numbers.len() != side * side {
            return Err(SeeError::Network { network: "selfie_segmentation", reason: "its mask has the wrong size".to_owned() });
        }
        let steps = numbers.into_iter().map(|v| (255.0 * v.clamp(0.0, 1.0)).round() / 255.0).collect();
        let seen = Raster::from_vec(side, side, steps);
        let [columns, rows] = self.size;
        let picture = self.view.part;
        let scale = [picture.width() / columns as f64, picture.height() / rows as f64];
        Ok(Raster::from_fn(columns, rows, |x, y| {
            let (x, y) = (picture.x0 + (x as f64 + 0.5) * scale[0], picture.y0 + (y as f64 + 0.5) * scale[1]);
            seen.sample((x - part.x0) / part.width() * side as f64, (y - part.y0) / part.height() * side as f64)
        }))
    }

    /// The network's result for the surroundings of each head, with these.
    fn round(&self, heads: &[Head]) -> Result<Vec<(Rect, Raster<f32>)>, SeeError> {
        let one = |head: &Head| {
            let part = head.surroundings(self.view.part);
            Ok((part, self.at(part, Outside::Repeated, Tone::Own)?))
        };
        mapped(heads, &one).into_iter().collect()
    }

    /// Near each head what was seen in its surroundings (where these overlap, the maximum); elsewhere `beyond`.
    fn near(&self, round: &[(Rect, Raster<f32>)], beyond: &Raster<f32>) -> Raster<f32> {
        let picture = self.view.part;
        let mut near: Raster<Option<f32>> = beyond.map(|_| None);
        for (part, round) in round {
            let columns = picture.width() / round.width() as f64;
            let rows = picture.height() / round.height() as f64;
            near = Raster::from_fn(near.width(), near.height(), |x, y| {
                let (px, py) = (picture.x0 + (x as f64 + 0.5) * columns, picture.y0 + (y as f64 + 0.5) * rows);
                let is_inside = (part.x0..part.x1).contains(&px) && (part.y0..part.y1).contains(&py);
                let before = near.get(x, y);
                if is_inside { Some(before.unwrap_or(0.0).max(round.get(x, y))) } else { before }
            });
        }
        near.zip_map(beyond, Option::unwrap_or)
    }
}
