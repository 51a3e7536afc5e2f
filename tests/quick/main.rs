//! What is tested in less than a minute.

#[path = "../common/any_style.rs"]
mod any_style;
#[cfg(feature = "cli")]
#[path = "../../fuzz/checks/mod.rs"]
mod checks;
#[path = "../common/mod.rs"]
mod common;
#[allow(dead_code)]
#[path = "../../examples/custom_style.rs"]
mod custom_style;
#[path = "../common/machine_file.rs"]
mod machine_file;
#[cfg(feature = "cli")]
#[path = "../common/photographed.rs"]
mod photographed;

mod architecture;
mod batch;
mod calibration;
mod citations;
mod colour_sheet;
mod colours;
mod complete_hedcut;
mod depth;
mod foreign;
mod fuzzed;
mod ink_box;
mod machines;
mod mutated;
mod paint_order;
mod pens;
mod portrait_tone;
mod regions;
mod seeing;
mod source;
mod styles;
