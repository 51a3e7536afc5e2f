//! The surfaces of the bust: how far a point is from each of them.

use crate::space::{Vec3, bell, ellipsoid, limb, noise, smooth_max, smooth_min, smoothstep, vec3};

/// The head turns a little towards the key light and leans a little.
pub const HEAD_TURN: f32 = -0.15;
pub const HEAD_LEAN: f32 = 0.03;
pub const EYE_CENTRE: Vec3 = vec3(0.32, 0.0, 0.60);
pub const EYE_RADIUS: f32 = 0.125;
/// Nothing below the neck reaches higher than this.
pub const TORSO_TOP: f32 = -1.25;
/// Height of the line between the lips, and half the width of the mouth.
pub const MOUTH_HEIGHT: f32 = -0.70;
pub const MOUTH_HALF: f32 = 0.25;

/// What a ray can hit. [`face_part`] subdivides the face, at hits only.
#[derive(Clone, Copy, PartialEq)]
pub enum Part {
    Face,
    Nose,
    Lips,
    Brow,
    Eye,
    Ear,
    Hair,
    Neck,
    Shirt,
    Collar,
    Button,
}

pub fn head_space(point: Vec3) -> Vec3 {
    let pivot = vec3(0.0, -1.0, -0.2);
    (point - pivot).turned(HEAD_TURN, HEAD_LEAN) + pivot
}

/// The signed distance to the nearest surface, and which one that is.
pub fn scene(point: Vec3) -> (f32, Part) {
    let head = head_space(point);
    let torso = torso(point.mirrored());
    let neck = neck(point.mirrored(), torso);
    let mut best = (neck, Part::Neck);
    let mut offer = |distance: f32, part: Part| {
        if distance < best.0 {
            best = (distance, part);
        }
    };
    // Far from a part a bound is enough; below 0.4 it would show in the soft shadows.
    let bound = (head - vec3(0.0, 0.05, 0.0)).length() - 1.35;
    if bound > 0.4 {
        offer(bound, Part::Hair);
    } else {
        let mirrored = head.mirrored();
        let face = face(mirrored);
        offer(smooth_min(face, neck, 0.12), if face < neck { Part::Face } else { Part::Neck });
        offer(smooth_min(ear(mirrored), face + 0.02, 0.04), Part::Ear);
        offer((mirrored - EYE_CENTRE).length() - EYE_RADIUS, Part::Eye);
        offer(hair(head), Part::Hair);
    }
    if point.y > TORSO_TOP + 0.4 {
        offer(point.y - TORSO_TOP, Part::Shirt);
    } else {
        let (shirt, part) = shirt(point, torso);
        offer(shirt, part);
        offer(collar(point), Part::Collar);
    }
    best
}

pub fn skull(p: Vec3) -> f32 {
    let cranium = ellipsoid(p, vec3(0.0, 0.36, -0.10), vec3(0.76, 0.79, 0.96));
    let middle = ellipsoid(p, vec3(0.0, -0.30, 0.24), vec3(0.61, 0.80, 0.60));
    let jaw = limb(p, [0.41, -0.58, 0.04], [0.11, -0.98, 0.64], [0.16, 0.16]);
    let hinge = limb(p, [0.54, -0.10, -0.10], [0.42, -0.56, 0.0], [0.12, 0.14]);
    let chin = ellipsoid(p, vec3(0.0, -1.02, 0.68), vec3(0.19, 0.15, 0.17));
    let cheek = ellipsoid(p, vec3(0.43, -0.22, 0.50), vec3(0.20, 0.17, 0.20));
    let muzzle = ellipsoid(p, vec3(0.0, -0.66, 0.56), vec3(0.37, 0.29, 0.33));
    let brow = limb(p, [0.08, 0.18, 0.76], [0.46, 0.19, 0.56], [0.09, 0.07]);
    let mut distance = smooth_min(cranium, middle, 0.30);
    distance = smooth_min(distance, smooth_min(jaw, hinge, 0.1), 0.22);
    distance = smooth_min(distance, chin, 0.14);
    distance = smooth_min(distance, cheek, 0.22);
    distance = smooth_min(distance, muzzle, 0.22);
    distance = smooth_min(distance, brow, 0.16);
    let socket = ellipsoid(p, vec3(0.31, 0.01, 0.86), vec3(0.21, 0.12, 0.17));
    smooth_max(distance, -socket, 0.13)
}

pub fn nose(p: Vec3) -> f32 {
    let bridge = limb(p, [0.0, 0.13, 0.74], [0.0, -0.33, 0.99], [0.07, 0.08]);
    let tip = ellipsoid(p, vec3(0.0, -0.35, 1.01), vec3(0.105, 0.095, 0.105));
    smooth_min(bridge, tip, 0.10)
}

pub fn nose_wing(p: Vec3) -> f32 {
    ellipsoid(p, vec3(0.105, -0.39, 0.91), vec3(0.058, 0.066, 0.10))
}

/// Head skin from the forehead to the chin, at a mirrored point.
pub fn face(p: Vec3) -> f32 {
    let mut distance = skull(p);
    if p.z < 0.2 || distance > 0.5 {
        return distance;
    }
    distance = smooth_min(distance, nose(p), 0.15);
    distance = smooth_min(distance, nose_wing(p), 0.055);
    let nostril = ellipsoid(p, vec3(0.058, -0.442, 0.98), vec3(0.032, 0.030, 0.055));
    distance = smooth_max(distance, -nostril, 0.03);
    distance -= relief(p);
    // The lids are a skin over the eyeball, cut open along the almond of the eye.
    let lid = (p - EYE_CENTRE).length() - EYE_RADIUS - 0.022;
    distance = smooth_min(distance, lid, 0.06);
    let opening = eye_opening(p).max(EYE_CENTRE.z + 0.07 - p.z);
    smooth_max(distance, -opening, 0.012)
}

/// Negative between the lids: the lens shape between two parabolas, outer corner a little higher.
pub fn eye_opening(p: Vec3) -> f32 {
    let (upper, lower) = lid_offsets(p);
    upper.max(lower) * 0.8
}

/// Distance of a point above the upper and below the lower edge of the opening.
pub fn lid_offsets(p: Vec3) -> (f32, f32) {
    let x = p.x - EYE_CENTRE.x;
    let y = p.y - 0.10 * x;
    let across = (x / 0.152).powi(2);
    let skew = 1.0 - 1.1 * x;
    let (upper, lower) = (0.053 * skew * (1.0 - across), 0.044 * (1.0 - across));
    (y - upper, -lower - y)
}

/// The fine forms of the face, as a height above the coarse ones.
pub fn relief(p: Vec3) -> f32 {
    let mut height = lip_relief(p);
    // Groove between nose and mouth, with its two ridges.
    let above_lip = smoothstep(-0.66, -0.58, p.y) * smoothstep(-0.42, -0.50, p.y);
    height += above_lip * (0.010 * bell(p.x - 0.055, 0.025) - 0.012 * bell(p.x, 0.03));
    // Hollow under the lower lip, fold from the nose wing to the mouth corner.
    height -= 0.026 * bell(p.y + 0.865, 0.055) * bell(p.x, 0.19);
    let flat = vec3(p.x, p.y, 0.0);
    let fold = limb(flat, [0.19, -0.40, 0.0], [0.33, -0.62, 0.0], [0.0, 0.0]);
    height -= 0.010 * bell(fold, 0.045) * smoothstep(-0.72, -0.5, p.y);
    // Crease over the upper lid, bag under the lower one.
    let (upper, lower) = lid_offsets(p);
    let lid_width = bell(p.x - EYE_CENTRE.x - 0.01, 0.12);
    height -= 0.018 * bell(upper - 0.040, 0.014) * lid_width;
    height -= 0.010 * bell(lower - 0.075, 0.03) * lid_width;
    height + 0.006 * brow_cover(p)
}

pub fn lip_relief(p: Vec3) -> f32 {
    let (line, upper, lower) = lip_offsets(p);
    let full = (1.0 - (p.x / MOUTH_HALF).powi(2)).max(0.0).sqrt();
    let swell = |t: f32| (t.clamp(0.0, 1.0) * std::f32::consts::PI).sin();
    let lips = full * (0.022 * swell(upper) + 0.036 * swell(lower));
    let gap = smoothstep(MOUTH_HALF + 0.05, MOUTH_HALF - 0.08, p.x) * bell(line, 0.024);
    // The corners are drawn in.
    let corner = bell(p.x - MOUTH_HALF - 0.01, 0.045) * bell(line, 0.05);
    lips - 0.018 * gap - 0.016 * corner
}

/// Distance from the line of the mouth, and how far a point is from it towards the upper and the
/// lower border of the lips (inside from 0 to 1). Only for points within the width of the mouth.
pub fn lip_offsets(p: Vec3) -> (f32, f32, f32) {
    let taper = (1.0 - (p.x / MOUTH_HALF).powi(2)).max(1e-4);
    let bend = 0.018 * (p.x / MOUTH_HALF).powi(2).min(1.5) - 0.009 * bell(p.x, 0.06);
    let line = p.y - MOUTH_HEIGHT - bend;
    let bow = 0.070 + 0.016 * bell(p.x - 0.055, 0.04) - 0.014 * bell(p.x, 0.025);
    let full = 0.110 * taper.sqrt();
    (line, line / (bow * taper), -line / full)
}

/// How densely the eyebrow covers the skin, 0 to 1, before its single hairs are drawn.
pub fn brow_cover(p: Vec3) -> f32 {
    let t = (p.x - 0.11) / 0.43;
    if !(-0.1..1.1).contains(&t) || (p.y - 0.22).abs() > 0.15 {
        return 0.0;
    }
    let offset = (p.y - brow_centre(t)).abs() / (0.046 * (1.0 - 0.62 * t.max(0.0)));
    smoothstep(1.0, 0.35, offset) * smoothstep(-0.08, 0.12, t) * smoothstep(1.06, 0.75, t)
}

pub fn brow_centre(t: f32) -> f32 {
    0.185 + 0.20 * t - 0.19 * t * t
}

pub fn ear(p: Vec3) -> f32 {
    let offset = p - vec3(0.735, -0.12, -0.05);
    if offset.length() > 0.8 {
        return offset.length() - 0.4;
    }
    // The plate stands off the head by about 30 degrees, a little more at the top.
    let (sin, cos) = 0.56_f32.sin_cos();
    let x = offset.x - 0.17 * offset.y;
    let (back, out) = (x * sin - offset.z * cos, x * cos + offset.z * sin);
    let wide = 0.15 + 0.12 * offset.y;
    let rim = ((back / wide).powi(2) + (offset.y / 0.27).powi(2)).sqrt() - 1.0;
    let edge = rim * 0.16;
    let plate = smooth_max(edge, (out + 0.02).abs() - 0.045, 0.03);
    let helix = edge.hypot(out - 0.012) - 0.030;
    let antihelix = (edge + 0.070).hypot(out - 0.008) - 0.024;
    let bowl = vec3(back + 0.04, offset.y + 0.02, out - 0.045);
    let bowl = ellipsoid(bowl, Vec3::default(), vec3(0.06, 0.10, 0.05));
    let whole = smooth_min(smooth_min(plate, helix, 0.03), antihelix, 0.03);
    smooth_max(whole, -bowl, 0.03)
}

pub fn hair(p: Vec3) -> f32 {
    let cap = ellipsoid(p, vec3(0.0, 0.43, -0.14), vec3(0.83, 0.83, 0.99));
    let front = ellipsoid(p, vec3(0.06, 0.93, 0.40), vec3(0.52, 0.27, 0.40));
    let volume = smooth_min(cap, front, 0.22);
    if volume > 0.35 {
        return volume - 0.03;
    }
    let (across, along) = strand(p);
    // Locks, and an uneven edge where they leave the skin.
    let lock = noise(vec3(across * 9.0, along * 1.5, 3.0));
    let thin = noise(vec3(across * 26.0, along * 2.5, 7.0));
    let side = p.x.abs();
    let forehead = 0.70 - 0.30 * smoothstep(0.30, 0.75, side) - 0.05 * bell(side - 0.42, 0.1) - p.y;
    let temple = p.z - 0.20 - 0.15 * smoothstep(-0.2, 0.5, p.y);
    let lower = -0.16 - 0.55 * smoothstep(-0.15, -0.35, p.z) - p.y;
    let edge = smooth_max(smooth_min(forehead, temple, 0.12), lower, 0.06);
    let edge = edge + 0.02 * thin + 0.02 * lock;
    smooth_max(volume - 0.026 * lock - 0.010 * thin, edge, 0.17)
}

/// Coordinates of the combed hair: across the strands and along them. They fan out from a point
/// hidden on the forehead and bend over to one side.
pub fn strand(p: Vec3) -> (f32, f32) {
    let offset = p - vec3(-0.24, 0.30, 0.85);
    let along = offset.length();
    let wave = 0.10 * noise(p * 2.2) + 0.03 * noise(p * 6.0);
    (offset.x.atan2(offset.y) - 0.45 * along + wave, along)
}

pub fn torso(p: Vec3) -> f32 {
    if p.y > TORSO_TOP + 0.4 {
        return p.y - TORSO_TOP;
    }
    let trunk = ellipsoid(p, vec3(0.0, -3.35, -0.12), vec3(1.55, 1.45, 0.74));
    let shoulder = limb(p, [0.45, -2.15, -0.28], [1.62, -2.42, -0.32], [0.38, 0.42]);
    let slope = limb(p, [0.22, -1.50, -0.38], [1.35, -2.10, -0.34], [0.22, 0.24]);
    smooth_min(smooth_min(trunk, shoulder, 0.35), slope, 0.30)
}

pub fn neck(p: Vec3, torso: f32) -> f32 {
    if p.y > -0.2 {
        return p.y + 0.5;
    }
    let column = limb(p, [0.0, -0.7, -0.12], [0.0, -2.1, -0.34], [0.45, 0.51]);
    let muscle = limb(p, [0.46, -0.62, -0.22], [0.09, -1.95, 0.20], [0.08, 0.06]);
    let throat = ellipsoid(p, vec3(0.0, -1.50, 0.22), vec3(0.08, 0.14, 0.07));
    let skin = smooth_min(smooth_min(column, muscle, 0.16), throat, 0.14);
    smooth_min(skin, torso, 0.16)
}

pub fn shirt(point: Vec3, torso: f32) -> (f32, Part) {
    let p = point.mirrored();
    let mut distance = torso - 0.035;
    if distance > 0.5 {
        return (distance - 0.08, Part::Shirt);
    }
    // Folds run from the shoulders towards the buttons, the strip with the buttons lies on top.
    let slant = point.x * 1.5 + point.y * 2.6 * point.x.signum();
    let fold = noise(vec3(slant, point.y * 0.8, 11.0));
    distance -= 0.06 * (1.0 + fold) * smoothstep(0.10, 0.6, p.x);
    let front = smoothstep(0.105, 0.095, (point.x - 0.03).abs()) * smoothstep(0.0, 0.1, p.z);
    distance -= 0.014 * front;
    let opening = (p.x - 0.36 * (p.y + 2.32)).max(-p.z);
    distance = smooth_max(distance, -opening, 0.02);
    let row = ((p.y + 2.50) / 0.42).round().min(0.0);
    let button = vec3(point.x - 0.03, p.y + 2.50 - row * 0.42, 0.0).length() - 0.045;
    let button = smooth_max(button, (distance - 0.016).abs() - 0.008, 0.008);
    if button < distance { (button, Part::Button) } else { (distance, Part::Shirt) }
}

/// A turned-down collar: a piece of a cone around the neck, cut to two points in front.
pub fn collar(point: Vec3) -> f32 {
    let p = point.mirrored();
    let centre_z = -0.28;
    let radius = p.x.hypot(p.z - centre_z);
    let facing = (p.z - centre_z) / radius.max(1e-4);
    let cone = (radius - 0.60 - 0.50 * (-1.50 - p.y).max(-0.2)) * 0.88;
    let top = p.y + 1.56 + 0.17 * facing;
    let inner = (0.03 + 0.62 * (-1.70 - p.y) - p.x) * 0.84;
    let lower = (-2.16 + 0.75 * (p.x - 0.42) - p.y) * 0.80;
    let outline = smooth_max(smooth_max(inner, lower, 0.02), top, 0.03);
    smooth_max(cone.abs() - 0.022, outline, 0.03)
}
