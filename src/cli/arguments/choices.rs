//! Options with a fixed set of values.

use clap::ValueEnum;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Fit {
    /// The whole photograph fits inside the box.
    Contain,
    /// The photograph fills the box and is cut at its border.
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
pub(in crate::cli) enum BlackPen {
    /// Drawn wherever it serves.
    Tones,
    /// Kept for outlines and features; tones are mixed from the other pens.
    Lines,
    /// Not used.
    None,
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

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum SeamOption {
    /// Wherever the travel is shortest.
    Nearest,
    /// Where the loops begin in the drawing.
    Drawn,
    /// At the highest vertex on the page.
    Top,
    /// At the lowest vertex.
    Bottom,
    /// At the leftmost vertex.
    Left,
    /// At the rightmost vertex.
    Right,
    /// At the sharpest vertex.
    Corner,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum DuplicatesOption {
    /// Drawn once; the number left out is reported.
    Drop,
    /// Drawn every time.
    Keep,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum StartCorner {
    /// Upper left.
    TopLeft,
    /// Upper right.
    TopRight,
    /// Lower left.
    BottomLeft,
    /// Lower right.
    BottomRight,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum InkModelOption {
    /// Centre lines of strokes only.
    Lines,
    /// Widths and fills too.
    Ink,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum PreviewTravel {
    /// Not shown.
    Off,
    /// Pale lines under the ink.
    Faint,
    /// Clear lines under the ink.
    Full,
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
