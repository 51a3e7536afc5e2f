//! Painting with the strokes of continuous Glass patterns (Papari and Petkov 2009; Papari 2009, chapter 7).

mod body;
mod colour;
mod cost;
mod detail;
mod discrete;
mod hairs;
mod noise;
mod one_pen;
mod painting;
mod parameters;
mod people;
mod transform;
mod underpainting;
mod visible;

use super::{Cost, Picture, Request, Settings, Style, StyleCard, StyleError};
use crate::drawing::{Drawing, Layer};
use crate::elementary::Elementary as _;
use crate::field::{Flow, glass_pattern, line_integral_convolution};
use crate::geometry::{Millimetres, Point, Rect};
use crate::raster::{Raster, anisotropic_diffusion, edge_preserving, equalised, fast_gaussian, gradient, structure_tensor};
use crate::source::{MaskRole, luminance};
use parameters::{CARD, GlassParameters, Gradient, Manner, Strokes};
use people::{People, along};

/// Change of colour per pixel at which diffusion stops: 6 of 255 steps. At half of it skin keeps its texture and the strokes whirl in
/// every pore; at three times it the astronaut's collar loses its corners.
const DIFFUSION_CONTRAST: f32 = 0.024;

/// Blur before the gradient that fine strokes follow, as a share of that for the others.
const FINE_FORMS: f32 = 0.35;

/// Working resolution where eyes and mouths are known, in the usual one: at 1 pupils are blots, at 2 a painting takes twice the time.
const FINER_PIXELS: f64 = 1.3;
/// How much of the photograph's own texture stays in eyes and mouths.
const KEPT_DETAIL: f32 = 0.8;
/// And how much on skin and hair, where smoothing alone makes patches of highlights.
const KEPT_SKIN: f32 = 0.4;

/// The style.
pub(super) struct Glass;

impl Style for Glass {
    fn card(&self) -> &StyleCard {
        &CARD
    }

    fn pixels_per_mm(&self, settings: &Settings, masks: &[MaskRole]) -> f64 {
        let parameters = GlassParameters::new(settings);
        let finer = if parameters.strokes == Strokes::Fitted && masks.contains(&MaskRole::Detail) { FINER_PIXELS } else { 1.0 };
        finer * parameters.pixels_per_mm()
    }

    fn cost(&self, settings: &Settings, picture: Rect, pixels_per_mm: f64) -> Cost {
        cost::cost(&Self::painting(settings, picture), picture, pixels_per_mm)
    }

    fn sketch(&self, request: &Request<'_>) -> Result<Drawing, StyleError> {
        let parameters = Self::painting(request.settings, request.portrait.placement.picture);
        request.drawer(parameters).draw()
    }
}

impl Glass {
    /// The values for a picture. No stroke is longer than its diagonal, since the frame in which strokes start is as wide as they are
    /// long.
    fn painting(settings: &Settings, picture: Rect) -> GlassParameters {
        let mut painting = GlassParameters::new(settings);
        painting.length = painting.length.min(Millimetres(picture.width().hypotenuse(picture.height())));
        painting
    }
}

type Drawer<'a> = super::Drawer<'a, GlassParameters>;

/// Common input of all manners of drawing, with a frame around the picture so that strokes can start beyond its border.
struct Ground {
    /// Pixels of the frame on each side.
    margin: usize,
    /// The smoothed picture's channels, framed.
    smoothed: Vec<Raster<f32>>,
    /// The subject, framed.
    subject: Raster<f32>,
    /// The direction of strokes, framed; none outside the subject; flat parts take that of their surroundings.
    flow: Flow,
    /// The direction of fine strokes, which also follow small forms.
    fine_flow: Flow,
    /// Where people are, without the frame.
    people: Option<People>,
}

impl Ground {
    /// True if a disc around a place, in framed pixels, lies inside the subject: a dab on its border would stick out in the background's
    /// colour.
    fn holds(&self, middle: Point, radius: f64) -> bool {
        (0..8).all(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_4).sine_and_cosine();
            let (x, y) = (middle.x + radius * cos, middle.y + radius * sin);
            self.subject.clamped(x.floor() as isize, y.floor() as isize) >= 0.5
        })
    }
}

impl Drawer<'_> {
    /// The chapter's steps in order.
    fn draw(&self) -> Result<Drawing, StyleError> {
        if self.portrait.subject.pixels().iter().all(|&s| s < 0.5) {
            return Err(StyleError::NothingToDraw(
                "nothing is inside the subject mask, which is nowhere more than half white; use a whiter mask".to_owned(),
            ));
        }
        let ground = self.ground();
        self.check()?;
        let layers = match self.parameters.manner() {
            Manner::Painting => painting::layers(self, &ground)?,
            Manner::OnePen => vec![one_pen::layer(self, &ground)?],
            Manner::Discrete => vec![discrete::layer(self, &ground)?],
        };
        Ok(Drawing { page: self.portrait.page, layers })
    }

    /// Edge-preserving smoothing and the flow (section 7.3).
    fn ground(&self) -> Ground {
        self.observer.begin("smoothing");
        let planes = colour::planes(&self.portrait.painted_light());
        let sigma = self.pixels(self.parameters.smoothing) as f32;
        let people = self.people();
        let smoothed = if sigma > 0.0 { self.smoothed(&planes, sigma, people.as_ref()) } else { planes };
        self.observer.picture("smoothed", &|| Picture::Grey(grey(&smoothed)));
        self.observer.begin("flow");
        let margin = self.pixels(self.parameters.length).ceil() as usize + 4;
        let subject = self.portrait.subject.framed(margin);
        let sigma = self.pixels(self.parameters.whirls) as f32;
        let framed = |flow: Flow| flow.completed().framed(margin).within(&subject);
        let (flow, fine_flow) = if let Some(laid) = self.laid_flow(&subject, margin) {
            (laid.within(&subject), laid.within(&subject))
        } else {
            let fine = self.flow(&smoothed, FINE_FORMS * sigma);
            let broad = self.flow(&smoothed, sigma);
            let broad = match &people {
                Some(people) => {
                    let behind = self.flow(&smoothed, people::BEHIND * sigma).completed();
                    let flow = broad.completed().mixed(&behind, &people.broad);
                    self.over_people(&flow, &grey(&smoothed), sigma)
                }
                None => broad,
            };
            let drawn = self.drawn_directions();
            let (broad, fine) = match &drawn {
                Some(drawn) => (along(&broad, drawn), along(&fine, drawn)),
                None => (broad, fine),
            };
            (framed(broad), framed(fine))
        };
        let smoothed = smoothed.iter().map(|plane| plane.framed(margin)).collect();
        Ground { margin, smoothed, subject, flow, fine_flow, people }
    }

    /// The picture without its texture; eyes and mouths keep theirs.
    fn smoothed(&self, planes: &[Raster<f32>], sigma: f32, people: Option<&People>) -> Vec<Raster<f32>> {
        let smooth = edge_preserving(planes, sigma, self.parameters.sharpness);
        let Some(people) = people else { return smooth };
        let kept = people.detail.zip_map(&people.broad, |detail, broad| (KEPT_DETAIL * detail).max(KEPT_SKIN * (1.0 - broad)));
        let mixed = |(smooth, plane): (&Raster<f32>, &Raster<f32>)| {
            let texture = plane.zip_map(smooth, |plane, smooth| plane - smooth).zip_map(&kept, |v, kept| kept * v);
            smooth.zip_map(&texture, |smooth, texture| smooth + texture)
        };
        smooth.iter().zip(planes).map(mixed).collect()
    }

    /// A transform's flow instead of the photograph's (figure 7.4); none with `transform=photo`.
    fn laid_flow(&self, framed: &Raster<f32>, margin: usize) -> Option<Flow> {
        let picture = self.portrait.placement.picture;
        let half = 0.5 * picture.width().min(picture.height());
        let margin = margin as f64;
        let velocity = |p: Point| {
            let place = self.portrait.placement.to_page(Point::new(p.x - margin, p.y - margin));
            self.parameters.transform.velocity(place - picture.center(), half)
        };
        velocity(Point::ORIGIN)?;
        Some(Flow::from_fn(framed.width(), framed.height(), |p| velocity(p).unwrap_or_default()))
    }

    /// Equations 7.9, 7.10 and 7.14.
    fn flow(&self, smoothed: &[Raster<f32>], sigma: f32) -> Flow {
        let blurred: Vec<Raster<f32>> = if self.parameters.gradient == Gradient::Diffusion {
            anisotropic_diffusion(smoothed, sigma, DIFFUSION_CONTRAST)
        } else {
            smoothed.iter().map(|plane| fast_gaussian(plane, sigma)).collect()
        };
        let light = gradient(&grey(&blurred));
        self.observer.picture("gradient", &|| Picture::Grey(shown_gradient(&light)));
        let gradients: Vec<Raster<[f32; 2]>> = blurred.iter().map(gradient).collect();
        let tensor = structure_tensor(&gradients).unwrap_or_else(|| light.map(|_| [0.0; 3]));
        Flow::steepest(&tensor, &light).turned(self.parameters.angle.0)
    }

    /// The pattern as a raster and line integral convolution of the same noise, for `stages`.
    fn show_patterns(&self, ground: &Ground, noise: &Raster<f32>) {
        let length = self.pixels(self.parameters.length) as f32;
        let shown = |raster: Raster<f32>| Picture::Grey(equalised(&raster.unframed(ground.margin)).map(|u| u + 0.5));
        self.observer.picture("noise", &|| shown(noise.clone()));
        self.observer.picture("glass-pattern", &|| shown(glass_pattern(noise, &ground.flow, length)));
        self.observer.picture("line-integral", &|| shown(line_integral_convolution(noise, &ground.flow, length)));
    }

    /// Converts framed pixels to the page.
    fn to_page(&self, ground: &Ground, p: Point) -> Point {
        let margin = ground.margin as f64;
        self.portrait.placement.to_page(Point::new(p.x - margin, p.y - margin))
    }

    /// The initial layer of every manner of drawing.
    fn empty_layer(&self, name: &str) -> Layer {
        self.observer.begin(name);
        Layer::new(name, 1)
    }
}

/// Luminance weights applied to the encoded channels.
fn grey(planes: &[Raster<f32>]) -> Raster<f32> {
    match planes {
        [r, g, b] => Raster::from_fn(r.width(), r.height(), |x, y| luminance([r.get(x, y), g.get(x, y), b.get(x, y)])),
        _ => planes[0].clone(),
    }
}

fn shown_gradient(gradient: &Raster<[f32; 2]>) -> Raster<f32> {
    let size = gradient.map(|[x, y]| x.hypotenuse(y));
    let most = size.pixels().iter().copied().fold(1e-6, f32::max);
    size.map(|g| 1.0 - g / most)
}
