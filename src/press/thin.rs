//! Chooses which marks too small for print stay, and what they become.

use super::Press;
use super::plan::Plan;
use crate::drawing::Mark;
use crate::geometry::{Point, thinned};
use crate::interrupt::Interrupt;

/// The marks of a layer in painting order, thinned out: specks are kept in blue-noise order, everywhere as many as their shares
/// add up to. Once the interrupt is raised, any of them.
pub(super) fn settled(plans: Vec<Plan>, press: &Press, interrupt: &Interrupt) -> Vec<Mark> {
    let (places, shares): (Vec<Point>, Vec<f64>) = plans.iter().flat_map(candidates).unzip();
    let is_kept = thinned(&places, &shares, interrupt);
    let mut is_kept = is_kept.into_iter();
    let mut marks = Vec::with_capacity(plans.len());
    for plan in plans {
        match plan {
            Plan::Whole(mark) => marks.push(mark),
            Plan::Specks(whole, specks) => {
                marks.extend(whole);
                marks.extend(specks.into_iter().zip(&mut is_kept).filter(|(_, kept)| *kept).map(|(speck, _)| speck.mark));
            }
            Plan::Broken(broken) => {
                let kept: Vec<bool> = is_kept.by_ref().take(broken.dashes().count()).collect();
                marks.extend(broken.strokes(&kept, press).into_iter().map(Mark::Stroke));
            }
        }
    }
    marks
}

fn candidates(plan: &Plan) -> Vec<(Point, f64)> {
    match plan {
        Plan::Whole(_) => Vec::new(),
        Plan::Specks(_, specks) => specks.iter().map(|speck| (speck.at, speck.share)).collect(),
        Plan::Broken(broken) => broken.dashes().collect(),
    }
}
