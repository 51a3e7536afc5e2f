//! Sketches as ink of the pen.

use super::*;

const INKML: &str = "http://www.w3.org/2003/InkML";

/// A drawing with two layers of two strokes each.
fn two_layers() -> Drawing {
    let stroke = |path: &str, pressure: Vec<f64>, times: Vec<f64>| {
        let widths = pressure.iter().map(|p| 0.5 * p).collect();
        let stroke = Stroke::swelling(BezPath::from_svg(path).unwrap(), widths).unwrap();
        Mark::Stroke(stroke.with_pressure(pressure).and_then(|stroke| stroke.with_times(times)).unwrap())
    };
    let mut layers = vec![Layer::new("hair & beard", 1), Layer::new("edges", 2)];
    layers[0].marks.push(stroke("M1,2 L10.125,2.5 L12,7", vec![0.25, 1.0, 0.5], vec![0.5, 0.75, 1.0]));
    layers[1].marks.push(stroke("M3,3 L-0.5,8", vec![0.1, 0.9], vec![2.0, 2.5]));
    Drawing { page: Page::new(90.0, 120.0), layers }
}

#[test]
fn inkml_reads_back() {
    let mut bytes = Vec::new();
    write_inkml(&two_layers(), "A <sketch>", &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert!(root.has_tag_name((INKML, "ink")));
    assert!(root.descendants().filter(roxmltree::Node::is_element).all(|node| node.tag_name().namespace() == Some(INKML)));
    let named = |name: &str| root.descendants().filter(|n| n.has_tag_name((INKML, name))).collect::<Vec<_>>();
    let channels: Vec<(&str, &str)> =
        named("channel").iter().map(|c| (c.attribute("name").unwrap(), c.attribute("units").unwrap())).collect();
    assert_eq!(channels, [("X", "mm"), ("Y", "mm"), ("F", "dev"), ("T", "ms")]);
    assert_eq!(named("timestamp").len(), 1);
    let id = |node: &roxmltree::Node<'_, '_>| {
        node.attribute(("http://www.w3.org/XML/1998/namespace", "id")).map(|id| format!("#{id}"))
    };
    let brushes: Vec<String> = named("brush").iter().filter_map(id).collect();
    let used: Vec<&str> = named("traceGroup").iter().map(|g| g.attribute("brushRef").unwrap()).collect();
    assert_eq!(used, brushes);
    let traces: Vec<Vec<Vec<f64>>> = named("trace")
        .iter()
        .map(|trace| {
            let points = trace.text().unwrap().split(',');
            points.map(|p| p.split_whitespace().map(|v| v.parse().unwrap()).collect()).collect()
        })
        .collect();
    let expected = [
        vec![vec![1.0, 2.0, 250.0, 500.0], vec![10.125, 2.5, 1000.0, 750.0], vec![12.0, 7.0, 500.0, 1000.0]],
        vec![vec![3.0, 3.0, 100.0, 2000.0], vec![-0.5, 8.0, 900.0, 2500.0]],
    ];
    assert_eq!(traces, expected);
}

#[test]
fn a_sketch_s_inkml_has_a_trace_for_each_stroke() {
    let photo = sample("bust-light.png");
    let masks = [(MaskRole::Subject, sample("bust-mask-subject.png")), (MaskRole::Hair, sample("bust-mask-hair.png"))];
    let mut drawing = Sitting { masks: &masks, set: QUICK, ..Sitting::new(&photo, (45.0, 60.0)) }.draw(&Silent);
    drawing.layers.retain(|layer| layer.name != "tone");
    let mut bytes = Vec::new();
    write_inkml(&drawing, "", &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let traces: Vec<roxmltree::Node<'_, '_>> = document.descendants().filter(|n| n.has_tag_name((INKML, "trace"))).collect();
    assert_eq!(traces.len(), drawing.marks().count());
    let mut before = 0;
    for trace in &traces {
        for point in trace.text().unwrap().split(',') {
            let values: Vec<&str> = point.split_whitespace().collect();
            let (force, time): (i64, i64) = (values[2].parse().unwrap(), values[3].parse().unwrap());
            assert!((0..=1000).contains(&force) && time >= before, "{point} after {before}");
            before = time;
        }
    }
}
