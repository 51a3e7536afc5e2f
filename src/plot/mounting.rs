//! Where the page lies on the machine.

use super::profile::{Paper, Profile};
use super::{Plot, Toolpath};
use crate::drawing::Page;
use crate::geometry::{Affine, Rect, clip_polyline};
use thiserror::Error;

/// Sizes that differ by less are the same sheet, in millimetres.
const SAME_SIZE: f64 = 1.0;
/// Rounding that is forgiven at the machine's limits, in millimetres.
const FORGIVEN: f64 = 0.02;

/// A page on a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Mounting {
    /// From the page's millimetres to machine units.
    pub to_machine: Affine,
    /// The machine's reach in machine units.
    pub limits: Rect,
    /// The sheet, where the machine knows any.
    pub paper: Option<Paper>,
    /// How the page is turned on the machine.
    pub turn: Turn,
}

/// A page's turn on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// As it is.
    Upright,
    /// Clockwise by a quarter, so that a portrait page lies on a landscape sheet.
    Quarter,
}

/// Why a page or drawing does not go onto a machine.
#[derive(Debug, Error, PartialEq)]
pub enum MountingError {
    /// The page is larger than every sheet.
    #[error(
        "a page of {width:.1} x {height:.1} mm is larger than every sheet of {machine} ({sheets}); choose --page or --size to fit"
    )]
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
    /// The drawing leaves the machine's reach.
    #[error(
        "the drawing reaches {excess:.2} mm beyond the {side} limit of {machine} on this sheet; {advice}, or cut it with --clip"
    )]
    OutOfReach {
        /// How far.
        excess: f64,
        /// Which limit.
        side: &'static str,
        /// The profile's name.
        machine: String,
        /// What would work.
        advice: String,
    },
}

/// Lays a page on a machine: on the sheet of its size, either way round, else in the middle of the first sheet of the profile
/// that holds it; where the machine knows no sheets, with its lower left corner at machine zero.
pub fn mount(profile: &Profile, page: &Page) -> Result<Mounting, MountingError> {
    let scale = profile.units_per_mm;
    if let Some(area) = &profile.area {
        return Ok(Mounting {
            to_machine: Affine::new([scale, 0.0, 0.0, -scale, 0.0, page.height * scale]),
            limits: Rect::new(area.x[0], area.y[0], area.x[1], area.y[1]),
            paper: None,
            turn: Turn::Upright,
        });
    }
    let (paper, turn) = choose_paper(profile, page)?;
    let (width, height) = turned_size(page, turn);
    // The page's turned box on the sheet, from the sheet's upper left corner.
    let (left, top) = (0.5 * (paper.width - width), 0.5 * (paper.height - height));
    let turned = match turn {
        Turn::Upright => Affine::IDENTITY,
        Turn::Quarter => Affine::new([0.0, 1.0, -1.0, 0.0, page.height, 0.0]),
    };
    let on_machine = Affine::new([scale, 0.0, 0.0, -scale, (left - paper.zero[0]) * scale, (paper.zero[1] - top) * scale]);
    Ok(Mounting {
        to_machine: on_machine * turned,
        limits: Rect::new(paper.x[0], paper.y[0], paper.x[1], paper.y[1]),
        paper: Some(paper.clone()),
        turn,
    })
}

const fn turned_size(page: &Page, turn: Turn) -> (f64, f64) {
    match turn {
        Turn::Upright => (page.width, page.height),
        Turn::Quarter => (page.height, page.width),
    }
}

fn choose_paper<'a>(profile: &'a Profile, page: &Page) -> Result<(&'a Paper, Turn), MountingError> {
    let spare = |paper: &Paper, turn| {
        let (width, height) = turned_size(page, turn);
        (paper.width - width, paper.height - height)
    };
    let options = || profile.paper.iter().flat_map(|paper| [(paper, Turn::Upright), (paper, Turn::Quarter)]);
    let exact = options().find(|&(paper, turn)| {
        let (x, y) = spare(paper, turn);
        x.abs() < SAME_SIZE && y.abs() < SAME_SIZE
    });
    let holds = |&(paper, turn): &(&Paper, Turn)| {
        let (x, y) = spare(paper, turn);
        x >= 0.0 && y >= 0.0
    };
    exact.or_else(|| options().find(holds)).ok_or_else(|| MountingError::PageTooLarge {
        width: page.width,
        height: page.height,
        machine: profile.name.clone(),
        sheets: profile.paper.iter().map(|p| format!("{} {} x {} mm", p.name, p.width, p.height)).collect::<Vec<_>>().join(", "),
    })
}

impl Mounting {
    /// The machine's reach in the page's millimetres.
    pub fn reach_on_page(&self) -> Rect {
        self.to_machine.inverse().transform_rect_bbox(self.limits)
    }

    /// Refuses a plot of which anything lies beyond the machine's reach, and says by how much.
    pub fn check(&self, profile: &Profile, plot: &Plot) -> Result<(), MountingError> {
        let points = || plot.pens.iter().flat_map(|pen| &pen.paths).flat_map(|path| &path.points);
        let Some(bounds) = points().map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b)) else { return Ok(()) };
        let excesses = excesses(self.to_machine.transform_rect_bbox(bounds), self.limits, profile.units_per_mm);
        let (excess, side) = excesses.into_iter().fold((0.0, ""), |worst, next| if next.0 > worst.0 { next } else { worst });
        if excess <= FORGIVEN {
            return Ok(());
        }
        let reach = self.reach_on_page();
        let fits = |w: f64, h: f64| w <= reach.width() && h <= reach.height();
        let advice = if fits(bounds.width(), bounds.height()) {
            "it would fit elsewhere on the page: leave a larger --margin, or plot with --fit page".to_owned()
        } else if fits(bounds.height(), bounds.width()) {
            "it would fit turned by 90 degrees: --rotate 90".to_owned()
        } else {
            format!(
                "it is {:.1} x {:.1} mm and the reach is {:.1} x {:.1} mm: make it smaller (draw --size, plot --scale or --fit page)",
                bounds.width(),
                bounds.height(),
                reach.width(),
                reach.height()
            )
        };
        Err(MountingError::OutOfReach { excess, side, machine: profile.name.clone(), advice })
    }
}

/// How far a box reaches beyond each limit, in millimetres.
fn excesses(inner: Rect, limits: Rect, units_per_mm: f64) -> [(f64, &'static str); 4] {
    [
        ((limits.x0 - inner.x0) / units_per_mm, "lower x"),
        ((inner.x1 - limits.x1) / units_per_mm, "upper x"),
        ((limits.y0 - inner.y0) / units_per_mm, "lower y"),
        ((inner.y1 - limits.y1) / units_per_mm, "upper y"),
    ]
}

/// Cuts every path at a rectangle of the page; returns how many millimetres of line, and how many touches, fell away.
pub fn clip_to(plot: &mut Plot, rect: Rect) -> (f64, usize) {
    let (mut lost_length, mut lost_touches) = (0.0, 0);
    for pen in &mut plot.pens {
        let mut kept = Vec::with_capacity(pen.paths.len());
        for path in std::mem::take(&mut pen.paths) {
            if let [touch] = path.points[..] {
                if rect.inflate(1e-9, 1e-9).contains(touch) {
                    kept.push(path);
                } else {
                    lost_touches += 1;
                }
                continue;
            }
            let pieces = clip_polyline(&path.points, rect);
            lost_length += path.length();
            for piece in pieces {
                let piece = Toolpath {
                    heights: path.heights.as_ref().map(|heights| piece.iter().map(|&(_, at)| between(heights, at)).collect()),
                    points: piece.into_iter().map(|(p, _)| p).collect(),
                    ..path
                };
                lost_length -= piece.length();
                kept.push(piece);
            }
        }
        pen.paths = kept;
    }
    (lost_length.max(0.0), lost_touches)
}

/// A value between vertices; `at` is the vertex's index plus a fraction.
fn between(values: &[f64], at: f64) -> f64 {
    let last = values.len() - 1;
    let i = (at.max(0.0) as usize).min(last);
    let next = values[(i + 1).min(last)];
    values[i] + (next - values[i]) * (at - i as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::plot::{PenPaths, built_in};

    fn profile(name: &str) -> Profile {
        Profile::parse(name, built_in(name).unwrap()).unwrap()
    }

    fn plot_of(page: Page, points: &[(f64, f64)]) -> Plot {
        let points = points.iter().map(|&(x, y)| Point::new(x, y)).collect();
        let pen = PenPaths {
            number: 1,
            name: "x".into(),
            colour: crate::drawing::Colour::BLACK,
            nib: 0.3,
            handling: crate::drawing::Handling::default(),
            paths: vec![Toolpath::new(points)],
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
