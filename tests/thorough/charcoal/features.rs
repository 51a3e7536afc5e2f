//! Features and hair that are found without masks.

use super::*;

/// The photograph lit from the left: light falls to half at the right border.
fn side_lit(photo: &[u8]) -> Vec<u8> {
    let picture = image::load_from_memory(photo).unwrap().to_rgba8();
    let width = f64::from(picture.width());
    let lit = |value: u8, share: f64| {
        let v = f64::from(value) / 255.0;
        let linear = if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) } * share;
        let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0).round() as u8
    };
    let pixels = ImageBuffer::from_fn(picture.width(), picture.height(), |x, y| {
        let share = 1.0 - 0.5 * f64::from(x) / width;
        let p = picture.get_pixel(x, y);
        Rgb([lit(p[0], share), lit(p[1], share), lit(p[2], share)])
    });
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::ImageRgb8(pixels).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Boxes of the features in the photograph's pixels, in the order of their labels.
type Boxes = [[f64; 4]; 6];

const ASTRONAUT: Boxes = [
    [186.0, 84.0, 214.0, 96.0],
    [236.0, 88.0, 267.0, 100.0],
    [190.0, 94.0, 215.0, 109.0],
    [234.0, 95.0, 261.0, 110.0],
    [203.0, 120.0, 247.0, 137.0],
    [201.0, 137.0, 252.0, 157.0],
];
/// The brows are seen through the upper rim of the glasses, which hides most of them.
const HOPPER: Boxes = [
    [178.0, 158.0, 252.0, 185.0],
    [276.0, 153.0, 347.0, 181.0],
    [196.0, 177.0, 247.0, 202.0],
    [282.0, 174.0, 334.0, 200.0],
    [234.0, 225.0, 298.0, 254.0],
    [222.0, 264.0, 312.0, 298.0],
];

fn bust_boxes() -> Boxes {
    let text = String::from_utf8(sample("bust-features.txt")).unwrap();
    FacialFeature::ALL.map(|feature| {
        // "eye" must not match "eyebrow": a number follows the name.
        let is_its_own = |line: &&str| line.strip_prefix(feature.name()).is_some_and(|rest| rest.starts_with(' '));
        let line = text.lines().find(is_its_own).unwrap();
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        [numbers[0], numbers[1], numbers[2], numbers[3]]
    })
}

/// Number of the six features whose middle is inside its box, grown by an eighth of its size on each side.
fn features_in_place(name: &str, notes: &Notes, boxes: &Boxes, scale: f64) -> usize {
    let labels = notes.features.lock().unwrap();
    let Some(labels) = labels.as_ref() else {
        println!("{name}: no face");
        return 0;
    };
    let mut right = 0;
    for (i, wanted) in boxes.iter().enumerate() {
        let (mut x, mut y, mut count) = (0.0, 0.0, 0.0);
        for (k, _) in labels.pixels().iter().enumerate().filter(|(_, label)| **label == i as i32 + 1) {
            x += (k % labels.width()) as f64 + 0.5;
            y += (k / labels.width()) as f64 + 0.5;
            count += 1.0;
        }
        let (x, y) = (x / count / scale, y / count / scale);
        let (mx, my) = ((wanted[2] - wanted[0]) / 8.0, (wanted[3] - wanted[1]) / 8.0);
        let is_inside = x >= wanted[0] - mx && x <= wanted[2] + mx && y >= wanted[1] - my && y <= wanted[3] + my;
        if !is_inside {
            println!("{name}: {} at {x:.0}, {y:.0}, not in {wanted:?}", FacialFeature::ALL[i].name());
        }
        right += usize::from(is_inside);
    }
    right
}

#[test]
fn features_of_the_busts_are_found_in_both_lights() {
    let masks = [
        (MaskRole::Subject, sample("bust-mask-subject.png")),
        (MaskRole::Hair, sample("bust-mask-hair.png")),
        (MaskRole::Face, sample("bust-mask-face.png")),
    ];
    for name in ["bust-light.png", "bust-brown.png", "bust-dark.png"] {
        for (light, photo) in [("normal", sample(name)), ("side", side_lit(&sample(name)))] {
            let notes = Notes::default();
            Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (90.0, 120.0)) }.draw(&notes);
            let right = features_in_place(name, &notes, &bust_boxes(), 1.0);
            println!("{name}, {light} light: {right} of 6 features");
            assert_eq!(right, 6, "{name}, {light} light");
        }
    }
}

/// The number of features in place without a face mask, in both lights.
fn portrait_features(name: &str, mm: (f64, f64), mask: Vec<u8>, boxes: &Boxes) -> Vec<usize> {
    let masks = [(MaskRole::Subject, mask)];
    let count = |(light, photo): (&str, Vec<u8>)| {
        let notes = Notes::default();
        Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, mm) }.draw(&notes);
        let right = features_in_place(name, &notes, boxes, 600.0 / 512.0);
        println!("{name}, {light} light: {right} of 6 features");
        right
    };
    [("normal", sample(name)), ("side", side_lit(&sample(name)))].map(count).to_vec()
}

#[test]
fn features_behind_glasses_are_found_without_a_face_mask() {
    let right = portrait_features("grace-hopper.jpg", (90.0, 105.469), sample("grace-hopper-subject.png"), &HOPPER);
    assert_eq!(right, [6, 6]);
}

#[test]
fn features_under_a_fringe_are_found_without_a_face_mask() {
    let right = portrait_features("astronaut.jpg", (90.0, 90.0), sample_alpha("astronaut-cutout.png"), &ASTRONAUT);
    assert_eq!(right, [6, 6]);
}

/// The light bust with its hair replaced by skin, lit from one side (`shade` from the lit side to the other, in encoded light),
/// with a highlight on the forehead.
fn shaved_bust(shade: (f64, f64), gleam: f64) -> Vec<u8> {
    use image::{ImageFormat, Rgb};
    let open = |name: &str| image::load_from_memory(&sample(name)).unwrap();
    let (mut bust, hair, face) =
        (open("bust-light.png").to_rgb8(), open("bust-mask-hair.png").to_luma8(), open("bust-mask-face.png").to_luma8());
    let in_face = || face.enumerate_pixels().filter(|(.., v)| v.0[0] > 200);
    let skin: [f64; 3] = [0, 1, 2].map(|channel| {
        let mut values: Vec<u8> = in_face().map(|(x, y, _)| bust.get_pixel(x, y).0[channel]).collect();
        values.sort_unstable();
        f64::from(values[values.len() / 2])
    });
    let (left, right) =
        hair.enumerate_pixels().filter(|(.., v)| v.0[0] > 127).fold((u32::MAX, 0), |(l, r), (x, ..)| (l.min(x), r.max(x)));
    let top = in_face().map(|(_, y, _)| y).min().unwrap();
    let (width, middle) = (f64::from(right - left), 0.5 * f64::from(left + right));
    // Includes single strands that hang out of the mask.
    let is_near = |x: u32, y: u32| {
        let step = |v: u32, by: i64, most: u32| (i64::from(v) + by).clamp(0, i64::from(most) - 1) as u32;
        let reach = [-14, -7, 0, 7, 14_i64];
        reach
            .iter()
            .any(|dx| reach.iter().any(|dy| hair.get_pixel(step(x, *dx, hair.width()), step(y, *dy, hair.height())).0[0] > 60))
    };
    for (x, y, _) in hair.enumerate_pixels().filter(|(x, y, _)| is_near(*x, *y)) {
        let across = (f64::from(x) - f64::from(left)) / width;
        let away = (f64::from(x) - middle).hypot(f64::from(y) - f64::from(top)) / (0.22 * width);
        let share = shade.0 + (shade.1 - shade.0) * across + gleam * (-away * away).exp();
        // Skin in shade is a little redder.
        let redder = [1.0, 1.0 - 0.1 * (1.0 - share).max(0.0), 1.0 - 0.2 * (1.0 - share).max(0.0)];
        let pixel = [0, 1, 2].map(|i| (skin[i] * share * redder[i]).clamp(0.0, 255.0) as u8);
        bust.put_pixel(x, y, Rgb(pixel));
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    bust.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const NO_EVIDENCE: &str = "too like the skin";

#[test]
fn a_shaved_head_gets_no_wig_and_the_user_hears_of_it() {
    for (shade, gleam) in [((1.0, 0.68), 0.0), ((1.05, 0.72), 0.12), ((0.95, 0.85), 0.3)] {
        let photo = shaved_bust(shade, gleam);
        if let Some(folder) = std::env::var_os("DRYPOINT_SHOW") {
            std::fs::write(std::path::Path::new(&folder).join(format!("shaved-{gleam}.png")), &photo).unwrap();
        }
        let masks = [(MaskRole::Subject, sample("bust-mask-subject.png"))];
        let notes = Notes::default();
        let drawing = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (45.0, 60.0)) }.draw(&notes);
        let warnings = notes.warnings.lock().unwrap().join("\n");
        assert!(drawing.layers.iter().all(|layer| layer.name != "hair"), "{shade:?} {gleam}: a wig");
        assert!(warnings.contains("a mask of the role hair"), "{shade:?} {gleam}: {warnings}");
    }
}

#[test]
fn the_busts_hair_is_found_without_a_mask() {
    for name in ["bust-light.png", "bust-brown.png", "bust-dark.png"] {
        let photo = sample(name);
        let masks = [(MaskRole::Subject, sample("bust-mask-subject.png"))];
        let notes = Notes::default();
        let drawing = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (45.0, 60.0)) }.draw(&notes);
        let warnings = notes.warnings.lock().unwrap().join("\n");
        assert!(drawing.layers.iter().any(|layer| layer.name == "hair"), "{name}: {warnings}");
        assert!(!warnings.contains(NO_EVIDENCE), "{name}: {warnings}");
    }
}

#[test]
fn skin_points_can_be_given() {
    let masks = [(MaskRole::Subject, sample("bust-mask-subject.png")), (MaskRole::Face, sample("bust-mask-face.png"))];
    let set: Vec<(&str, &str)> = QUICK.iter().copied().chain([("skin", "30,45;35,45;46,29;57,45;62,43")]).collect();
    let (photo, notes) = (side_lit(&sample("bust-light.png")), Notes::default());
    Sitting { masks: &masks, set: &set, ..Sitting::new(&photo, (90.0, 120.0)) }.draw(&notes);
    assert_eq!(features_in_place("bust-light.png", &notes, &bust_boxes(), 1.0), 6);
    let wrong = [("skin".to_owned(), "30,45;35".to_owned())];
    assert!(Settings::resolve("charcoal", find("charcoal").unwrap().parameters(), &wrong).is_err());
}
