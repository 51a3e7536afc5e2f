//! Regions by colour: their borders, and the lines beside them.

use super::*;

fn png_of_colours(width: u32, height: u32, colour: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let picture = RgbImage::from_fn(width, height, |x, y| image::Rgb(colour(x, y)));
    DynamicImage::ImageRgb8(picture).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Two regions with a slanted straight border: dark grey to its left, light grey to its right.
fn two_regions(hues: [[u8; 3]; 2], set: &[(&str, &str)]) -> (Drawing, impl Fn(Point) -> f64 + use<>) {
    let is_left = |x: u32, y: u32| f64::from(x) < 150.0 + 0.05 * f64::from(y);
    let photo = png_of_light(300, 300, |x, y| if is_left(x, y) { 0.35 } else { 0.65 });
    let scribbles = png_of_colours(300, 300, |x, y| match x {
        40..60 if (100..200).contains(&y) => hues[0],
        240..260 if (100..200).contains(&y) => hues[1],
        _ => [0, 0, 0],
    });
    let mut sheet = Sheet::new(&photo, (30.0, 30.0), set);
    sheet.masks.push((MaskRole::Scribbles, scribbles));
    let mut portrait = sheet.portrait();
    portrait.depth = Some(portrait.tone.map(|_| 0.5));
    // Positive to the right of the border, in millimetres.
    (sheet.draw(&portrait), |p: Point| (p.x - 15.0 - 0.05 * p.y) / 0.05_f64.hypot(1.0))
}

#[test]
fn strokes_keep_to_their_region() {
    for (overlap, most) in [("0", 0.05), ("0.5", 0.5)] {
        // Cyan: 90 degrees, red: 0 degrees.
        let (drawing, side) = two_regions([[0, 255, 255], [255, 0, 0]], &[("look", "hatch"), ("overlap", overlap)]);
        let mut over = [f64::NEG_INFINITY; 2];
        for stroke in strokes(&drawing.layers[0]) {
            let line = points(stroke.curve());
            let along = line[line.len() - 1] - line[0];
            let is_left = along.y.abs() > along.x.abs();
            let farthest = line.iter().map(|p| if is_left { side(*p) } else { -side(*p) }).fold(f64::NEG_INFINITY, f64::max);
            let over = &mut over[usize::from(!is_left)];
            *over = over.max(farthest);
        }
        println!("overlap {overlap} mm: strokes reach {over:.3?} mm beyond their region");
        assert!(over.iter().all(|o| *o <= most + 0.05), "{over:?}");
        assert!(overlap == "0" || over[1] > 0.2, "the overlap is used: {over:?}");
    }
}

/// Keeps the regions of a drawing.
#[derive(Default)]
struct Regions(Mutex<Option<Raster<i32>>>);

impl Observer for Regions {
    fn begin(&self, _: &str) {}
    fn progress(&self, _: f64) {}
    fn picture(&self, name: &str, make: &dyn Fn() -> Picture) {
        if let ("regions", Picture::Labels(labels)) = (name, make()) {
            *self.0.lock().unwrap() = Some(labels);
        }
    }
    fn warn(&self, _: &str) {}
    fn is_interrupted(&self) -> bool {
        false
    }
}

/// A photograph divided into regions, by superpixels and by scribbles, with lines of every direction.
fn samples_in_regions(photo: &[u8], (columns, rows): (u32, u32), overlap: &str) -> Vec<(&'static str, Drawing, Raster<i32>)> {
    // Bars a third of the picture apart, each with its own hue.
    let hues = [[255, 0, 0], [255, 200, 0], [0, 255, 0], [0, 255, 255], [0, 100, 255], [255, 0, 255], [255, 0, 100]];
    let scribbles = png_of_colours(columns, rows, |x, y| match (x % 170, y % 170) {
        (70..100, 50..120) => hues[((x / 170 + 3 * (y / 170)) % 7) as usize],
        _ => [0, 0, 0],
    });
    [("superpixels", "superpixels"), ("scribbles", "auto")]
        .into_iter()
        .map(|(name, regions)| {
            let set = [("regions", regions), ("region_size", "6mm"), ("overlap", overlap)];
            let mut sheet = Sheet::new(photo, (60.0, 60.0), &set);
            if name == "scribbles" {
                sheet.masks.push((MaskRole::Scribbles, scribbles.clone()));
            }
            let kept = Regions::default();
            let drawing = find("engrave").unwrap().draw(&sheet.portrait(), &sheet.settings(), 0, &kept).unwrap();
            (name, drawing, kept.0.into_inner().unwrap().unwrap())
        })
        .collect()
}

/// Distance in pixels from a place to the nearest pixel of a label within a few pixels.
fn pixels_to(labels: &Raster<i32>, label: i32, p: Point) -> f64 {
    let reach = 12_isize;
    let (cx, cy) = (p.x.floor() as isize, p.y.floor() as isize);
    let mut least = reach as f64;
    for (x, y) in (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (cx + i, cy + j))) {
        if labels.contains(x, y) && labels.clamped(x, y) == label {
            let off = |v: f64, at: isize| (at as f64 - v).max(v - at as f64 - 1.0).max(0.0);
            least = least.min(off(p.x, x).hypot(off(p.y, y)));
        }
    }
    least
}

/// The region that a stroke leaves least, and by how many millimetres it leaves it.
fn region_of(labels: &Raster<i32>, line: &[Point]) -> (i32, f64) {
    let places: Vec<Point> = line.iter().map(|p| Point::new(p.x / PIXEL, p.y / PIXEL)).collect();
    let label_at = |p: &Point| labels.clamped(p.x.floor() as isize, p.y.floor() as isize);
    let mut crossed: Vec<i32> = places.iter().map(label_at).filter(|label| *label > 0).collect();
    crossed.sort_unstable();
    crossed.dedup();
    let farthest = |label: i32| {
        places.iter().filter(|p| label_at(p) != label).map(|p| pixels_to(labels, label, *p)).fold(0.0, f64::max) * PIXEL
    };
    crossed.into_iter().map(|label| (label, farthest(label))).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
}

/// Greatest length along which strokes of two regions run within 15 degrees and half a pitch of each other.
fn longest_side_by_side(lines: &[(i32, Vec<Point>)]) -> f64 {
    const STEP: f64 = 0.1;
    let fine: Vec<(i32, Vec<Point>)> = lines.iter().map(|(label, line)| (*label, resample(line, STEP))).collect();
    let cell = |p: Point| ((p.x / (0.5 * PITCH)).floor() as i64, (p.y / (0.5 * PITCH)).floor() as i64);
    let mut cells: HashMap<(i64, i64), Vec<Leg>> = HashMap::new();
    for (k, (_, line)) in fine.iter().enumerate() {
        line.windows(2).for_each(|pair| cells.entry(cell(pair[0])).or_default().push((k, [pair[0], pair[1]])));
    }
    let mut longest = 0.0_f64;
    for (label, line) in &fine {
        // Length that each stroke of another region has run beside this one so far.
        let mut runs: HashMap<usize, f64> = HashMap::new();
        for pair in line.windows(2) {
            let (way, (x, y)) = (pair[1] - pair[0], cell(pair[0]));
            let near = (-2..=2).flat_map(|j| (-2..=2).map(move |i| (x + i, y + j))).filter_map(|c| cells.get(&c)).flatten();
            let beside: HashSet<usize> = near
                .filter(|(k, s)| {
                    let sine = way.cross(s[1] - s[0]).abs() / (way.hypot() * (s[1] - s[0]).hypot()).max(1e-12);
                    fine[*k].0 != *label
                        && sine < 15.0_f64.to_radians().sin()
                        && distance_to_segment(pair[0], s[0], s[1]) < 0.5 * PITCH
                })
                .map(|(k, _)| *k)
                .collect();
            runs = beside.into_iter().map(|k| (k, runs.get(&k).unwrap_or(&0.0) + way.hypot())).collect();
            longest = runs.values().copied().fold(longest, f64::max);
        }
    }
    longest
}

#[test]
fn samples_in_regions_have_clean_edges() {
    assert_clean_edges("0", 0.0);
}

#[test]
fn samples_in_overlapping_regions_have_clean_edges() {
    assert_clean_edges("0.5", 0.5);
}

fn assert_clean_edges(overlap: &str, most: f64) {
    let photos = [("astronaut.jpg", (512, 512)), ("coffee.png", (600, 400)), ("chelsea.png", (451, 300))];
    let drawings = photos.into_iter().flat_map(|(photo, size)| {
        samples_in_regions(&sample(photo), size, overlap)
            .into_iter()
            .map(move |(regions, drawing, labels)| (format!("{photo}, {regions}"), drawing, labels))
    });
    for (name, drawing, labels) in drawings {
        for layer in &drawing.layers {
            let lines: Vec<Vec<Point>> = strokes(layer).iter().map(|s| points(s.curve())).collect();
            let lines: Vec<(i32, Vec<Point>, f64)> = lines
                .into_iter()
                .map(|line| {
                    let (label, over) = region_of(&labels, &line);
                    (label, line, over)
                })
                .collect();
            let over = lines.iter().map(|line| line.2).fold(0.0, f64::max);
            let shortest = lines.iter().map(|line| polyline_length(&line.1)).fold(f64::INFINITY, f64::min);
            let beside = longest_side_by_side(&lines.into_iter().map(|(label, line, _)| (label, line)).collect::<Vec<_>>());
            println!(
                "{name}, overlap {overlap}, {}: strokes reach {over:.3} mm beyond their region, the shortest is \
                 {shortest:.3} mm, two run side by side for {beside:.2} mm",
                layer.name
            );
            // Half a pixel: the regions' borders are curves between pixel centres.
            assert!(over <= most + 0.05, "{over}");
            assert!(shortest >= 0.5 * PITCH - 1e-3, "{shortest}");
            assert!(beside <= 2.0 * PITCH, "{beside}");
        }
        if overlap == "0" {
            assert_apart(&drawing, &name);
        }
    }
}

#[test]
fn there_are_no_stubs() {
    let photo = sample("astronaut.jpg");
    let set = [("regions", "superpixels"), ("region_size", "6mm"), ("look", "crosshatch")];
    let sheet = Sheet::new(&photo, (60.0, 60.0), &set);
    let drawing = sheet.draw(&sheet.portrait());
    assert_apart(&drawing, "superpixels");
    for layer in &drawing.layers {
        let shortest = strokes(layer).iter().map(|s| polyline_length(&points(s.curve()))).fold(f64::INFINITY, f64::min);
        println!("{}: shortest stroke {shortest:.3} mm", layer.name);
        assert!(shortest >= 0.5 * PITCH - 1e-3, "{shortest}");
    }
}

#[test]
fn regions_lines_do_not_run_side_by_side() {
    // Cyan and a slightly bluer cyan: 90 and 94 degrees, along the border.
    let (drawing, side) = two_regions([[0, 255, 255], [0, 221, 255]], &[("look", "hatch"), ("thinnest", "0")]);
    let lines: Vec<Vec<Point>> = strokes(&drawing.layers[0]).iter().map(|s| points(s.curve())).collect();
    let (left, right): (Vec<_>, Vec<_>) = lines.into_iter().partition(|line| side(line[line.len() / 2].midpoint(line[0])) < 0.0);
    assert!(left.len() > 10 && right.len() > 10, "{} and {}", left.len(), right.len());
    let mut longest = 0.0_f64;
    for line in &left {
        let mut run = 0.0;
        let fine = resample(line, 0.05);
        for pair in fine.windows(2) {
            let is_near = right.iter().any(|other| {
                other.windows(2).any(|s| {
                    let angle =
                        (pair[1] - pair[0]).cross(s[1] - s[0]).abs() / ((pair[1] - pair[0]).hypot() * (s[1] - s[0]).hypot());
                    angle < 15.0_f64.to_radians().sin() && distance_to_segment(pair[0], s[0], s[1]) < 0.5 * PITCH
                })
            });
            run = if is_near { run + 0.05 } else { 0.0 };
            longest = longest.max(run);
        }
    }
    println!("strokes of two regions side by side for {longest:.2} mm at most");
    assert!(longest <= 2.0 * PITCH, "{longest}");
}

#[test]
fn no_outline_meets_itself() {
    assert!(segments_a_centimetre() > 0.0);
}

#[test]
fn strokes_are_few_smooth_curves() {
    let per_cm = segments_a_centimetre();
    assert!(per_cm <= 12.0, "{per_cm}");
}

/// Bezier segments per centimetre of stroke, both sides and ends, on a smooth form; no outline may cross itself.
fn segments_a_centimetre() -> f64 {
    let photo = png_of_light(300, 300, |x, y| 0.45 + 0.3 * (f64::from(x) / 70.0).sin() * (f64::from(y) / 90.0).cos());
    let sheet = Sheet::new(&photo, (60.0, 60.0), WHOLE);
    let mut portrait = sheet.portrait();
    let depth = |x: usize, y: usize| 0.5 + 0.3 * (x as f32 / 90.0).sin() * (y as f32 / 70.0).cos();
    portrait.depth = Some(Raster::from_fn(portrait.placement.columns, portrait.placement.rows, depth));
    let drawing = sheet.draw(&portrait);
    let (mut pieces, mut length) = (0, 0.0);
    for stroke in strokes(&drawing.layers[0]) {
        let outline = stroke.outline().unwrap();
        pieces += outline.segments().count();
        length += stroke.length();
        let mut ring = flatten(&outline, 0.002).remove(0).0;
        ring.dedup_by(|a, b| a.distance(*b) < 1e-6);
        if ring[0].distance(ring[ring.len() - 1]) < 1e-6 {
            ring.pop();
        }
        assert!(!meets_itself(&ring), "an outline meets itself near {:?}", ring[0]);
    }
    let per_cm = f64::from(pieces as u32) / (0.1 * length);
    println!("swell: {per_cm:.2} Bezier segments a centimetre, both sides and ends");
    per_cm
}

/// True if a closed ring crosses itself, by testing all pairs of segments that are near along x.
fn meets_itself(ring: &[Point]) -> bool {
    let count = ring.len();
    let segment = |i: usize| [ring[i], ring[(i + 1) % count]];
    let mut order: Vec<usize> = (0..count).collect();
    let left = |i: usize| segment(i)[0].x.min(segment(i)[1].x);
    order.sort_by(|a, b| left(*a).total_cmp(&left(*b)));
    order.iter().enumerate().any(|(n, &i)| {
        let right = segment(i)[0].x.max(segment(i)[1].x);
        order[n + 1..].iter().take_while(|j| left(**j) <= right).any(|&j| {
            let apart = i.abs_diff(j).min(count - i.abs_diff(j));
            apart > 1 && segment_distance(segment(i), segment(j)) == 0.0
        })
    })
}
