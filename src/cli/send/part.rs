//! Which part of a file is drawn: all, a part that was asked for, or what an earlier drawing left.

use super::super::arguments::SendOptions;
use super::super::failure::Failure;
use super::super::interruption::interrupt;
use super::super::messages::{say, warning};
use super::super::output;
use super::meeting::confirm;
use super::{File, journal_of};
use crate::drive::{Evidence, Found, Place, Program, Record, Stand, place_to_continue, read_journal};
use crate::plot::{Act, Profile};

/// A journal of many days.
const MOST_JOURNAL: u64 = 1 << 27;
/// A machine that was not moved stands within this many machine units of where it stopped.
const SAME_PLACE: f64 = 1.0;

/// The part that will be drawn.
pub(super) struct Planned {
    /// Its paths by their numbers in the file, from 1; `None` for all.
    pub paths: Option<Vec<usize>>,
    /// Length of the first of them that is left out, in machine units.
    pub along: f64,
    chosen: Chosen,
}

/// What a journal begins with.
pub(super) struct Chosen {
    /// The paths that were asked for at first, by their numbers; `None` for all.
    pub paths: Option<Vec<usize>>,
    pub is_continued: bool,
}

impl Planned {
    /// The part of a program.
    pub fn program(&self, profile: &Profile, whole: &Program) -> Result<Program, Failure> {
        match &self.paths {
            None => Ok(whole.clone()),
            Some(numbers) => {
                let paths: Vec<usize> = numbers.iter().map(|number| number - 1).collect();
                Ok(whole.part(profile, &paths, self.along, interrupt())?)
            }
        }
    }

    pub fn into_chosen(self) -> Chosen {
        self.chosen
    }
}

/// The part to draw; `None` if nothing is left to continue.
pub(super) fn planned(
    stand: Option<Stand>,
    profile: &Profile,
    file: &File,
    options: &SendOptions,
) -> Result<Option<Planned>, Failure> {
    let journal = journal_of(options, &file.name);
    if options.goes_on {
        return continued(stand, profile, file, &journal, options);
    }
    warn_of_unfinished(file, &journal);
    let paths = asked_for(&file.program, profile, options)?;
    if paths.as_ref().is_some_and(Vec::is_empty) {
        return Err(Failure::Work(format!("{}: no path lies in the part that was asked for", file.name)));
    }
    let paths: Option<Vec<usize>> = paths.map(|paths| paths.into_iter().map(|path| path + 1).collect());
    Ok(Some(Planned { paths: paths.clone(), along: 0.0, chosen: Chosen { paths, is_continued: false } }))
}

fn warn_of_unfinished(file: &File, journal: &str) {
    let text = std::fs::read_to_string(journal).unwrap_or_default();
    if let Some((beginning, record)) = read_journal(&text)
        && beginning.sha256 == file.sha256
        && !record.is_done
        && record.path > 1
    {
        warning!("an earlier drawing stopped at path {}; --continue would go on there, this begins anew", record.path);
    }
}

/// The paths that the options name, from 0; `None` for all.
fn asked_for(program: &Program, profile: &Profile, options: &SendOptions) -> Result<Option<Vec<usize>>, Failure> {
    let count = program.paths.len();
    let first = match (options.from, options.path, options.line) {
        (Some(share), _, _) => {
            let until = share * program.seconds();
            program.paths.partition_point(|path| program.lines[path.end - 1].until <= until)
        }
        (_, Some(path), _) if path == 0 || path > count => {
            return Err(Failure::Usage(format!("--path {path}: the file has the paths 1 to {count}")));
        }
        (_, Some(path), _) => path - 1,
        (_, _, Some(line)) => {
            let last = program.lines.last().map_or(0, |line| line.number);
            if line == 0 || line > last {
                return Err(Failure::Usage(format!("--line {line}: the file has the lines 1 to {last}")));
            }
            program.path_of(line - 1)
        }
        _ => 0,
    };
    let in_layer = |path: usize| options.layer.as_ref().is_none_or(|name| is_in_layer(program, path, name));
    let in_region = |path: usize| options.region.is_none_or(|region| touches(program, path, region, profile.units_per_mm));
    let is_part = first > 0 || options.layer.is_some() || options.region.is_some();
    Ok(is_part.then(|| (first..count).filter(|&path| in_layer(path) && in_region(path)).collect()))
}

/// True if a path belongs to a layer: the pen's number, or its name as the file gives it, with or without the nib.
fn is_in_layer(program: &Program, path: usize, name: &str) -> bool {
    let path = &program.paths[path];
    if name.parse() == Ok(path.pen) {
        return true;
    }
    let named = program.lines[..path.begin].iter().rev().find(|line| line.act == Act::Pen(path.pen));
    let title = named.and_then(|line| line.name.as_deref()?.split_once(": ")).map_or("", |(_, title)| title);
    title == name || title.rsplit_once(' ').is_some_and(|(title, _)| title == name)
}

/// True if a path's box meets a region in millimetres.
fn touches(program: &Program, path: usize, [x, y, width, height]: [f64; 4], per_mm: f64) -> bool {
    let path = &program.paths[path];
    let places: Vec<[f64; 2]> = program.places(path).map(|place| [place.x / per_mm, place.y / per_mm]).collect();
    let beyond = |axis: usize, low: f64, size: f64| {
        places.iter().all(|at| at[axis] < low) || places.iter().all(|at| at[axis] > low + size)
    };
    !beyond(0, x, width) && !beyond(1, y, height)
}

fn continued(
    stand: Option<Stand>,
    profile: &Profile,
    file: &File,
    journal: &str,
    options: &SendOptions,
) -> Result<Option<Planned>, Failure> {
    let text = String::from_utf8(output::read(journal, MOST_JOURNAL, "")?).unwrap_or_default();
    let (beginning, record) = read_journal(&text)
        .ok_or_else(|| Failure::Work(format!("{journal} is not a journal of a drawing; begin without --continue")))?;
    if beginning.sha256 != file.sha256 {
        return Err(Failure::Work(format!(
            "{journal} is of another file, or {} was changed since; make it as it was, or begin without --continue",
            file.name
        )));
    }
    if beginning.profile != profile.name {
        return Err(Failure::Work(format!(
            "the drawing began on {}, not on {}; give --profile {0}",
            beginning.profile, profile.name
        )));
    }
    let overlap = options.overlap.map(|mm| mm * profile.units_per_mm);
    let found = found(stand, file, &record, options);
    let Some((Place { path, along }, evidence)) = place_to_continue(&file.program, &record, found, overlap) else {
        return Ok(None);
    };
    check_origin(stand, &record, evidence, options)?;
    let is_chosen = |i: &usize| beginning.paths.as_ref().is_none_or(|paths| paths.contains(&(i + 1)));
    let paths: Vec<usize> = (path..file.program.paths.len()).filter(is_chosen).collect();
    if paths.is_empty() {
        return Ok(None);
    }
    if !options.quiet {
        say!(
            "{}: goes on at path {} of {}, {:.1} mm along it",
            file.name,
            path + 1,
            file.program.paths.len(),
            along / profile.units_per_mm
        );
    }
    let along = if paths[0] == path { along } else { 0.0 };
    let numbers = paths.into_iter().map(|path| path + 1).collect();
    Ok(Some(Planned { paths: Some(numbers), along, chosen: Chosen { paths: beginning.paths, is_continued: true } }))
}

/// Where to look for the pen: where the journal saw it stop, else where the machine stands.
fn found(stand: Option<Stand>, file: &File, record: &Record, options: &SendOptions) -> Option<Found> {
    // After homing, or setting zero anew, the machine no longer stands where it stopped.
    let stopped = record.at.filter(|_| record.is_stopped).map(|at| Found { at, is_down: record.is_down });
    let stands = stand.filter(|_| !options.home && !options.at_origin);
    stopped.or_else(|| stands.map(|stand| Found { at: stand.at, is_down: file.program.is_down(&stand) }))
}

/// If the machine lost its position, it is homed, or the user says where zero is.
fn check_origin(stand: Option<Stand>, record: &Record, evidence: Evidence, options: &SendOptions) -> Result<(), Failure> {
    if options.home || options.at_origin {
        return Ok(());
    }
    let is_where_it_stopped = match (stand, record.at) {
        (Some(stand), Some(at)) => (0..2).all(|axis| (stand.at[axis] - at[axis]).abs() < SAME_PLACE),
        _ => false,
    };
    if stand.is_some() && if record.is_stopped { is_where_it_stopped } else { evidence == Evidence::Pen } {
        return Ok(());
    }
    say!(
        "the machine restarted or was moved, so that zero may be elsewhere now. Home it (--home), or move the pen to the origin by hand \
         and give --at-origin"
    );
    confirm(false, "Or is zero certainly where it was when the drawing began?")
}
