#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| drypoint_fuzz::hpgl::check(bytes));
