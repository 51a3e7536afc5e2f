//! The samples that drawings are measured on.

/// A sample, its size and its subject mask.
pub type SamplePicture = (&'static str, (f64, f64), Option<&'static str>);

/// The samples whose tone is measured.
pub const SAMPLES: [SamplePicture; 9] = [
    ("astronaut.jpg", (90.0, 90.0), None),
    ("astronaut-cutout.png", (90.0, 90.0), None),
    ("grace-hopper.jpg", (90.0, 105.469), Some("grace-hopper-subject.png")),
    ("chelsea.png", (90.0, 59.867), None),
    ("coffee.png", (90.0, 60.0), None),
    ("raccoon.jpg", (90.0, 67.5), None),
    ("bust-light.png", (90.0, 120.0), Some("bust-mask-subject.png")),
    ("bust-brown.png", (90.0, 120.0), Some("bust-mask-subject.png")),
    ("bust-dark.png", (90.0, 120.0), Some("bust-mask-subject.png")),
];
