//! The paper that charcoal catches on.

use super::{Drawer, ForPens};
use crate::raster::{Raster, enlarge, paper_texture};

/// Pixels per grain: with fewer, small grains lose their shape; more cost time and bytes.
pub(super) const PIXELS_A_GRAIN: f64 = 5.0;
/// Scale of the coarser texture that the thesis blends in, in grains: clumps of two or three grains make a middle tone gritty.
const CLUMP: usize = 2;
/// From one pen's part of a shared sheet to the next one's, in pixels: eight grains and more, where the texture no longer knows of itself.
const STEP: (usize, usize) = (43, 31);
/// Pens that share a sheet.
const MOST_PENS: u64 = 8;

/// Textures of one sheet of paper, larger than the picture: each pen meets another part of it.
pub(super) struct Sheet {
    /// Where the random numbers of the drawing start; a pen's differ from it by the pen's number.
    seed: u64,
    tooth: Raster<f32>,
    clumps: Raster<f32>,
}

impl Drawer<'_> {
    /// The paper's tooth and its clumps, 0 to 1.
    pub(super) fn paper(&self) -> (Raster<f32>, Raster<f32>) {
        let (width, height) = self.paper_size();
        let Some(shared) = self.portrait.prepared.get::<ForPens>() else { return self.textures(width, height) };
        let sheet = &shared.sheet;
        let pen = ((self.seed ^ sheet.seed) % MOST_PENS) as usize;
        let (columns, rows) = (pen * STEP.0..pen * STEP.0 + width, pen * STEP.1..pen * STEP.1 + height);
        (sheet.tooth.part(&columns, &rows), sheet.clumps.part(&columns, &rows))
    }

    /// A sheet large enough that each pen has its own part.
    pub(super) fn paper_for_pens(&self) -> Sheet {
        let (width, height) = self.paper_size();
        let more = MOST_PENS as usize - 1;
        let (tooth, clumps) = self.textures(width + more * STEP.0, height + more * STEP.1);
        Sheet { seed: self.seed, tooth, clumps }
    }

    fn paper_size(&self) -> (usize, usize) {
        let picture = self.portrait.placement.picture;
        let count = |length: f64| ((length / self.parameters.grain.0 * PIXELS_A_GRAIN).round() as usize).max(4);
        (count(picture.width()), count(picture.height()))
    }

    fn textures(&self, width: usize, height: usize) -> (Raster<f32>, Raster<f32>) {
        let texture = |width, height, salt: u64| paper_texture(width, height, PIXELS_A_GRAIN as f32, self.seed ^ salt);
        // Clumps need fewer pixels.
        let clumps = texture(width.div_ceil(CLUMP), height.div_ceil(CLUMP), 0xc1a9);
        (texture(width, height, 0x7007), enlarge(&clumps, CLUMP, width, height))
    }

    /// The paper's tooth, finer on the skin of people whose faces are known, 0 to 1: a hand presses smaller grains there.
    pub(super) fn finer_in_faces(&self, tooth: Raster<f32>, skin: &Raster<f32>) -> Raster<f32> {
        /// Size of the grains on skin, as a share of the others'.
        const FINE_GRAIN: f32 = 0.6;
        let Some([columns, rows]) = skin.extent_above(0.5).filter(|_| !self.portrait.faces.is_empty()) else { return tooth };
        let (width, height) = (tooth.width(), tooth.height());
        let (fx, fy) = (skin.width() as f64 / width as f64, skin.height() as f64 / height as f64);
        let (left, top) = ((columns.start as f64 / fx) as usize, (rows.start as f64 / fy) as usize);
        let (wide, high) = ((columns.len() as f64 / fx) as usize + 2, (rows.len() as f64 / fy) as usize + 2);
        let fine = paper_texture(wide, high, FINE_GRAIN * PIXELS_A_GRAIN as f32, self.seed ^ 0xf17e);
        Raster::from_fn(width, height, |x, y| {
            let is_in_box = (left..left + wide).contains(&x) && (top..top + high).contains(&y);
            let is_fine = is_in_box && skin.sample((x as f64 + 0.5) * fx, (y as f64 + 0.5) * fy) > 0.5;
            if is_fine { fine.get(x - left, y - top) } else { tooth.get(x, y) }
        })
    }
}
