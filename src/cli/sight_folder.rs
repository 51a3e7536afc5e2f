//! The folder that `see` writes and `draw --sight` reads: `sight.json`, a picture of each region, named by its role, the depth, and
//! an overlay.

use super::failure::Failure;
use super::masks::RoleMask;
use super::overlay::{Overlaid, overlay};
use super::png::png;
use super::seen::{Depth, Seen};
use super::{claims, output, proof};
use crate::geometry::{Point, Rect};
use crate::raster::Raster;
use crate::see::{Face, Sight};
use crate::source::grey_image;
use crate::source::{Iris, Landmarks, MaskRole, POINTS, Photograph, Spectacles};
use kurbo::Circle;
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const SIGHT: &str = "sight.json";
const DEPTH: &str = "depth.png";
const OVERLAY: &str = "overlay.png";

/// The file name of a role's picture.
fn file_of(role: MaskRole) -> String {
    format!("{}.png", role.name())
}

/// Writes everything that was found. Files of an earlier sight that this one does not replace are removed.
pub(super) fn write(folder: &Path, sight: &Sight, photograph: &Photograph) -> Result<(), Failure> {
    let name = folder.to_string_lossy();
    std::fs::create_dir_all(folder).map_err(|error| Failure::Work(format!("{name} cannot be created: {error}")))?;
    let path = |file: &str| folder.join(file).to_string_lossy().into_owned();
    let masks: Vec<(String, &Raster<u8>)> = sight.masks().into_iter().map(|(role, mask)| (path(&file_of(role)), mask)).collect();
    let others = [SIGHT, DEPTH, OVERLAY].map(path);
    claims::check_distinct(others.iter().chain(masks.iter().map(|(file, _)| file)).map(String::as_str))?;
    let [json, depth, overlaid] = &others;
    if Path::new(json).exists() {
        let stale = MaskRole::ALL.into_iter().map(|(_, role)| path(&file_of(role))).chain([depth.clone(), overlaid.clone()]);
        for stale in stale.filter(|file| Path::new(file).exists() && masks.iter().all(|(mask, _)| mask != file)) {
            std::fs::remove_file(&stale).map_err(|error| Failure::Work(format!("{stale} cannot be removed: {error}")))?;
        }
    }
    let write_depth = || {
        let Some(map) = &sight.depth else { return Ok(()) };
        png(depth, &grey_image(&sight.at_full_size(&map.map(f32::from)).map(|v| v.round() as u16)).into())
    };
    let write_overlay = || {
        if sight.subject.is_none() {
            return Ok(());
        }
        let faces: Vec<Overlaid<'_>> =
            sight.faces.iter().map(|face| Overlaid { landmarks: &face.landmarks, bounds: Some(face.bounds) }).collect();
        let picture = overlay(photograph, sight.subject.as_ref(), &faces).map_err(|error| Failure::about(&name)(&error))?;
        png(overlaid, &picture.into())
    };
    let write_mask = |(file, mask): &(String, &Raster<u8>)| {
        png(file, &grey_image(&sight.at_full_size(&mask.map(f32::from)).map(|v| v.round() as u8)).into())
    };
    // The largest takes as long as all others.
    let (depth, others) = rayon::join(write_depth, || {
        write_overlay()?;
        masks.par_iter().try_for_each(write_mask)
    });
    depth.and(others)?;
    write_json(json, sight, photograph)
}

/// Writes what was found in its own size, for drafts.
pub(super) fn write_small(folder: &Path, sight: &Sight, photograph: &Photograph) -> Result<(), Failure> {
    let name = folder.to_string_lossy();
    std::fs::create_dir_all(folder).map_err(|error| Failure::Work(format!("{name} cannot be created: {error}")))?;
    let path = |file: &str| folder.join(file).to_string_lossy().into_owned();
    for (role, mask) in sight.masks() {
        png(&path(&file_of(role)), &grey_image(mask).into())?;
    }
    if let Some(map) = &sight.depth {
        png(&path(DEPTH), &grey_image(map).into())?;
    }
    write_json(&path(SIGHT), sight, photograph)
}

fn write_json(file: &str, sight: &Sight, photograph: &Photograph) -> Result<(), Failure> {
    let text = format!("{:#}\n", as_json(sight, photograph));
    output::write(file, |out| out.write_all(text.as_bytes()))
}

/// Reads a folder, edited or not.
pub(super) fn read(folder: &str, photograph: &Photograph) -> Result<Seen, Failure> {
    let path = |file: &str| Path::new(folder).join(file);
    let of_roles = || MaskRole::ALL.into_iter().map(|(_, role)| (role, path(&file_of(role))));
    if !path(SIGHT).exists() && !of_roles().any(|(_, file)| file.exists()) {
        return Err(Failure::Work(format!(
            "{folder} has no {SIGHT} and no picture named by a role, such as subject.png; `drypoint see PHOTO -o {folder}` writes them"
        )));
    }
    let picture = |file: &Path| Ok::<_, Failure>(Arc::new(proof::photograph(&file.to_string_lossy())?.photograph));
    let name = |file: &Path| Some(file.to_string_lossy().into_owned());
    let read_masks = || {
        let there: Vec<(MaskRole, PathBuf)> = of_roles().filter(|(_, file)| file.exists()).collect();
        let masks = there.into_par_iter().map(|(role, file)| Ok(RoleMask { role, mask: picture(&file)?, file: name(&file) }));
        masks.collect::<Result<_, Failure>>()
    };
    let read_depth = || {
        let depth = Some(path(DEPTH)).filter(|file| file.exists());
        depth.map(|file| Ok::<_, Failure>(Depth { map: picture(&file)?, file: name(&file) })).transpose()
    };
    let (depth, masks) = rayon::join(read_depth, read_masks);
    let faces = if path(SIGHT).exists() { faces(&path(SIGHT).to_string_lossy(), photograph)? } else { Vec::new() };
    Ok(Seen { masks: masks?, faces, depth: depth?, lack: None })
}

/// The part of `sight.json` that is read; the rest is for other programs.
#[derive(Deserialize)]
struct Written {
    photograph: WrittenSize,
    faces: Vec<WrittenFace>,
}

#[derive(Deserialize)]
struct WrittenSize {
    width: f64,
    height: f64,
}

#[derive(Deserialize)]
struct WrittenFace {
    irises: WrittenIrises,
    points: Vec<[f64; 3]>,
    spectacles: Option<WrittenSpectacles>,
    #[serde(default)]
    pearls: Vec<WrittenRound>,
}

#[derive(Deserialize)]
struct WrittenSpectacles {
    rims: [Vec<[f64; 2]>; 2],
    bridge: Vec<[f64; 2]>,
    temples: [Vec<[f64; 2]>; 2],
    width: f64,
}

#[derive(Deserialize)]
struct WrittenIrises {
    right: WrittenRound,
    left: WrittenRound,
}

#[derive(Deserialize)]
struct WrittenRound {
    centre: [f64; 2],
    radius: f64,
}

/// The faces of a `sight.json`, in pixels of this photograph, which may differ in size from the one that was searched.
fn faces(name: &str, photograph: &Photograph) -> Result<Vec<Landmarks>, Failure> {
    let bytes = output::read_settings(name)?;
    let written: Written = serde_json::from_str(&bytes).map_err(|error| Failure::Work(format!("{name} is no sight: {error}")))?;
    let WrittenSize { width, height } = written.photograph;
    let (x, y) = (f64::from(photograph.width()) / width, f64::from(photograph.height()) / height);
    let is_alike = x.is_finite() && y.is_finite() && x > 0.0 && (x / y - 1.0).abs() < 0.03;
    if !is_alike {
        return Err(Failure::Work(format!(
            "{name} is for a photograph of {width} x {height} px, and this one has other proportions: {} x {} px",
            photograph.width(),
            photograph.height()
        )));
    }
    let placed = written.faces.iter().map(|face| {
        let landmarks = landmarks(face, name, width.max(height))?;
        Ok(landmarks.placed(|p| Point::new(p.x * x, p.y * y), (x * y).sqrt()))
    });
    placed.collect()
}

/// A face as it is written; `longest` is the longer side of its photograph.
fn landmarks(face: &WrittenFace, name: &str, longest: f64) -> Result<Landmarks, Failure> {
    let refused = |why: String| Err(Failure::Work(format!("{name}: {why}")));
    if face.points.len() != POINTS || face.points.iter().flatten().any(|v| !v.is_finite() || v.abs() > 1e6) {
        return refused(format!("each face must have {POINTS} points of three numbers"));
    }
    let centre = |round: &WrittenRound| Point::new(round.centre[0], round.centre[1]);
    let irises = [&face.irises.right, &face.irises.left].map(|iris| Iris { centre: centre(iris), radius: iris.radius });
    let is_eye = |iris: &Iris| [iris.centre.x, iris.centre.y, iris.radius].iter().all(|v| v.abs() <= 1e6) && iris.radius >= 0.0;
    if !irises.iter().all(is_eye) {
        return refused("irises must have a centre of two numbers and a radius of 0 or more, in pixels".to_owned());
    }
    let spectacles = face.spectacles.as_ref().map(spectacles);
    if spectacles.as_ref().is_some_and(|spectacles| !is_sound(spectacles, longest)) {
        return refused(
            "rims of spectacles must have three points or more, all of them in the picture, and a width above 0".to_owned(),
        );
    }
    let pearls: Vec<Circle> = face.pearls.iter().map(|pearl| Circle::new(centre(pearl), pearl.radius)).collect();
    let is_pearl = |pearl: &Circle| {
        let is_near = |v: f64| v.abs() <= 2.0 * longest;
        is_near(pearl.center.x) && is_near(pearl.center.y) && (1e-3..=0.1 * longest).contains(&pearl.radius)
    };
    if !pearls.iter().all(is_pearl) {
        return refused("pearls must have a centre in the picture and a radius above 0, in pixels".to_owned());
    }
    Ok(Landmarks { points: face.points.clone(), irises, spectacles, pearls })
}

/// `longest` is the photograph's longer side; a rim may reach beyond it.
fn is_sound(spectacles: &Spectacles, longest: f64) -> bool {
    let is_near = |v: f64| v.abs() <= 2.0 * longest;
    (1e-3..=0.1 * longest).contains(&spectacles.width)
        && spectacles.rims.iter().all(|rim| rim.len() > 2)
        && spectacles.lines().iter().flatten().all(|p| is_near(p.x) && is_near(p.y))
}

fn spectacles(written: &WrittenSpectacles) -> Spectacles {
    let line = |line: &Vec<[f64; 2]>| line.iter().map(|[x, y]| Point::new(*x, *y)).collect::<Vec<_>>();
    let both = |lines: &[Vec<[f64; 2]>; 2]| lines.each_ref().map(line);
    Spectacles { rims: both(&written.rims), bridge: line(&written.bridge), temples: both(&written.temples), width: written.width }
}

/// What was found as JSON, in pixels of the photograph after its EXIF rotation.
pub(super) fn as_json(sight: &Sight, photograph: &Photograph) -> Value {
    let of_roles = sight.masks().into_iter().map(|(role, _)| {
        let file = file_of(role);
        (file.trim_end_matches(".png").to_owned(), Value::String(file.clone()))
    });
    let mut regions: serde_json::Map<String, Value> = of_roles.collect();
    if sight.depth.is_some() {
        regions.insert("depth".to_owned(), Value::String(DEPTH.to_owned()));
    }
    json!({
        "drypoint": env!("CARGO_PKG_VERSION"),
        "photograph": { "width": sight.width, "height": sight.height, "sha256": photograph.info.sha256 },
        "faces": sight.faces.iter().map(face_json).collect::<Vec<_>>(),
        "regions": regions,
    })
}

fn spectacles_json(spectacles: &Spectacles) -> Value {
    let line = |line: &Vec<Point>| line.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
    json!({
        "rims": spectacles.rims.each_ref().map(line),
        "bridge": line(&spectacles.bridge),
        "temples": spectacles.temples.each_ref().map(line),
        "width": spectacles.width,
    })
}

fn face_json(face: &Face) -> Value {
    let Rect { x0, y0, .. } = face.bounds;
    let round = |Point { x, y }: Point, radius: f64| json!({ "centre": [x, y], "radius": radius });
    let [right, left] = face.landmarks.irises.map(|iris| round(iris.centre, iris.radius));
    json!({
        "box": [x0, y0, face.bounds.width(), face.bounds.height()],
        "score": face.score,
        "irises": { "right": right, "left": left },
        "spectacles": face.landmarks.spectacles.as_ref().map(spectacles_json),
        "pearls": face.landmarks.pearls.iter().map(|pearl| round(pearl.center, pearl.radius)).collect::<Vec<_>>(),
        "points": face.landmarks.points,
    })
}
