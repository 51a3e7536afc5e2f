//! A small plot that meets every kind of move, and any plot's way through a machine's profile to its file.

use super::refusal;
use drypoint::drawing::{Colour, Handling, Page};
use drypoint::geometry::{Point, Rect};
use drypoint::interrupt::Interrupt;
use drypoint::order::Effort;
use drypoint::plot::{
    Duplicates, Job, JobOptions, Language, Mounting, PenPaths, Plot, Profile, Sequence, ShownTravel, Strokes, Toolpath, mount,
};
use drypoint::write::SvgHead;

/// An arc, a touch, a closed path and a swelling one; the second pen of the same number waits first.
pub(crate) fn small_plot(page: Page) -> Plot {
    let at = |x: f64, y: f64| Point::new(x * page.width, y * page.height);
    let arc = (1..=12).map(|i| f64::from(i) * 0.25).map(|a| at(0.5 + 0.2 * a.cos(), 0.5 + 0.2 * a.sin()));
    let square = [(0.6, 0.3), (0.6, 0.6), (0.3, 0.6), (0.3, 0.3)].map(|(x, y)| at(x, y));
    let swelling = Toolpath::through(at(0.2, 0.8), [at(0.5, 0.7), at(0.8, 0.8)]);
    let swelling = swelling.with_heights(vec![0.0, -0.5, 0.1]).expect("three points");
    let pen = |name: &str, handling: Handling, paths: Vec<Toolpath>| PenPaths {
        number: 1,
        name: name.to_owned(),
        colour: Colour::BLACK,
        nib: 0.3,
        handling,
        paths,
    };
    let arc = Toolpath::through(at(0.5 + 0.2, 0.5), arc);
    let level = vec![arc, Toolpath::touch(at(0.1, 0.1)), Toolpath::through(at(0.3, 0.3), square)];
    let second = Handling { pauses: true, speed_percent: Some(50.0), delay_seconds: 0.5 };
    Plot { page, pens: vec![pen("lines", Handling::default(), level), pen("swell", second, vec![swelling])] }
}

/// A machine's file and what it was made of.
pub(crate) struct Written {
    pub(crate) text: String,
    pub(crate) plot: Plot,
    pub(crate) mounting: Mounting,
}

/// Takes a plot through a machine's job, and writes it and its preview; nothing where the machine refuses it.
pub(crate) fn written(profile: &Profile, mut plot: Plot) -> Option<Written> {
    let mounting = told(mount(profile, &plot.page))?;
    let reach = mounting.reach_on_page();
    assert!(reach.is_finite() && mounting.drawable(&plot.page).is_finite(), "reach {reach:?}");
    if !profile.can_pause() {
        plot.pens.iter_mut().for_each(|pen| pen.handling.pauses = false);
    }
    if profile.language() == Language::Hpgl {
        plot.pens.iter_mut().for_each(|pen| pen.handling.delay_seconds = 0.0);
    }
    let sequence = Sequence { effort: Effort::None, duplicates: Duplicates::Keep, ..Sequence::default() };
    let options = JobOptions { sequence, dry_seconds: profile.can_dwell().then_some(2.0), ..JobOptions::default() };
    let job = told(Job::of_paths(plot, Some(profile), &options, &Interrupt::never()))?;
    let seconds = job.report().total.seconds.expect("the machine is known");
    assert!(seconds.is_finite() && seconds >= 0.0, "{seconds} s");
    let text = ascii(|out| job.write(&SvgHead::default(), out));
    ascii(|out| job.write_preview(ShownTravel::Faint, out));
    Some(Written { text, plot: job.plot().clone(), mounting })
}

fn told<T, E: std::fmt::Display>(result: Result<T, E>) -> Option<T> {
    result.inspect_err(refusal::is_told).ok()
}

fn ascii(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("memory takes all that is written");
    String::from_utf8(bytes).expect("what is written is text")
}

/// Everything that a file makes a machine do is finite, and within `reach` if there is one.
pub(crate) fn is_sound(motion: &Strokes, reach: Option<Rect>) {
    for p in motion.visited.iter().chain(motion.paths.iter().flat_map(|(_, path)| path)) {
        assert!(p.is_finite(), "{p:?}");
        if let Some(reach) = reach {
            let inside = (reach.x0..=reach.x1).contains(&p.x) && (reach.y0..=reach.y1).contains(&p.y);
            assert!(inside, "{p:?} is outside of {reach:?}");
        }
    }
    assert!(motion.paths.iter().all(|(_, path)| !path.is_empty()), "a path without a point");
}
