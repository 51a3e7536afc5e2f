//! Lines that run over a picture's border, so that the cut there is straight.

use crate::geometry::{Point, Rect};

/// The sine of the least angle to the border: flatter lines run along it.
const FLATTEST: f64 = 0.25;

/// How far a line goes straight on beyond the last of its points, where it runs over the picture's border: until half of its width
/// is outside. `None` if it ends farther from the border than `reach`, or before a place on it where nothing `is_drawn`. All in pixels.
pub(crate) fn over_the_border(
    [before, end]: [Point; 2],
    picture: Rect,
    (reach, half_width): (f64, f64),
    is_drawn: &dyn Fn(Point) -> bool,
) -> Option<f64> {
    let way = (end - before).normalize();
    let Rect { x0, y0, x1, y1 } = picture;
    let sides = [(end.x - x0, -way.x), (x1 - end.x, way.x), (end.y - y0, -way.y), (y1 - end.y, way.y)];
    let crossed =
        sides.into_iter().filter(|&(room, sine)| room < reach && sine > FLATTEST).map(|(room, sine)| (room.max(0.0), sine));
    let drawn = crossed.filter(|(room, sine)| is_drawn(end + way * (room / sine)));
    drawn.map(|(room, sine)| (room + half_width) / sine).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: Rect = Rect::new(0.0, 0.0, 10.0, 10.0);

    fn over(points: [(f64, f64); 2]) -> Option<f64> {
        over_the_border(points.map(Point::from), PICTURE, (1.0, 0.5), &|p| p.x < 6.0)
    }

    #[test]
    fn a_line_that_ends_beside_the_border_goes_on_over_it() {
        assert_eq!(over([(5.0, 9.0), (5.0, 9.5)]), Some(1.0));
        let slanting = over([(3.0, 8.75), (4.0, 9.5)]).unwrap();
        assert!((slanting - 1.0 / 0.6).abs() < 1e-9, "{slanting}");
    }

    #[test]
    fn a_line_along_it_away_from_it_or_beside_the_shape_does_not() {
        assert_eq!(over([(4.0, 9.5), (5.0, 9.6)]), None);
        assert_eq!(over([(5.0, 9.5), (5.0, 9.4)]), None);
        assert_eq!(over([(5.0, 6.0), (5.0, 7.0)]), None);
        assert_eq!(over([(7.0, 9.0), (7.0, 9.5)]), None);
    }
}
