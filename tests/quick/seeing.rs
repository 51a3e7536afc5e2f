//! What is found in the samples, once for all tests.
#![cfg(feature = "see")]

use crate::common::sample;
use drypoint::interrupt::Interrupt;
use drypoint::see::{Sight, look};
use drypoint::source::{Limits, Photograph};
use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};

/// What is found in a photograph of these bytes.
pub fn seen(bytes: &[u8]) -> Sight {
    look(&Photograph::decode(bytes, Limits::default()).unwrap(), &Interrupt::never()).unwrap()
}

/// What is found in a sample.
pub fn seen_sample(name: &'static str) -> &'static Sight {
    static SEEN: Mutex<BTreeMap<&str, &'static OnceLock<Sight>>> = Mutex::new(BTreeMap::new());
    let cell = *SEEN.lock().unwrap().entry(name).or_insert_with(|| Box::leak(Box::default()));
    cell.get_or_init(|| seen(&sample(name)))
}
