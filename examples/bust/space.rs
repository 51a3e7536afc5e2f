//! Vectors, hashed noise and the signed distances everything is built from.

use std::ops::{Add, Mul, Neg, Sub};

#[derive(Clone, Copy, Default)]
pub struct Vec3 {
    pub x: f32,
    pub y: f32,
    pub z: f32,
}

pub const fn vec3(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3 { x, y, z }
}

macro_rules! componentwise {
    ($operator:ident, $method:ident) => {
        impl $operator for Vec3 {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                vec3(self.x.$method(other.x), self.y.$method(other.y), self.z.$method(other.z))
            }
        }
    };
}

componentwise!(Add, add);
componentwise!(Sub, sub);
componentwise!(Mul, mul);

impl Mul<f32> for Vec3 {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        self * vec3(factor, factor, factor)
    }
}

impl Neg for Vec3 {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Vec3 {
    pub fn dot(self, other: Self) -> f32 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub fn cross(self, other: Self) -> Self {
        vec3(self.y * other.z - self.z * other.y, self.z * other.x - self.x * other.z, self.x * other.y - self.y * other.x)
    }

    pub fn length(self) -> f32 {
        self.dot(self).sqrt()
    }

    pub fn normalized(self) -> Self {
        self * (1.0 / self.length().max(1e-9))
    }

    pub fn mix(self, other: Self, amount: f32) -> Self {
        self * (1.0 - amount) + other * amount
    }

    /// Turned about the y axis, then leant about the z axis.
    pub fn turned(self, turn: f32, lean: f32) -> Self {
        let (sin, cos) = turn.sin_cos();
        let (x, z) = (self.x * cos - self.z * sin, self.x * sin + self.z * cos);
        let (sin, cos) = lean.sin_cos();
        vec3(x * cos - self.y * sin, x * sin + self.y * cos, z)
    }

    /// The same point folded onto one half of the face, without a seam where the halves meet.
    pub fn mirrored(self) -> Self {
        vec3(self.x.hypot(0.02), self.y, self.z)
    }
}

pub fn smoothstep(from: f32, to: f32, value: f32) -> f32 {
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

pub fn bell(offset: f32, width: f32) -> f32 {
    (-(offset / width).powi(2)).exp()
}

pub fn hash(x: i32, y: i32, z: i32) -> f32 {
    let mut state =
        (x as u32).wrapping_mul(0x8da6_b343) ^ (y as u32).wrapping_mul(0xd816_3841) ^ (z as u32).wrapping_mul(0xcb1a_b31f);
    state = (state ^ (state >> 15)).wrapping_mul(0x2c1b_3c6d);
    state = (state ^ (state >> 12)).wrapping_mul(0x297a_2d39);
    (state ^ (state >> 15)) as f32 / u32::MAX as f32
}

/// Value noise in -1..1 with cells of size one.
pub fn noise(point: Vec3) -> f32 {
    let (x0, y0, z0) = (point.x.floor(), point.y.floor(), point.z.floor());
    let fade = |t: f32| t * t * (3.0 - 2.0 * t);
    let (u, v, w) = (fade(point.x - x0), fade(point.y - y0), fade(point.z - z0));
    let (x, y, z) = (x0 as i32, y0 as i32, z0 as i32);
    let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let edge = |dy, dz| lerp(hash(x, y + dy, z + dz), hash(x + 1, y + dy, z + dz), u);
    let side = |dz| lerp(edge(0, dz), edge(1, dz), v);
    lerp(side(0), side(1), w) * 2.0 - 1.0
}

pub fn smooth_min(a: f32, b: f32, blend: f32) -> f32 {
    let overlap = (blend - (a - b).abs()).max(0.0) / blend;
    a.min(b) - overlap * overlap * blend * 0.25
}

pub fn smooth_max(a: f32, b: f32, blend: f32) -> f32 {
    -smooth_min(-a, -b, blend)
}

pub fn ellipsoid(point: Vec3, centre: Vec3, radii: Vec3) -> f32 {
    let offset = point - centre;
    let scaled = vec3(offset.x / radii.x, offset.y / radii.y, offset.z / radii.z);
    let steep = vec3(scaled.x / radii.x, scaled.y / radii.y, scaled.z / radii.z);
    let length = scaled.length();
    length * (length - 1.0) / steep.length().max(1e-6)
}

/// A capsule whose radius changes from one end to the other.
pub fn limb(point: Vec3, from: [f32; 3], to: [f32; 3], radii: [f32; 2]) -> f32 {
    let from = vec3(from[0], from[1], from[2]);
    let axis = vec3(to[0], to[1], to[2]) - from;
    let t = ((point - from).dot(axis) / axis.dot(axis)).clamp(0.0, 1.0);
    (point - from - axis * t).length() - (radii[0] + (radii[1] - radii[0]) * t)
}
