//! Colours and inks.

use crate::elementary::Elementary as _;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A colour in sRGB, 8 bits per channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Colour {
    /// Red.
    pub r: u8,
    /// Green.
    pub g: u8,
    /// Blue.
    pub b: u8,
}

impl Colour {
    /// Black.
    pub const BLACK: Self = Self { r: 0, g: 0, b: 0 };
    /// White.
    pub const WHITE: Self = Self { r: 255, g: 255, b: 255 };
    /// The named colour that CSS Color 4 added.
    pub const REBECCAPURPLE: Self = Self { r: 0x66, g: 0x33, b: 0x99 };
}

impl Colour {
    /// Visible difference of two colours: their distance in CIE L*a*b* (D65); about 2 is just noticeable.
    pub fn difference(self, other: Self) -> f64 {
        let (a, b) = (self.lab(), other.lab());
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    /// CIE L*/100, 0 to 1.
    pub(crate) fn lightness(self) -> f64 {
        self.lab()[0] / 100.0
    }

    fn lab(self) -> [f64; 3] {
        let light = |v: u8| {
            let v = f64::from(v) / 255.0;
            if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).power(2.4) }
        };
        let [r, g, b] = [self.r, self.g, self.b].map(light);
        // IEC 61966-2-1, divided by D65's white.
        let x = (0.412_4 * r + 0.357_6 * g + 0.180_5 * b) / 0.950_5;
        let y = 0.212_6 * r + 0.715_2 * g + 0.072_2 * b;
        let z = (0.019_3 * r + 0.119_2 * g + 0.950_5 * b) / 1.089;
        let f = |t: f64| if t > 0.008_856 { t.cube_root() } else { 7.787 * t + 16.0 / 116.0 };
        [116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))]
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.r, self.g, self.b)
    }
}

/// Why a text is not a colour.
#[derive(Debug, Error, PartialEq)]
#[error("'{0}' is not a colour; write a CSS colour such as navy, #1a2b3c or rgb(26, 43, 60), or k, or spot:NAME")]
pub struct ColourError(String);

impl FromStr for Colour {
    type Err = ColourError;

    /// Parses any CSS colour, ignoring its alpha. `currentColor` is CSS's initial value, black.
    fn from_str(text: &str) -> Result<Self, ColourError> {
        match text.trim() {
            // `rebeccapurple` is from CSS Color 4; the parser knows the names of CSS Color 3.
            name if name.eq_ignore_ascii_case("rebeccapurple") => return Ok(Self::REBECCAPURPLE),
            name if name.eq_ignore_ascii_case("currentcolor") => return Ok(Self::BLACK),
            _ => {}
        }
        let colour = svgtypes::Color::from_str(text).map_err(|_| ColourError(text.to_owned()))?;
        Ok(Self { r: colour.red, g: colour.green, b: colour.blue })
    }
}

/// What a layer is printed or drawn with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The black plate only.
    Black,
    /// A colour.
    Colour(Colour),
    /// A named ink of its own plate.
    Spot {
        /// As the printer knows it.
        name: String,
        /// Its colour at full tint, for screens and proofs.
        shown: Colour,
    },
}

impl Ink {
    /// Its colour on screen.
    pub const fn colour(&self) -> Colour {
        match self {
            Self::Colour(colour) | Self::Spot { shown: colour, .. } => *colour,
            Self::Black => Colour::BLACK,
        }
    }
}

impl fmt::Display for Ink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Black => write!(f, "k"),
            Self::Colour(colour) => write!(f, "{colour}"),
            Self::Spot { name, .. } => write!(f, "spot:{name}"),
        }
    }
}

impl FromStr for Ink {
    type Err = ColourError;

    /// `k`, a CSS colour, or `spot:NAME`, which is shown in black.
    fn from_str(text: &str) -> Result<Self, ColourError> {
        match text.strip_prefix("spot:") {
            // In print files `All` and `None` mean every plate and no plate.
            Some("" | "All" | "None") => Err(ColourError(text.to_owned())),
            Some(name) => Ok(Self::Spot { name: name.to_owned(), shown: Colour::BLACK }),
            None if text.eq_ignore_ascii_case("k") => Ok(Self::Black),
            None => text.parse().map(Self::Colour),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_those_of_lab() {
        let [red, orange, blue] = ["red", "orange", "blue"].map(|name| name.parse::<Colour>().unwrap());
        assert!((Colour::BLACK.difference(Colour::WHITE) - 100.0).abs() < 0.1);
        assert!(red.difference(orange) < red.difference(blue));
    }

    #[test]
    fn inks_are_read_and_written() {
        assert_eq!("k".parse(), Ok(Ink::Black));
        assert_eq!("spot:PANTONE 286 C".parse(), Ok(Ink::Spot { name: "PANTONE 286 C".into(), shown: Colour::BLACK }));
        assert_eq!("navy".parse(), Ok(Ink::Colour(Colour { r: 0, g: 0, b: 128 })));
        assert_eq!("RebeccaPurple".parse(), Ok(Ink::Colour(Colour::REBECCAPURPLE)));
        assert_eq!(("currentColor".parse(), "currentcolor".parse()), (Ok(Colour::BLACK), Ok(Colour::BLACK)));
        assert!("purplish".parse::<Ink>().is_err());
        assert!("spot:".parse::<Ink>().is_err() && "spot:All".parse::<Ink>().is_err());
        assert_eq!(Ink::Colour(Colour { r: 1, g: 2, b: 255 }).to_string(), "#0102ff");
    }
}
