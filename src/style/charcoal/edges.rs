//! Step 3: edges (sections 3.1.3 and 6.3.2).

use super::Drawer;
use super::features::Features;
use super::regions::Regions;
use super::strokes::Touch;
use crate::drawing::Mark;
use crate::elementary::Elementary as _;
use crate::field::{Curve, EdgeParameters, contours, detect_edges, distance_to_curves, lines_of};
use crate::geometry::{Point, Ring, Vec2, polyline_length, smooth_polyline};
use crate::raster::{Raster, dilate, thin};
use crate::source::MaskRole;
use crate::style::Picture;
use crate::style::creases::Creases;
use crate::style::jaw::Jaws;
use crate::style::random::stream;
use rand::{Rng, RngExt};
use std::f64::consts::TAU;

impl Drawer<'_> {
    pub(super) fn edges(&self, regions: &Regions, features: &Features) -> Vec<Mark> {
        /// Pressures of the displaced segments and of the line itself, which is emphasised (section 6.3.2).
        const SKETCH_PRESSURE: f64 = 0.25;
        const LINE_PRESSURE: f64 = 0.9;
        /// Width of an edge as a share of the stick's: contours must stay lighter than the features.
        const LINE_WIDTH: f64 = 0.8;
        self.observer.begin("edges");
        let faces = Creases::of(self.portrait);
        let least = self.pixels(self.parameters.edge_length);
        let lines = self.edge_lines(regions, features);
        // A shadow in a face ends as a tone: its outline would be a scar. Lines that the user wants stay, wherever and however short.
        let is_chosen = self.portrait.masks.contains_key(&MaskRole::Edges);
        let lines: Vec<Vec<Point>> = lines
            .iter()
            .flat_map(|line| open_pieces(line, |p| !is_chosen && faces.are_in(*p)))
            .filter(|piece| is_chosen || polyline_length(piece) >= least)
            .collect();
        let jaws = if is_chosen { Vec::new() } else { Jaws::of(self.portrait, self.pitch()).curves() };
        let lines = self.not_beside(lines, &jaws, least);
        let touch = Touch {
            width: LINE_WIDTH * self.parameters.stroke_width,
            pressure: LINE_PRESSURE,
            taper: 0.3,
            node: 2.0 * self.parameters.pitch,
        };
        // As firm as what is drawn asks for: a background that is not drawn makes no line firm, and the light side's line is faint.
        let tone = self.portrait.on_white(&self.portrait.tone);
        let mut marks = Vec::new();
        for (i, points) in lines.iter().enumerate() {
            let mut random = stream(self.seed, "sketch", i as u64);
            for _ in 0..self.parameters.sketch_passes {
                let light = Touch { pressure: SKETCH_PRESSURE, ..touch };
                let segments = self.sketched(points, &mut random);
                marks.extend(segments.iter().filter_map(|segment| self.stroke(segment, light, |_| 1.0)));
            }
            let firm = self.firmness(&tone, points, &mut random);
            marks.extend(self.stroke(points, touch, |p| firm.get(nearest(points, p)).copied().unwrap_or(1.0)));
        }
        marks.extend(jaws.iter().enumerate().flat_map(|(i, jaw)| self.jaw(jaw, &tone, i as u64, touch)));
        marks
    }

    /// The soft line of a jaw, where it shows.
    fn jaw(&self, jaw: &Curve, tone: &Raster<f32>, element: u64, touch: Touch) -> Vec<Mark> {
        /// Pressure from which a jaw is drawn, the most that it has, and the share of it over which it fades out at both ends: a firm line
        /// that stops is a wire, and so is one where the face has no border.
        const JAW_PRESSURE: (f64, f64) = (0.2, 0.6);
        const JAW_FADES: f64 = 0.3;
        let firm = self.firmness(tone, &jaw.points, &mut stream(self.seed, "jaw", element));
        let last = (jaw.points.len() - 1) as f64;
        let pressure = |p: Point| {
            let at = nearest(&jaw.points, p);
            let along = at as f64 / last;
            let fade = (along.min(1.0 - along) / JAW_FADES).min(1.0);
            fade * firm.get(at).copied().unwrap_or(0.0).min(JAW_PRESSURE.1)
        };
        let shown = |p: &Point| firm.get(nearest(&jaw.points, *p)).is_some_and(|firm| *firm >= JAW_PRESSURE.0);
        let pieces =
            jaw.points.split(|p| !shown(p)).filter(|piece| polyline_length(piece) >= self.pixels(8.0 * self.parameters.pitch));
        pieces.filter_map(|piece| self.stroke(piece, touch, pressure)).collect()
    }

    /// What is left of lines that do not run along one of the others.
    fn not_beside(&self, lines: Vec<Vec<Point>>, others: &[Curve], least: f64) -> Vec<Vec<Point>> {
        /// Distance within which two lines are one, in pitches.
        const BESIDE: f64 = 8.0;
        let (width, height) = self.size();
        let Some(field) = distance_to_curves(others, width, height) else { return lines };
        let reach = self.pixels(BESIDE * self.parameters.pitch) as f32;
        let is_beside = |p: &Point| field.distance.sample(p.x, p.y) < reach;
        let open = |points: Vec<Point>| open_pieces(&Curve { points, closed: false }, is_beside);
        lines.into_iter().flat_map(open).filter(|piece| polyline_length(piece) >= least).collect()
    }

    /// Edges without the image mask and the specks, chosen by the user's keep mask; plus the subject's border.
    fn edge_lines(&self, regions: &Regions, features: &Features) -> Vec<Curve> {
        /// Brightness of the keep mask above which an edge is kept.
        const KEPT: f32 = 0.25;
        /// Tolerance in pixels between an edge and the keep mask.
        const KEPT_REACH: usize = 2;
        if self.portrait.masks.get(&MaskRole::Edges).is_some_and(|mask| mask.pixels().iter().all(|v| *v < KEPT)) {
            // None is wanted.
            return Vec::new();
        }
        let parameters = self.edge_parameters();
        let steps = detect_edges(&self.portrait.on_white(&self.portrait.lightness), parameters);
        self.observer.picture("canny", &|| Picture::Mask(steps.canny.clone()));
        let hidden = self.hidden(regions, features);
        let kept = steps.skeleton.zip_map(&hidden, |edge, hidden| if hidden != 0 { 0 } else { edge });
        let Some(wanted) = self.portrait.masks.get(&MaskRole::Edges).map(|mask| mask.map(|v| u8::from(v >= KEPT))) else {
            self.observer.picture("edges-kept", &|| Picture::Mask(kept.clone()));
            let found = lines_of(&kept, parameters.smoothing, parameters.least_length);
            return self.with_silhouette(found, regions, &hidden);
        };
        let near = dilate(&wanted, KEPT_REACH);
        let drawn = self.drawn_by_hand(&wanted, &kept);
        let kept = kept.zip_map(&near, |edge, keep| edge & keep).zip_map(&drawn, |edge, drawn| edge | drawn);
        self.observer.picture("edges-kept", &|| Picture::Mask(kept.clone()));
        // Lines kept by the user are not specks, however short.
        let found = lines_of(&kept, parameters.smoothing, self.pitch() as f32);
        let hidden = hidden.zip_map(&near, |hidden, near| hidden | (1 - near));
        self.with_silhouette(found, regions, &hidden)
    }

    /// Thinned lines of a keep mask that follow no detected edge; broad strokes of the mask only select edges.
    fn drawn_by_hand(&self, wanted: &Raster<u8>, found: &Raster<u8>) -> Raster<u8> {
        let pitch = self.pitch().round().max(1.0) as usize;
        let outside = dilate(&wanted.map(|v| 1 - v), pitch);
        let broad = dilate(&outside.map(|v| 1 - v), 2 * pitch);
        let followed = dilate(found, pitch);
        thin(&wanted.zip_map(&broad, |v, broad| v & (1 - broad)).zip_map(&followed, |v, followed| v & (1 - followed)))
    }

    fn edge_parameters(&self) -> EdgeParameters {
        EdgeParameters {
            blur: self.pixels(self.parameters.edge_blur) as f32,
            thresholds: self.thresholds(self.parameters.edge_low, self.parameters.edge_high),
            least_length: self.pixels(self.parameters.edge_length) as f32,
            smoothing: self.pitch() as f32,
        }
    }

    /// The image mask: regions that other steps draw. The background is inset by a few pixels, since the subject's border is an edge;
    /// hair includes its border, which needs no line.
    fn hidden(&self, regions: &Regions, features: &Features) -> Raster<u8> {
        let margin = self.pitch().round().max(1.0) as usize;
        let near_subject = dilate(&regions.subject.map(|v| u8::from(v >= 0.5)), margin);
        let hair = dilate(&regions.hair.map(|v| u8::from(v >= 0.5)), margin);
        let drawn = dilate(&features.drawn.map(|v| u8::from(v > 0.0)), margin);
        let hidden = near_subject.zip_map(&hair, |near, hair| u8::from(near == 0 || hair != 0));
        hidden.zip_map(&drawn, |hidden, drawn| hidden | drawn)
    }

    /// Adds the subject's exact contour and removes detected edges beside it.
    fn with_silhouette(&self, found: Vec<Curve>, regions: &Regions, hidden: &Raster<u8>) -> Vec<Curve> {
        if !regions.has_background {
            return found;
        }
        let least = self.pixels(self.parameters.edge_length);
        let smoothing = self.pixels(1.5 * self.parameters.pitch);
        let (width, height) = self.size();
        let is_hidden = |p: &Point| hidden.clamped(p.x as isize, p.y as isize) != 0;
        let silhouette: Vec<Curve> = contours(&regions.subject, 0.5)
            .into_iter()
            .filter(|line| line.length() >= least)
            .flat_map(|line| open_pieces(&line, is_hidden))
            .filter(|piece| polyline_length(piece) >= least)
            .map(|piece| Curve { points: smooth_polyline(&piece, Ring::Open, smoothing, 1.5), closed: false })
            .collect();
        let Some(field) = distance_to_curves(&silhouette, width, height) else { return found };
        let reach = self.pixels(1.6 * self.parameters.pitch) as f32;
        let beside = |p: &Point| field.distance.sample(p.x, p.y) < reach;
        let apart = found.iter().flat_map(|line| open_pieces(line, beside)).filter(|piece| polyline_length(piece) >= least);
        let apart: Vec<Curve> = apart.map(|points| Curve { points, closed: false }).collect();
        silhouette.into_iter().chain(apart).collect()
    }

    /// Pressure along an edge: by the step of tone at each point, with the wander of a hand.
    fn firmness(&self, tone: &Raster<f32>, points: &[Point], random: &mut impl Rng) -> Vec<f64> {
        /// Length of line, in pitches, over which the hand's pressure wanders, and its amplitude.
        const WANDER: (f64, f64) = (9.0, 0.35);
        /// Pressure without a step, and by how much it grows over a whole step. At twice the growth a light head is in a wire.
        const FAINTEST: f64 = 0.08;
        const STEEP: f64 = 1.3;
        let reach = self.pixels(1.5 * self.parameters.pitch);
        let phase = random.random_range(0.0..TAU);
        let wave = TAU / (WANDER.0 * self.pitch() * random.random_range(0.7..1.4));
        let mut travelled = 0.0;
        let steps = points.windows(2).map(|pair| {
            let along = pair[1] - pair[0];
            travelled += along.hypot();
            let across = Vec2::new(-along.y, along.x) / along.hypot().max(1e-9) * reach;
            let at = |p: Point| f64::from(tone.sample(p.x, p.y));
            let step = (at(pair[0] + across) - at(pair[0] - across)).abs();
            let wander = 1.0 - WANDER.1 * (0.5 + 0.5 * (wave * travelled + phase).sine());
            ((FAINTEST + STEEP * step) * wander).clamp(FAINTEST, 1.0)
        });
        let firm: Vec<f64> = steps.collect();
        running_mean(&firm, (4.0 * self.pitch()) as usize)
    }

    /// Overlapping pieces of a line, each with randomly displaced ends.
    fn sketched(&self, points: &[Point], random: &mut impl Rng) -> Vec<Vec<Point>> {
        /// Length of a displaced segment as a share of its line, and the overlap of neighbours.
        const SEGMENT: (f64, f64) = (0.3, 0.7);
        const OVERLAP: f64 = 0.3;
        let length = polyline_length(points);
        let offset = self.pixels(self.parameters.sketch_offset);
        let least = 8.0 * self.pitch();
        let mut pieces = Vec::new();
        let mut from = 0.0;
        while from < length {
            let share = random.random_range(SEGMENT.0..SEGMENT.1);
            let long = (share * length).clamp(least.min(length), 5.0 * least);
            let mut shift = || Vec2::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0)) * offset;
            let (first, last) = (shift(), shift());
            let piece = between(points, from, (from + long).min(length));
            let end = (piece.len().max(2) - 1) as f64;
            pieces.push(piece.iter().enumerate().map(|(i, p)| *p + first.lerp(last, i as f64 / end)).collect());
            if from + long >= length {
                break;
            }
            from += long * (1.0 - OVERLAP);
        }
        pieces
    }
}

/// The runs of a line for which `is_out` is false.
fn open_pieces(line: &Curve, is_out: impl Fn(&Point) -> bool) -> Vec<Vec<Point>> {
    let mut points = line.points.clone();
    if line.closed {
        // Starts at a point that is out, so that no run is cut at the seam.
        let start = points.iter().position(&is_out).unwrap_or(0);
        points.rotate_left(start);
        points.push(points[0]);
    }
    points.split(is_out).filter(|run| run.len() > 1).map(<[Point]>::to_vec).collect()
}

/// The index of the point nearest to a place.
fn nearest(points: &[Point], p: Point) -> usize {
    (0..points.len()).min_by(|a, b| points[*a].distance_squared(p).total_cmp(&points[*b].distance_squared(p))).unwrap_or(0)
}

/// Mean of each value and its `reach` neighbours on either side.
fn running_mean(values: &[f64], reach: usize) -> Vec<f64> {
    let mut sums = vec![0.0; values.len() + 1];
    for (i, value) in values.iter().enumerate() {
        sums[i + 1] = sums[i] + value;
    }
    let mean = |i: usize| {
        let (from, to) = (i.saturating_sub(reach), (i + reach + 1).min(values.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}

/// The part of a polyline between two arc lengths.
fn between(points: &[Point], from: f64, to: f64) -> Vec<Point> {
    let mut part = Vec::new();
    let mut travelled = 0.0;
    for pair in points.windows(2) {
        let piece = pair[0].distance(pair[1]);
        let at = |length: f64| pair[0].lerp(pair[1], ((length - travelled) / piece.max(1e-12)).clamp(0.0, 1.0));
        if travelled + piece >= from && travelled <= to {
            if part.is_empty() {
                part.push(at(from));
            }
            part.push(at(to));
        }
        travelled += piece;
    }
    part
}
