//! The spans of a line inside its region, from border to border (step 4 of the style).

use super::lines::{Family, Line};
use super::span::Span;
use super::widths::{LineReading, LineReadings, READINGS};

/// A line that runs along a border with another region, nearer than this (in pitches), is left out. The other region's lines do the
/// same, so that the two stay half a pitch apart.
const BORDER_ROOM: f64 = 0.26;
/// Sine of the angle to a border below which a line counts as running along it: 20 degrees, since two lines may be 15 degrees apart.
const ALONG_BORDER: f64 = 0.34;
/// Minimum sine of a line's angle to a border when the gap before the border is computed: at smaller angles a long end would give all
/// its ink to the rest.
const MOST_LACKING: f64 = 0.3;
/// A place no farther beyond the rim than this, in millimetres, was cut there.
const ON_RIM: f64 = 1e-9;
/// Minimum length that a line extends over a border, if the overlap allows, in pitches: two lines that do so from both sides stay below
/// two pitches together.
const BESIDE: f64 = 0.9;
/// Pieces shorter than this are left out, in pitches.
const STUB: f64 = 0.5;

impl LineReadings<'_> {
    /// The readings of a line where it is present and inside its region.
    pub(super) fn find(&self, line: &Line) -> LineReading {
        let first = line.first.div_ceil(self.stride);
        let end = (line.first + line.heights.len() - 1) / self.stride + 1;
        if end <= first + 1 {
            return LineReading::default();
        }
        let ground = self.wanted.ground;
        let (inside, leave): (Vec<f64>, Vec<f64>) = (first..end)
            .map(|r| {
                if line.presence[r * self.stride - line.first] == 0.0 && (r == first || r + 1 == end || self.is_gone(line, r)) {
                    return (-1.0, 0.0);
                }
                ground.reach(self.wanted.region.label, self.wanted.turn, self.point(line, r))
            })
            .unzip();
        let mut is_in: Vec<bool> = inside.iter().map(|&s| s > 0.0).collect();
        if ground.has_neighbours() {
            // Less the allowed overlap, plus the gap to leave free.
            let own: Vec<f64> = inside.iter().zip(&leave).map(|(inside, leave)| inside - leave).collect();
            self.leave_borders(line, first, &own, &mut is_in);
            if ground.overlap > 0.0 {
                self.shorten_overlaps(line, first, &own, &mut is_in);
            }
        }
        let spans = self.spans(line, first, &inside, &leave, &is_in);
        let inside = inside.iter().map(|&s| s as f32).collect();
        let mut course = LineReading { first, spans, inside, weight: vec![0.0; end - first], ..LineReading::default() };
        for span in &course.spans {
            let range = self.readings_in(*span);
            for r in range.start.max(first)..range.end.min(end) {
                course.weight[r - first] = line.presence[r * self.stride - line.first].max(1e-3);
            }
        }
        course
    }

    /// True if a line is absent at a reading and on both sides of it.
    fn is_gone(&self, line: &Line, r: usize) -> bool {
        let at = r * self.stride - line.first;
        line.presence[at.saturating_sub(1)] == 0.0 && line.presence[(at + 1).min(line.presence.len() - 1)] == 0.0
    }

    /// Removes readings that run along a border for more than a pitch.
    fn leave_borders(&self, line: &Line, first: usize, inside: &[f64], is_in: &mut [bool]) {
        let label = self.wanted.region.label;
        let room = BORDER_ROOM * self.family.pitch;
        let beside: Vec<bool> = (0..is_in.len())
            .map(|i| {
                is_in[i] && inside[i] < room && {
                    let (a, b) = (i.saturating_sub(1), (i + 1).min(is_in.len() - 1));
                    let along = self.point(line, first + b) - self.point(line, first + a);
                    let inwards = self.wanted.ground.inwards(label, self.point(line, first + i));
                    along.dot(inwards).abs() < ALONG_BORDER * along.hypot()
                }
            })
            .collect();
        let least = (READINGS * self.family.pitch / (self.step() * READINGS)).ceil() as usize;
        for run in runs(&beside).into_iter().filter(|run| run.len() >= least) {
            is_in[run].fill(false);
        }
    }

    /// Shortens a line that crosses a border at a slant and extends too far beside the other region's lines.
    fn shorten_overlaps(&self, line: &Line, first: usize, own: &[f64], is_in: &mut [bool]) {
        let most = self.wanted.ground.overlap.max(BESIDE * self.family.pitch);
        let way = |i: usize| (self.point(line, first + i) - self.point(line, first + i - 1)).hypot();
        // Length of line since it was inside, from either side.
        let mut away = vec![f64::INFINITY; own.len()];
        for i in 0..own.len() {
            away[i] = if own[i] > 0.0 { 0.0 } else { i.checked_sub(1).map_or(f64::INFINITY, |before| away[before] + way(i)) };
        }
        for i in (0..own.len().saturating_sub(1)).rev() {
            away[i] = away[i].min(away[i + 1] + way(i + 1));
        }
        is_in.iter_mut().zip(away).for_each(|(is_in, away)| *is_in &= away <= most);
    }

    fn spans(&self, line: &Line, first: usize, inside: &[f64], leave: &[f64], is_in: &[bool]) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for run in runs(is_in) {
            // Position at which the border is crossed between two readings.
            let crossing = |within: usize, beyond: Option<usize>| match beyond.filter(|&b| b < inside.len()) {
                Some(b) if inside[b] <= 0.0 && inside[b] > -1.0 => {
                    let t = inside[within] / (inside[within] - inside[b]);
                    self.place(first + within) + (self.place(first + b) - self.place(first + within)) * t
                }
                _ => self.place(first + within),
            };
            // Length left free before a border, along the line.
            let lacking = |within: usize, beyond: Option<usize>| match beyond.filter(|&b| b < inside.len()) {
                Some(b) if inside[b] <= 0.0 && inside[b] > -1.0 => {
                    (-leave[b]).max(0.0) * self.step() / (inside[within] - inside[b]).max(MOST_LACKING * self.step())
                }
                _ => 0.0,
            };
            let (start, last) = (run.start, run.end - 1);
            let span = Span {
                from: crossing(start, start.checked_sub(1)),
                to: crossing(last, Some(last + 1)),
                is_cut: [start > 0 && inside[start - 1] > -1.0, last + 1 < inside.len() && inside[last + 1] > -1.0],
                lacking: [lacking(start, start.checked_sub(1)), lacking(last, Some(last + 1))],
            };
            spans.push(span);
        }
        let mut spans: Vec<Span> = spans.into_iter().flat_map(|span| self.on_page(line, span)).collect();
        // A line that leaves its region and comes back leaves the gap without compensation.
        for i in 1..spans.len() {
            let short = 0.5 * (self.family.gap.distance - (spans[i].from - spans[i - 1].to)).max(0.0);
            spans[i - 1].to -= short;
            spans[i].from += short;
        }
        spans.retain(|span| span.to - span.from >= STUB * self.family.pitch);
        spans
    }

    /// The parts of a span inside the picture, checked at every column: over noise a line may leave it and come back between two
    /// readings.
    fn on_page(&self, line: &Line, span: Span) -> Vec<Span> {
        let Family { first, step, .. } = *self.family;
        let column = |u: f64| (u - first) / step;
        let inside = |u: f64| self.rim(line, u).inside;
        let columns = (column(span.from) + 1e-6).ceil() as usize..=(column(span.to) - 1e-6).floor() as usize;
        let places = columns.map(|c| first + c as f64 * step);
        let mut parts = Vec::new();
        let mut before = (span.from, inside(span.from));
        let mut open = (before.1 >= -ON_RIM).then_some(span);
        for u in places.chain(std::iter::once(span.to)) {
            let here = (u, inside(u));
            // Last position at which the rim can be crossed.
            let crossing = || before.0 + (here.0 - before.0) * (before.1 / (before.1 - here.1)).clamp(0.0, 1.0);
            match (open, here.1 >= -ON_RIM) {
                (None, true) => {
                    open =
                        Some(Span { from: crossing(), is_cut: [true, span.is_cut[1]], lacking: [0.0, span.lacking[1]], ..span });
                }
                (Some(part), false) => {
                    parts.push(Span { to: crossing(), is_cut: [part.is_cut[0], true], lacking: [part.lacking[0], 0.0], ..part });
                    open = None;
                }
                _ => {}
            }
            before = here;
        }
        parts.extend(open);
        parts
    }

    /// The readings inside a span.
    pub(super) fn readings_in(&self, span: Span) -> std::ops::Range<usize> {
        let index = |u: f64| (u - self.family.first) / self.step();
        let from = (index(span.from) - 1e-9).ceil().max(0.0) as usize;
        from..((index(span.to) + 1e-9).floor().max(0.0) as usize + 1)
    }
}

/// Runs of true flags.
fn runs(flags: &[bool]) -> Vec<std::ops::Range<usize>> {
    let mut runs: Vec<std::ops::Range<usize>> = Vec::new();
    for (i, _) in flags.iter().enumerate().filter(|(_, flag)| **flag) {
        match runs.last_mut() {
            Some(run) if run.end == i => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}
