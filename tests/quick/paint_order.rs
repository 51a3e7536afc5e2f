//! Opaque paint on a plotter: hidden parts are not drawn, and the rest is drawn along the shortest way.

use drypoint::drawing::{Colour, Drawing, Ink, Layer, Mark, Mixing, Page, Painted, Stroke};
use drypoint::geometry::{BezPath, Point};
use drypoint::interrupt::Interrupt;
use drypoint::order::Effort;
use drypoint::plot::{Hides, InkModel, Nibs, Plot, Sequence, Toolpath, coverage, lower, occluded};

const PAPER: f64 = 120.0;
const INKS: [Colour; 3] = [Colour { r: 20, g: 20, b: 20 }, Colour { r: 200, g: 60, b: 30 }, Colour { r: 60, g: 90, b: 200 }];

fn spread(i: usize, step: f64) -> f64 {
    (i as f64 * step).fract()
}

/// Crossing strokes of three colours, one layer per colour, all in one group, and their painting order.
fn painting(count: usize, width: f64) -> (Drawing, Vec<Painted>) {
    let mut layers: Vec<Layer> = (1..)
        .zip(INKS)
        .map(|(pen, ink)| Layer { mixing: Mixing::Paint, ink: Ink::Colour(ink), ..Layer::new("paint", pen) })
        .collect();
    let mut order = Vec::new();
    for i in 0..count {
        let layer = i * 7 % 3;
        let at = Point::new(4.0 + (PAPER - 12.0) * spread(i, 0.754_877_67), 4.0 + (PAPER - 12.0) * spread(i, 0.569_840_29));
        let mut curve = BezPath::new();
        curve.move_to(at);
        curve.line_to(at + (4.0 * spread(i, 0.618), 4.0 * spread(i, 0.414)));
        order.push(Painted::Mark { layer, mark: layers[layer].marks.len() });
        let stroke = Stroke::even(curve, width).in_group(Some(0));
        layers[layer].marks.push(Mark::Stroke(stroke));
    }
    (Drawing { page: Page::new(PAPER, PAPER), layers }, order)
}

fn travel(plot: &Plot) -> f64 {
    let mut at = Point::ORIGIN;
    let mut sum = 0.0;
    for path in plot.pens.iter().flat_map(|pen| &pen.paths) {
        sum += at.distance(path.ends().start);
        at = path.ends().end;
    }
    sum
}

#[test]
fn paint_that_is_left_is_drawn_along_the_shortest_way() {
    for width in [0.3, 1.5] {
        let (drawing, order) = painting(1500, width);
        let seen = occluded(&drawing, &order, Hides::PaintOnOtherColours, &Interrupt::never()).unwrap();
        let mut plot = lower(&seen, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
        let unordered = travel(&plot);
        let ink: f64 = plot.pens.iter().flat_map(|pen| &pen.paths).map(Toolpath::length).sum();
        let sequence = Sequence { effort: Effort::Fast, merge: 0.05, ..Sequence::default() };
        plot.put_in_order(Point::ORIGIN, &sequence, &Interrupt::never()).unwrap();
        let ordered = travel(&plot);
        println!("width {width}: {ink:.0} mm of ink, {unordered:.0} mm of travel unordered, {ordered:.0} mm ordered");
        assert!(ordered < 0.15 * unordered, "{ordered} of {unordered}");
        // Each pen is used once.
        assert_eq!(plot.pens.iter().map(|pen| pen.number).collect::<Vec<_>>(), [1, 2, 3]);
    }
}

#[test]
fn what_lies_under_another_colour_is_not_drawn_whatever_the_pens_order() {
    let (drawing, order) = painting(600, 2.0);
    let seen = occluded(&drawing, &order, Hides::PaintOnOtherColours, &Interrupt::never()).unwrap();
    let plot = lower(&seen, InkModel::Ink, &Nibs::all(0.3), 0.02, &Interrupt::never()).unwrap();
    // All visible parts together are the whole inked area: each point once, in one colour.
    let inked = |drawing: &Drawing| {
        let mut one = drawing.clone();
        let marks = one.layers.iter().flat_map(|layer| layer.marks.clone()).collect();
        one.layers = vec![Layer { marks, ..Layer::new("all", 1) }];
        let plot = Plot { pens: vec![plot.pens[0].clone()], ..plot.clone() };
        coverage(&one, &plot, &Nibs::all(0.3), &Interrupt::never()).unwrap()[0].asked
    };
    let (all, parts) = (inked(&drawing), seen.layers.iter().map(Layer::ink_mm2).sum::<f64>());
    assert!(parts < 1.25 * all && parts > 0.98 * all, "{parts} mm2 in parts of {all}");
    let hidden: f64 = drawing.layers.iter().map(Layer::ink_mm2).sum::<f64>() - parts;
    assert!(hidden > 0.03 * all, "{hidden} of {all} mm2 is hidden");
}
