//! Sines, logarithms and their kin, with the same bits on every machine.
//!
//! The standard library asks the system for these functions, and no two systems agree on their last bits: a drawing would differ
//! between Linux, Windows and a browser. `libm` computes them from additions and multiplications, which are exact everywhere.

/// Elementary functions of floating-point numbers. Angles are in radians.
#[allow(dead_code, reason = "the library alone does not use all")]
pub(crate) trait Elementary: Sized {
    fn sine(self) -> Self;
    fn cosine(self) -> Self;
    fn tangent(self) -> Self;
    fn arc_sine(self) -> Self;
    fn arc_cosine(self) -> Self;
    fn arc_tangent(self) -> Self;
    fn hyperbolic_tangent(self) -> Self;
    /// e to this power.
    fn exponential(self) -> Self;
    fn logarithm(self) -> Self;
    fn logarithm_above_1(self) -> Self;
    fn binary_logarithm(self) -> Self;
    fn decimal_logarithm(self) -> Self;
    fn cube_root(self) -> Self;
    fn power(self, exponent: Self) -> Self;
    /// The angle of the point that lies this far up and `x` to the right, from -pi to pi.
    fn angle_over(self, x: Self) -> Self;
    /// The length of the longest side of a triangle with a right angle. It overflows where a square does.
    fn hypotenuse(self, other: Self) -> Self;

    fn sine_and_cosine(self) -> (Self, Self);
}

macro_rules! elementary {
    ($number:ty: $sin:ident $cos:ident $tan:ident $asin:ident $acos:ident $atan:ident $tanh:ident $exp:ident $log:ident $log1p:ident
        $log2:ident $log10:ident $cbrt:ident $pow:ident $atan2:ident $sincos:ident) => {
        impl Elementary for $number {
            #[inline]
            fn sine(self) -> Self {
                libm::$sin(self)
            }
            #[inline]
            fn cosine(self) -> Self {
                libm::$cos(self)
            }
            #[inline]
            fn tangent(self) -> Self {
                libm::$tan(self)
            }
            #[inline]
            fn arc_sine(self) -> Self {
                libm::$asin(self)
            }
            #[inline]
            fn arc_cosine(self) -> Self {
                libm::$acos(self)
            }
            #[inline]
            fn arc_tangent(self) -> Self {
                libm::$atan(self)
            }
            #[inline]
            fn hyperbolic_tangent(self) -> Self {
                libm::$tanh(self)
            }
            #[inline]
            fn exponential(self) -> Self {
                libm::$exp(self)
            }
            #[inline]
            fn logarithm(self) -> Self {
                libm::$log(self)
            }
            #[inline]
            fn logarithm_above_1(self) -> Self {
                libm::$log1p(self)
            }
            #[inline]
            fn binary_logarithm(self) -> Self {
                libm::$log2(self)
            }
            #[inline]
            fn decimal_logarithm(self) -> Self {
                libm::$log10(self)
            }
            #[inline]
            fn cube_root(self) -> Self {
                libm::$cbrt(self)
            }
            #[inline]
            fn power(self, exponent: Self) -> Self {
                libm::$pow(self, exponent)
            }
            #[inline]
            fn angle_over(self, x: Self) -> Self {
                libm::$atan2(self, x)
            }
            #[inline]
            fn hypotenuse(self, other: Self) -> Self {
                (self * self + other * other).sqrt()
            }
            #[inline]
            fn sine_and_cosine(self) -> (Self, Self) {
                libm::$sincos(self)
            }
        }
    };
}

elementary!(f64: sin cos tan asin acos atan tanh exp log log1p log2 log10 cbrt pow atan2 sincos);
elementary!(f32: sinf cosf tanf asinf acosf atanf tanhf expf logf log1pf log2f log10f cbrtf powf atan2f sincosf);

/// The vector of length 1 at an angle.
pub(crate) fn unit_at(angle: f64) -> kurbo::Vec2 {
    let (sine, cosine) = angle.sine_and_cosine();
    kurbo::Vec2::new(cosine, sine)
}

/// The angle of a vector, from -pi to pi.
pub(crate) fn angle_of(vector: kurbo::Vec2) -> f64 {
    vector.y.angle_over(vector.x)
}

/// A turn around the origin.
pub(crate) fn turned_by(angle: f64) -> kurbo::Affine {
    let (sine, cosine) = angle.sine_and_cosine();
    kurbo::Affine::new([cosine, sine, -sine, cosine, 0.0, 0.0])
}
