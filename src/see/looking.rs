//! The order of detection: upright, else by quarter turns, else in tiles; then each face, then the people.

use super::SeeError;
use super::depth::depth;
use super::faces::{self, Found};
use super::far_side::without_stubs;
use super::hat_outline::without_bumps_of_hats;
use super::iris::irises;
use super::jewellery::with_pearls;
use super::mesh::mesh;
use super::networks::{DETECTOR, Engine, IRIS, MESH, Network, PERSON};
use super::regions::regions;
use super::sight::{Face, Regions, Sight};
use super::spectacles::spectacles;
use super::subject::subject;
use super::turn::Turn;
use super::view::View;
use crate::geometry::{Point, Rect};
use crate::interrupt::Interrupt;
use crate::parallel::both;
use crate::raster::Raster;
use crate::source::{Landmarks, Photograph, Spectacles};
use kurbo::Circle;
use std::f64::consts::FRAC_PI_2;

/// Longer side in pixels of the view, and of the masks: a face that fills a fifth of it still has the mesh's 200 pixels, and a
/// mask's edge is fine enough for a picture of 170 mm at the usual pitch.
const LONGEST: f64 = 1024.0;
/// A face with fewer pixels in the view gets a closer view, if the photograph has more: mesh and irises take 128 for a face.
const ENOUGH: f64 = 160.0;
/// Longer side of a closer view in pixels, and its extent in longer sides of the face's box.
const CLOSER: f64 = 640.0;
const ROUND_A_FACE: f64 = 3.0;
/// Least width of a face in pixels of the photograph; smaller ones give no drawing and are found in foliage.
const LEAST_FACE: f64 = 20.0;
/// Least probability by the mesh that it lies on a face; it removes doubtful faces that pass the detector's gate.
const PRESENCE: f64 = 0.5;

pub(super) fn look(photograph: &Photograph, interrupt: &Interrupt) -> Result<Sight, SeeError> {
    let engine = Engine::new();
    let upright = Turn::new(0, [photograph.width(), photograph.height()]);
    let mut sight = Sight {
        width: photograph.width(),
        height: photograph.height(),
        faces: Vec::new(),
        subject: None,
        regions: None,
        depth: None,
    };
    let first = View::whole(photograph, upright, LONGEST)?;
    let detector = engine.load(&DETECTOR)?;
    let Some((turn, view, found)) = find(&detector, photograph, first, upright, interrupt)? else {
        return Ok(sight);
    };
    let (measured, strangers) =
        both(|| measured(&engine, photograph, turn, &view, &found, interrupt), || faces::strangers(&detector, &view, &found));
    let (mut faces, closer) = measured?;
    if faces.is_empty() {
        return Ok(sight);
    }
    interrupt.check()?;
    let strangers = strangers?;
    let (people, spectacles) = both(|| people(&engine, &view, &faces, &strangers), || worn(&view, &closer, &faces));
    let People { subject, regions, depth, pearls } = people?;
    for ((face, spectacles), pearls) in faces.iter_mut().zip(spectacles).zip(pearls) {
        face.landmarks.spectacles = spectacles;
        face.landmarks.pearls = pearls;
    }
    sight.regions = Some(regions.map(|plane| turn.raster_back(plane)));
    sight.depth = Some(turn.raster_back(&depth));
    sight.subject = Some(turn.raster_back(&subject));
    sight.faces = faces.iter().map(|face| turned_back(turn, face)).collect();
    Ok(sight)
}

/// The people on the view's grid.
struct People {
    subject: Raster<u8>,
    regions: Regions,
    depth: Raster<u16>,
    /// Of each face, in pixels of the upright picture.
    pearls: Vec<Vec<Circle>>,
}

/// Separates the people from the ground, and their regions from one another.
fn people(engine: &Engine, view: &View, faces: &[Face], strangers: &[Rect]) -> Result<People, SeeError> {
    let points: Vec<Vec<[f64; 3]>> = faces.iter().map(|face| face.landmarks.points.clone()).collect();
    let subject = subject(&engine.load(&PERSON)?, view, &points, strangers)?;
    let step = view.step();
    let on_view = |p: Point| Point::new((p.x - view.part.x0) / step.x, (p.y - view.part.y0) / step.y);
    let landmarks: Vec<Landmarks> = faces.iter().map(|face| face.landmarks.placed(on_view, 1.0 / step.x)).collect();
    let subject = without_stubs(subject, &landmarks);
    let (regions, near) = both(|| regions(&view.pixels, &subject, &landmarks), || depth(&subject, view, faces));
    let (smooth, regions) = without_bumps_of_hats(subject.clone(), regions, &landmarks);
    let (whole, regions, pearls) = with_pearls(&view.pixels, &smooth, &landmarks, regions);
    let upright = |pearl: Circle| {
        let Point { x, y } = pearl.center;
        Circle::new((view.part.x0 + step.x * x, view.part.y0 + step.y * y), step.x * pearl.radius)
    };
    let pearls = pearls.into_iter().map(|worn| worn.into_iter().map(upright).collect()).collect();
    let depth = if smooth == subject { near } else { depth(&smooth, view, faces) };
    Ok(People { subject: whole, regions, depth, pearls })
}

/// The spectacles of each face, in its closer view if it has one.
fn worn(view: &View, closer: &[Option<View>], faces: &[Face]) -> Vec<Option<Spectacles>> {
    let own = |(face, closer): (&Face, &Option<View>)| {
        spectacles(closer.as_ref().unwrap_or(view), &face.landmarks.points, &face.landmarks.irises)
    };
    faces.iter().zip(closer).map(own).collect()
}

/// Finds the faces, and the rotation and view in which they are upright.
fn find(
    detector: &Network,
    photograph: &Photograph,
    first: View,
    upright: Turn,
    interrupt: &Interrupt,
) -> Result<Option<(Turn, View, Vec<Found>)>, SeeError> {
    let found = faces::find(detector, &first)?;
    let is_upright = |found: &[Found]| found.first().is_some_and(|largest| largest.angle().abs() < 0.5 * FRAC_PI_2);
    let (turn, view, found) = if is_upright(&found) {
        (upright, first, found)
    } else {
        let turned = find_turned(detector, &first, upright, interrupt)?;
        match turned {
            Some((turn, found)) => (turn, View::whole(photograph, turn, LONGEST)?, found),
            None => (upright, first, Vec::new()),
        }
    };
    let found = faces::with_missed(detector, &view, found, interrupt)?;
    Ok((!found.is_empty()).then_some((turn, view, found)))
}

/// The quarter turn in which a face is upright and has the highest score.
fn find_turned(
    detector: &Network,
    first: &View,
    upright: Turn,
    interrupt: &Interrupt,
) -> Result<Option<(Turn, Vec<Found>)>, SeeError> {
    let mut best: Option<(f64, Turn, Vec<Found>)> = None;
    for quarters in [1, 3, 2] {
        interrupt.check()?;
        let turn = upright.further(quarters);
        let [width, height] = turn.upright_size();
        let view = View::new(turn.raster(&first.pixels), Rect::new(0.0, 0.0, width, height));
        let found = faces::find(detector, &view)?;
        let Some(largest) = found.first().filter(|largest| largest.angle().abs() < 0.5 * FRAC_PI_2) else { continue };
        if best.as_ref().is_none_or(|(score, ..)| largest.score > *score) {
            best = Some((largest.score, turn, found));
        }
    }
    Ok(best.map(|(_, turn, found)| (turn, found)))
}

/// Landmarks and irises of each face, in pixels of the upright picture, and the closer view of it if one was taken.
fn measured(
    engine: &Engine,
    photograph: &Photograph,
    turn: Turn,
    view: &View,
    found: &[Found],
    interrupt: &Interrupt,
) -> Result<(Vec<Face>, Vec<Option<View>>), SeeError> {
    let (points_of, irises_of) = (engine.load(&MESH)?, engine.load(&IRIS)?);
    let (mut faces, mut views) = (Vec::new(), Vec::new());
    for found in found.iter().filter(|found| found.bounds.width() >= LEAST_FACE) {
        interrupt.check()?;
        let side = found.side();
        let step = view.step().x;
        let closer = if step > 1.0 && side / step < ENOUGH {
            let round = Rect::from_center_size(found.bounds.center(), (ROUND_A_FACE * side, ROUND_A_FACE * side));
            Some(View::of_part(photograph, turn, round, CLOSER)?)
        } else {
            None
        };
        let view = closer.as_ref().unwrap_or(view);
        let mesh = mesh(&points_of, view, found)?;
        if mesh.presence < PRESENCE {
            continue;
        }
        let mut points = mesh.points;
        let irises = irises(&irises_of, view, &mut points)?;
        let landmarks = Landmarks { points, irises, spectacles: None, pearls: Vec::new() };
        faces.push(Face { bounds: found.bounds, score: found.score, landmarks });
        views.push(closer);
    }
    Ok((faces, views))
}

/// Maps a face of the upright picture to the photograph's grid.
fn turned_back(turn: Turn, face: &Face) -> Face {
    let landmarks = face.landmarks.placed(|p| turn.back(p), 1.0);
    Face { bounds: turn.box_back(face.bounds), score: face.score, landmarks }
}
