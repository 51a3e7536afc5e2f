//! Scale-space filtering of a histogram (Witkin 1983; Lim and Lee 1990; Wong 1999, section 6.1.1): finds its features without a preset
//! width.
//!
//! ```text
//!   sigma ^   \      /          two inflections bound a hill; as the histogram is blurred, pairs vanish;
//!         |  \ \    / /         a hill that outlives the hills within it is a feature
//!         |  |\ \  /| |
//!         +------------> grey
//! ```

use crate::elementary::Elementary as _;

/// A feature of a histogram: a hill that persists while the histogram is blurred.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Position of its top, in bins; a bin's middle is at a whole number.
    pub at: f64,
    /// The inflections on either side at the finest scale that keeps it, in bins.
    pub span: (f64, f64),
    /// Samples nearer to this mode than to any other.
    pub samples: u32,
}

/// Minimum and maximum blur of the stack, in bins. Below 1.5, 20,000 samples in 256 bins show hills of mere counting noise; the maximum
/// leaves at most one or two hills.
const SCALES: (f64, f64) = (1.5, 64.0);
/// Number of blurs in the stack: steps of 5 % allow matching inflections by position.
const STEPS: usize = 78;
/// Blur, in bins, of the curve used to read and compare the tops of hills.
const FINE: f64 = 2.0;
/// Minimum rise of a hill above the valley to its neighbour: a share of its height, and a multiple of the counting noise left at the
/// fine blur (0.38 of the height's root). Without it 42 of 100 mixtures of Gaussians were recovered, the others had ripples in their
/// tails; with it 99.
const LEAST_RISE: f64 = 0.15;
const NOISE_RISE: f64 = 4.0 * 0.38;

/// The features of a histogram with at least `least_samples` samples, in order of position.
///
/// The inflections bound hills at every scale; hills nested from scale to scale form the interval tree, whose branch lengths are
/// measured in the logarithm of the scale. A hill is kept instead of those it splits into if it lasts longer than their average (section
/// 6.1.1).
pub fn histogram_modes(histogram: &[u32], least_samples: u32) -> Vec<Mode> {
    if histogram.iter().all(|count| *count == 0) {
        return Vec::new();
    }
    let stack: Vec<Vec<(f64, f64)>> = (0..STEPS).map(|i| hills(&blurred(histogram, scale(i)))).collect();
    let tree = Tree::new(&stack);
    let mut stable = Vec::new();
    for root in tree.roots() {
        tree.stable_under(root, &mut stable);
    }
    let fine = blurred(histogram, FINE);
    let modes = stable.into_iter().map(|node| {
        let span = tree.nodes[node].span;
        Mode { at: summit(&fine, span), span, samples: 0 }
    });
    counted(standing_out(modes.collect(), &fine), histogram, least_samples)
}

fn scale(step: usize) -> f64 {
    SCALES.0 * (SCALES.1 / SCALES.0).power(step as f64 / (STEPS - 1) as f64)
}

/// The histogram blurred by a Gaussian, 0 beyond its ends.
fn blurred(histogram: &[u32], sigma: f64) -> Vec<f64> {
    let reach = (4.0 * sigma).ceil() as usize;
    let weights: Vec<f64> = (0..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exponential()).collect();
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    (0..histogram.len())
        .map(|i| {
            let (from, to) = (i.saturating_sub(reach), (i + reach).min(histogram.len() - 1));
            (from..=to).map(|j| f64::from(histogram[j]) * weights[i.abs_diff(j)]).sum::<f64>() / total
        })
        .collect()
}

/// The spans between two inflections where the curve is concave, as (rising, falling) positions in bins.
fn hills(curve: &[f64]) -> Vec<(f64, f64)> {
    let at = |i: isize| if i < 0 { 0.0 } else { curve.get(i as usize).copied().unwrap_or(0.0) };
    let bend = |i: isize| at(i - 1) - 2.0 * at(i) + at(i + 1);
    let tallest = curve.iter().copied().fold(0.0, f64::max);
    let (mut hills, mut start) = (Vec::new(), None);
    for i in -1..=curve.len() as isize {
        let (before, here) = (bend(i - 1), bend(i));
        let crossing = || (i - 1) as f64 + before / (before - here);
        if before >= 0.0 && here < 0.0 {
            start = Some(crossing());
        } else if before < 0.0
            && here >= 0.0
            && let Some(rising) = start.take()
        {
            let falling = crossing();
            let middle = at((0.5 * (rising + falling)).round() as isize);
            // A bend in the far tail is rounding error, not a hill.
            if middle > 1e-6 * tallest {
                hills.push((rising, falling));
            }
        }
    }
    hills
}

/// Hills linked from scale to scale.
struct Tree {
    nodes: Vec<Node>,
}

struct Node {
    /// Its span at the finest scale.
    span: (f64, f64),
    /// Number of the stack's steps that it lasts.
    lasts: usize,
    parent: Option<usize>,
    children: Vec<usize>,
}

impl Tree {
    /// Builds the tree from the coarsest scale down: a hill that contains one hill of the next finer scale continues, one that contains
    /// several ends.
    fn new(stack: &[Vec<(f64, f64)>]) -> Self {
        let mut tree = Self { nodes: Vec::new() };
        let mut above: Vec<usize> = Vec::new();
        for hills in stack.iter().rev() {
            let middle = |span: (f64, f64)| 0.5 * (span.0 + span.1);
            let mut parts: Vec<Vec<(f64, f64)>> = vec![Vec::new(); above.len()];
            let mut fresh = Vec::new();
            for &hill in hills {
                // Inflections move little between two scales, so a hill's middle lies inside its parent hill.
                let holder = (0..above.len()).find(|&i| {
                    let span = tree.nodes[above[i]].span;
                    (span.0..=span.1).contains(&middle(hill))
                });
                match holder {
                    Some(i) => parts[i].push(hill),
                    None => fresh.push(tree.grown(hill, None)),
                }
            }
            let mut here = fresh;
            for (node, parts) in above.into_iter().zip(parts) {
                if let [only] = parts[..] {
                    tree.nodes[node].span = only;
                    tree.nodes[node].lasts += 1;
                    here.push(node);
                } else {
                    here.extend(parts.into_iter().map(|part| tree.grown(part, Some(node))));
                }
            }
            above = here;
        }
        tree
    }

    fn grown(&mut self, span: (f64, f64), parent: Option<usize>) -> usize {
        let node = self.nodes.len();
        self.nodes.push(Node { span, lasts: 1, parent, children: Vec::new() });
        if let Some(parent) = parent {
            self.nodes[parent].children.push(node);
        }
        node
    }

    fn roots(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.nodes.len()).filter(|i| self.nodes[*i].parent.is_none())
    }

    /// The most stable hills in a branch.
    fn stable_under(&self, node: usize, stable: &mut Vec<usize>) {
        let Node { lasts, children, .. } = &self.nodes[node];
        let total: usize = children.iter().map(|child| self.nodes[*child].lasts).sum();
        if children.is_empty() || lasts * children.len() > total {
            stable.push(node);
        } else {
            for child in children {
                self.stable_under(*child, stable);
            }
        }
    }
}

/// The top reached uphill from the highest place of a span, interpolated between bins by a parabola.
fn summit(curve: &[f64], span: (f64, f64)) -> f64 {
    let last = curve.len() - 1;
    let (from, to) = ((span.0.max(0.0) as usize).min(last), (span.1.ceil().max(0.0) as usize).min(last));
    let mut best = (from..=to).max_by(|&a, &b| curve[a].total_cmp(&curve[b])).unwrap_or(from);
    while best > 0 && curve[best - 1] > curve[best] {
        best -= 1;
    }
    while best < last && curve[best + 1] > curve[best] {
        best += 1;
    }
    if best == 0 || best == last {
        return best as f64;
    }
    let (before, here, after) = (curve[best - 1], curve[best], curve[best + 1]);
    let bend = before - 2.0 * here + after;
    best as f64 + if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// Modes separated by sufficient valleys; of two neighbours without one, the lower is removed, the least separated first.
fn standing_out(mut modes: Vec<Mode>, curve: &[f64]) -> Vec<Mode> {
    modes.sort_by(|a, b| a.at.total_cmp(&b.at));
    loop {
        let bin = |mode: &Mode| mode.at.round() as usize;
        let rises = modes.windows(2).enumerate().map(|(i, pair)| {
            let (a, b) = (bin(&pair[0]), bin(&pair[1]));
            let valley = curve[a..=b].iter().copied().fold(f64::INFINITY, f64::min);
            let (lower, height) = if curve[a] < curve[b] { (i, curve[a]) } else { (i + 1, curve[b]) };
            let needed = (LEAST_RISE * height).max(NOISE_RISE * height.sqrt());
            ((height - valley) / needed.max(1e-9), lower)
        });
        match rises.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((rise, lower)) if rise <= 1.0 => modes.remove(lower),
            _ => return modes,
        };
    }
}

/// Assigns samples to the nearest mode; removes modes with too few, the smallest first.
fn counted(mut modes: Vec<Mode>, histogram: &[u32], least_samples: u32) -> Vec<Mode> {
    loop {
        for mode in &mut modes {
            mode.samples = 0;
        }
        for (bin, &count) in histogram.iter().enumerate() {
            let nearest = modes.iter_mut().min_by(|a, b| (a.at - bin as f64).abs().total_cmp(&(b.at - bin as f64).abs()));
            if let Some(mode) = nearest {
                mode.samples += count;
            }
        }
        let poorest = (0..modes.len()).min_by_key(|i| modes[*i].samples);
        match poorest {
            Some(i) if modes[i].samples < least_samples && modes.len() > 1 => {
                modes.remove(i);
            }
            _ => return modes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bell(histogram: &mut [u32], mean: f64, sigma: f64, samples: f64) {
        for (bin, count) in histogram.iter_mut().enumerate() {
            let z = (bin as f64 - mean) / sigma;
            *count += (samples * (-0.5 * z * z).exponential() / (sigma * 2.506_628)).round() as u32;
        }
    }

    #[test]
    fn two_bells_are_two_modes_and_one_is_one() {
        let mut histogram = vec![0; 256];
        bell(&mut histogram, 80.0, 5.0, 9000.0);
        assert_eq!(histogram_modes(&histogram, 100).len(), 1);
        bell(&mut histogram, 140.0, 8.0, 5000.0);
        let modes = histogram_modes(&histogram, 100);
        assert_eq!(modes.len(), 2, "{modes:?}");
        assert!((modes[0].at - 80.0).abs() < 1.0 && (modes[1].at - 140.0).abs() < 1.0, "{modes:?}");
        assert!(modes[0].samples > 8900);
    }

    #[test]
    fn nothing_and_a_single_grey() {
        assert!(histogram_modes(&[0; 256], 1).is_empty());
        let mut one = vec![0; 256];
        one[255] = 50;
        assert_eq!(histogram_modes(&one, 1).len(), 1);
    }
}
