//! A region seen alone: what lies beyond its border steers nothing.

use super::Parts;
use crate::field::nearest_seed;
use crate::raster::{Raster, erode};
use crate::source::{Placement, Portrait};

impl Parts {
    /// The portrait in which every place beyond a part looks like the nearest place inside, so that no edge lies on the part's border:
    /// dots of a cheek do not follow the collar. Nothing changes if no place is inside. The border of the subject stays.
    pub fn alone(&self, part: usize, portrait: &Portrait) -> Portrait {
        let mut alone = portrait.clone();
        let Some(nearest) = nearest_seed(&self.own(part, &portrait.placement)) else { return alone };
        alone.tone = continued(&portrait.tone, &nearest);
        alone.lightness = continued(&portrait.lightness, &nearest);
        alone.light = continued(&portrait.light, &nearest);
        alone.depth = portrait.depth.as_ref().map(|depth| continued(depth, &nearest));
        alone
    }

    /// The pixels of another grid that belong to a part, 1 inside, without those at its border, which show some of what is beyond.
    fn own(&self, part: usize, placement: &Placement) -> Raster<u8> {
        erode(&self.share_on(part, placement).map(|share| u8::from(share > 0.5)), 2)
    }
}

fn continued<T: Copy + Default + Send + Sync>(raster: &Raster<T>, nearest: &Raster<u32>) -> Raster<T> {
    nearest.map(|place| raster.pixels()[place as usize])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;
    use crate::scene::Border;

    #[test]
    fn a_part_alone_has_no_edge_at_its_border() {
        let placement = Placement::new(Rect::new(0.0, 0.0, 40.0, 40.0), 5.0);
        let left = Raster::from_fn(200, 200, |x, _| f32::from(u8::from(x < 100)));
        let own = Parts::new(placement, &[(left, Border::Butt)]).own(1, &placement);
        assert!(own.get(90, 100) == 1 && own.get(110, 100) == 0);
        let lightness = Raster::from_fn(200, 200, |x, y| if x < 100 { 0.2 + 0.001 * y as f32 } else { 0.9 });
        let alone = continued(&lightness, &nearest_seed(&own).unwrap());
        assert_eq!(alone.get(50, 30), lightness.get(50, 30));
        assert_eq!(alone.get(180, 30), lightness.get(50, 30));
    }
}
