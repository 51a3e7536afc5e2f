//! A part of the sheet in the coordinates of a machine.

use super::error::StudioError;
use toml::{Table, Value};

/// The option of `drypoint send` for a box on the sheet: x, y, width, height in millimetres from the sheet's upper left corner.
pub(super) fn region(part: [f64; 4], page: [f64; 2], machine: &Table) -> Result<String, StudioError> {
    let [x, y, width, height] = part;
    if !part.iter().all(|v| v.is_finite()) || width <= 0.0 || height <= 0.0 {
        return Err(StudioError::Refused("the part to plot has no size; drag a box on the sheet".to_owned()));
    }
    // Where such machines lay a sheet depends on how it is turned, which only the drawing's own command knows.
    if machine.get("paper").is_some_and(|papers| papers.as_array().is_none_or(|papers| !papers.is_empty())) {
        let why = "this machine has sheets of its own, on which a part cannot be told from here";
        return Err(StudioError::Refused(format!(
            "{why}; send it with drypoint send --region X,Y,W,H in the machine's coordinates"
        )));
    }
    let axes = machine.get("axes");
    let word = |key: &str, usual: &'static str| axes.and_then(|axes| axes.get(key)?.as_str()).unwrap_or(usual).to_owned();
    let corner = word("zero", "lower-left");
    let zero = [if corner.ends_with("right") { page[0] } else { 0.0 }, if corner.starts_with("lower") { page[1] } else { 0.0 }];
    let scale = |key: &str| machine.get(key).and_then(number).unwrap_or(1.0);
    let along = |way: &str, [x, y]: [f64; 2]| match way {
        "left" => zero[0] - x,
        "up" => zero[1] - y,
        "down" => y - zero[1],
        _ => x - zero[0],
    };
    let (x_way, y_way) = (word("x", "right"), word("y", "up"));
    let point = |p| [along(&x_way, p) * scale("scale_x"), along(&y_way, p) * scale("scale_y")];
    let ([x0, y0], [x1, y1]) = (point([x, y]), point([x + width, y + height]));
    let rounded = |v: f64| (v * 1000.0).round() / 1000.0 + 0.0;
    let [left, low, wide, high] = [x0.min(x1), y0.min(y1), (x1 - x0).abs(), (y1 - y0).abs()].map(rounded);
    Ok(format!("--region={left},{low},{wide},{high}"))
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(machine: &str) -> Result<String, StudioError> {
        region([10.0, 20.0, 30.0, 5.0], [100.0, 150.0], &machine.parse().unwrap())
    }

    #[test]
    fn a_part_lies_where_the_machine_s_axes_lead() {
        assert_eq!(of("").unwrap(), "--region=10,125,30,5");
        let axidraw = "[axes]\nx = 'right'\ny = 'down'\nzero = 'upper-left'\n";
        assert_eq!(of(axidraw).unwrap(), "--region=10,20,30,5");
        let turned = "scale_x = 1.01\n[axes]\nx = 'down'\ny = 'left'\nzero = 'upper-right'\n";
        assert_eq!(of(turned).unwrap(), "--region=20.2,60,5.05,30");
    }

    #[test]
    fn a_part_that_cannot_be_told_is_refused() {
        assert!(of("[[paper]]\nname = 'a4'\n").is_err());
        assert!(region([0.0, 0.0, 0.0, 5.0], [100.0, 100.0], &Table::new()).is_err());
    }
}
