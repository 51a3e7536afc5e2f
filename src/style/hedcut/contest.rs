//! Where masks that are not sure meet, the strongest wins.

use crate::raster::Raster;

/// Gives each place to the strongest of the masks, of skin, which is the rest of the subject, and of paper; all are 0 to 1, and the winner is
/// above a half. Where three that are not sure meet, none is, and skin's dots would fill the seam. Where two meet nothing changes. Earlier
/// masks take from later ones.
pub(super) fn contest(subject: &Raster<f32>, masks: &mut [Option<Raster<f32>>]) {
    let mut skin = subject.clone();
    for mask in masks.iter_mut().flatten() {
        *mask = mask.zip_map(&skin, f32::min);
        skin = skin.zip_map(mask, |skin, mask| skin - mask);
    }
    let unclaimed = skin.zip_map(subject, |skin, subject| skin.max(1.0 - subject));
    let claims = masks.to_vec();
    for (i, mask) in masks.iter_mut().enumerate() {
        let Some(mask) = mask else { continue };
        let others = claims.iter().enumerate().filter(|(other, _)| *other != i).filter_map(|(_, other)| other.as_ref());
        let strongest = others.fold(unclaimed.clone(), |strongest, other| strongest.zip_map(other, f32::max));
        *mask = mask.zip_map(&strongest, |mask, strongest| 0.5 + 0.5 * (mask - strongest));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hair and cloth in one pixel, before and after.
    fn of(subject: f32, hair: f32, cloth: f32) -> [f32; 2] {
        let one = |v: f32| Raster::filled(1, 1, v);
        let mut masks = [Some(one(hair)), Some(one(cloth)), None];
        contest(&one(subject), &mut masks);
        [0, 1].map(|i| masks[i].as_ref().map_or(f32::NAN, |mask| mask.get(0, 0)))
    }

    #[test]
    fn no_seam_of_skin_is_left_where_three_meet() {
        let [hair, cloth] = of(1.0, 0.41, 0.36);
        assert!(hair > 0.5 && cloth < 0.5, "{hair} {cloth}");
        let [hair, cloth] = of(1.0, 0.2, 0.48);
        assert!(hair < 0.5 && cloth > 0.5, "{hair} {cloth}");
    }

    #[test]
    fn where_two_meet_nothing_changes() {
        for share in [0.0, 0.3, 0.5, 0.8, 1.0] {
            assert!((of(1.0, 0.0, share)[1] - share).abs() < 1e-6 || share == 0.0, "cloth and skin");
            assert!((of(1.0, share, 1.0 - share)[0] - share).abs() < 1e-6, "hair and cloth");
            assert!((of(share, share, 0.0)[0] - share).abs() < 1e-6, "hair and paper");
        }
        assert_eq!(of(1.0, 1.0, 1.0), [1.0, 0.0], "a place that is painted as both is hair");
    }
}
