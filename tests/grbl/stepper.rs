//! The segment buffer: the first block's speed profile, cut into hundredths of a second and converted to timer ticks.

use super::Real;
use super::planner::Planner;
use std::collections::VecDeque;

/// Minutes of a whole segment: 100 acceleration ticks a second.
const SEGMENT: Real = 1.0 / (100.0 * 60.0);
/// Size of the ring of segments, of which one place stays free.
const SEGMENT_BUFFER_SIZE: usize = 6;
/// A segment covers at least this many steps, or ends with the block.
const LEAST_STEPS: Real = 1.25;
/// Where a block's end falls on a segment's, rounding may leave a tiny distance at a tiny speed; the last step then waits until
/// it is covered, up to the timer's longest period. A distance below this fraction of a step counts as such a trace.
const TRACE: Real = 0.01;
/// Timer ticks a minute.
const CLOCK: Real = 16e6 * 60.0;
/// Above these numbers of ticks per step, each step is made in 2, 4 and 8 parts.
const SMOOTHING: [u64; 3] = [2000, 4000, 8000];
/// The timer's longest period.
const LONGEST_PERIOD: u64 = 0xffff;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ramp {
    Accelerate,
    Cruise,
    Decelerate,
}

/// The speed profile of the rest of a block; distances are from its end.
#[derive(Clone, Copy, Debug)]
struct Profile {
    ramp: Ramp,
    accelerate_until: Real,
    decelerate_after: Real,
    top_speed: Real,
    exit_speed: Real,
}

/// The block that is being divided into segments.
#[derive(Clone, Copy, Debug)]
struct Loaded {
    speed: Real,
    whole_steps_left: Real,
    steps_per_mm: Real,
    /// Time of the fraction of a step that the last segment could not make.
    time_owed: Real,
    /// Minutes of this segment spent on a trace.
    late: Real,
    /// `None` if it must be recomputed.
    profile: Option<Profile>,
}

/// A piece of a block at one speed.
#[derive(Clone, Copy, Debug)]
struct Segment {
    seconds: f64,
    /// Where it ends, in mm.
    end: [f64; 3],
}

#[derive(Default)]
pub struct Stepper {
    /// The segments that are ready; the first is running.
    segments: VecDeque<Segment>,
    /// True from a feed hold until it is resumed.
    holds: bool,
    /// Where the last finished segment ended.
    pub at: [f64; 3],
    loaded: Option<Loaded>,
    pub clock: f64,
    /// Seconds spent on traces.
    pub late: f64,
    pub steps: u64,
    pub top_speed: Real,
}

impl Stepper {
    /// Cuts segments off the blocks until the ring is full or no block is left.
    pub fn fill(&mut self, planner: &mut Planner) {
        while self.segments.len() < SEGMENT_BUFFER_SIZE - 1 {
            if !self.cut(planner) {
                return;
            }
        }
    }

    /// Ends the running segment; false if there is none.
    pub fn finish_segment(&mut self) -> bool {
        let Some(segment) = self.segments.pop_front() else { return false };
        self.clock += segment.seconds;
        self.at = segment.end;
        true
    }

    /// Seconds of the running segment.
    pub fn running(&self) -> Option<f64> {
        self.segments.front().map(|segment| segment.seconds)
    }

    /// Brakes from now on.
    pub fn hold(&mut self) {
        self.holds = true;
    }

    /// True if it stands still on hold.
    pub fn is_held(&self) -> bool {
        self.holds && self.segments.is_empty() && self.loaded.is_none_or(|loaded| loaded.speed == 0.0)
    }

    /// Goes on from rest.
    pub fn resume(&mut self, planner: &mut Planner) {
        self.holds = false;
        if let Some(loaded) = &mut self.loaded {
            (loaded.speed, loaded.profile) = (0.0, None);
        }
        planner.plan_again();
    }

    /// Forgets everything; the motors stand where they are.
    pub fn reset(&mut self) {
        self.segments.clear();
        (self.loaded, self.holds) = (None, false);
    }

    /// A piece of braking at the block's acceleration: a hundredth of a second, or to rest, or to the block's end.
    fn brake(loaded: &mut Loaded, length: Real, acceleration: Real) -> (Real, Real) {
        let speed = loaded.speed;
        let time = SEGMENT.min(speed / acceleration);
        let way = time * (speed - 0.5 * acceleration * time);
        if way >= length {
            let end = (speed * speed - 2.0 * acceleration * length).max(0.0).sqrt();
            loaded.speed = end;
            return ((2.0 * length / (speed + end)).max(1e-9), 0.0);
        }
        loaded.speed = if time < SEGMENT { 0.0 } else { speed - acceleration * time };
        (time, length - way)
    }

    /// A new plan starts from the running block's speed and remaining length, and may change how it ends.
    pub fn prepare_replan(&mut self, planner: &mut Planner) {
        if let (Some(loaded), Some(block)) = (&mut self.loaded, planner.first()) {
            block.entry_squared = loaded.speed * loaded.speed;
            loaded.profile = None;
        }
    }

    fn cut(&mut self, planner: &mut Planner) -> bool {
        let exit_squared = planner.exit_squared();
        let Some(block) = planner.first() else { return false };
        let mut loaded = self.loaded.unwrap_or_else(|| Loaded {
            speed: block.entry_squared.sqrt(),
            whole_steps_left: block.steps as Real,
            steps_per_mm: block.steps as Real / block.length,
            time_owed: 0.0,
            late: 0.0,
            profile: None,
        });
        if self.holds {
            return self.cut_braking(loaded, planner);
        }
        let mut profile = loaded
            .profile
            .unwrap_or_else(|| profile(block.length, block.entry_squared, exit_squared, block.nominal, block.acceleration));
        loaded.late = 0.0;
        let (time, left) = segment(&mut loaded, &mut profile, block.length, block.acceleration);
        loaded.profile = Some(profile);
        let steps_left = loaded.steps_per_mm * left;
        let whole = steps_left.ceil();
        let time_per_step = (time + loaded.time_owed) / (loaded.whole_steps_left - steps_left);
        let seconds = duration((loaded.whole_steps_left - whole) as u64, time_per_step);
        self.segments.push_back(Segment { seconds, end: block.place(left) });
        self.late += (60.0 * f64::from(loaded.late)).min(duration(1, 1.0));
        self.steps += (loaded.whole_steps_left - whole) as u64;
        self.top_speed = self.top_speed.max(loaded.speed);
        loaded.time_owed = (whole - steps_left) * time_per_step;
        loaded.whole_steps_left = whole;
        block.length = left;
        if left > 0.0 {
            self.loaded = Some(loaded);
        } else {
            self.loaded = None;
            planner.discard_first();
        }
        true
    }
}

impl Stepper {
    /// A segment of a feed hold; false at rest. Steps are not counted here.
    fn cut_braking(&mut self, mut loaded: Loaded, planner: &mut Planner) -> bool {
        let Some(block) = planner.first() else { return false };
        if loaded.speed <= 0.0 {
            self.loaded = Some(Loaded { speed: 0.0, profile: None, ..loaded });
            return false;
        }
        let (time, left) = Self::brake(&mut loaded, block.length, block.acceleration);
        self.segments.push_back(Segment { seconds: 60.0 * f64::from(time), end: block.place(left) });
        (block.length, loaded.profile) = (left, None);
        loaded.whole_steps_left = (loaded.steps_per_mm * left).ceil();
        block.entry_squared = loaded.speed * loaded.speed;
        if left > 0.0 {
            self.loaded = Some(loaded);
        } else {
            let speed = loaded.speed;
            planner.discard_first();
            self.loaded = None;
            if let Some(next) = planner.first() {
                next.entry_squared = speed * speed;
            }
        }
        true
    }
}

fn profile(length: Real, entry_squared: Real, exit_squared: Real, nominal: Real, acceleration: Real) -> Profile {
    let over = |from: Real, to: Real| (to - from) / (2.0 * acceleration);
    // Where the ramp up from the entry would meet the ramp down to the exit.
    let meeting = 0.5 * (length + over(exit_squared, entry_squared));
    let exit_speed = exit_squared.sqrt();
    let mut profile =
        Profile { ramp: Ramp::Accelerate, accelerate_until: 0.0, decelerate_after: 0.0, top_speed: exit_speed, exit_speed };
    if meeting >= length {
        profile.ramp = Ramp::Decelerate;
    } else if meeting > 0.0 {
        profile.decelerate_after = over(exit_squared, nominal * nominal);
        if profile.decelerate_after < meeting {
            profile.top_speed = nominal;
            profile.accelerate_until = length - over(entry_squared, nominal * nominal);
            if entry_squared >= nominal * nominal {
                profile.ramp = Ramp::Cruise;
            }
        } else {
            (profile.accelerate_until, profile.decelerate_after) = (meeting, meeting);
            profile.top_speed = (exit_squared + 2.0 * acceleration * meeting).sqrt();
        }
    }
    profile
}

/// Advances along the profile for the time of a segment, longer if that is less than a step, shorter if the block ends; returns
/// the time and the remaining length.
fn segment(loaded: &mut Loaded, profile: &mut Profile, length: Real, acceleration: Real) -> (Real, Real) {
    let at_least = (length - LEAST_STEPS / loaded.steps_per_mm).max(0.0);
    let (mut allowed, mut spent, mut left) = (SEGMENT, 0.0, length);
    loop {
        spent += advance(loaded, profile, &mut left, acceleration, allowed - spent, length);
        if left <= 0.0 {
            return (spent, 0.0);
        }
        if spent >= allowed {
            if left <= at_least {
                return (spent, left);
            }
            allowed += SEGMENT;
        }
    }
}

/// Advances for a time or to the end of the ramp, whichever is first; returns the time. Where a ramp up ends, the firmware takes
/// the distance from the segment's beginning, but the speed from here. So after a segment had to be extended, as at a start from
/// rest, it counts the distance before twice.
fn advance(
    loaded: &mut Loaded,
    profile: &mut Profile,
    left: &mut Real,
    acceleration: Real,
    time: Real,
    at_segment_start: Real,
) -> Real {
    let change = acceleration * time;
    match profile.ramp {
        Ramp::Accelerate => {
            let then = *left - time * (loaded.speed + 0.5 * change);
            if then >= profile.accelerate_until {
                (*left, loaded.speed) = (then, loaded.speed + change);
                return time;
            }
            let taken = 2.0 * (at_segment_start - profile.accelerate_until) / (loaded.speed + profile.top_speed);
            (*left, loaded.speed) = (profile.accelerate_until, profile.top_speed);
            profile.ramp = if profile.accelerate_until > profile.decelerate_after { Ramp::Cruise } else { Ramp::Decelerate };
            taken
        }
        Ramp::Cruise => {
            let then = *left - time * profile.top_speed;
            if then >= profile.decelerate_after {
                *left = then;
                return time;
            }
            let taken = (*left - profile.decelerate_after) / profile.top_speed;
            *left = profile.decelerate_after;
            profile.ramp = Ramp::Decelerate;
            taken
        }
        Ramp::Decelerate => {
            let then = *left - time * (loaded.speed - 0.5 * change);
            if loaded.speed > change && then > 0.0 {
                (*left, loaded.speed) = (then, loaded.speed - change);
                return time;
            }
            let taken = 2.0 * *left / (loaded.speed + profile.exit_speed);
            if *left * loaded.steps_per_mm < TRACE {
                loaded.late = taken;
            }
            (*left, loaded.speed) = (0.0, profile.exit_speed);
            taken
        }
    }
}

/// Seconds of a number of steps: ticks per step are whole, and slow steps are made in parts.
fn duration(steps: u64, minutes_per_step: Real) -> f64 {
    let ticks = (CLOCK * minutes_per_step).ceil() as u64;
    let parts = SMOOTHING.iter().filter(|&&slow| ticks >= slow).count();
    ((steps << parts) * (ticks >> parts).min(LONGEST_PERIOD)) as f64 / 16e6
}
