//! Places in the picture, as a parameter's value.

/// A few places in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Places {
    /// Across and down, in percent of the picture.
    pub(super) percent: [(f64, f64); Self::MOST],
    pub(super) count: usize,
}

impl Places {
    /// Maximum number of places of any parameter.
    pub const MOST: usize = 8;

    /// Across and down, 0 to 1 of the picture's width and height.
    pub fn shares(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.percent[..self.count].iter().map(|(across, down)| (across / 100.0, down / 100.0))
    }

    /// Reads `x,y;x,y` in percent.
    pub(super) fn parse(text: &str, most: usize) -> Option<Self> {
        let mut places = Self { percent: [(0.0, 0.0); Self::MOST], count: 0 };
        for place in text.split(';').map(str::trim).filter(|place| !place.is_empty()) {
            let (across, down) = place.split_once(',')?;
            let percent = |text: &str| {
                let number: f64 = text.trim().trim_end_matches('%').parse().ok()?;
                (0.0..=100.0).contains(&number).then_some(number)
            };
            if places.count == most.min(Self::MOST) {
                return None;
            }
            places.percent[places.count] = (percent(across)?, percent(down)?);
            places.count += 1;
        }
        Some(places)
    }

    pub(super) fn text(&self) -> String {
        self.percent[..self.count].iter().map(|(across, down)| format!("{across},{down}")).collect::<Vec<_>>().join(";")
    }
}
