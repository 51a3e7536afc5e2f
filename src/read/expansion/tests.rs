//! How much small files expand to.

use super::*;
use crate::read::shape_cost::{curves, segments};

fn count(body: &str) -> Result<f64, SvgError> {
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='{XLINK}'>{body}</svg>");
    let mut budget = Budget::of_millions(1e3);
    spend_expansion(&Document::parse(&text).unwrap(), &mut budget)?;
    Ok(budget.spent())
}

/// Definitions in a chain: each member draws the next one several times.
fn chain(length: usize, member: impl Fn(usize, Option<usize>) -> String) -> String {
    (0..length).map(|i| member(i, (i + 1 < length).then_some(i + 1))).collect()
}

fn markers(length: usize) -> String {
    chain(length, |i, next| {
        let next = next.map_or(String::new(), |next| format!("style='marker:url(#m{next})'"));
        format!("<marker id='m{i}'><path d='M0 0L1 1L2 0' stroke='red' {next}/></marker>")
    }) + "<path d='M0 0L9 9' marker-end='url(#m0)'/>"
}

#[test]
fn each_level_of_markers_multiplies() {
    let [one, two, three] = [1, 2, 3].map(|length| count(&markers(length)).unwrap());
    // One vertex at the start, two in between and one at the end: at least four times as much.
    assert!(three - two > 3.0 * (two - one), "{one} {two} {three}");
    assert!(matches!(count(&markers(40)), Err(SvgError::Work(_))));
}

#[test]
fn what_is_inherited_is_counted_where_it_is_used() {
    let pattern = format!("<pattern id='p'>{}</pattern>", "<rect/>".repeat(1000));
    let plain = count(&format!("{pattern}<g id='g'>{}</g>", "<rect/>".repeat(10))).unwrap();
    let filled = count(&format!("{pattern}<g fill='url(#p)'>{}</g>", "<rect/>".repeat(10))).unwrap();
    let used = count(&format!("{pattern}<defs><g id='g'>{}</g></defs><use href='#g' fill='url(#p)'/>", "<rect/>".repeat(10)));
    let own = count(&format!("{pattern}<g fill='url(#p)'>{}</g>", "<rect fill='red'/>".repeat(10))).unwrap();
    assert!(filled > plain + 10.0 * 1000.0 && used.unwrap() > plain + 10.0 * 1000.0, "{plain} {filled}");
    assert!(own < plain + 1000.0, "{plain} {own}");
}

#[test]
fn circles_are_refused_but_for_what_svg_passes_over() {
    let masks = "<mask id='a'><rect mask='url(#b)'/></mask><mask id='b'><rect mask='url(#c)'/></mask><mask id='c'><rect mask='url(#a)'/></mask>";
    let inherited = "<g fill='url(#p)'><pattern id='p'><rect/></pattern><rect/></g>";
    let gradients = "<linearGradient id='a' href='#b'/><linearGradient id='b' href='#c'/><linearGradient id='c' href='#b'/>";
    let uses = "<g id='a'><use href='#b'/></g><g id='b'><use href='#c'/></g><g id='c'><use href='#a'/></g>";
    for body in [masks, inherited, gradients, uses] {
        assert!(matches!(count(body), Err(SvgError::Circle(_))), "{body}");
    }
    let self_use = "<g id='g'><use href='#g'/><rect/></g><use href='#g'/>";
    let self_marker = "<style>path{marker-end:url(#m);marker-start:url(#n)}</style><marker id='m'><path d='M0 0H1'/></marker>                           <marker id='n'><path d='M0 0H1'/></marker><path d='M0 0H9'/>";
    for body in [self_use, self_marker] {
        assert!(count(body).is_ok(), "{body}: {:?}", count(body));
    }
}

#[test]
fn path_data_is_counted_as_it_will_be_drawn() {
    let (count, subpaths) = segments("M0 0 1 1 2 2zM5 5a1 1 0 0 0 1 1h3");
    assert!((4.0 + 1.0..4.0 + 8.0).contains(&count) && subpaths == 2.0, "{count}");
    assert!(segments("M0 0A1e300 1e300 0 1 0 1 1").0 > 1e40 && segments("M0 0A1e9 1e9 0 0 0 1 1").0 < 3.0);
    assert!(segments("M0 9e29A1 1 0 0 1 6 6").0 > 1e6 && segments("M0 9e5A1 1 0 0 1 6 6").0 < 10.0);
    assert!(curves(10.0) < 10.0 && curves(1e38) > 1e6);
    assert_eq!(segments("M0 0L1 1 oops L2 2"), (1.0, 1.0));
}
