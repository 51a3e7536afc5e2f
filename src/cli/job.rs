//! Makes the library's plotting job from command-line options, and turns its errors into messages about options.

use super::arguments::{Order, ToolpathOptions};
use super::failure::Failure;
use super::interruption::interrupt;
use super::pens::PenSet;
use super::toolpaths::duration;
use crate::drawing::Drawing;
use crate::order::{Direction, Effort};
use crate::plot::{
    Course, InkModel, Job, JobError, JobOptions, MachineFeature, PlacingMarks, Plot, Profile, ReachPolicy, Sequence,
};
use crate::style::Observer;

/// The job of a drawing; each step is reported to the observer.
pub(super) fn of_drawing<'a>(
    drawing: &Drawing,
    model: InkModel,
    machine: Option<&'a Profile>,
    options: &ToolpathOptions,
    pens: &PenSet,
    observer: &dyn Observer,
) -> Result<Job<'a>, Failure> {
    let begin = |step: &str| observer.begin(step);
    let made = Job::of_drawing(drawing, model, pens.nibs(), machine, &asked(options, pens), &begin, interrupt());
    made.map_err(|error| refused(error, options))
}

/// The job of tool paths.
pub(super) fn of_paths<'a>(
    plot: Plot,
    machine: Option<&'a Profile>,
    options: &ToolpathOptions,
    pens: &PenSet,
) -> Result<Job<'a>, Failure> {
    Job::of_paths(plot, machine, &asked(options, pens), interrupt()).map_err(|error| refused(error, options))
}

fn asked(options: &ToolpathOptions, pens: &PenSet) -> JobOptions {
    JobOptions {
        sequence: sequence(options),
        tolerance: options.tolerance,
        beyond: if options.clip { ReachPolicy::Clip } else { ReachPolicy::Refuse },
        marks: PlacingMarks { has_frame: options.frame, has_registration: options.registration },
        pause_every: options.pause_every,
        dry_seconds: options.dry_time,
        dwell: pens.dwell().clone(),
    }
}

/// The sequence options given by the user.
fn sequence(options: &ToolpathOptions) -> Sequence {
    Sequence {
        effort: match options.order {
            Order::Full => Effort::Full,
            Order::Fast | Order::Random => Effort::Fast,
            Order::None => Effort::None,
        },
        direction: if options.keep_direction { Direction::AsDrawn } else { Direction::Either },
        merge: options.merge,
        duplicates: options.duplicates,
        seam: options.seam,
        course: match options.order {
            Order::Random => Course::Shuffled(options.order_seed),
            _ if options.reverse => Course::Backwards,
            _ => Course::Forwards,
        },
        start: options.start_corner,
    }
}

/// The failure for a job error, naming the options that caused it and those that help.
fn refused(error: JobError, options: &ToolpathOptions) -> Failure {
    match error {
        JobError::Interrupted => Failure::Interrupted,
        JobError::Misfit(error) => Failure::Misfit(error),
        JobError::NoMachine(MachineFeature::Drying) => {
            Failure::Usage("--dry-time needs a machine's speeds; give --profile".to_owned())
        }
        JobError::NoMachine(_) => Failure::Usage("--frame and --pause-every make a machine wait; give --profile".to_owned()),
        JobError::OwnFrame { machine } => {
            Failure::Usage(format!("--frame: {machine} is driven by its own program; trace the outline there"))
        }
        JobError::NoHandling { .. } => {
            Failure::Work(format!("{error}; draw the layers one by one with --layers, or remove ! and +D from the layer's label"))
        }
        JobError::NoSuchPen { .. } => {
            Failure::Work(format!("{error}; choose --layers, or give the layer a lower number, or a slot with --pens"))
        }
        JobError::NoPause { wish: MachineFeature::Frame, machine } => no_pause("--frame", &machine),
        JobError::NoPause { wish: MachineFeature::PauseEvery, machine } => no_pause("--pause-every", &machine),
        JobError::NoPause { .. } => Failure::Work(format!("{error}; write one file for each layer: -o 'name-{{layer}}.gcode'")),
        JobError::NoWait { seconds } => Failure::Work(format!(
            "--dry-time {}: the machine would have to wait {} in total, and its language has no wait command; use a shorter time",
            options.dry_time.unwrap_or_default(),
            duration(seconds)
        )),
    }
}

fn no_pause(option: &str, machine: &str) -> Failure {
    Failure::Work(format!("{option} needs a pause, and {machine} has no pause command"))
}
