//! Options with a fixed set of values: the library's own choices, and those that only the command line has.

use crate::colour::Black;
#[cfg(feature = "drive")]
use crate::drive::Handshake;
use crate::plot::{DrawingCorner, Duplicates, InkModel, Seam, ShownTravel};
use clap::ValueEnum;
use clap::builder::PossibleValue;

/// Makes a choice of the library one of the command line: the word for each value, in the order of the help, and what the help says.
macro_rules! words {
    ($choice:ty { $($value:ident: $word:literal, $help:literal;)+ }) => {
        impl ValueEnum for $choice {
            fn value_variants<'a>() -> &'a [Self] {
                &[$(Self::$value),+]
            }

            fn to_possible_value(&self) -> Option<PossibleValue> {
                Some(match self {
                    $(Self::$value => PossibleValue::new($word).help($help),)+
                })
            }
        }
    };
}

words! { Black {
    Tones: "tones", "Drawn wherever it serves";
    Lines: "lines", "Kept for outlines and features; tones are mixed from the other pens";
    None: "none", "Not used";
} }

words! { Seam {
    Nearest: "nearest", "Wherever the travel is shortest";
    Drawn: "drawn", "Where the loops begin in the drawing";
    Top: "top", "At the highest vertex on the page";
    Bottom: "bottom", "At the lowest vertex";
    Left: "left", "At the leftmost vertex";
    Right: "right", "At the rightmost vertex";
    Corner: "corner", "At the sharpest vertex";
} }

words! { Duplicates {
    Drop: "drop", "Drawn once; the number left out is reported";
    Keep: "keep", "Drawn every time";
} }

words! { DrawingCorner {
    TopLeft: "top-left", "Upper left";
    TopRight: "top-right", "Upper right";
    BottomLeft: "bottom-left", "Lower left";
    BottomRight: "bottom-right", "Lower right";
} }

words! { InkModel {
    Lines: "lines", "Centre lines of strokes only";
    Ink: "ink", "Widths and fills too";
} }

words! { ShownTravel {
    Off: "off", "Not shown";
    Faint: "faint", "Pale lines under the ink";
    Full: "full", "Clear lines under the ink";
} }

#[cfg(feature = "drive")]
words! { Handshake {
    None: "query", "The plotter is asked for free space (`ESC.B`); any cable will do";
    Software: "xon", "XON and XOFF";
    Hardware: "rts", "RTS and CTS; the plotter's DTR must be connected to CTS";
} }

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Fit {
    /// The whole photograph fits inside the box.
    Contain,
    /// The photograph fills the box and is cut at its border, beside the heads where it can be.
    Cover,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum PlotFit {
    /// The size stays.
    None,
    /// Scaled to the page less its margin.
    Page,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Background {
    /// Left out by hedcut, grid and engrave if a face is found, else drawn.
    Auto,
    /// Drawn, unless a mask or the photograph's alpha leaves it out.
    Keep,
    /// Left out in every style.
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Tone {
    /// Adjusted to the faces found: they use the whole range from paper to ink, and darker skin stays darker.
    Portrait,
    /// CIE L*/100.
    Lightness,
    /// Luminance Y.
    Linear,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Format {
    /// Scalable vector graphics.
    Svg,
    /// PDF for print.
    Pdf,
    /// HP-GL for pen plotters.
    Hpgl,
    /// G-code.
    Gcode,
    /// `InkML`: strokes with force and time, for painting programs; `draw` only.
    Inkml,
    /// JSON: every mark as numbers in millimetres, for programs; with a plotter its tool paths in drawing order.
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Order {
    /// The shortest travel found by a full search.
    Full,
    /// Nearly as short, in a fraction of the time.
    Fast,
    /// As in the file.
    None,
    /// At random, so that ink dries before the pen comes back.
    Random,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Rotate {
    /// Not at all.
    #[default]
    #[value(name = "0")]
    None,
    /// A quarter turn clockwise.
    #[value(name = "90")]
    Quarter,
    /// A half turn.
    #[value(name = "180")]
    Half,
    /// A quarter turn anticlockwise.
    #[value(name = "270")]
    ThreeQuarters,
    /// A quarter turn if the drawing fits only that way; for `draw` also if it makes the picture larger.
    Auto,
}
