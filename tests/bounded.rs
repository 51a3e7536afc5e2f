//! Work is counted before it is done: each of these small files once took all memory or never ended. Each is read, or refused
//! with the number and the limit, within two gigabytes.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use drypoint::read::{Budget, SvgError, read_svg, read_svg_within};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::Output;

const HEAD: &str = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='100mm' height='100mm' viewBox='0 0 100 100'>";

fn svg(body: &str) -> Vec<u8> {
    format!("{HEAD}{body}</svg>").into_bytes()
}

fn many(number: usize, element: impl Fn(usize) -> String) -> String {
    (0..number).map(element).collect()
}

/// Deterministic pseudo-random points from 0 to 100.
fn scattered(number: usize) -> impl Iterator<Item = (f64, f64)> {
    let fraction = |i: usize, step: f64| 100.0 * (i as f64 * step).fract();
    (0..number).map(move |i| (fraction(i * i % 65_537, 0.618_034), fraction(i * i % 65_521, 0.414_214)))
}

/// Runs `inspect` or `plot` on a file within 2 GB of address space.
fn run(name: &str, bytes: &[u8], arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let file: PathBuf = folder.path().join(name);
    std::fs::write(&file, bytes).unwrap();
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 2000000; exec \"$@\"", "sh"]).arg(assert_cmd::cargo::cargo_bin!("drypoint"));
    // Each thread's heap would take address space of its own.
    command.env("MALLOC_ARENA_MAX", "1").env("RAYON_NUM_THREADS", "2").current_dir(folder.path());
    command.arg(arguments[0]).arg(&file).args(&arguments[1..]);
    command.timeout(std::time::Duration::from_mins(10)).output().unwrap()
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The command succeeds or is refused with a message.
fn is_bounded(name: &str, bytes: &[u8]) {
    for arguments in [&["inspect"][..], &["plot", "-o", "out.svg", "--order", "none"]] {
        if arguments[0] == "plot" && !name.contains(".svg") {
            continue;
        }
        let output = run(name, bytes, arguments);
        let text = told(&output);
        match output.status.code() {
            Some(0) => {}
            Some(1) => assert!(
                text.contains("nothing to draw")
                    || text.contains("million steps of work") && text.contains("limit is 12 million"),
                "{name}: {text}"
            ),
            other => panic!("{name} {}: {other:?}\n{}", arguments[0], text.chars().take(500).collect::<String>()),
        }
    }
}

/// The command is refused, with the number and the limit.
fn is_refused(name: &str, bytes: &[u8]) {
    is_bounded(name, bytes);
    let output = run(name, bytes, &["inspect"]);
    assert_eq!(output.status.code(), Some(1), "{name}: {}", told(&output));
    assert!(told(&output).contains("million steps of work"), "{name}: {}", told(&output));
}

#[test]
fn nested_markers() {
    let members = many(13, |i| {
        let next = if i == 12 { String::new() } else { format!("style='marker:url(#m{})'", i + 1) };
        format!("<marker id='m{i}'><path d='M0 0L1 1L2 0' stroke='red' {next}/></marker>")
    });
    is_refused("markers.svg", &svg(&format!("{members}<path d='M0 0L50 50L90 0' stroke='black' style='marker:url(#m0)'/>")));
}

#[test]
fn nested_masks_and_clip_paths() {
    for (element, property) in [("mask", "mask"), ("clipPath", "clip-path")] {
        let members = many(26, |i| {
            let next = if i == 25 { String::new() } else { format!("{property}='url(#m{})'", i + 1) };
            format!(
                "<{element} id='m{i}'><rect width='100' height='100' fill='white' {next}/><rect width='90' height='90' fill='white' {next}/></{element}>"
            )
        });
        is_refused("masks.svg", &svg(&format!("{members}<path d='M0 0L50 50' stroke='black' {property}='url(#m0)'/>")));
    }
}

#[test]
fn nested_patterns() {
    let members = many(26, |i| {
        let fill = if i == 25 { "red".to_owned() } else { format!("url(#p{})", i + 1) };
        format!(
            "<pattern id='p{i}' width='.1' height='.1' fill='{fill}'><rect width='10' height='10'/><rect width='9' height='9'/></pattern>"
        )
    });
    is_refused("patterns.svg", &svg(&format!("{members}<rect width='50' height='50' fill='url(#p0)' stroke='black'/>")));
}

#[test]
fn many_vertices_with_a_long_marker() {
    let marker = format!("<marker id='m' overflow='visible'><path d='M0 0{}' stroke='black'/></marker>", "L1 1L0 1".repeat(1000));
    let points: String = scattered(20_000).fold(String::new(), |mut text, (x, y)| {
        let _ = write!(text, "L{x:.2} {y:.2}");
        text
    });
    is_refused(
        "vertices.svg",
        &svg(&format!("{marker}<path stroke='black' fill='none' marker-mid='url(#m)' d='M0 0{points}'/>")),
    );
}

#[test]
fn a_long_entity_many_times() {
    let declared = format!("<!DOCTYPE svg [<!ENTITY e '{}'>]>", "M0 0L1 1 ".repeat(11_000));
    for body in [format!("<path stroke='black' d='{}'/>", "&e;".repeat(20_000)), "<path stroke='black' d='&e;'/>".repeat(20_000)]
    {
        is_refused("entities.svg", format!("{declared}{HEAD}{body}</svg>").as_bytes());
    }
    let elements = format!("<!DOCTYPE svg [<!ENTITY e '{}'>]>{HEAD}{}</svg>", "<g/>".repeat(25_000), "&e;".repeat(20_000));
    is_refused("elements.svg", elements.as_bytes());
}

#[test]
fn a_packed_file_that_is_long_unpacked() {
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(HEAD.as_bytes()).unwrap();
    let chunk = b"<g/>".repeat(1 << 20);
    (0..225).for_each(|_| packed.write_all(&chunk).unwrap());
    packed.write_all(b"</svg>").unwrap();
    is_refused("bomb.svgz", &packed.finish().unwrap());
    let mut plain = HEAD.as_bytes().to_vec();
    (0..8).for_each(|_| plain.extend_from_slice(&chunk));
    plain.extend_from_slice(b"</svg>");
    is_refused("groups.svg", &plain);
}

#[test]
fn many_fine_dashes() {
    let line = |i: usize| format!("<path stroke='black' d='M0 {:.1}H100' stroke-dasharray='.0026 .0026'/>", i as f64 * 0.2);
    is_refused("dashes.svg", &svg(&many(500, line)));
    let pattern = "1 ".repeat(50_000);
    // Too fine for its line; the line is drawn solid.
    is_bounded(
        "pattern.svg",
        &svg(&many(500, |_| format!("<path stroke='black' d='M0 0H9e8' stroke-dasharray='{pattern}' transform='scale(1e-7)'/>"))),
    );
    is_bounded("offset.svg", &svg("<path stroke='black' d='M0 0H10' stroke-dasharray='1 1' stroke-dashoffset='1e38'/>"));
}

#[test]
fn long_arcs() {
    let head = "(drypoint 0.1 for grbl-servo)\nG21\nG90\nM3 S700\n";
    is_refused("turns.gcode", format!("{head}{}", "G2 X0 Y0 I1e9 J0\n".repeat(40_000)).as_bytes());
    is_refused("circles.gcode", format!("{head}{}", "G3 X0 Y0 I1000000000 J0\n".repeat(40_000)).as_bytes());
    is_refused("angles.hpgl", format!("IN;SP1;PU0,0;PD;{}", "AA5,5,1e18;".repeat(20_000)).as_bytes());
    is_refused("touches.hpgl", format!("IN;SP1;{}", "PD;PU;".repeat(3_000_000)).as_bytes());
    for (radius, number) in [("1e300", 1), ("1e36", 20)] {
        let shapes = format!("<path d='M0 0A{radius} {radius} 0 1 0 1 1'/>").repeat(number);
        is_refused("arc.svg", &svg(&format!("{shapes}<path d='M0 0H9' stroke='black'/>")));
    }
    is_refused("circles.svg", &svg(&"<circle r='3e38' stroke='black'/>".repeat(200)));
    is_refused("ellipses.svg", &svg(&"<ellipse rx='1e30%' ry='1' stroke='black'/>".repeat(2000)));
}

#[test]
fn long_styles() {
    let style = "stroke:red;".repeat(20_000);
    is_bounded("style.svg", &svg(&format!("<path d='M0 0H50' stroke='black' style='{style}'/>")));
    is_refused("styles.svg", &svg(&format!("<path d='M0 0H50' stroke='black' style='{style}'/>").repeat(40)));
    is_refused("rule.svg", &svg(&format!("<style>path{{{style}}}</style>{}", "<path d='M0 0H50' stroke='black'/>".repeat(4000))));
    let attributes: String = many(20_000, |i| format!(" a{i}='1'"));
    is_bounded("attributes.svg", &svg(&format!("<path d='M0 0H50' stroke='black'{attributes}/>")));
    is_refused("attributed.svg", &svg(&format!("<path d='M0 0H50' stroke='black'{attributes}/>").repeat(40)));
    let selectors = "a,".repeat(20_000);
    is_refused("selectors.svg", &svg(&format!("<style>{selectors}b{{{style}}}</style><path d='M0 0H50' stroke='black'/>")));
}

#[test]
fn many_rules_on_many_elements() {
    let rules = many(4000, |i| format!(".c{i}{{stroke:red}}"));
    is_bounded(
        "rules.svg",
        &svg(&format!("<style>{rules}</style>{}", many(4000, |i| format!("<path class='c{i}' d='M0 {}H9'/>", i % 90)))),
    );
    let rules = many(20_000, |i| format!(".c{i}{{stroke:red}}"));
    is_refused(
        "more.svg",
        &svg(&format!("<style>{rules}</style>{}", many(20_000, |i| format!("<path class='c{i}' d='M0 {}H9'/>", i % 90)))),
    );
    // Each descendant is searched at every depth.
    let deep = format!("{}<path d='M0 0H9'/>{}", "<g>".repeat(100), "</g>".repeat(100));
    is_refused("descendants.svg", &svg(&format!("<style>x {}path{{stroke:red}}</style>{deep}", "g ".repeat(9))));
    is_refused("sheets.svg", &svg(&format!("{}<path d='M0 0H9' stroke='red'/>", "<style>.a{fill:red}</style>".repeat(30_000))));
}

#[test]
fn many_crossings() {
    let points: String = scattered(20_000).fold(String::new(), |mut text, (x, y)| {
        let _ = write!(text, "{x:.3},{y:.3} ");
        text
    });
    is_refused("even-odd.svg", &svg(&format!("<polygon fill-rule='evenodd' points='{points}'/>")));
    is_refused(
        "clip.svg",
        &svg(&format!(
            "<clipPath id='c'><polygon points='{points}'/></clipPath><path clip-path='url(#c)' d='M0 0H9' stroke='black'/>"
        )),
    );
    is_refused(
        "clipped.svg",
        &svg(&format!(
            "<clipPath id='c'><rect width='50' height='50'/></clipPath><polygon clip-path='url(#c)' points='{points}'/>"
        )),
    );
}

#[test]
fn long_lines_at_long_borders() {
    let points: String = scattered(3000).fold(String::new(), |mut text, (x, y)| {
        let _ = write!(text, "{x:.3},{y:.3} ");
        text
    });
    let saw: String = many(30_000, |i| format!("{},{} ", i as f64 * 0.003, 20 * (i % 2)));
    is_refused(
        "saw.svg",
        &svg(&format!(
            "<clipPath id='c'><polygon points='{saw} 90,90 0,90'/></clipPath>{}",
            format!("<polyline fill='none' clip-path='url(#c)' points='{points}' stroke='black'/>").repeat(100)
        )),
    );
}

#[test]
fn references_that_lead_back() {
    for body in [
        "<g fill='url(#p)'><pattern id='p' width='1' height='1'><rect width='1' height='1'/></pattern><rect width='9' height='9'/></g>",
        "<linearGradient id='a' href='#b'/><linearGradient id='b' href='#c'/><linearGradient id='c' href='#b'/><rect width='9' height='9' fill='url(#a)'/>",
        "<g id='a'><use href='#b'/></g><g id='b'><use href='#c'/></g><g id='c'><use href='#a'/></g>",
        "<mask id='a'><rect mask='url(#b)'/></mask><mask id='b'><rect mask='url(#c)'/></mask><mask id='c'><rect mask='url(#a)'/></mask>",
    ] {
        let output = run("circle.svg", &svg(body), &["inspect"]);
        assert_eq!(output.status.code(), Some(1), "{body}: {}", told(&output));
        assert!(told(&output).contains("refers back to itself"), "{body}: {}", told(&output));
    }
    let chain = many(600, |i| format!("<mask id='m{i}'><rect width='9' height='9' mask='url(#m{})'/></mask>", i + 1));
    let output = run("chain.svg", &svg(&format!("{chain}<rect mask='url(#m0)' width='9' height='9'/>")), &["inspect"]);
    assert!(output.status.code() == Some(1) && told(&output).contains("512 deep"), "{}", told(&output));
}

#[test]
fn a_file_without_end_is_not_read_to_its_end() {
    if !std::path::Path::new("/dev/zero").exists() {
        return;
    }
    let output = run(
        "frame.svg",
        &svg("<path d='M0 0H9' stroke='black'/>"),
        &["plot", "-o", "out.hpgl", "--profile", "hp7475a", "--pens", "/dev/zero"],
    );
    assert!(output.status.code() == Some(1) && told(&output).contains("65536 bytes"), "{}", told(&output));
}

#[test]
fn the_option_lifts_the_limit() {
    let lines = svg(&many(1000, |i| format!("<path stroke='black' d='M0 {:.1}H100' stroke-dasharray='1 1'/>", i as f64 * 0.1)));
    let refused = run("lines.svg", &lines, &["inspect", "--most-work", "0.2"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(told(&refused).contains("the limit is 0.2 million; --most-work 1 or more"), "{}", told(&refused));
    assert_eq!(run("lines.svg", &lines, &["inspect", "--most-work", "1"]).status.code(), Some(0));
    assert!(matches!(read_svg_within(&lines, &mut Budget::of_millions(0.2)), Err(SvgError::Work(_))));
    assert_eq!(
        run("lines.svg", &lines, &["plot", "-o", "out.svg", "--most-work", "1", "--order", "none"]).status.code(),
        Some(0)
    );
    assert_eq!(run("lines.svg", &lines, &["inspect", "--most-work", "1001"]).status.code(), Some(2));
}

/// Realistic drawings are far below the limit.
#[test]
fn large_drawings_are_read() {
    let points: String = scattered(1_000_000).fold(String::new(), |mut text, (x, y)| {
        let _ = write!(text, "L{x:.2} {y:.2}");
        text
    });
    let line = read_svg(&svg(&format!("<path fill='none' stroke='black' d='M0 0{points}'/>"))).unwrap();
    assert_eq!(line.layers[0].counts(), [0, 1, 0]);
    let strokes = many(200_000, |i| format!("<path d='M{} {}c1 0 2 1 2 2s1 2 2 2' stroke='black' fill='none'/>", i % 97, i % 89));
    assert_eq!(read_svg(&svg(&strokes)).unwrap().layers[0].counts(), [0, 200_000, 0]);
    // As matplotlib writes them: each mark is a use within the same clip path.
    let marks = many(50_000, |i| format!("<g clip-path='url(#p)'><use href='#m' x='{}' y='{}'/></g>", i % 97, i % 89));
    let scatter = format!(
        "<defs><path id='m' d='M0 3C0.8 3 1.5 2.7 2.1 2.1C2.7 1.5 3 0.8 3 0Z' stroke='black'/></defs><clipPath id='p'><rect width='100' height='100'/></clipPath>{marks}"
    );
    assert_eq!(read_svg(&svg(&scatter)).unwrap().layers[0].layer.marks.len(), 100_000);
}
