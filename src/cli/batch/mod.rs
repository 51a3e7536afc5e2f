//! `drypoint batch`: many photographs, a process for each, one JSON line each.
//!
//! ```text
//!   inputs --named--> shard --> recorded as drawn? ---yes--> skipped
//!                                      | no
//!                                 memory is free --> `drypoint draw` --> record
//! ```
//!
//! A process per photograph, so that none can stop the others, whatever is wrong with it, and memory is given back after each.

mod child;
mod inputs;
mod memory;
mod order;
mod record;
mod telling;

use super::arguments::{BatchOptions, Shard};
use super::claims;
use super::failure::Failure;
use super::interruption::{is_interrupted, remove_unfinished};
use super::output;
use child::Children;
use inputs::{Named, Pictures};
use memory::Memory;
use order::Order;
use record::Record;
use sha2::{Digest, Sha256};
use std::collections::HashSet;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use telling::{Drawn, Outcome, Telling};

/// Draws the pictures.
pub(super) fn run(options: &BatchOptions) -> Result<(), Failure> {
    let order = Order::of(options)?;
    let pictures = Pictures::of(&options.inputs)?;
    let shard = options.shard.unwrap_or(Shard::WHOLE);
    let count = pictures.count(|name| is_in_shard(name, shard))?;
    let telling = Telling::new(options, count)?;
    let jobs = options.jobs.map_or_else(cores, usize::from);
    let work = Work {
        order: &order,
        threads: options.draw.picture.threads.map_or_else(|| (cores() / jobs).max(1), usize::from),
        memory: Memory::new(options.max_memory.unwrap_or_else(memory::free)),
        children: Children::new()?,
        telling: &telling,
        stops: AtomicBool::new(false),
        refused: Mutex::new(None),
        held: Mutex::new(None),
        folders: Mutex::new(HashSet::new()),
    };
    let queue = Mutex::new(Queue { pictures: pictures.into_iter(), shard, outputs: HashSet::new() });
    std::thread::scope(|scope| {
        scope.spawn(|| work.children.stop_when(|| is_interrupted() || work.stops.load(Ordering::SeqCst)));
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(|| work.draw_all(&queue))).collect();
        workers.into_iter().for_each(|worker| drop(worker.join()));
        work.children.end();
    });
    if is_interrupted() {
        return Err(Failure::Interrupted);
    }
    work.folders.lock().unwrap_or_else(PoisonError::into_inner).iter().for_each(|folder| remove_unfinished(folder));
    if let Some(failure) = work.refused.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(failure);
    }
    if let Some((outcome, reason)) = work.held.into_inner().unwrap_or_else(PoisonError::into_inner) {
        if telling.nothing_is_told() {
            return Err(Failure::Usage(reason));
        }
        telling.tell(&outcome)?;
    }
    telling.finish()
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Deals pictures out by the hash of their names.
fn is_in_shard(name: &str, shard: Shard) -> bool {
    let hash = Sha256::digest(name.as_bytes());
    let number = hash[..8].iter().fold(0_u64, |number, byte| number << 8 | u64::from(*byte));
    number % u64::from(shard.count) == u64::from(shard.number - 1)
}

/// The pictures still to come.
struct Queue {
    pictures: inputs::Iter,
    shard: Shard,
    /// Hashes of the outputs so far: two pictures of one name would overwrite each other.
    outputs: HashSet<u64>,
}

impl Queue {
    fn next(&mut self, order: &Order) -> Option<Result<Named, Outcome>> {
        loop {
            let named = match self.pictures.next()? {
                Ok(named) if !is_in_shard(&named.name, self.shard) => continue,
                Ok(named) => named,
                Err(failure) => return Some(Err(Outcome::failed_manifest(&failure))),
            };
            let output = order.output(&named.name);
            let hash = Sha256::digest(output.as_bytes())[..8].iter().fold(0_u64, |number, byte| number << 8 | u64::from(*byte));
            if self.outputs.insert(hash) {
                return Some(Ok(named));
            }
            let reason = format!("{output} is already the output of another photograph; give it a name of its own in a manifest");
            return Some(Err(Outcome::failed(&named, &output, reason)));
        }
    }
}

/// What all workers share.
struct Work<'a> {
    order: &'a Order,
    threads: usize,
    memory: Memory,
    children: Children,
    telling: &'a Telling,
    /// True when the work cannot go on.
    stops: AtomicBool,
    refused: Mutex<Option<Failure>>,
    /// The first picture for which the command line was wrong, and why, while nothing is drawn: the next ones show whose fault it was.
    held: Mutex<Option<(Outcome, String)>>,
    /// The outputs' folders so far.
    folders: Mutex<HashSet<PathBuf>>,
}

impl Work<'_> {
    fn draw_all(&self, queue: &Mutex<Queue>) {
        while !is_interrupted() && !self.stops.load(Ordering::SeqCst) {
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next(self.order);
            let outcome = match next {
                None => return,
                Some(Ok(named)) => self.draw(&named),
                Some(Err(outcome)) => Ok(Some(outcome)),
            };
            let told = outcome.and_then(|outcome| outcome.map_or(Ok(()), |outcome| self.telling.tell(&outcome)));
            if let Err(failure) = told {
                self.refused.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(failure);
                self.stops.store(true, Ordering::SeqCst);
            }
        }
    }

    /// Draws one picture, unless it is drawn already; no outcome if it was interrupted. The failure is one of the whole batch.
    fn draw(&self, named: &Named) -> Result<Option<Outcome>, Failure> {
        let begun = Instant::now();
        let output = self.order.output(&named.name);
        match self.drawn(named, &output) {
            Ok(drawn) => Ok(Some(Outcome::done(named, &output, drawn, begun.elapsed()))),
            Err(_) if is_interrupted() || self.stops.load(Ordering::SeqCst) => Ok(None),
            Err(Failure::Usage(reason)) if self.telling.nothing_is_drawn() => {
                let outcome = Outcome::failed(named, &output, reason.clone()).after(begun.elapsed());
                self.usage_failure(outcome, reason)
            }
            Err(failure) => Ok(Some(Outcome::failed(named, &output, failure.to_string()).after(begun.elapsed()))),
        }
    }

    /// What is wrong with the command line is wrong for every picture, and in the same words; what is wrong with a picture is not.
    fn usage_failure(&self, outcome: Outcome, reason: String) -> Result<Option<Outcome>, Failure> {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        match &*held {
            Some((_, first)) if *first == reason => Err(Failure::Usage(reason)),
            Some(_) => Ok(Some(outcome)),
            None => {
                *held = Some((outcome, reason));
                Ok(None)
            }
        }
    }

    /// Once for each folder: what a killed process left there goes.
    fn enter(&self, folder: &Path) {
        let mut folders = self.folders.lock().unwrap_or_else(PoisonError::into_inner);
        if !folders.contains(folder) {
            folders.insert(folder.to_owned());
            remove_unfinished(folder);
        }
    }

    fn drawn(&self, named: &Named, output: &str) -> Result<Drawn, Failure> {
        claims::check_not_input(output)?;
        let folder = Path::new(output).parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        self.enter(folder);
        let key = self.order.key(named)?;
        if let Some(record) = Record::of(output).filter(|record| record.holds(&key, output)) {
            return Ok(Drawn { sha256: record.sha256, bytes: record.bytes, warnings: Vec::new(), is_new: false });
        }
        std::fs::create_dir_all(folder).map_err(Failure::writing(output))?;
        let warnings = {
            let _held = self.memory.hold(self.order.foretold_bytes(&named.photo), is_interrupted);
            self.children.run(&self.order.words(named, output, self.threads))?
        };
        let record = Record::made(key, output)?;
        record.write(output)?;
        Ok(Drawn { sha256: record.sha256, bytes: record.bytes, warnings, is_new: true })
    }
}

/// SHA-256 of a file, in hexadecimal, and its length.
fn hashed(path: &Path) -> std::io::Result<(String, u64)> {
    let (mut file, mut hasher) = (std::fs::File::open(path)?, Sha256::new());
    let (mut part, mut length) = (vec![0; 1 << 16], 0);
    loop {
        match file.read(&mut part)? {
            0 => break,
            read => {
                hasher.update(&part[..read]);
                length += read as u64;
            }
        }
    }
    Ok((crate::source::hexadecimal(&hasher.finalize()), length))
}

/// The same, with a message for a file that a user named.
fn hashed_input(name: &str) -> Result<(String, u64), Failure> {
    let path = Path::new(name);
    // Neither a folder, nor a pipe that nobody writes to, nor a device without an end.
    let kind = std::fs::metadata(path).map(|data| (data.is_dir(), data.is_file()));
    if let Ok((is_folder, false)) = kind {
        let what = if is_folder { "is a folder" } else { "is no ordinary file" };
        return Err(Failure::Work(format!("{name} {what}; give a file")));
    }
    hashed(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Failure::Work(format!("{name} does not exist; check its name")),
        _ => Failure::Work(format!("{name} cannot be read: {error}")),
    })
}

/// Refuses outputs that are not one file per picture.
fn check_output(name: &str) -> Result<(), Failure> {
    let problem = match name {
        "-" => "batch writes a file per picture: -o 'out/{name}.svg'",
        _ if !name.contains(order::NAME) => "all pictures would be one file; put {name} into -o, such as 'out/{name}.svg'",
        _ if name.contains("{layer}") => "batch writes one file per picture; {layer} is for `drypoint draw`",
        _ => return Ok(()),
    };
    Err(Failure::Usage(problem.to_owned()))
}

/// Writes a small file whole or not at all.
fn write_whole(path: &Path, text: &str) -> Result<(), Failure> {
    output::write(&path.to_string_lossy(), |out| out.write_all(text.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_in_one_shard() {
        let names: Vec<String> = (0..1000).map(|i| format!("folder/{i}")).collect();
        let shards: Vec<usize> =
            (1..=7).map(|number| names.iter().filter(|name| is_in_shard(name, Shard { number, count: 7 })).count()).collect();
        assert_eq!(shards.iter().sum::<usize>(), 1000);
        assert!(shards.iter().all(|count| (100..190).contains(count)), "{shards:?}");
        assert!(is_in_shard("a", Shard::WHOLE));
    }
}
