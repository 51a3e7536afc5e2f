//! The colours of all overprints of a set of pens: measured where they were, predicted otherwise.

use super::bands::{BANDS, Bands, smoothest};
use super::pens::{Opacity, PenSet};
use super::space::rgb_to_xyz;

/// Bounds of a measured overprint's correction, and the least reflectance.
const CORRECTION: f32 = 6.0;
const LEAST: f32 = 1e-4;

/// Reflectance of each overprint: index `s` has the pens whose bits are set, 0 the bare paper.
///
/// Transparent inks multiply in each band what they leave of the paper's light; an opaque ink hides what lies below it. What
/// measured pairs differ from this is carried over to the overprints that contain them.
pub(super) fn overprints(set: &PenSet) -> Vec<Bands> {
    let paper = smoothest(rgb_to_xyz(set.paper().colour));
    let inks: Vec<Bands> = set.pens().iter().map(|pen| smoothest(rgb_to_xyz(pen.colour))).collect();
    let covers: Vec<bool> = set.pens().iter().map(|pen| pen.opacity == Opacity::Opaque).collect();
    let predicted: Vec<Bands> = (0..1usize << inks.len()).map(|pens| laid(pens, &paper, &inks, &covers)).collect();
    let measured: Vec<(usize, Bands)> = set
        .overprints()
        .iter()
        .map(|o| (o.pens.iter().fold(0, |bits, pen| bits | 1 << pen), smoothest(rgb_to_xyz(o.colour))))
        .collect();
    (0..predicted.len()).map(|pens| corrected(pens, &predicted, &measured)).collect()
}

fn laid(pens: usize, paper: &Bands, inks: &[Bands], covers: &[bool]) -> Bands {
    let mut light = *paper;
    for i in (0..inks.len()).filter(|i| pens >> i & 1 == 1) {
        for band in 0..BANDS {
            let is_alone = pens == 1 << i;
            light[band] = if covers[i] || is_alone {
                inks[i][band]
            } else {
                light[band] * (inks[i][band] / paper[band].max(LEAST)).min(1.0)
            };
        }
    }
    light.map(|v| v.max(LEAST))
}

fn corrected(pens: usize, predicted: &[Bands], measured: &[(usize, Bands)]) -> Bands {
    if let Some((_, colour)) = measured.iter().find(|(of, _)| *of == pens && pens.count_ones() > 1) {
        return colour.map(|v| v.max(LEAST));
    }
    let mut light = predicted[pens];
    for (of, colour) in measured.iter().filter(|(of, _)| of & pens == *of && of.count_ones() == 2) {
        for band in 0..BANDS {
            let ratio = colour[band].max(LEAST) / predicted[*of][band];
            light[band] = (light[band] * ratio.clamp(1.0 / CORRECTION, CORRECTION)).clamp(LEAST, 1.1);
        }
    }
    light
}
