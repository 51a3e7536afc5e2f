//! Rays, and the light that reaches the points they hit.

use crate::colour::{LOOKS, background, shade};
use crate::figure::{MOUTH_HALF, Part, brow_cover, head_space, lip_offsets, nose, nose_wing, scene, skull};
use crate::space::{Vec3, smoothstep, vec3};
use crate::{HEIGHT, WIDTH, feature_bit};

/// Rays per pixel along each axis.
pub const GRID: u32 = 2;
/// Height of the picture at the plane of the eyes, and the height of its centre.
pub const FRAME_HEIGHT: f32 = 4.3;
pub const FRAME_CENTRE: f32 = -0.62;
/// A portrait lens stands about a metre and a half away.
pub const CAMERA_DISTANCE: f32 = 15.0;
/// Rays start and end at these depths; the nose tip is at about 1.2.
pub const NEAR: f32 = 1.35;
pub const FAR: f32 = -1.3;
pub const KEY_LIGHT: Vec3 = vec3(-0.52, 0.55, 0.655);
pub const FILL_LIGHT: Vec3 = vec3(0.80, 0.10, 0.59);

/// A visible point, with the light that reaches it. The same for all three looks.
#[derive(Clone, Copy)]
pub struct Hit {
    pub position: Vec3,
    /// The position in the space of the head.
    pub head: Vec3,
    pub normal: Vec3,
    /// Towards the camera.
    pub view: Vec3,
    pub part: Part,
    /// How much of the key light is seen from here, 0 to 1.
    pub key_visible: f32,
    /// How much of the surroundings is seen from here, 0 to 1.
    pub openness: f32,
}

#[derive(Default)]
pub struct Pixel {
    pub colours: [Vec3; 3],
    pub subject: f32,
    pub face: f32,
    pub hair: f32,
    pub clothing: f32,
    /// Mean of the z of the hits, valid where the subject covers half the pixel.
    pub depth: f32,
    /// One bit for each of [`FEATURE_NAMES`].
    pub features: u8,
}

pub fn render_pixel(x: u32, y: u32) -> Pixel {
    let mut pixel = Pixel::default();
    let weight = 1.0 / (GRID * GRID) as f32;
    let mut last = None;
    for sample in 0..GRID * GRID {
        let inside = |index: u32| (index as f32 + 0.5) / GRID as f32;
        let right = (x as f32 + inside(sample % GRID)) / WIDTH as f32 - 0.5;
        let down = (y as f32 + inside(sample / GRID)) / HEIGHT as f32 - 0.5;
        let width = FRAME_HEIGHT * WIDTH as f32 / HEIGHT as f32;
        let target = vec3(right * width, FRAME_CENTRE - down * FRAME_HEIGHT, 0.0);
        let camera = vec3(0.0, FRAME_CENTRE, CAMERA_DISTANCE);
        let Some(hit) = trace(camera, (target - camera).normalized(), last) else {
            let wall = background(right, down);
            pixel.colours = pixel.colours.map(|colour| colour + wall * weight);
            continue;
        };
        for (colour, look) in pixel.colours.iter_mut().zip(&LOOKS) {
            *colour = *colour + shade(&hit, look) * weight;
        }
        pixel.subject += weight;
        pixel.depth += hit.position.z * weight;
        match hit.part {
            Part::Hair => pixel.hair += weight,
            Part::Shirt | Part::Collar | Part::Button => pixel.clothing += weight,
            Part::Neck | Part::Ear => {}
            _ => pixel.face += weight,
        }
        pixel.features |= feature_bit(&hit);
        last = Some(hit);
    }
    pixel.depth /= pixel.subject.max(1e-6);
    pixel
}

/// Follows a ray to the first surface. The light is taken from the last hit of the same pixel if that is close, since shadows are
/// soft.
pub fn trace(camera: Vec3, direction: Vec3, last: Option<Hit>) -> Option<Hit> {
    let mut travelled = (NEAR - camera.z) / direction.z;
    let end = (FAR - camera.z) / direction.z;
    for _ in 0..160 {
        let position = camera + direction * travelled;
        let (distance, part) = scene(position);
        if distance < 0.0008 {
            return Some(light_hit(position, direction, part, last));
        }
        // The distances are stretched where reliefs and noise are steep.
        travelled += distance * 0.7;
        if travelled > end {
            return None;
        }
    }
    // Not finished after all steps: the ray grazes an edge.
    let position = camera + direction * travelled;
    Some(light_hit(position, direction, scene(position).1, last))
}

pub fn light_hit(position: Vec3, direction: Vec3, part: Part, last: Option<Hit>) -> Hit {
    let head = head_space(position);
    let part = if part == Part::Face { face_part(head.mirrored()) } else { part };
    let normal = normal(position);
    let (key_visible, openness) = match last {
        Some(near) if near.part == part && (near.position - position).length() < 0.015 => (near.key_visible, near.openness),
        _ => (key_visible(position + normal * 0.006), openness(position, normal)),
    };
    Hit { position, head, normal, view: -direction, part, key_visible, openness }
}

pub fn face_part(p: Vec3) -> Part {
    if p.z < 0.2 {
        return Part::Face;
    }
    let (_, upper, lower) = lip_offsets(p);
    if p.x < MOUTH_HALF && upper < 1.0 && lower < 1.0 {
        Part::Lips
    } else if brow_cover(p) > 0.3 {
        Part::Brow
    } else if p.y < 0.0 && nose(p).min(nose_wing(p)) < skull(p) {
        Part::Nose
    } else {
        Part::Face
    }
}

pub fn normal(position: Vec3) -> Vec3 {
    let mut sum = Vec3::default();
    for (x, y, z) in [(1., -1., -1.), (-1., -1., 1.), (-1., 1., -1.), (1., 1., 1.)] {
        let corner = vec3(x, y, z);
        sum = sum + corner * scene(position + corner * 0.002).0;
    }
    sum.normalized()
}

/// The shadow of a large soft box: near misses of the ray darken by how near they are.
pub fn key_visible(from: Vec3) -> f32 {
    let mut visible = 1.0_f32;
    let mut travelled = 0.02;
    for _ in 0..40 {
        let (distance, _) = scene(from + KEY_LIGHT * travelled);
        visible = visible.min(0.5 + 0.5 * distance * 6.0 / travelled);
        if visible <= 0.0 || travelled > 2.2 {
            break;
        }
        travelled += (distance * 0.9).clamp(0.015, 0.25);
    }
    smoothstep(0.0, 1.0, visible)
}

pub fn openness(position: Vec3, normal: Vec3) -> f32 {
    let mut closed = 0.0;
    let mut weight = 1.0;
    for step in [0.02, 0.06, 0.13, 0.24, 0.42] {
        closed += (step - scene(position + normal * step).0).max(0.0) / step * weight;
        weight *= 0.8;
    }
    (1.0 - 0.34 * closed).clamp(0.0, 1.0)
}
