//! What the parts of the bust look like on three people.

use crate::figure::{
    EYE_CENTRE, HEAD_LEAN, HEAD_TURN, MOUTH_HALF, Part, brow_centre, brow_cover, hair, lid_offsets, lip_offsets, strand,
};
use crate::light::{FILL_LIGHT, Hit, KEY_LIGHT};
use crate::space::{Vec3, bell, noise, smoothstep, vec3};

/// Colours of one person, as linear light.
pub struct Look {
    pub name: &'static str,
    pub skin: Vec3,
    /// The skin where much blood shows: cheeks, nose, ears.
    pub flush: Vec3,
    pub lips: Vec3,
    pub iris: Vec3,
    pub hair: Vec3,
    pub shirt: Vec3,
    /// How much darker the stripes of the shirt are, and their number per decimetre.
    pub stripes: (f32, f32),
}

pub const LOOKS: [Look; 3] = [
    Look {
        name: "bust-light",
        skin: vec3(0.60, 0.385, 0.285),
        flush: vec3(0.58, 0.27, 0.20),
        lips: vec3(0.42, 0.145, 0.125),
        iris: vec3(0.10, 0.17, 0.24),
        hair: vec3(0.155, 0.080, 0.036),
        shirt: vec3(0.16, 0.25, 0.42),
        stripes: (0.0, 1.0),
    },
    Look {
        name: "bust-brown",
        skin: vec3(0.30, 0.160, 0.092),
        flush: vec3(0.29, 0.115, 0.068),
        lips: vec3(0.235, 0.083, 0.066),
        iris: vec3(0.050, 0.024, 0.010),
        hair: vec3(0.020, 0.013, 0.010),
        shirt: vec3(0.68, 0.66, 0.62),
        stripes: (0.55, 9.0),
    },
    Look {
        name: "bust-dark",
        skin: vec3(0.105, 0.053, 0.032),
        flush: vec3(0.105, 0.042, 0.026),
        lips: vec3(0.105, 0.040, 0.035),
        iris: vec3(0.022, 0.011, 0.006),
        hair: vec3(0.016, 0.013, 0.012),
        shirt: vec3(0.36, 0.27, 0.10),
        stripes: (0.0, 1.0),
    },
];

pub const KEY_COLOUR: Vec3 = vec3(1.18, 1.13, 1.06);
pub const FILL_COLOUR: Vec3 = vec3(0.19, 0.18, 0.17);
pub const AMBIENT_COLOUR: Vec3 = vec3(0.22, 0.21, 0.205);

pub fn background(right: f32, down: f32) -> Vec3 {
    let spot = right.hypot(down - 0.1);
    let level = 0.66 - 0.38 * smoothstep(0.0, 0.9, spot);
    vec3(level, level, level * 1.01)
}

pub fn shade(hit: &Hit, look: &Look) -> Vec3 {
    match hit.part {
        Part::Hair => shade_hair(hit, look),
        Part::Eye => {
            let mirror = hit.normal * (2.0 * hit.normal.dot(hit.view)) - hit.view;
            let catch = smoothstep(0.955, 0.975, mirror.dot(KEY_LIGHT)) * 0.9;
            lit(hit, eye_albedo(hit, look), 0.06, 0.3) + vec3(catch, catch, catch)
        }
        Part::Shirt | Part::Collar | Part::Button => {
            let wave = (hit.position.x * look.stripes.1 * std::f32::consts::TAU).cos();
            let weave = 1.0 + 0.06 * noise(hit.position * 70.0);
            let stripe = 1.0 - look.stripes.0 * smoothstep(0.75, 0.9, wave);
            let pale = if hit.part == Part::Button { 0.45 } else { 0.0 };
            let albedo = (look.shirt * (weave * stripe)).mix(vec3(0.7, 0.68, 0.62), pale);
            lit(hit, albedo, 0.03, 0.0)
        }
        _ => lit(hit, skin_albedo(hit, look), skin_shine(hit), 1.0),
    }
}

/// Diffuse and glossy light. Skin is translucent: light wraps round to where the surface already turns away from the key, red
/// farthest.
pub fn lit(hit: &Hit, albedo: Vec3, shine: f32, translucency: f32) -> Vec3 {
    let facing = hit.normal.dot(KEY_LIGHT);
    let wrapped = |wrap: f32| ((facing + wrap) / (1.0 + wrap)).max(0.0);
    let wrap = vec3(0.30, 0.16, 0.12) * translucency;
    let key = vec3(wrapped(wrap.x), wrapped(wrap.y), wrapped(wrap.z));
    let bleeding = hit.key_visible.powf(1.0 - 0.35 * translucency);
    let key = key * vec3(bleeding, hit.key_visible, hit.key_visible) * KEY_COLOUR;
    let fill = hit.normal.dot(FILL_LIGHT).mul_add(0.7, 0.3).max(0.0) * (0.4 + 0.6 * hit.openness);
    let sky = 0.65 + 0.35 * hit.normal.y;
    let light = key + FILL_COLOUR * fill + AMBIENT_COLOUR * (sky * hit.openness);
    let half = (KEY_LIGHT + hit.view).normalized();
    let glance = hit.normal.dot(half).max(0.0);
    let fresnel = 0.35 + 0.65 * (1.0 - hit.normal.dot(hit.view).max(0.0)).powi(4);
    let gloss = shine * fresnel * hit.key_visible * (0.5 * glance.powi(14) + 0.9 * glance.powi(48));
    albedo * light + KEY_COLOUR * gloss
}

pub fn skin_shine(hit: &Hit) -> f32 {
    let p = hit.head.mirrored();
    if hit.part == Part::Lips {
        return 0.34 * (1.0 - bell(lip_offsets(p).0, 0.02));
    }
    let forehead = bell(p.x, 0.35) * smoothstep(0.2, 0.5, p.y);
    let oily = forehead + bell(p.x, 0.09) * smoothstep(0.5, 0.9, p.z);
    let pores = 1.0 + 0.25 * noise(hit.head * 80.0);
    (0.16 + 0.14 * oily) * pores
}

pub fn skin_albedo(hit: &Hit, look: &Look) -> Vec3 {
    let p = hit.head.mirrored();
    let mottle = 1.0 + 0.045 * noise(hit.head * 8.0) + 0.035 * noise(hit.head * 34.0);
    let cheek = bell((p - vec3(0.42, -0.32, 0.62)).length(), 0.24);
    let tip = bell((p - vec3(0.0, -0.36, 1.08)).length(), 0.16);
    let ear = if hit.part == Part::Ear { 0.5 } else { 0.0 };
    let mut albedo = (look.skin * mottle).mix(look.flush, 0.45 * cheek + 0.45 * tip + ear);
    // Hair thins out over the skin at its edge.
    let (across, strand_along) = strand(hit.head);
    let root = 0.5 + 0.5 * noise(vec3(across * 60.0, strand_along * 4.0, 9.0));
    let rooted = smoothstep(0.075 * root, 0.0, hair(hit.head));
    albedo = albedo.mix(look.hair * 0.7, 0.9 * rooted);
    if p.z < 0.3 || hit.part == Part::Neck || hit.part == Part::Ear {
        return albedo;
    }
    let (line, upper, lower) = lip_offsets(p);
    if p.x < MOUTH_HALF + 0.02 {
        let border = smoothstep(1.06, 0.90, upper) * smoothstep(1.08, 0.84, lower);
        let inside = border * smoothstep(MOUTH_HALF + 0.01, MOUTH_HALF - 0.02, p.x);
        let grain = 1.0 + 0.12 * noise(vec3(hit.head.x * 60.0, hit.head.y * 9.0, 1.0));
        albedo = albedo.mix(look.lips * grain, inside * 0.9);
        let open = smoothstep(MOUTH_HALF + 0.02, MOUTH_HALF - 0.03, p.x);
        albedo = albedo * (1.0 - 0.9 * open * bell(line, 0.012));
    }
    let (upper, lower) = lid_offsets(p);
    let near_eye = bell((p - EYE_CENTRE - vec3(0.0, 0.02, 0.12)).length(), 0.20);
    albedo = albedo.mix(look.flush * 0.6, 0.35 * near_eye);
    let width = smoothstep(0.19, 0.14, (p.x - EYE_CENTRE.x).abs());
    let lashes = bell(upper - 0.006, 0.014) * width + 0.45 * bell(lower - 0.006, 0.010) * width;
    let lash = lashes.min(1.0) * smoothstep(0.06, 0.045, upper.max(lower));
    albedo = albedo.mix(look.hair * 0.25, 0.9 * lash);
    albedo.mix(look.hair * 0.4, 0.9 * brow_hairs(p))
}

/// Single hairs of the eyebrow: upright near the nose, lying down towards the temple.
pub fn brow_hairs(p: Vec3) -> f32 {
    let cover = brow_cover(p);
    if cover <= 0.0 {
        return 0.0;
    }
    let t = (p.x - 0.11) / 0.43;
    let above = p.y - brow_centre(t);
    let slant = 0.4 + 1.4 * t;
    let across = (p.x - slant * above) / slant.hypot(1.0);
    let hairs = noise(vec3(across * 170.0, above * 12.0, 2.0));
    smoothstep(0.15, 0.75, cover + 0.5 * hairs * cover.sqrt())
}

pub fn eye_albedo(hit: &Hit, look: &Look) -> Vec3 {
    let side = hit.head.x.signum();
    let local = hit.head - vec3(EYE_CENTRE.x * side, EYE_CENTRE.y, EYE_CENTRE.z);
    let gaze = vec3(0.0, 0.0, 1.0).turned(HEAD_TURN, HEAD_LEAN);
    let radius = (local - gaze * local.dot(gaze)).length() / 0.057;
    let corner = local.x * side;
    let red = smoothstep(0.08, 0.14, corner.abs());
    let white = vec3(0.60, 0.57, 0.54).mix(vec3(0.45, 0.20, 0.17), 0.6 * red);
    let spokes = noise(vec3(local.y.atan2(local.x) * 7.0, radius * 1.5, side));
    let ring = smoothstep(1.05, 0.80, radius);
    let iris = look.iris * ((0.85 + 0.5 * spokes) * (0.35 + 0.65 * ring) * (1.5 - 0.5 * radius));
    let coloured = white.mix(iris, smoothstep(1.04, 0.94, radius));
    let seen = coloured.mix(vec3(0.004, 0.004, 0.004), smoothstep(0.44, 0.38, radius));
    // The upper lid and its lashes darken the ball below them.
    let (upper, lower) = lid_offsets(hit.head.mirrored());
    let shaded = smoothstep(0.0, -0.035, upper) * 0.85 + 0.15;
    seen * (shaded * (smoothstep(0.0, -0.012, lower) * 0.5 + 0.5))
}

/// Hair shines across its strands, not as a surface would: in a band round the head.
pub fn shade_hair(hit: &Hit, look: &Look) -> Vec3 {
    let p = hit.head;
    let (across, along) = strand(p);
    let step = 0.004;
    let slope = vec3(
        strand(p + vec3(step, 0.0, 0.0)).0 - across,
        strand(p + vec3(0.0, step, 0.0)).0 - across,
        strand(p + vec3(0.0, 0.0, step)).0 - across,
    );
    let fine = noise(vec3(across * 75.0, along * 3.0, 1.0));
    let finer = noise(vec3(across * 150.0, along * 5.0, 4.0));
    // Tangents are in head space, so the lights must be too.
    let into_head = |v: Vec3| v.turned(HEAD_TURN, HEAD_LEAN);
    let normal = into_head(hit.normal);
    let tangent = (normal.cross(slope).normalized() + normal * (0.12 * fine)).normalized();
    let sheen = |half: Vec3, power: i32| {
        let cos = tangent.dot(half);
        (1.0 - cos * cos).max(0.0).sqrt().powi(power)
    };
    let half = into_head((KEY_LIGHT + hit.view).normalized());
    let streak = 0.62 + 0.42 * fine + 0.26 * finer;
    let facing = hit.normal.dot(KEY_LIGHT).mul_add(0.75, 0.25).max(0.0) * hit.key_visible;
    let light = KEY_COLOUR * facing + FILL_COLOUR * 0.6 + AMBIENT_COLOUR * hit.openness;
    let gloss = (0.05 * sheen(half, 90) + 0.025 * sheen(half, 16)) * facing * streak.max(0.0);
    let tint = vec3(0.6, 0.6, 0.6) + look.hair * 9.0;
    look.hair * light * (streak.max(0.12) * (0.35 + 0.65 * hit.openness)) + tint * gloss
}
