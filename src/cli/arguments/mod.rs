//! Options, their units and their help.

mod batch;
mod calibrate;
mod choices;
mod draw;
mod files;
mod placing;
mod reporting;
#[cfg(feature = "drive")]
mod send;
mod sheet;
#[cfg(feature = "studio")]
mod studio;
mod toolpaths;
mod values;

pub(super) use batch::*;
pub(super) use calibrate::*;
pub(super) use choices::*;
pub(super) use draw::*;
pub(super) use files::*;
pub(super) use placing::*;
#[cfg(feature = "drive")]
pub(super) use send::*;
pub(super) use sheet::*;
#[cfg(feature = "studio")]
pub(super) use studio::*;
pub(super) use toolpaths::*;
pub(super) use values::{CropNumber, CropPart, NIBS, Shard};

use clap::{Parser, Subcommand};

/// Turns a photograph into vector stroke art for print or a pen plotter.
///
/// Lengths take mm (the default), cm, in or pt, and px where an SVG is read. `-` is stdin or stdout. Data goes to stdout, everything else to stderr.
/// Exit status: 0 success, 1 the work failed, 2 the command line is wrong, 130 interrupted.
#[derive(Debug, Parser)]
#[command(name = "drypoint", version, max_term_width = 100)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

/// How to send a file to its machine.
const SENDING: &str = "\
Sending a file to its plotter:
  `drypoint send` does it, with pause, stop and going on. Other ways:
  HP-GL   The plotter buffers a few hundred bytes and pauses the sender by handshake; without a handshake it loses lines. Plotters of
          the 1980s use DTR (pin 20), which the cable must connect to the computer's CTS:
              stty -F /dev/ttyUSB0 9600 cs8 -cstopb -parenb -ixon crtscts raw && cat drawing.hpgl > /dev/ttyUSB0
          With a plain cable use a sender that asks for free buffer space (ESC.B), such as chiplotle's plot_hpgl_file, or put XON/XOFF
          into the file: --set-profile 'hpgl.preamble=\"\\u001B.I81;;17:\\u001B.N;19:\"' with stty ... ixon -crtscts.
  G-code  A sender that waits for `ok`, such as Universal G-code Sender, bCNC, Candle or cncjs; 3D printers read it from their card.
  SVG     For the AxiDraw: Inkscape's extension, axicli or saxi; layers are plotted in order, with a pause before those marked !.";

/// What `batch` prints and keeps.
const BATCHES: &str = "\
For each picture, as it ends, one JSON line on stdout: photo, name, output, status (done, skipped or failed), reason, warnings,
seconds, and sha256 and bytes of the output. {name} in any option's value is the picture's name, such as --mask 'hair=masks/{name}.png';
pictures of a folder are named by their path in it. OUT/.drypoint/ holds a record per picture: it is skipped if the photograph, all
options, the files that they name, the version and the output are as recorded. Any number of machines may share the folder.
Exit status: 0 all done or skipped, 3 some failed, 1 could not start, 2 the command line is wrong.";

/// How to steer a machine while it draws.
#[cfg(feature = "drive")]
const KEYS: &str = "\
While it draws, on a terminal:
  space   Pause at the end of the path, pen up; again to go on. The same by the signal USR1.
  q       Stop at once, lift the pen and end; --continue goes on. The same by Ctrl-C and the signal TERM.
  + -     Draw a tenth faster or slower; = as the file says.
  [ ]     Press the pen more lightly or harder, from the next path on.
  Enter   Go on after a change of pen.";

/// How to measure pens; docs/colour.md has the details.
const CALIBRATING: &str = "\
The colours of your pens, in two steps:
  drypoint calibrate --colours pens.toml --profile grbl-servo -o colours.gcode    plot it and let it dry
  drypoint calibrate --colours pens.toml --read photo.jpg -o measured.toml        the same pens with their colours on this paper
";

/// How to read a test sheet; docs/calibration.md has the details.
pub(super) const READING: &str = "\
What to measure on the sheet, and what to change (--set-profile KEY=VALUE, or the key in a TOML file that extends the profile):
  square  Measure its sides (100 mm, less on a small sheet). scale_x = scale_x * drawn / measured along the side marked X; same for scale_y.
  NIB     The last rung without white between its lines: its spacing is --pen.
  Z       The highest line without a gap, in mm above gcode.height.down: add it (towards up), less 0.2, to gcode.height.down.
  DWELL   The shortest rest, in seconds, at which all dots are present and equally large: motion.touch_seconds.
  FILL    The smallest overlap without white hairlines. Areas are filled with 10 %; for another overlap, --pen nib * (1 - overlap) / 0.9.
  PENS    The distance of each cross from its ticks, in mm along the machine's X and Y: pen.N.offset = [x, y].
  SPEED   The fastest squares with sharp, closed corners: motion.draw_speed. If even the slowest are wavy, lower the acceleration.";

// Only one value is ever made, so its size does not matter.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Draw a photograph as SVG or PDF for print, or with --profile as a plotter's HP-GL or G-code.
    #[command(after_long_help = SENDING)]
    Draw(DrawOptions),
    /// Plot any SVG: ordered tool paths for a machine.
    #[command(after_long_help = SENDING)]
    Plot(PlotOptions),
    /// Write every intermediate result of a style, numbered and named, as PNG or SVG.
    Stages(StagesOptions),
    /// Find faces, people and their parts in a photograph, and write them as PNG and JSON for `draw --sight`.
    See(SeeOptions),
    /// Write a scene: all options of a drawing in a file, with every default spelled out, for `draw FILE.toml`.
    #[command(mut_arg("output", |arg| arg.help("The scene to write; `-` for stdout").value_name("FILE.toml")),
        mut_arg("save_scene", |arg| arg.hide(true)), mut_arg("dry_run", |arg| arg.hide(true)), mut_arg("format", |arg| arg.hide(true)))]
    Scene(DrawOptions),
    /// Draw anew from the recipe inside an SVG or PDF; any option of `draw` changes that.
    #[command(mut_arg("photo", |arg| arg.help("The drawing; its photograph and masks lie beside it or in this folder").value_name("DRAWING")),
        mut_arg("output", |arg| arg.help("The file to write [default: DRAWING-redone beside it]").required(false)))]
    Redo(DrawOptions),
    /// Draw many photographs, each by the same options: one JSON line each, a second run draws only what is missing or has changed.
    #[command(after_long_help = BATCHES,
        mut_arg("photo", |arg| arg.num_args(1..).value_name("PHOTO|FOLDER|FILE.tsv").help("Photographs, folders of them, and \
            manifests (.tsv, or `-` for stdin): one photograph per line, and after a tab its name")),
        mut_arg("output", |arg| arg.help("The files to write, with {name} in the name, such as 'out/{name}.svg'; folders are made")),
        mut_arg("threads", |arg| arg.help("Worker threads of each picture [default: cores / jobs]")),
        mut_arg("json", |arg| arg.hide(true)), mut_arg("save_scene", |arg| arg.hide(true)), mut_arg("dry_run", |arg| arg.hide(true)))]
    Batch(BatchOptions),
    /// Put several scenes and SVGs on one sheet, for print or a machine; the layers of each pen are merged and ordered as one.
    Sheet(SheetOptions),
    /// List the presets, or print one as TOML. Your own are TOML files in drypoint/presets in the folder of configurations.
    Presets(ListOptions),
    /// Print the JSON schema of scenes and presets, from which editors complete.
    Schema,
    /// Show what is in a drawing: sheet, layers, pens, marks, lengths, time.
    Inspect(InspectOptions),
    /// Write the rest of a plotter's file from where the machine stopped, with state, pen and position restored.
    Resume(ResumeOptions),
    /// Send a file to its machine and draw it, with pause, stop and going on in the very stroke.
    #[cfg(feature = "drive")]
    #[command(after_long_help = KEYS)]
    Send(SendOptions),
    /// List the ports of this computer to which a machine may be connected.
    #[cfg(feature = "drive")]
    Ports(PortsOptions),
    /// Open a page in the browser in which a portrait is tuned by eye. Nothing leaves this computer.
    #[cfg(feature = "studio")]
    Studio(StudioOptions),
    /// Draw a test sheet for a machine and its pens, or with --colours a sheet from which the pens' colours are measured with --read.
    #[command(after_help = format!("{CALIBRATING}\n{READING}"))]
    Calibrate(CalibrateOptions),
    /// List the styles, or one style's parameters with default, unit, range, meaning and source.
    Styles(ListOptions),
    /// List the plotters, or print one profile as TOML.
    Profiles(ProfilesOptions),
    /// List common pens with their widths and estimated colours, for `like` in a file of pens; NAME: those whose name holds it.
    Pens(ListOptions),
    /// Print shell completions.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual pages, or write each to a file of its own.
    Man(ManualOptions),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
