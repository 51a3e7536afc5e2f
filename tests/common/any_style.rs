//! Any style on any sheet, for tests that go through all styles.
#![allow(dead_code)]

use drypoint::drawing::{Drawing, Mark, Page};
use drypoint::geometry::{BezPath, Rect};
use drypoint::source::{Crop, DepthSense, Landmarks, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use drypoint::style::{Observer, Picture, Settings, StyleError, find};
use std::sync::Mutex;

/// How a test draws.
#[derive(Clone)]
pub struct Order<'a> {
    pub style: &'a str,
    pub photo: &'a [u8],
    pub page: Page,
    pub picture: Rect,
    pub set: Vec<(String, String)>,
    pub masks: Vec<(MaskRole, &'a [u8])>,
    pub depth: Option<&'a [u8]>,
    /// In pixels of the photograph.
    pub faces: Vec<Landmarks>,
}

impl<'a> Order<'a> {
    /// A picture that fills its page.
    pub fn new(style: &'a str, photo: &'a [u8], mm: (f64, f64), set: &[(&str, &str)]) -> Self {
        let set = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        let picture = Rect::new(0.0, 0.0, mm.0, mm.1);
        Self { style, photo, page: Page::new(mm.0, mm.1), picture, set, masks: Vec::new(), depth: None, faces: Vec::new() }
    }

    pub fn settings(&self) -> Settings {
        Settings::resolve(self.style, find(self.style).unwrap().parameters(), &self.set).unwrap()
    }

    pub fn portrait(&self) -> Portrait {
        let photograph = Photograph::decode(self.photo, Limits::default()).unwrap();
        let roles: Vec<MaskRole> = self.masks.iter().map(|(role, _)| *role).collect();
        let resolution = find(self.style).unwrap().resolution(&self.settings(), &roles, self.picture);
        let placement = Placement::new(self.picture, resolution);
        let crop = Crop::all(&photograph);
        let mut portrait =
            Portrait::new(&photograph, crop, self.page, placement, ToneTarget::Lightness, ToneCurve::default()).unwrap();
        for (role, bytes) in &self.masks {
            let mask = Photograph::decode(bytes, Limits::default()).unwrap();
            portrait.add_mask(*role, &mask, &photograph, crop).unwrap();
        }
        if let Some(depth) = self.depth {
            let depth = Photograph::decode(depth, Limits::default()).unwrap();
            portrait.add_depth(&depth, DepthSense::NearWhite, &photograph, crop).unwrap();
        }
        portrait.add_faces(&self.faces, &photograph, crop).unwrap();
        portrait
    }

    /// The drawing and its warnings.
    pub fn try_draw(&self) -> (Result<Drawing, StyleError>, String) {
        let notes = Notes::default();
        let drawing = find(self.style).unwrap().draw(&self.portrait(), &self.settings(), 0, &notes);
        (drawing, notes.0.into_inner().unwrap().join("\n"))
    }

    pub fn draw(&self) -> Drawing {
        self.try_draw().0.unwrap()
    }
}

/// Collects the warnings.
#[derive(Default)]
pub struct Notes(Mutex<Vec<String>>);

impl Observer for Notes {
    fn begin(&self, _: &str) {}
    fn progress(&self, _: f64) {}
    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}
    fn warn(&self, message: &str) {
        self.0.lock().unwrap().push(message.to_owned());
    }
    fn is_interrupted(&self) -> bool {
        false
    }
}

/// The border of a mark's ink.
pub fn ink_outline(mark: &Mark, tolerance: f64) -> BezPath {
    match mark {
        Mark::Dot(dot) => dot.path(),
        Mark::Stroke(stroke) => stroke.ink_outline(tolerance),
        Mark::Area(area) => area.outline.clone(),
    }
}
