//! The tone of a face on the print compared with the photograph's.

use super::kept;
use super::print::Print;
use super::sitter::{Sitter, inside, median};
use drypoint::drawing::Page;
use drypoint::geometry::Point;
use drypoint::raster::{Raster, dilate, gaussian_blur, reduce};
use drypoint::source::{Crop, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget, outlines};

/// Ink below which a pixel is bare, and above which it is black.
const BARE: f32 = 0.03;
const BLACK: f32 = 0.85;
/// Standard deviation of the blur for measuring ink, and width of the halo, in pitches.
const BLUR: f64 = 2.0;
const HALO: f64 = 2.0;
/// Radius, in pitches, up to which a gap in the soft edge of hair is not outside: single pixels between two hairs are no halo.
const GAP: f64 = 0.25;
/// Width of the skin around a feature that it is compared with, in widths of the face.
const ROUND: f64 = 0.08;
/// Contrast of the photograph, in L*/100, below which its sign is unreliable.
const LEAST_CONTRAST: f64 = 0.01;
/// Invisible ink on paper: the round edges of the outermost dots.
const NO_INK: f64 = 0.005;

/// Measurements of one face.
pub struct FaceTone {
    /// Fractions of the face.
    bare: f64,
    black: f64,
    /// Median ink and median L*/100 within the outline of the face.
    ink: f64,
    lightness: f64,
    eyes: Contrast,
    lips: Contrast,
    /// Mean ink just outside the silhouette.
    halo: f64,
}

/// How much darker a feature is than the skin around it.
#[derive(Clone, Copy)]
struct Contrast {
    /// In L*/100.
    photograph: f64,
    /// In ink.
    drawing: f64,
}

impl Contrast {
    fn has_its_sign(self) -> bool {
        self.photograph * self.drawing > 0.0 || self.photograph.abs() < LEAST_CONTRAST
    }

    /// Checked only if the drawing's sign is the photograph's.
    fn is_enough(self) -> bool {
        !self.has_its_sign() || self.drawing.abs() >= self.photograph.abs() - 0.005
    }
}

/// The face on the print's grid, halved, so that resvg's error on small dots is halved too.
struct Weighed<'a> {
    sitter: &'a Sitter,
    print: &'a Print,
    portrait: Portrait,
    ink: Raster<f32>,
    skin: Raster<f32>,
}

pub fn measured(sitter: &Sitter, print: &Print) -> FaceTone {
    let weighed = Weighed::new(sitter, print);
    let face = weighed.face();
    let blurred = blurred_within(&weighed.ink, &face, (BLUR * weighed.pitch()) as f32);
    let ink = within(&blurred, &face);
    let share = |is_so: fn(f32) -> bool| ink.iter().filter(|v| is_so(**v)).count() as f64 / ink.len() as f64;
    let eyes = [&outlines::RIGHT_EYE, &outlines::LEFT_EYE].map(|eye| weighed.contrast(eye));
    let mean = |of: fn(&Contrast) -> f64| 0.5 * (of(&eyes[0]) + of(&eyes[1]));
    FaceTone {
        bare: share(|v| v < BARE),
        black: share(|v| v > BLACK),
        ink: median(ink.iter().copied().map(f64::from).collect()),
        lightness: median(within(&weighed.portrait.lightness, &face).into_iter().map(f64::from).collect()),
        eyes: Contrast { photograph: mean(|c| c.photograph), drawing: mean(|c| c.drawing) },
        lips: weighed.contrast(&outlines::LIPS),
        halo: weighed.halo(),
    }
}

impl<'a> Weighed<'a> {
    fn new(sitter: &'a Sitter, print: &'a Print) -> Self {
        let ink = reduce(&print.ink(), 2);
        let placement = Placement { picture: print.picture, columns: ink.width(), rows: ink.height() };
        let page = Page::new(print.picture.width(), print.picture.height());
        let (photograph, crop) = (&sitter.photograph, Crop::all(&sitter.photograph));
        let (target, curve) = (ToneTarget::Lightness, ToneCurve::default());
        let mut portrait = Portrait::new(photograph, crop, page, placement, target, curve).expect("it was decoded");
        for (role, mask) in sitter.sight.masks() {
            portrait.add_mask(role, &Photograph::from_grey(mask), photograph, crop).expect("it is of the photograph");
        }
        let skin = portrait.masks[&MaskRole::Skin].clone();
        Self { sitter, print, portrait, ink, skin }
    }

    /// The pitch in pixels.
    fn pitch(&self) -> f64 {
        self.print.pitch.expect("dots have a pitch") * 0.5 * self.print.pixels_per_mm
    }

    /// The inside of a contour of the face.
    fn inside(&self, indices: &[usize]) -> Raster<u8> {
        let line = self.sitter.face().line(indices);
        let outline: Vec<Point> = line.iter().map(|p| (self.print.place(*p).to_vec2() * 0.5).to_point()).collect();
        inside(&outline, self.ink.width(), self.ink.height())
    }

    /// The part of the face's outline that belongs to the person.
    fn face(&self) -> Raster<u8> {
        self.inside(&outlines::OVAL).zip_map(&self.portrait.subject, |inside, subject| inside * u8::from(subject >= 0.5))
    }

    /// Contrast of a feature with the skin around it, without other features.
    fn contrast(&self, indices: &[usize]) -> Contrast {
        let feature = self.inside(indices);
        let reach = ROUND * self.sitter.face().width() * 0.5 * self.print.scale();
        let round = dilate(&feature, reach.round() as usize);
        let bare_skin = self.skin.zip_map(&self.portrait.masks[&MaskRole::Detail], |s, d| u8::from(s > 0.5 && d < 0.02));
        let round = round.zip_map(&bare_skin, |near, skin| near & skin);
        Contrast {
            photograph: mean_in(&self.portrait.lightness, &round) - mean_in(&self.portrait.lightness, &feature),
            drawing: mean_in(&self.ink, &feature) - mean_in(&self.ink, &round),
        }
    }

    /// Mean ink outside the person, near the silhouette.
    fn halo(&self) -> f64 {
        let person = self.portrait.subject.map(|v| u8::from(v >= 0.5));
        let near = dilate(&person, (HALO * self.pitch()).round() as usize);
        let gap = (GAP * self.pitch()).round() as usize;
        let person = dilate(&self.portrait.subject.map(|v| u8::from(v >= 0.01)), gap);
        let outside = dilate(&person.map(|v| 1 - v), gap);
        let ring = near.zip_map(&outside, |near, outside| near * outside);
        mean_in(&self.ink, &ring)
    }
}

/// A blur that ignores everything outside.
fn blurred_within(raster: &Raster<f32>, inside: &Raster<u8>, sigma: f32) -> Raster<f32> {
    let weight = inside.map(f32::from);
    let sum = gaussian_blur(&raster.zip_map(&weight, |v, w| v * w), sigma);
    sum.zip_map(&gaussian_blur(&weight, sigma), |sum, weight| if weight > 1e-6 { sum / weight } else { 0.0 })
}

fn within(raster: &Raster<f32>, inside: &Raster<u8>) -> Vec<f32> {
    raster.pixels().iter().zip(inside.pixels()).filter(|(_, inside)| **inside == 1).map(|(v, _)| *v).collect()
}

fn mean_in(raster: &Raster<f32>, inside: &Raster<u8>) -> f64 {
    let values = within(raster, inside);
    values.iter().copied().map(f64::from).sum::<f64>() / values.len().max(1) as f64
}

/// A row for each portrait, then the guarantees for all.
pub fn report(tones: &[(&str, FaceTone)]) {
    println!(
        "{:16} {:>5} {:>6} {:>5} {:>5}   {:>12}   {:>12} {:>6}",
        "", "bare", "black", "ink", "L*", "eyes / photo", "lips / photo", "halo"
    );
    for (name, tone) in tones {
        let FaceTone { bare, black, ink, lightness, eyes, lips, halo } = tone;
        let missed = missed(tone);
        println!(
            "{name:16} {:4.1}% {:5.1}% {ink:5.2} {:5.1}   {:5.2} / {:4.2}   {:5.2} / {:4.2} {halo:6.4}   {}",
            100.0 * bare,
            100.0 * black,
            100.0 * lightness,
            eyes.drawing,
            eyes.photograph,
            lips.drawing,
            lips.photograph,
            if missed.is_empty() { String::new() } else { format!("MISSED {}", missed.join(", ")) }
        );
    }
    for (what, promise) in PROMISES {
        let kept_by = tones.iter().filter(|(_, tone)| promise(tone)).count();
        println!("{what:58} {kept_by}/{}   {}", tones.len(), kept(kept_by == tones.len()));
    }
    let ink: Vec<f64> = tones.iter().map(|(_, tone)| -tone.ink).collect();
    let lightness: Vec<f64> = tones.iter().map(|(_, tone)| tone.lightness).collect();
    let correlation = correlation(&ranks(&ink), &ranks(&lightness));
    println!(
        "{:58} {correlation:.2}   at least 0.85: {}",
        "rank correlation of median white and median L*",
        kept(correlation >= 0.85)
    );
}

/// A guarantee, and whether a face meets it.
type Promise = (&'static str, fn(&FaceTone) -> bool);

/// The guarantees for every face.
const PROMISES: [Promise; 5] = [
    ("bare, 2 to 25 % of the face", |tone| (0.02..=0.25).contains(&tone.bare)),
    ("black, at most 5 % of the face", |tone| tone.black <= 0.05),
    ("eyes, contrast at least the photograph's", |tone| tone.eyes.is_enough()),
    ("lips, contrast at least the photograph's", |tone| tone.lips.is_enough()),
    ("halo, no ink outside the silhouette", |tone| tone.halo <= NO_INK),
];

fn missed(tone: &FaceTone) -> Vec<&'static str> {
    let broken = PROMISES.iter().filter(|(_, promise)| !promise(tone));
    broken.map(|(what, _)| what.split(',').next().unwrap_or_default()).collect()
}

/// The rank of each value; equal values share their mean.
fn ranks(values: &[f64]) -> Vec<f64> {
    let rank = |v: &f64| {
        let below = values.iter().filter(|other| *other < v).count();
        let equal = values.iter().filter(|other| *other == v).count();
        below as f64 + 0.5 * (equal as f64 - 1.0)
    };
    values.iter().map(rank).collect()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let product: f64 = a.iter().zip(b).map(|(x, y)| (x - ma) * (y - mb)).sum();
    let square = |values: &[f64], mean: f64| values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    product / (square(a, ma) * square(b, mb)).sqrt()
}
