//! The links of a tour with their lengths, so that the search need not look them up in the tour again and again.

use super::ends::End;
use super::rearrangement::Rearrangement;
use super::sites::Sites;
use super::tour::Tour;

/// For each end, its link. Changes can be undone, like those of the tour.
pub(super) struct Links {
    of: Vec<Link>,
    /// The links replaced since the last [`Links::keep`], each by one of its ends.
    replaced: Vec<(End, Link)>,
}

/// A link as one of its ends sees it: the other end, and the way there in millimetres.
#[derive(Clone, Copy)]
pub(super) struct Link {
    pub(super) to: End,
    pub(super) length: f64,
}

impl Links {
    /// The links of this tour.
    pub(super) fn new(sites: &Sites, tour: &Tour) -> Self {
        let link = |end| {
            let to = tour.link(end);
            Link { to, length: sites.distance(end, to) }
        };
        Self { of: (0..2 * tour.len() as End).map(link).collect(), replaced: Vec::new() }
    }

    /// The link of this end.
    #[inline]
    pub(super) fn of(&self, end: End) -> Link {
        self.of[end as usize]
    }

    /// Follows a change of the tour that has been made: only the links before the segments have changed.
    pub(super) fn follow(&mut self, sites: &Sites, tour: &Tour, change: &Rearrangement) {
        for segment in &change.segments[..change.count] {
            let end = tour.entry(segment.to);
            let to = tour.link(end);
            let length = sites.distance(end, to);
            self.replace(end, Link { to, length });
            self.replace(to, Link { to: end, length });
        }
    }

    /// Makes all changes so far final.
    pub(super) fn keep(&mut self) {
        self.replaced.clear();
    }

    /// Undoes all changes since the last [`Links::keep`].
    pub(super) fn take_back(&mut self) {
        while let Some((end, link)) = self.replaced.pop() {
            self.of[end as usize] = link;
        }
    }

    fn replace(&mut self, end: End, link: Link) {
        self.replaced.push((end, std::mem::replace(&mut self.of[end as usize], link)));
    }
}
