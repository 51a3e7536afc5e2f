//! What takes minutes: drawings of samples in every style, machines byte by byte, every command of the pages.

#[path = "../common/any_style.rs"]
mod any_style;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/fields.rs"]
mod fields;
#[cfg(feature = "cli")]
#[path = "../grbl/mod.rs"]
mod grbl;
#[path = "../common/machine_file.rs"]
mod machine_file;
#[cfg(feature = "cli")]
#[path = "../common/microscope.rs"]
mod microscope;
#[path = "../common/paper_stripes.rs"]
mod paper_stripes;
#[path = "../common/photographed.rs"]
mod photographed;
#[path = "../common/rasterised.rs"]
mod rasterised;

mod bounds;
mod by_hand;
mod charcoal;
mod colour_accuracy;
mod colour_sheet;
mod column;
mod command_line;
mod effects;
mod ends_of_ranges;
mod engrave;
mod files_kept;
mod flat_colours;
mod flat_places;
mod glass;
mod grid;
mod hedcut;
mod independent;
mod inkml;
mod lowering;
mod moire;
mod picture_box;
mod placing;
mod planner;
mod press;
mod recipes;
mod reports;
mod resume;
mod round_trip;
mod scenes;
mod see;
mod sight;
mod tangled;
