//! What was found in a photograph.

use crate::geometry::Rect;
use crate::raster::Raster;
use crate::source::{Landmarks, MaskRole};

/// What was found in a photograph, on its pixel grid (after EXIF orientation; x right, y down, pixel centres at halves).
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    /// Columns of the photograph.
    pub width: u32,
    /// Rows of the photograph.
    pub height: u32,
    /// The faces, largest first.
    pub faces: Vec<Face>,
    /// The people whose faces were found: 255 inside, with a soft edge, in the photograph's proportions, at most 1024 pixels on
    /// the longer side. `None` without a face: the network's person is then a guess (animals are found in pieces).
    pub subject: Option<Raster<u8>>,
    /// The people's regions, on the subject's grid. `None` without a face.
    pub regions: Option<Regions>,
    /// Nearness of each pixel of the subject: 65535 is the nearest, 0 the background; on the subject's grid. `None` without a
    /// face.
    pub depth: Option<Raster<u16>>,
}

/// Share of each pixel in each region, 0 to 255. All but `detail` add up to the subject.
#[derive(Clone, Debug, PartialEq)]
pub struct Regions {
    /// Bare skin: face, ears, neck, hands, shaved heads; and pearls on it.
    pub skin: Raster<u8>,
    /// Hair of the head, including long hair on shoulders.
    pub hair: Raster<u8>,
    /// Beards and moustaches.
    pub facial_hair: Raster<u8>,
    /// Hats, caps and scarves.
    pub headwear: Raster<u8>,
    /// Clothing and anything else worn below the chin.
    pub clothing: Raster<u8>,
    /// Eyes with their lids, brows, nose and mouth, and pearls, which need finer strokes; overlaps the other regions.
    pub detail: Raster<u8>,
}

impl Regions {
    /// Applies `change` to every region.
    #[must_use]
    pub fn map(&self, change: impl Fn(&Raster<u8>) -> Raster<u8>) -> Self {
        Self {
            skin: change(&self.skin),
            hair: change(&self.hair),
            facial_hair: change(&self.facial_hair),
            headwear: change(&self.headwear),
            clothing: change(&self.clothing),
            detail: change(&self.detail),
        }
    }
}

impl Sight {
    /// The subject and every region, by mask role.
    pub fn masks(&self) -> Vec<(MaskRole, &Raster<u8>)> {
        let subject = self.subject.iter().map(|subject| (MaskRole::Subject, subject));
        let regions = self.regions.iter().flat_map(|regions| {
            [
                (MaskRole::Skin, &regions.skin),
                (MaskRole::Hair, &regions.hair),
                (MaskRole::FacialHair, &regions.facial_hair),
                (MaskRole::Headwear, &regions.headwear),
                (MaskRole::Clothing, &regions.clothing),
                (MaskRole::Detail, &regions.detail),
            ]
        });
        subject.chain(regions).collect()
    }

    /// The subject at the photograph's own size.
    pub fn subject_at_full_size(&self) -> Option<Raster<u8>> {
        let subject = self.subject.as_ref()?.map(f32::from);
        Some(self.at_full_size(&subject).map(|v| v.round() as u8))
    }

    /// Enlarges a map of the photograph to its own size, bilinear.
    pub fn at_full_size(&self, map: &Raster<f32>) -> Raster<f32> {
        let (width, height) = (self.width as usize, self.height as usize);
        let (x_step, y_step) = (map.width() as f64 / f64::from(self.width), map.height() as f64 / f64::from(self.height));
        Raster::from_fn(width, height, |x, y| map.sample((x as f64 + 0.5) * x_step, (y as f64 + 0.5) * y_step))
    }
}

/// One face.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The detector's box: from the brows to the chin, upright.
    pub bounds: Rect,
    /// The detector's score, 0.75 to 1.
    pub score: f64,
    /// Its landmarks and irises.
    pub landmarks: Landmarks,
}
