//! Lone dots: a few of them in white cloth, far from all other marks, look like dust.

use super::runs::Piece;
use crate::geometry::Point;
use crate::geometry::kd_tree::KdTree;
use crate::parallel::collected;

/// A dot stays if so many nodes of other pieces lie within a reach, in pitches: inside a field of dots there are 25 and more, at its border
/// half of them.
const COMPANY: usize = 6;
const REACH: f64 = 3.0;

/// Leaves out dots without company.
pub(super) fn without_specks(pieces: &mut [Vec<Piece>], pitch: f64) {
    let nodes = pieces.iter().flatten().enumerate().flat_map(|(i, piece)| piece.nodes.iter().map(move |node| (*node, i)));
    let (places, owners): (Vec<Point>, Vec<usize>) = nodes.unzip();
    let tree = KdTree::new(places.into_iter().zip(0..).collect());
    let reach = (REACH * pitch).powi(2);
    let has_company = |piece: &Piece, own: usize, near: &mut Vec<(f64, u32)>| {
        let [place] = piece.nodes.as_slice() else { return true };
        tree.nearest((*place, u32::MAX), COMPANY, |label| owners[label as usize] != own, near);
        near.len() == COMPANY && near[COMPANY - 1].0 <= reach
    };
    let mut first = 0;
    for family in pieces {
        let stays: Vec<bool> = collected(family.len(), &|i| has_company(&family[i], first + i, &mut Vec::new()));
        first += family.len();
        let mut stays = stays.into_iter();
        family.retain(|_| stays.next().unwrap_or(true));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_of_dots_stays_and_dust_goes() {
        let dot = |x: f64, y: f64| Piece { nodes: vec![Point::new(x, y)], widths: vec![0.3], ceilings: vec![1.0] };
        let field = (0..100).map(|i| dot(f64::from(i % 10), f64::from(i / 10)));
        let dust = [(30.0, 30.0), (32.5, 30.0), (30.0, 33.0)].map(|(x, y)| dot(x, y));
        let mut pieces = [field.chain(dust).collect(), Vec::new(), Vec::new()];
        without_specks(&mut pieces, 1.0);
        assert_eq!(pieces[0].len(), 100);
    }
}
