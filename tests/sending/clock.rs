//! The time left that a user reads.

use crate::machine::{Job, Machine, many, plot};
use std::io::{BufRead, BufReader};
use std::process::Stdio;

#[test]
fn the_time_left_is_true_after_a_minute() {
    // A report is read some hundredths of a second after it was true, and a faster machine goes on meanwhile.
    let (paths, pace, least) = if many(20) == 20 { (150, 1.0, 10.0) } else { (110, 4.0, 60.0) };
    let (machine, job) = (Machine::at_pace(pace), Job::new(&plot(paths, 5)));
    let mut child = job.send(&machine, &["--status", "-"]).stdout(Stdio::piped()).spawn().unwrap();
    let mut told: Vec<(f64, f64)> = Vec::new();
    for line in BufReader::new(child.stdout.take().unwrap()).lines() {
        let state: serde_json::Value = serde_json::from_str(&line.unwrap()).unwrap();
        let left = state["seconds_left"].as_f64().filter(|_| state["state"] == "drawing");
        told.extend(left.map(|left| (machine.firmware().now, left)));
    }
    assert!(child.wait().unwrap().success());
    let (begun, end) = (told[0].0, machine.firmware().rested);
    let late = told.iter().filter(|(now, left)| now - begun > 60.0 && *left > least);
    let off: Vec<f64> = late.map(|(now, left)| (left / (end - now) - 1.0).abs()).collect();
    let worst = off.iter().copied().fold(0.0, f64::max);
    println!("{} reports of {:.0} s, the time left at most {:.2} % off", off.len(), end - begun, 100.0 * worst);
    assert!(off.len() > 5 && worst <= 0.02, "{off:?}");
}
