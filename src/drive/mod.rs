//! Driving a machine: sends a file, follows what is drawn, pauses, stops, and continues after anything.
//!
//! ```text
//!   file --Program--> lines and paths with times --Session--> Controller (GRBL, Marlin, EBB, HP-GL) --Port--> machine
//!                                                    \--> Journal --recovery--> the place to continue from
//! ```
//!
//! Nothing here opens files or prints: a journal is kept by whoever implements [`Ledger`], a terminal or a page follows as
//! [`Onlooker`]. Every protocol was proved against models of the machines, not on machines.

mod checkpoints;
mod clock;
mod controller;
mod dips;
mod ebb;
mod error;
mod grbl;
mod hpgl;
mod journal;
mod lines;
mod marlin;
mod modes;
mod part;
mod port;
mod program;
mod recovery;
mod session;
mod stand;
mod standing;

#[doc(hidden)]
pub use controller::{Controller, Heard, SpeedChange};
#[doc(hidden)]
pub use dips::{Dip, Inkwell, Refill};
#[doc(hidden)]
pub use ebb::{Ebb, PenHeights, Rest};
pub use error::DriveError;
pub use grbl::Grbl;
#[doc(hidden)]
pub use grbl::{Difference, Greeting, MachineState, Settings, Status, adopted, differences, enforced_reach};
#[doc(hidden)]
pub use hpgl::Hpgl;
#[doc(hidden)]
pub use journal::{Beginning, Journal, Ledger, Record, read_journal};
#[doc(hidden)]
pub use marlin::Marlin;
#[doc(hidden)]
pub use port::{FoundPort, Handshake, LineSettings, Port, open_port, ports};
pub use program::Program;
#[doc(hidden)]
pub use program::{PathLines, Place, ProgramLine};
#[doc(hidden)]
pub use recovery::{Evidence, Found, place_to_continue};
pub use session::Session;
#[doc(hidden)]
pub use session::{Ending, Happening, Onlooker, Wish};
#[doc(hidden)]
pub use stand::Stand;
#[doc(hidden)]
pub use standing::Progress;
