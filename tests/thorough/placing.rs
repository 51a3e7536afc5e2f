//! The position of a drawing on its sheet; and the advice of every refusal works when followed.
#![cfg(feature = "cli")]

use crate::common;

use common::png_of_light;
use drypoint::geometry::Rect;
use drypoint::read::read_svg;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The exit status and the message.
fn run(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(arguments).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

fn run_words(folder: &Path, line: &str) -> (i32, String) {
    run(folder, &line.split_whitespace().collect::<Vec<_>>())
}

/// A picture that is dark at the left and above, so that turns and mirrors show.
fn photograph(width: u32, height: u32) -> Vec<u8> {
    png_of_light(width, height, |x, y| if x < width / 4 && y < height / 4 { 0.02 } else { 0.9 })
}

fn box_of(file: &Path) -> (Rect, f64, f64) {
    let drawing = read_svg(&fs::read(file).unwrap()).unwrap().drawing();
    (drawing.bounding_box().unwrap(), drawing.page.width, drawing.page.height)
}

#[test]
fn draw_turns_mirrors_and_moves_as_plot_does() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("photo.png"), photograph(60, 40)).unwrap();
    let draw = |out: &str, more: &str| {
        let line = format!("draw photo.png -q --set highlights=off --set outline=off -o {out} --page a5 --size 60x40mm {more}");
        assert_eq!(run_words(folder.path(), &line), (0, String::new()), "{line}");
        box_of(&at(out))
    };
    let near = |(drawn, ..): (Rect, f64, f64), x: f64, y: f64, width: f64, height: f64| {
        let wanted = Rect::new(x, y, x + width, y + height);
        let off = [drawn.x0 - wanted.x0, drawn.y0 - wanted.y0, drawn.x1 - wanted.x1, drawn.y1 - wanted.y1];
        // Marks on the border extend over it by less than a pitch.
        assert!(off.iter().all(|off| off.abs() < 0.8), "{drawn:?} is not {wanted:?}");
    };
    near(draw("a.svg", "--center"), 44.0, 85.0, 60.0, 40.0);
    near(draw("b.svg", "--at 20,35"), 20.0, 35.0, 60.0, 40.0);
    near(draw("c.svg", "--at 2,3cm --rotate 90"), 20.0, 30.0, 40.0, 60.0);
    let dark = |out: &str, more: &str| {
        draw(out, more);
        let drawing = read_svg(&fs::read(at(out)).unwrap()).unwrap().drawing();
        // Centre of mass of the ink, from the middle of the sheet.
        let ink: f64 = drawing.marks().map(drypoint::drawing::Mark::area).sum();
        let moment = drawing.marks().map(|mark| (mark.bounding_box().center().to_vec2()) * mark.area());
        let middle = moment.fold(drypoint::geometry::Vec2::ZERO, |sum, next| sum + next) / ink;
        (middle.x < 74.0, middle.y < 105.0)
    };
    assert_eq!(dark("d.svg", ""), (true, true));
    assert_eq!(dark("e.svg", "--mirror"), (false, true));
    assert_eq!(dark("f.svg", "--rotate 90"), (false, true));
    assert_eq!(dark("g.svg", "--rotate 180"), (false, false));
    assert_eq!(dark("h.svg", "--rotate 270"), (true, false));
    assert_eq!(dark("i.svg", "--mirror --rotate 90"), (false, false));
    // A landscape picture fits a portrait sheet at a larger size when turned.
    let (upright, ..) = box_of_free(folder.path(), "j.svg", "");
    let (turned, width, height) = box_of_free(folder.path(), "k.svg", "--rotate auto");
    assert!(turned.area() > 1.5 * upright.area() && turned.height() > turned.width(), "{upright:?} {turned:?}");
    assert!((width - 148.0).abs() < 0.001 && (height - 210.0).abs() < 0.001);
}

fn box_of_free(folder: &Path, out: &str, more: &str) -> (Rect, f64, f64) {
    let line = format!("draw photo.png -q --pitch 3 --set highlights=off -o {out} --page a5 {more}");
    assert_eq!(run_words(folder, &line), (0, String::new()), "{line}");
    box_of(&folder.join(out))
}

/// A plotter user's frame: a page in millimetres with one rectangle.
fn frame(page: (f64, f64), x: f64, y: f64, width: f64, height: f64) -> String {
    let (w, h) = page;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {w} {h}\" fill=\"none\" \
         stroke=\"#000\" stroke-width=\".2\"><path d=\"M{x} {y}h{width}v{height}h-{width}z\"/></svg>"
    )
}

#[test]
fn plot_mirrors_and_puts_the_corner_where_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("f.svg"), frame((100.0, 80.0), 10.0, 20.0, 30.0, 10.0)).unwrap();
    for (more, (x, y)) in [("", (10.0, 20.0)), ("--mirror", (60.0, 20.0)), ("--at 5,6mm", (5.1, 6.1)), ("--center", (35.0, 35.0))]
    {
        let line = format!("plot f.svg -q -o out.svg {more}");
        assert_eq!(run_words(folder.path(), &line), (0, String::new()), "{line}");
        let (drawn, ..) = box_of(&folder.path().join("out.svg"));
        let corner = drawn.inset(-0.15).origin();
        assert!((corner.x - x).abs() < 0.01 && (corner.y - y).abs() < 0.01, "{line}: {corner:?}");
    }
    let (status, message) = run_words(folder.path(), "plot f.svg -o out.svg --fit page --at 5,5");
    assert!(status == 2 && message.contains("leave one of them out"), "{message}");
}

#[test]
fn a_square_photograph_lies_where_the_machine_reaches() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("photo.png"), photograph(64, 64)).unwrap();
    for page in ["a4", "a4-landscape", "a3", "letter", "tabloid-landscape"] {
        for more in
            ["", "--margin 10mm", "--margin 0", "--size 150x150mm", "--center", "--rotate 90", "--rotate auto --size 12x15cm"]
        {
            let line = format!("draw photo.png -q --pitch 4 --order none -o o.hpgl --profile hp7475a --page {page} {more}");
            assert_eq!(run_words(folder.path(), &line), (0, String::new()), "{line}");
        }
    }
}

/// The remedies that a refusal names, each as options to add; "a or b" are two.
fn remedies(message: &str) -> Vec<String> {
    let advice = message.rsplit_once("; ").map_or(message, |(_, advice)| advice);
    let advice = advice.replace(", or cut it with --clip", " or --clip").replace("without --at: ", "");
    let is_option = |word: &&str| {
        word.starts_with("--")
            || word.parse::<f64>().is_ok()
            || (word.ends_with("mm") && word.contains(|c: char| c.is_ascii_digit()))
            || *word == "page"
    };
    let of = |part: &str| {
        part.split([' ', ','])
            .filter(|w| !w.is_empty())
            .skip_while(|w| !w.starts_with("--"))
            .take_while(is_option)
            .collect::<Vec<_>>()
            .join(" ")
    };
    advice.split(" or ").map(of).filter(|options| !options.is_empty()).collect()
}

/// The command with options added; they replace a rotation that it has.
fn followed(line: &str, remedy: &str) -> String {
    let mut words: Vec<&str> = line.split_whitespace().collect();
    for option in remedy.split_whitespace().filter(|word| word.starts_with("--")) {
        if let Some(at) = words.iter().position(|word| *word == option) {
            let end = if words.get(at + 1).is_some_and(|next| !next.starts_with("--")) { at + 2 } else { at + 1 };
            words.drain(at..end);
        }
    }
    format!("{} {remedy}", words.join(" "))
}

/// The command without its --at.
fn without_place(line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let at = words.iter().position(|word| *word == "--at").unwrap();
    [&words[..at], &words[at + 2..]].concat().join(" ")
}

/// Runs a command; if it is refused, each remedy that it names must work.
fn advice_works(folder: &Path, line: &str) -> usize {
    let (status, message) = run_words(folder, line);
    if status == 0 {
        return 0;
    }
    println!("{line}: {message}");
    assert!(status == 1 && !message.contains("panicked"), "{line}: {message}");
    let ways = if message.contains("larger than every sheet") {
        let ways = ["choose one of them with --page, and --fit page", "choose a --size that fits on one of them"];
        assert!(ways.iter().any(|way| message.contains(way)), "{line}: {message}");
        vec![if line.starts_with("plot") { "--page a4 --fit page" } else { "--size 150x150mm" }.to_owned(); 2]
    } else {
        remedies(&message.replace("choose another --at, or leave it out", "without --at: --threads 2"))
    };
    assert!(ways.len() > 1, "{line}: {message} has no advice but --clip: {ways:?}");
    for remedy in &ways {
        let gives_way = message.contains("without --at") || message.contains("choose another --at");
        let line = if gives_way { without_place(line) } else { line.to_owned() };
        let again = followed(&line, remedy);
        let (status, said) = run_words(folder, &again);
        assert_eq!(status, 0, "{line}: {message} and then {again}: {said}");
    }
    1
}

#[test]
fn the_advice_of_a_refused_plot_works() {
    let folder = tempfile::tempdir().unwrap();
    let mut refused = 0;
    let frames = [
        frame((297.0, 210.0), 2.0, 2.0, 290.0, 205.0),
        frame((210.0, 297.0), 2.0, 2.0, 90.0, 100.0),
        frame((250.0, 400.0), 20.0, 20.0, 200.0, 360.0),
        frame((350.0, 200.0), 10.0, 10.0, 180.0, 185.0),
        frame((350.0, 200.0), -10.0, 10.0, 280.0, 120.0),
        frame((400.0, 60.0), 20.0, 10.0, 305.0, 40.0),
    ];
    for drawing in frames {
        fs::write(folder.path().join("f.svg"), drawing).unwrap();
        for (machine, out) in [("hp7475a", "o.hpgl"), ("grbl-servo", "o.gcode"), ("axidraw-v3", "o.svg")] {
            for more in ["", "--page a4", "--page a4 --rotate 90", "--page a4-landscape --at 180,10", "--rotate 270 --mirror"] {
                refused += advice_works(folder.path(), &format!("plot f.svg -q -o {out} --profile {machine} {more}"));
            }
        }
    }
    assert!(refused > 30, "only {refused} were refused");
}

#[test]
fn the_advice_of_a_refused_drawing_works() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("square.png"), photograph(64, 64)).unwrap();
    fs::write(folder.path().join("wide.png"), photograph(90, 45)).unwrap();
    let mut refused = 0;
    for photo in ["square.png", "wide.png"] {
        for (machine, out) in [("hp7475a", "o.hpgl"), ("grbl-servo", "o.gcode"), ("axidraw-v3", "o.svg")] {
            for more in [
                "--size 400x500mm",
                "--size 295x420mm --rotate 90",
                "--size 205x290mm --page a4",
                "--size 200x100mm --page a4-landscape --rotate 90",
                "--page a4 --at 0,0",
                "--page a4 --at 150,150 --size 100x100mm",
            ] {
                let line = format!("draw {photo} -q --pitch 5 --order none -o {out} --profile {machine} {more}");
                refused += advice_works(folder.path(), &line);
            }
        }
    }
    assert!(refused > 8, "only {refused} were refused");
}

#[test]
fn a_plot_is_made_smaller_to_keep_to_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let lines = (0..40).map(|i| format!("M10 {0}h180", 10 + 2 * i)).collect::<Vec<_>>().concat();
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200mm\" height=\"100mm\" viewBox=\"0 0 200 100\" fill=\"none\" \
         stroke=\"#000\" stroke-width=\".3\"><path d=\"{lines}\"/></svg>"
    );
    fs::write(folder.path().join("l.svg"), svg).unwrap();
    let json = |line: &str| -> serde_json::Value {
        let output = Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .current_dir(folder.path())
            .args(line.split_whitespace())
            .output()
            .unwrap();
        assert!(output.status.success(), "{line}: {output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let plot = "plot l.svg --json -o o.gcode --profile grbl-servo";
    let whole = json(plot)["total"]["seconds"].as_f64().unwrap();
    let half = json(&format!("{plot} --max-time {}s", (0.5 * whole).round()));
    let (seconds, scale) = (half["total"]["seconds"].as_f64().unwrap(), half["scale"].as_f64().unwrap());
    assert!(seconds <= 0.5 * whole + 1.0 && seconds > 0.4 * whole && scale < 0.9, "{seconds} of {whole} at {scale}");
    let ample = json(&format!("{plot} --max-time 10h"));
    assert_eq!((ample["scale"].as_f64(), ample["total"]["seconds"].as_f64()), (Some(1.0), Some(whole)), "never larger");
    let limit = format!("--max-time {}s", (0.5 * whole).round());
    let (status, message) = run_words(folder.path(), &format!("plot l.svg -o o.gcode --profile grbl-servo --scale 1.05 {limit}"));
    let figure = message.split("--scale ").last().and_then(|rest| rest.trim().parse::<f64>().ok());
    assert!(status == 1 && figure.is_some(), "{message}");
    let kept = format!("{plot} --scale {} {limit}", figure.unwrap());
    assert!(json(&kept)["total"]["seconds"].as_f64().unwrap() <= 0.5 * whole + 1.0, "{kept}");
    let (status, message) = run_words(folder.path(), &format!("plot l.svg -o o.gcode --profile grbl-servo --fit page {limit}"));
    assert!(status == 1 && message.contains("leave out --fit"), "{message}");
}

#[test]
fn a_dry_run_is_turned_and_refused_as_the_drawing_is() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("wide.png"), photograph(90, 45)).unwrap();
    fs::write(folder.path().join("f.svg"), frame((297.0, 210.0), 2.0, 2.0, 250.0, 105.0)).unwrap();
    for (line, status, words) in [
        ("draw wide.png --profile hp7475a --page a4 --rotate 90 -o o.hpgl --pitch 4", 0, "210.0 x 297.0 mm"),
        ("draw wide.png --profile hp7475a --page a4 --rotate auto --mirror -o o.hpgl --pitch 4", 0, "210.0 x 297.0 mm"),
        ("draw wide.png --profile hp7475a --size 160x80mm --rotate 90 -o o.hpgl --pitch 4", 0, "80.0 x 160.0 mm"),
        ("draw wide.png --profile hp7475a --page a4 --at 150,10 -o o.hpgl --pitch 4", 1, "choose another --at"),
        ("plot f.svg --profile hp7475a --page a4 -o o.hpgl", 1, "--rotate 90 --center"),
    ] {
        for line in [line.to_owned(), format!("{line} --dry-run")] {
            let (ended, said) = run_words(folder.path(), &line);
            assert!(ended == status && said.contains(words), "{line}: {said}");
        }
    }
}
