//! A stroke's centre line and width in working pixels.

use crate::drawing::Stroke;
use crate::elementary::Elementary as _;
use crate::field::Ribbon;
use crate::geometry::{Point, Ring, catmull_rom};
use kurbo::ParamCurve;

/// Steps between two nodes when a stroke is stamped on the canvas; nodes are at most 5 pixels apart.
const STEPS: usize = 4;
/// Maximum width in radii of the line's curvature; at 2 the inner side shrinks to a point.
const WIDEST_TURN: f64 = 1.7;
/// Share of its width that a stroke keeps at its tip, like a brush's last hairs.
const TIP: f64 = 0.25;

/// A stroke without a colour yet, in framed pixels.
pub(super) struct Body {
    pub nodes: Vec<Point>,
    pub widths: Vec<f64>,
    /// Closely spaced places along it, with the width there.
    pub fine: Vec<(Point, f64)>,
    /// For each step of `fine`, the stretch between nodes that contains it.
    pub stretch_of: Vec<usize>,
}

impl Body {
    /// Narrows the stroke where the line's radius of curvature is smaller than its width allows: an outline beyond its own centre of
    /// curvature has holes.
    pub(super) fn new(nodes: Vec<Point>, mut widths: Vec<f64>) -> Self {
        for (triple, width) in nodes.windows(3).zip(&mut widths[1..]) {
            let (a, b) = (triple[1] - triple[0], triple[2] - triple[1]);
            let turn = a.cross(b).angle_over(a.dot(b)).abs();
            *width = width.min(WIDEST_TURN * a.hypot().min(b.hypot()) / turn.max(1e-9));
        }
        let mut fine = vec![(nodes[0], widths[0])];
        let mut stretch_of = Vec::new();
        for (i, segment) in catmull_rom(&nodes, Ring::Open).segments().enumerate() {
            for step in 1..=STEPS {
                let t = step as f64 / STEPS as f64;
                fine.push((segment.eval(t), widths[i] + (widths[i + 1] - widths[i]) * t));
                stretch_of.push(i);
            }
        }
        Self { nodes, widths, fine, stretch_of }
    }

    /// A ribbon whose upstream part (`taper`, a share of its length) tapers to a tip.
    pub(super) fn of_ribbon(ribbon: &Ribbon, taper: f64) -> Self {
        let length: f64 = ribbon.nodes.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let taper = taper * length;
        let mut left = 0.0;
        let mut widths = ribbon.widths.clone();
        for i in (0..widths.len()).rev().filter(|_| taper > 0.0) {
            widths[i] *= (TIP + (1.0 - TIP) * left / taper).min(1.0);
            if i > 0 {
                left += ribbon.nodes[i].distance(ribbon.nodes[i - 1]);
            }
        }
        Self::new(ribbon.nodes.clone(), widths)
    }

    /// Number of stretches between nodes.
    pub(super) fn stretches(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The part from one node to another as a stroke on the page, of `scale` millimetres per pixel.
    pub(super) fn stroke(&self, first: usize, last: usize, scale: f64, to_page: impl Fn(Point) -> Point) -> Option<Stroke> {
        let nodes: Vec<Point> = self.nodes[first..=last].iter().map(|p| to_page(*p)).collect();
        let widths = self.widths[first..=last].iter().map(|w| w * scale).collect();
        Stroke::swelling(catmull_rom(&nodes, Ring::Open), widths)
    }
}
