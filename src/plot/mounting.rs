//! The position of the page on the machine.

use super::profile::{Paper, Profile};
use super::{Plot, Toolpath};
use crate::drawing::Page;
use crate::geometry::{Affine, Point, Rect, Vec2, clip_polyline};
use std::fmt;
use thiserror::Error;

/// Sheet sizes that differ by less are the same, in millimetres.
const SAME_SIZE: f64 = 1.0;
/// Rounding tolerance at the machine's limits, in millimetres.
const ROUNDING_TOLERANCE: f64 = 0.02;

/// Default tolerance of fitted arcs, in millimetres; the same as for flattened curves.
const ARC_TOLERANCE: f64 = 0.02;

/// A page on a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Mounting {
    /// Transform from the page's millimetres to machine units.
    pub to_machine: Affine,
    /// The machine's reach in machine units.
    pub limits: Rect,
    /// The sheet, if the machine knows it.
    pub paper: Option<Paper>,
    /// How the page is turned on the machine.
    pub turn: Turn,
    /// Where the pen waits at the end, in machine units.
    pub park: Point,
    /// Rectangle on the page traced with the pen up before the first pen draws; then the machine waits.
    pub frame: Option<Rect>,
    /// Maximum deviation of fitted arcs from their path, in millimetres.
    pub tolerance: f64,
    /// Corrections for slots whose ink is offset, in machine units.
    offsets: Vec<(u32, Vec2)>,
}

/// A page's rotation on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Not rotated.
    Upright,
    /// A quarter turn clockwise, so that a portrait page lies on a landscape sheet.
    Quarter,
    /// A quarter turn anticlockwise, as the `AxiDraw`'s program does.
    QuarterBack,
}

/// Why a page or drawing does not fit on a machine.
#[derive(Debug, Error, PartialEq)]
pub enum MountingError {
    /// The page is larger than every sheet.
    #[error("a page of {width:.1} x {height:.1} mm is larger than every sheet of {machine} ({sheets})")]
    PageTooLarge {
        /// Width of the page.
        width: f64,
        /// Height of the page.
        height: f64,
        /// The profile's name.
        machine: String,
        /// The sheets and their sizes.
        sheets: String,
    },
    /// The drawing extends beyond the machine's reach.
    #[error("the drawing reaches {excess:.2} mm beyond the {side} limit of {machine} on this sheet; {room}")]
    OutOfReach {
        /// By how many millimetres.
        excess: f64,
        /// Which limit.
        side: &'static str,
        /// The profile's name.
        machine: String,
        /// The drawing's size and the available room.
        room: Room,
    },
    /// The drawing extends beyond the sheet.
    #[error("the drawing reaches {excess:.2} mm beyond the sheet's {side} edge; {room}")]
    OffSheet {
        /// By how many millimetres.
        excess: f64,
        /// Which edge.
        side: &'static str,
        /// The drawing's size and the available room.
        room: Room,
    },
}

/// A drawing's size and the room available for it, each as (width, height) in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Size of the drawing's pen paths.
    pub drawn: (f64, f64),
    /// Size of the page's drawable area.
    pub free: (f64, f64),
    /// Size of the machine's reach, regardless of the page.
    pub reach: (f64, f64),
    /// Size of the drawable area with the page turned by a quarter, if the machine takes it.
    pub free_turned: Option<(f64, f64)>,
}

impl Room {
    /// True if the drawing fits somewhere on this page.
    pub fn is_enough(&self) -> bool {
        fits(self.drawn, self.free)
    }

    /// True if the drawing, turned by a quarter, fits on the page as it lies.
    pub fn is_enough_across(&self) -> bool {
        fits((self.drawn.1, self.drawn.0), self.free)
    }

    /// True if the drawing fits when the page is turned by a quarter with it.
    pub fn is_enough_turned(&self) -> bool {
        self.free_turned.is_some_and(|free| fits((self.drawn.1, self.drawn.0), free))
    }
}

/// True if the inner width and height fit in the outer ones.
fn fits(inner: (f64, f64), outer: (f64, f64)) -> bool {
    inner.0 <= outer.0 + ROUNDING_TOLERANCE && inner.1 <= outer.1 + ROUNDING_TOLERANCE
}

impl fmt::Display for Room {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_enough() {
            return write!(f, "it would fit elsewhere on the page");
        }
        let ((width, height), (free_width, free_height)) = (self.drawn, self.free);
        write!(f, "it is {width:.1} x {height:.1} mm, and {free_width:.1} x {free_height:.1} mm can be drawn on")
    }
}

/// Places a page on a machine: on the sheet of its size, in either orientation; else in the machine's own area, with zero where
/// the axes say; else in the middle of the profile's first sheet that holds it.
pub fn mount(profile: &Profile, page: &Page) -> Result<Mounting, MountingError> {
    if let Some((paper, turn)) = paper_of_size(profile, page) {
        return Ok(on_paper(profile, page, paper, turn));
    }
    if let Some(area) = &profile.area {
        let turns = profile.speech().turns_portrait() && page.height > page.width;
        let turn = if turns { Turn::QuarterBack } else { Turn::Upright };
        let (width, height) = turned_size(page, turn);
        let limits = Rect::new(area.x[0], area.y[0], area.x[1], area.y[1]);
        return Ok(Mounting {
            paper: None,
            turn,
            ..Mounting::new(profile, sheet_to_machine(profile, profile.axes.zero.on(width, height)) * turned(page, turn), limits)
        });
    }
    let (paper, turn) = paper_that_holds(profile, page)?;
    Ok(on_paper(profile, page, paper, turn))
}

/// Places the page in the middle of a sheet.
fn on_paper(profile: &Profile, page: &Page, paper: &Paper, turn: Turn) -> Mounting {
    let (width, height) = turned_size(page, turn);
    let centred = Affine::translate((0.5 * (paper.width - width), 0.5 * (paper.height - height)));
    let to_machine = sheet_to_machine(profile, Point::new(paper.zero[0], paper.zero[1])) * centred * turned(page, turn);
    let limits = Rect::new(paper.x[0], paper.y[0], paper.x[1], paper.y[1]);
    let plain = Mounting::new(profile, to_machine, limits);
    let park = paper.park.map_or(plain.park, |[x, y]| Point::new(x, y));
    Mounting { paper: Some(paper.clone()), turn, park, ..plain }
}

/// Transform from millimetres on the sheet to machine units along the machine's axes; `zero` is machine zero on the sheet.
fn sheet_to_machine(profile: &Profile, zero: Point) -> Affine {
    let x = profile.axes.x.vector() * (profile.units_per_mm * profile.scale_x);
    let y = profile.axes.y.vector() * (profile.units_per_mm * profile.scale_y);
    Affine::new([x.x, y.x, x.y, y.y, 0.0, 0.0]) * Affine::translate(-zero.to_vec2())
}

/// Transform from the page to the turned page, whose upper left corner is the origin.
fn turned(page: &Page, turn: Turn) -> Affine {
    match turn {
        Turn::Upright => Affine::IDENTITY,
        Turn::Quarter => Affine::new([0.0, 1.0, -1.0, 0.0, page.height, 0.0]),
        Turn::QuarterBack => Affine::new([0.0, -1.0, 1.0, 0.0, 0.0, page.width]),
    }
}

const fn turned_size(page: &Page, turn: Turn) -> (f64, f64) {
    match turn {
        Turn::Upright => (page.width, page.height),
        Turn::Quarter | Turn::QuarterBack => (page.height, page.width),
    }
}

/// Each sheet in both orientations, with the width and height that the page leaves free.
fn sheets<'a>(profile: &'a Profile, page: &Page) -> impl Iterator<Item = (&'a Paper, Turn, f64, f64)> {
    profile.paper.iter().flat_map(move |paper| {
        [Turn::Upright, Turn::Quarter].map(|turn| {
            let (width, height) = turned_size(page, turn);
            (paper, turn, paper.width - width, paper.height - height)
        })
    })
}

fn paper_of_size<'a>(profile: &'a Profile, page: &Page) -> Option<(&'a Paper, Turn)> {
    sheets(profile, page).find(|&(_, _, x, y)| x.abs() < SAME_SIZE && y.abs() < SAME_SIZE).map(|(paper, turn, ..)| (paper, turn))
}

fn paper_that_holds<'a>(profile: &'a Profile, page: &Page) -> Result<(&'a Paper, Turn), MountingError> {
    let holds = sheets(profile, page).find(|&(_, _, x, y)| x >= 0.0 && y >= 0.0);
    holds.map(|(paper, turn, ..)| (paper, turn)).ok_or_else(|| MountingError::PageTooLarge {
        width: page.width,
        height: page.height,
        machine: profile.name.clone(),
        sheets: profile.paper.iter().map(|p| format!("{} {} x {} mm", p.name, p.width, p.height)).collect::<Vec<_>>().join(", "),
    })
}

impl Mounting {
    /// A mounting from a machine's reach and the page's transform, without a sheet.
    pub fn new(profile: &Profile, to_machine: Affine, limits: Rect) -> Self {
        let park = profile.speech().park().map_or(Point::new(limits.x1, limits.y1), |[x, y]| Point::new(x, y));
        let offset = |[x, y]: [f64; 2]| -Vec2::new(x * profile.scale_x, y * profile.scale_y) * profile.units_per_mm;
        let offsets = profile.pen.iter().map(|pen| (pen.slot, offset(pen.offset))).collect();
        Self { to_machine, limits, paper: None, turn: Turn::Upright, park, frame: None, tolerance: ARC_TOLERANCE, offsets }
    }

    /// The position of a pen that draws at a point of the page, in machine units.
    pub fn place(&self, pen: u32, p: Point) -> Point {
        self.to_machine * p + self.offsets.iter().find(|(slot, _)| *slot == pen).map_or(Vec2::ZERO, |(_, offset)| *offset)
    }

    /// The machine's reach in the page's millimetres, whatever the pen.
    pub fn reach_on_page(&self) -> Rect {
        let moved = |rect: Rect| self.offsets.iter().fold(rect, |rect, (_, offset)| rect.intersect(self.limits - *offset));
        self.to_machine.inverse().transform_rect_bbox(moved(self.limits))
    }

    /// The drawable area on the page: the sheet without what the machine cannot reach.
    pub fn drawable(&self, page: &Page) -> Rect {
        self.reach_on_page().intersect(page.rect())
    }

    /// Refuses a plot that extends beyond the machine's reach or off the sheet, and reports by how much.
    pub fn check(&self, profile: &Profile, plot: &Plot) -> Result<(), MountingError> {
        let (mut worst, mut worst_off) = ((0.0, ""), (0.0, ""));
        let mut whole: Option<Rect> = None;
        for pen in &plot.pens {
            let points = || pen.paths.iter().flat_map(Toolpath::points);
            let Some(drawn) = bounds(points().copied()) else { continue };
            let Some(sent) = bounds(points().map(|p| self.place(pen.number, *p))) else { continue };
            let reached = excesses(sent, self.limits, profile.units_per_mm, ["lower x", "upper x", "lower y", "upper y"]);
            let on_sheet = excesses(drawn, plot.page.rect(), 1.0, ["left", "right", "upper", "lower"]);
            let greater = |worst: (f64, &'static str), next: (f64, &'static str)| if next.0 > worst.0 { next } else { worst };
            worst = reached.into_iter().fold(worst, greater);
            worst_off = on_sheet.into_iter().fold(worst_off, greater);
            whole = Some(whole.map_or(drawn, |whole| whole.union(drawn)));
        }
        let Some(whole) = whole else { return Ok(()) };
        if worst.0 > ROUNDING_TOLERANCE {
            let (machine, room) = (profile.name.clone(), self.room(profile, &plot.page, whole));
            return Err(MountingError::OutOfReach { excess: worst.0, side: worst.1, machine, room });
        }
        if worst_off.0 > ROUNDING_TOLERANCE {
            let room = self.room(profile, &plot.page, whole);
            return Err(MountingError::OffSheet { excess: worst_off.0, side: worst_off.1, room });
        }
        Ok(())
    }

    /// The available room for a drawing with these bounds.
    fn room(&self, profile: &Profile, page: &Page, drawn: Rect) -> Room {
        let size = |rect: Rect| (rect.width().max(0.0), rect.height().max(0.0));
        let turned = Page { width: page.height, height: page.width, ..*page };
        Room {
            drawn: size(drawn),
            free: size(self.drawable(page)),
            reach: size(self.reach_on_page()),
            free_turned: mount(profile, &turned).ok().map(|mounting| size(mounting.drawable(&turned))),
        }
    }
}

fn bounds(points: impl Iterator<Item = Point>) -> Option<Rect> {
    points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))
}

/// How far a rectangle extends beyond each limit, in millimetres.
fn excesses(inner: Rect, limits: Rect, units_per_mm: f64, names: [&'static str; 4]) -> [(f64, &'static str); 4] {
    [
        ((limits.x0 - inner.x0) / units_per_mm, names[0]),
        ((inner.x1 - limits.x1) / units_per_mm, names[1]),
        ((limits.y0 - inner.y0) / units_per_mm, names[2]),
        ((inner.y1 - limits.y1) / units_per_mm, names[3]),
    ]
}

/// Cuts every path at a rectangle of the page. Returns the lost millimetres of line and the number of lost touches.
pub fn clip_to(plot: &mut Plot, rect: Rect) -> (f64, usize) {
    let (mut lost_length, mut lost_touches) = (0.0, 0);
    for pen in &mut plot.pens {
        let mut kept = Vec::with_capacity(pen.paths.len());
        for path in std::mem::take(&mut pen.paths) {
            if let [touch] = path.points()[..] {
                if rect.inflate(1e-9, 1e-9).contains(touch) {
                    kept.push(path);
                } else {
                    lost_touches += 1;
                }
                continue;
            }
            lost_length += path.length();
            for piece in clip_polyline(path.points(), rect).iter().filter_map(|points| piece(&path, points)) {
                lost_length -= piece.length();
                kept.push(piece);
            }
        }
        pen.paths = kept;
    }
    (lost_length.max(0.0), lost_touches)
}

/// A piece of a path: its points with their positions along the path (vertex index plus fraction).
fn piece(path: &Toolpath, points: &[(Point, f64)]) -> Option<Toolpath> {
    let mut piece = Toolpath::new(points.iter().map(|(p, _)| *p).collect())?;
    if let Some(heights) = path.heights() {
        piece = piece.with_heights(points.iter().map(|&(_, at)| between(heights, at)).collect())?;
    }
    (piece.dwell_seconds, piece.group) = (path.dwell_seconds, path.group);
    Some(piece)
}

/// The interpolated value at `at`, a vertex index plus a fraction.
fn between(values: &[f64], at: f64) -> f64 {
    let last = values.len() - 1;
    let i = (at.max(0.0) as usize).min(last);
    let next = values[(i + 1).min(last)];
    values[i] + (next - values[i]) * (at - i as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::PenPaths;

    fn profile(name: &str) -> Profile {
        Profile::built_in(name).unwrap()
    }

    fn plot_of(page: Page, points: &[(f64, f64)]) -> Plot {
        let points = points.iter().map(|&(x, y)| Point::new(x, y)).collect();
        let pen = PenPaths {
            number: 1,
            name: "x".into(),
            colour: crate::drawing::Colour::BLACK,
            nib: 0.3,
            handling: crate::drawing::Handling::default(),
            paths: Toolpath::new(points).into_iter().collect(),
        };
        Plot { page, pens: vec![pen] }
    }

    #[test]
    fn a_portrait_a4_page_lies_turned_on_the_landscape_sheet() {
        let mounting = mount(&profile("hp7475a"), &Page::new(210.0, 297.0)).unwrap();
        assert_eq!(mounting.turn, Turn::Quarter);
        assert_eq!(mounting.paper.as_ref().unwrap().name, "a4");
        // The page's upper left corner comes to the sheet's upper right one.
        let corner = mounting.to_machine * Point::ORIGIN;
        let expected = Point::new((297.0 - 10.0) * 40.192_926, 206.0 * 40.192_926);
        assert!(corner.distance(expected) < 1e-6, "{corner:?}");
    }

    #[test]
    fn a_small_page_is_centred_and_reachable() {
        let machine = profile("hp7475a");
        let page = Page::new(90.0, 120.0);
        let mounting = mount(&machine, &page).unwrap();
        assert_eq!(mounting.paper.as_ref().unwrap().name, "a4");
        assert!(mounting.check(&machine, &plot_of(page, &[(0.0, 0.0), (90.0, 120.0)])).is_ok());
    }

    #[test]
    fn what_is_out_of_reach_is_refused_with_its_distance() {
        let machine = profile("grbl-servo");
        let page = Page::new(320.0, 200.0);
        let mounting = mount(&machine, &page).unwrap();
        let error = mounting.check(&machine, &plot_of(page, &[(0.0, 100.0), (312.5, 100.0)])).unwrap_err();
        assert!(
            matches!(&error, MountingError::OutOfReach { excess, side: "upper x", .. } if (excess - 12.5).abs() < 1e-9),
            "{error}"
        );
        let mut plot = plot_of(page, &[(0.0, 100.0), (312.5, 100.0)]);
        let (lost, _) = clip_to(&mut plot, mounting.reach_on_page());
        assert!((lost - 12.5).abs() < 1e-9);
        assert!(mounting.check(&machine, &plot).is_ok());
    }

    #[test]
    fn a_page_larger_than_every_sheet_is_refused() {
        assert!(matches!(mount(&profile("hp7475a"), &Page::new(594.0, 841.0)), Err(MountingError::PageTooLarge { .. })));
    }
}
