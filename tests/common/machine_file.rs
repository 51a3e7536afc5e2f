//! A plot's file for a machine, and the file as motion again.
#![allow(dead_code)]

use drypoint::interrupt::Interrupt;
use drypoint::order::Effort;
use drypoint::plot::{Duplicates, Job, JobError, JobOptions, Plot, Profile, Sequence, Strokes};
use drypoint::read::Budget;
use drypoint::write::SvgHead;

/// The job of a plot whose paths stay as they stand and rest no longer than they say.
pub fn job_as_it_stands<'a>(plot: &Plot, profile: &'a Profile) -> Result<Job<'a>, JobError> {
    let sequence = Sequence { effort: Effort::None, duplicates: Duplicates::Keep, ..Sequence::default() };
    let dwell = plot.pens.iter().map(|pen| (pen.number, 0.0)).collect();
    let options = JobOptions { sequence, dwell, ..JobOptions::default() };
    Job::of_paths(plot.clone(), Some(profile), &options, &Interrupt::never())
}

/// Its file.
pub fn written(plot: &Plot, profile: &Profile) -> Result<String, JobError> {
    let mut bytes = Vec::new();
    let head = SvgHead { recipe: "{}".into(), ..SvgHead::default() };
    job_as_it_stands(plot, profile)?.write(&head, &mut bytes).unwrap();
    Ok(String::from_utf8(bytes).unwrap())
}

/// The motion that a file orders.
pub fn read_back(text: &str, profile: &Profile) -> Strokes {
    profile.read(text, &mut Budget::default()).unwrap()
}

/// A plot's paths as SVG, as wide as their nibs.
pub fn picture(plot: &Plot) -> String {
    let options = JobOptions {
        sequence: Sequence { effort: Effort::None, duplicates: Duplicates::Keep, ..Sequence::default() },
        ..JobOptions::default()
    };
    let job = Job::of_paths(plot.clone(), None, &options, &Interrupt::never()).unwrap();
    let mut bytes = Vec::new();
    job.write(&SvgHead::default(), &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}
