//! Options that choose one of a few.

use clap::ValueEnum;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Fit {
    /// All of the photograph is inside the box.
    Contain,
    /// The photograph fills the box; what stands out is cut.
    Cover,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum PlotFit {
    /// As it is.
    None,
    /// To the page less its margin.
    Page,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Background {
    /// Left out by hedcut, grid and engrave where a face is found, else drawn.
    Auto,
    /// Drawn, unless a mask or the photograph's alpha leaves it out.
    Keep,
    /// Left out in every style.
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Tone {
    /// Made for the faces that are found: they take the whole range from paper to ink, and darker skin stays darker.
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
    /// `InkML`: the strokes with force and time, for painting programs; of `draw` only.
    Inkml,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Order {
    /// The best.
    Full,
    /// Nearly as good, in a fraction of the time.
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
    /// Where they begin in the drawing.
    Drawn,
    /// At their highest vertex on the page.
    Top,
    /// At their lowest vertex.
    Bottom,
    /// At their leftmost vertex.
    Left,
    /// At their rightmost vertex.
    Right,
    /// At their sharpest vertex.
    Corner,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum DuplicatesOption {
    /// Drawn once; how many went is reported.
    Drop,
    /// Drawn as often as they are there.
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
    /// Strokes' centre lines only.
    Lines,
    /// Widths and fills too.
    Ink,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum PreviewTravel {
    /// Not shown.
    Off,
    /// A pale web under the ink.
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
    /// A quarter, clockwise.
    #[value(name = "90")]
    Quarter,
    /// A half.
    #[value(name = "180")]
    Half,
    /// A quarter, anticlockwise.
    #[value(name = "270")]
    ThreeQuarters,
    /// A quarter where the drawing fits only so; `draw` also where the picture gets larger so.
    Auto,
}
