//! Everything that decides a drawing: the photograph, what is known of it, its place on the sheet, the style and its settings.

use super::arguments::{PictureOptions, PlacingOptions};
use super::crop;
use super::eyes;
use super::failure::Failure;
use super::known::{self, Known, Wanted};
use super::layout::{Layout, lay_out, reach_of};
use super::looking;
use super::manner::{Manner, find_style, fineness, given, resolved};
use super::masks::RoleMask;
use super::messages::say;
use super::palette::{APART, AT_ONCE, Palette};
use super::proof;
use super::regions::{self, Region};
use super::remedies::advised;
use super::roles::{role_names, roles_of, styles_with_role};
use super::seen_stages;
use crate::drawing::{Drawing, Page};
use crate::geometry::{Affine, Rect};
use crate::plot::{Profile, mount};
use crate::raster::Raster;
use crate::source::{DepthSense, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use crate::style::{self, Cost, Observer, Settings, Style, StyleError};
use crate::tone::portrait_tone;
use image::DynamicImage;

/// Minimum number of pitches across the short side of a picture in advice: with fewer, nothing is left of a face.
const LEAST_PITCHES: f64 = 25.0;
/// The spacing of marks, in millimetres, that is assumed of a style without a pitch.
pub(super) const UNKNOWN_PITCH: f64 = 1.0;

/// Everything that determines a drawing.
pub(super) struct Task<'a> {
    pub options: &'a PictureOptions,
    pub manner: Manner,
    /// Regions in manners of their own, later ones over earlier ones.
    pub regions: Vec<Region>,
    pub photograph: Photograph,
    /// Columns and rows of the photograph itself, of which that may be a small copy.
    pub size: [u32; 2],
    pub layout: Layout,
    /// The parameters given by the user.
    given: Vec<(String, String)>,
    /// The pens, if it is drawn in colours.
    pub palette: Option<Palette>,
}

impl<'a> Task<'a> {
    pub(super) fn placed(
        options: &'a PictureOptions,
        placing: &PlacingOptions,
        reach: impl Fn(&Page) -> Option<Rect>,
    ) -> Result<Self, Failure> {
        let style = find_style(&options.style)?;
        let given = given(options);
        let settings = resolved(style, &given, options)?;
        if options.black >= options.white {
            return Err(Failure::Usage(format!("--black {} must be below --white {}", options.black, options.white)));
        }
        let mask_files: Vec<(MaskRole, &str)> = options
            .mask
            .iter()
            .map(|(role, file)| Ok((role_of(style, role, options)?, file.as_str())))
            .collect::<Result<_, Failure>>()?;
        if let Some((role, _)) =
            options.mask.iter().enumerate().find_map(|(i, mask)| options.mask[..i].iter().find(|m| m.0 == mask.0))
        {
            return Err(Failure::Usage(format!("--mask {role}= is given twice")));
        }
        if options.depth.is_some() && !style.card().uses_depth {
            let able: Vec<&str> = style::STYLES.iter().filter(|s| s.card().uses_depth).map(|s| s.name()).collect();
            let able = able.join(", ");
            return Err(Failure::Usage(format!("--depth: {} does not use a depth map; it is for {able}", style.name())));
        }
        let proof = proof::photograph(&options.photo)?;
        let (size, photograph) = (proof.size, proof.photograph);
        let painted = mask_files.into_iter().map(|(role, file)| RoleMask::read(role, file));
        let painted: Vec<RoleMask> = painted.collect::<Result<_, Failure>>()?;
        let seen = looking::seen(options, &photograph)?;
        let mut notices = Vec::new();
        let regions = regions::regions(options, &photograph, &seen, &painted, &mut notices)?;
        let own = painted.into_iter().filter(|mask| known::takes(style, mask.role)).collect();
        let mut known = known::of(options, style, &photograph, own, seen)?;
        known.notices.extend(notices);
        // Marks on the picture's border extend beyond it by less than a pitch.
        let pitch = settings.pitch().unwrap_or(UNKNOWN_PITCH);
        let crop = crop::part(options, &photograph, size, &known.faces)?;
        let layout = lay_out(options, placing, (crop, &known.faces), |page| Some(reach(page)?.inset(-pitch)))?;
        if style.card().leaves_out_background && !options.draft {
            known.notices.extend(eyes::eyes_notice(&known.faces, &layout, pitch, options.crop));
        }
        let palette = Palette::read(options, || roughly(options, &photograph, &layout))?;
        known.notices.extend(palette.iter().filter_map(|palette| palette.choice.clone()));
        let manner = Manner { style, settings, known, seed: options.seed, fineness: fineness(options) };
        Ok(Self { options, manner, regions, photograph, size, layout, given, palette })
    }

    /// True if the picture with other options, including all its ink, would lie within the machine's reach.
    pub(super) fn would_fit(&self, picture: &PictureOptions, placing: &PlacingOptions, profile: &Profile) -> bool {
        let Ok(crop) = crop::part(picture, &self.photograph, self.size, &self.manner.known.faces) else { return false };
        let Ok(layout) = lay_out(picture, placing, (crop, &self.manner.known.faces), reach_of(Some(profile))) else {
            return false;
        };
        let (width, height) = layout.sheet();
        let page = Page { width, height, ..layout.page };
        let drawable = mount(profile, &page).map(|mounting| mounting.drawable(&page).inflate(0.01, 0.01));
        drawable.is_ok_and(|drawable| drawable.union(layout.placed()) == drawable)
    }

    /// Prints the decisions made from what was found. Called after the work, so that a failure has a single message.
    pub(super) fn tell(&self, is_quiet: bool) {
        self.manner.known.notices.iter().filter(|_| !is_quiet).for_each(|notice| say!("drypoint: {notice}"));
    }

    /// Pictures of what was found in the photograph, by name.
    pub(super) fn seen(&self) -> Result<Vec<(&'static str, DynamicImage)>, Failure> {
        seen_stages::pictures(&self.photograph, &self.manner.known).map_err(|error| Failure::about(&self.options.photo)(&error))
    }

    /// The parameters with another pitch; `None` if the style does not accept it.
    pub(super) fn settings_at(&self, pitch: f64) -> Option<Settings> {
        let mut given = self.given.clone();
        given.push(("pitch".to_owned(), pitch.to_string()));
        Settings::resolve(self.manner.style.name(), self.manner.style.parameters(), &given).ok()
    }

    /// Takes another pitch, as if it were given.
    pub(super) fn set_pitch(&mut self, pitch: f64) {
        if let Some(settings) = self.settings_at(pitch) {
            self.manner.settings = settings;
            self.given.push(("pitch".to_owned(), pitch.to_string()));
        }
    }

    /// The parameters given by the user.
    pub(super) fn given(&self) -> &[(String, String)] {
        &self.given
    }

    /// The largest pitch that the style accepts and that leaves the picture recognisable.
    pub(super) fn largest_useful_pitch(&self) -> f64 {
        let pitch = self.manner.style.parameters().iter().find(|parameter| parameter.name == "pitch");
        let most = pitch.and_then(|parameter| parameter.kind.ends()).map_or(f64::INFINITY, |ends| ends[1]);
        most.min(self.layout.picture.width().min(self.layout.picture.height()) / LEAST_PITCHES)
    }

    /// The smallest short side, in millimetres, that leaves the picture recognisable at this pitch.
    pub(super) fn smallest_useful_side(&self) -> f64 {
        LEAST_PITCHES * self.manner.settings.pitch().unwrap_or(UNKNOWN_PITCH)
    }

    /// Memory and time for drawing a picture, including the photographs already in memory.
    pub(super) fn cost(&self, settings: &Settings, picture: Rect) -> Cost {
        let cost =
            |manner: &Manner, settings: &Settings| manner.style.cost(settings, picture, manner.resolution(settings, picture));
        let regions = self.regions.iter().map(|region| cost(&region.manner, &region.manner.settings));
        // One part is drawn after the other.
        let cost = regions.fold(cost(&self.manner, settings), |all, one| Cost {
            bytes: all.bytes.max(one.bytes),
            seconds: all.seconds + one.seconds,
            ..all
        });
        let unused = &self.manner.known.unused;
        let known = &self.manner.known;
        let masks = known.masks.iter().chain(&known.people).chain(&unused.masks).map(|mask| &*mask.mask);
        let others = masks.chain(known.depth.iter().chain(&unused.depth).map(|depth| &*depth.map));
        let photographs: usize = others.chain([&self.photograph]).map(Photograph::bytes).sum();
        let at_once = if self.palette.is_some() && APART.contains(&self.manner.style.name()) { AT_ONCE } else { 1 };
        Cost { bytes: cost.bytes * at_once as f64 + photographs as f64, ..cost }
    }

    /// Where the photograph lies on the turned sheet: from its pixels to millimetres.
    pub(super) fn to_sheet(&self) -> Affine {
        let Layout { crop, picture, page, turning } = self.layout;
        let scale = picture.width() / crop.width;
        let placed = Affine::translate((picture.x0, picture.y0)) * Affine::scale(scale) * Affine::translate((-crop.x, -crop.y));
        let [across, down] = [(self.photograph.width(), self.size[0]), (self.photograph.height(), self.size[1])]
            .map(|(copy, itself)| f64::from(copy) / f64::from(itself));
        turning.matrix(&page) * placed * Affine::scale_non_uniform(across, down)
    }

    /// Working resolution in pixels per millimetre.
    pub(super) fn resolution(&self, settings: &Settings, picture: Rect) -> f64 {
        self.manner.resolution(settings, picture)
    }

    pub(super) fn draw(&self, observer: &dyn Observer) -> Result<Drawing, Failure> {
        for warning in &self.photograph.info.warnings {
            observer.warn(&format!("{}: {warning}", self.options.photo));
        }
        let picture = self.layout.picture;
        self.draw_in(&self.manner.settings, Placement::new(picture, self.resolution(&self.manner.settings, picture)), observer)
    }

    /// Draws the picture with other parameters or at another placement.
    pub(super) fn draw_in(&self, settings: &Settings, placement: Placement, observer: &dyn Observer) -> Result<Drawing, Failure> {
        observer.begin("photograph");
        let drawing = if self.palette.is_some() {
            self.coloured(settings, placement, observer)?
        } else if self.regions.is_empty() {
            let portrait = self.portrait(&self.manner.known, placement)?;
            self.manner.style.draw(&portrait, settings, self.options.seed, observer).map_err(|error| self.undrawn(&error))?
        } else {
            self.composed(settings, placement, observer)?
        };
        Ok(self.layout.turning.turned(drawing))
    }

    /// The failure for a style's error.
    pub(super) fn undrawn(&self, error: &StyleError) -> Failure {
        match error {
            StyleError::Interrupted => Failure::Interrupted,
            nothing => Failure::Work(format!("{}: {}", self.options.photo, advised(nothing))),
        }
    }

    /// The photograph at a working resolution, with what a style knows of it.
    pub(super) fn portrait(&self, known: &Known, placement: Placement) -> Result<Portrait, Failure> {
        let target = if let Wanted::Own(target) = known.tone { target } else { ToneTarget::Lightness };
        let curve =
            ToneCurve { black: self.options.black as f32, white: self.options.white as f32, gamma: self.options.gamma as f32 };
        let about = |name: &str| {
            let name = name.to_owned();
            move |error: crate::source::SourceError| Failure::about(&name)(&advised(&error))
        };
        let mut portrait = Portrait::new(&self.photograph, self.layout.crop, self.layout.page, placement, target, curve)
            .map_err(about(&self.options.photo))?;
        let (photograph, crop) = (&self.photograph, self.layout.crop);
        for RoleMask { role, file, mask } in &known.masks {
            let name = file.as_deref().unwrap_or(&self.options.photo);
            portrait.add_mask(*role, mask, photograph, crop).map_err(about(name))?;
        }
        if let Some(RoleMask { file, mask, .. }) = &known.people {
            portrait.add_people(mask, photograph, crop).map_err(about(file.as_deref().unwrap_or(&self.options.photo)))?;
        }
        if let Some(depth) = &known.depth {
            let sense = if self.options.depth_far_white { DepthSense::FarWhite } else { DepthSense::NearWhite };
            let name = depth.file.as_deref().unwrap_or(&self.options.photo);
            portrait.add_depth(&depth.map, sense, photograph, crop).map_err(about(name))?;
            if self.options.depth.is_none() {
                portrait.set_depth_found();
            }
        }
        portrait.add_faces(&known.faces, photograph, crop).map_err(about(&self.options.photo))?;
        if let Wanted::Portrait(strength) = known.tone
            && let Some(tone) = portrait_tone(&portrait, strength as f32)
        {
            portrait.set_portrait_tone(&tone, curve);
        }
        portrait.open_highlights();
        Ok(portrait)
    }
}

/// The role of a mask that the style, the tone or a region uses.
fn role_of(style: &dyn Style, name: &str, options: &PictureOptions) -> Result<MaskRole, Failure> {
    let styles = options.region.iter().filter_map(|region| style::find(region.style.as_deref()?));
    let is_used = options.region.iter().any(|region| region.mask == name)
        || styles.into_iter().any(|style| roles_of(style).any(|(known, _)| known == name));
    if let Some(role) = MaskRole::named(name).filter(|_| is_used) {
        return Ok(role);
    }
    let refuse = || {
        let others: Vec<&str> = styles_with_role(name).map(Style::name).collect();
        let others = if others.is_empty() { String::new() } else { format!("; {name} is for {}", others.join(", ")) };
        Failure::Usage(format!("--mask {name}: {} takes {}{others}", style.name(), role_names(style)))
    };
    roles_of(style).find(|(known, _)| *known == name).map(|(_, role)| role).ok_or_else(refuse)
}

/// The light of the picture's part that is drawn, small.
fn roughly(options: &PictureOptions, photograph: &Photograph, layout: &Layout) -> Result<Raster<[f32; 3]>, Failure> {
    const SIDE: f64 = 256.0;
    let Layout { page, picture, crop, .. } = *layout;
    let placement = Placement::new(picture, SIDE / picture.width().max(picture.height()));
    let portrait = Portrait::new(photograph, crop, page, placement, ToneTarget::Linear, ToneCurve::default());
    Ok(portrait.map_err(|error| Failure::about(&options.photo)(&error))?.light)
}
