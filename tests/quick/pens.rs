//! Pens, colours and speeds: the machine's are used, and the rest is reported.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use drypoint::plot::{Language, Profile, built_in_names};
use std::fs;
use std::path::Path;

/// Runs the program in a folder; its status, stdout and stderr.
fn drypoint(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_drypoint")).current_dir(folder).args(arguments).output().unwrap();
    let said = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), said(output.stdout), said(output.stderr))
}

/// A picture as plotting libraries write it: no layers, one colour per line.
fn lines(colours: &[String]) -> String {
    let line = |(i, colour): (usize, &String)| {
        format!("<path style=\"stroke:{colour};fill:none\" d=\"M20 {} h{}\"/>", 20 + 2 * i, 40 + i)
    };
    let body: String = colours.iter().enumerate().map(line).collect();
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"120mm\" height=\"100mm\" viewBox=\"0 0 120 100\">{body}</svg>")
}

fn viridis(count: usize) -> Vec<String> {
    (0..count).map(|i| format!("#{:02x}{:02x}{:02x}", 68 + 7 * i, 1 + 9 * i, 84 + 3 * (i % 20))).collect()
}

#[test]
fn more_colours_than_pens_are_drawn_with_the_pens_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let colours = viridis(25);
    fs::write(folder.path().join("a.svg"), lines(&colours)).unwrap();
    let run = |more: &[&str]| drypoint(folder.path(), &[&["plot", "a.svg", "-q"], more].concat());

    // One pen: all colours are merged, and each of them is named.
    let (status, _, said) = run(&["--profile", "grbl-servo", "-o", "a.gcode"]);
    assert_eq!(status, 0, "{said}");
    assert!(said.contains("25 colours became one, the one pen of grbl-servo"), "{said}");
    assert!(colours.iter().all(|colour| said.contains(colour.as_str())), "{said}");
    let gcode = at("a.gcode");
    assert_eq!((gcode.matches("M3 S700").count(), gcode.lines().filter(|line| *line == "M0").count()), (26, 0));

    // Six pens for colours from dark to light: each stands for several, and the ends are not merged.
    let (status, _, said) = run(&["--profile", "hp7475a", "-o", "a.hpgl"]);
    assert_eq!(status, 0, "{said}");
    assert!(said.contains("25 colours on the 6 pens of hp7475a"), "{said}");
    let of_pen = |pen: u32| said.split(&format!("pen {pen} ")).nth(1).unwrap().split(';').next().unwrap();
    assert!((1..=6).all(|pen| (2..=8).contains(&of_pen(pen).matches('#').count())), "{said}");
    assert!(of_pen(1).contains(&colours[0]) && !of_pen(1).contains(&colours[24]), "{said}");
    assert!(colours.iter().all(|colour| said.contains(colour.as_str())), "{said}");
    let hpgl = at("a.hpgl");
    let slots: Vec<&str> = hpgl.split(';').filter(|word| word.starts_with("SP")).collect();
    assert_eq!(slots, ["SP1", "SP2", "SP3", "SP4", "SP5", "SP6", "SP0"]);
    assert_eq!(hpgl.matches(";PD").count(), 25);

    // As many colours as pens: each keeps its own. A pens file can assign them otherwise.
    fs::write(folder.path().join("a.svg"), lines(&colours[..6])).unwrap();
    let (status, _, said) = run(&["--profile", "hp7475a", "-o", "a.hpgl"]);
    assert_eq!((status, said.as_str()), (0, ""));
    fs::write(folder.path().join("a.svg"), lines(&colours)).unwrap();
    fs::write(
        folder.path().join("pens.toml"),
        "[dark]\ncolour = \"#440154\"\nslot = 4\n[light]\ncolour = \"yellow\"\nslot = 2\n",
    )
    .unwrap();
    let (status, _, said) = run(&["--profile", "hp7475a", "-o", "a.hpgl", "--pens", "pens.toml"]);
    assert_eq!((status, said.as_str()), (0, ""));
    assert!(at("a.hpgl").contains("SP4;") && !at("a.hpgl").contains("SP1;"));
}

#[test]
fn three_thousand_colours_are_drawn_too() {
    let folder = tempfile::tempdir().unwrap();
    let colours: Vec<String> = (0..3000).map(|i| format!("#{:06x}", i * 5000)).collect();
    let line = |(i, colour): (usize, &String)| format!("<path stroke=\"{colour}\" d=\"M{} 50v9\"/>", 20 + i / 10);
    let body: String = colours.iter().enumerate().map(line).collect();
    let head = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"420mm\" height=\"297mm\" viewBox=\"0 0 420 297\">";
    fs::write(folder.path().join("many.svg"), format!("{head}{body}</svg>")).unwrap();
    let (status, _, said) = drypoint(folder.path(), &["plot", "many.svg", "-q", "--profile", "hp7475a", "-o", "x.hpgl"]);
    assert_eq!(status, 0, "{said}");
    assert!(said.contains("3000 colours on the 6 pens") && said.contains(" more"), "{said}");
    assert!(said.len() < 5000, "{}", said.len());
}

const THREE: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
    width=\"100mm\" height=\"80mm\" viewBox=\"0 0 100 80\" fill=\"none\">\
    <g id=\"a\" inkscape:groupmode=\"layer\" inkscape:label=\"1 black\"><path stroke=\"#000\" d=\"M20 20H80V60H20zM25 25h50M25 30h50\"/></g></svg>";

fn seconds(folder: &Path, file: &str, profile: &str) -> f64 {
    let (status, json, said) = drypoint(folder, &["plot", file, "--profile", profile, "--json", "--dry-run", "-o", "x.gcode"]);
    assert_eq!(status, 0, "{said}");
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    let total = &value["total"];
    let number = |key: &str| total[key].as_f64().unwrap();
    assert!((number("motion_seconds") + number("waiting_seconds") - number("seconds")).abs() < 1e-9, "{total}");
    assert!(number("waiting_seconds") > 0.0 && value["pens"][0]["motion_seconds"].as_f64().is_some());
    number("seconds")
}

#[test]
fn a_speed_in_a_label_means_the_same_on_another_machine() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let at = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    fs::write(folder.join("a.svg"), THREE).unwrap();
    fs::write(folder.join("slow.toml"), "[black]\nspeed = 30\n").unwrap();
    let plot = |file: &str, profile: &str, out: &str, more: &[&str]| {
        let (status, _, said) = drypoint(folder, &[&["plot", file, "-q", "--profile", profile, "-o", out], more].concat());
        assert_eq!(status, 0, "{said}");
        said
    };
    // The plotter's default speed is not written as the layer's own.
    plot("a.svg", "axidraw-v3", "usual.svg", &[]);
    assert!(at("usual.svg").contains("inkscape:label=\"1 black +S25\""), "{}", at("usual.svg"));
    let direct = seconds(folder, "a.svg", "grbl-servo");
    let by_way = seconds(folder, "usual.svg", "grbl-servo");
    assert!((by_way / direct - 1.0).abs() < 0.01, "{direct} s and {by_way} s");
    let (_, json, _) = drypoint(folder, &["inspect", "usual.svg", "--profile", "grbl-servo", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!((told["plot"]["total"]["seconds"].as_f64().unwrap() / direct - 1.0).abs() < 0.05, "{told}");

    // A layer's own speed is kept, in mm/s; and in percent on the same machine.
    plot("a.svg", "axidraw-v3", "slow.svg", &["--pens", "slow.toml"]);
    assert!(at("slow.svg").contains("1 black +S15"), "{}", at("slow.svg"));
    plot("slow.svg", "grbl-servo", "slow.gcode", &[]);
    let feed: f64 = at("slow.gcode").split(" F").nth(1).unwrap().lines().next().unwrap().parse().unwrap();
    assert!((feed / 1800.0 - 1.0).abs() < 0.02, "{feed}");
    plot("slow.svg", "axidraw-v3", "again.svg", &[]);
    assert!(at("again.svg").contains("1 black +S15"), "{}", at("again.svg"));

    // A label written by hand is for the plotter's program and is kept as it stands.
    fs::write(folder.join("own.svg"), THREE.replace("1 black", "1 black +S40")).unwrap();
    plot("own.svg", "axidraw-v3", "own-again.svg", &[]);
    assert!(at("own-again.svg").contains("1 black +S40"), "{}", at("own-again.svg"));

    // A speed that another machine cannot reach is reported.
    fs::write(folder.join("fast.svg"), at("usual.svg").replace("+S25", "+S110")).unwrap();
    let said = plot("fast.svg", "grbl-servo", "fast.gcode", &[]);
    assert!(said.contains("layer 'black' asks for 221 mm/s") && said.contains("at 100"), "{said}");
}

#[test]
fn a_speed_above_the_machine_s_greatest_is_refused_with_it() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), THREE).unwrap();
    for name in built_in_names() {
        let profile = Profile::built_in(name).unwrap();
        let out = match profile.language() {
            Language::Hpgl => "x.hpgl",
            Language::Gcode => "x.gcode",
            _ => "x.svg",
        };
        let run = |option: &str, speed: f64| {
            let speed = speed.to_string();
            drypoint(folder.path(), &["plot", "a.svg", "-q", "--dry-run", "--profile", name, "-o", out, option, &speed])
        };
        for (option, most) in [("--speed", profile.motion.fastest_drawing()), ("--travel-speed", profile.motion.fastest_travel())]
        {
            let (status, _, said) = run(option, 2000.0);
            assert_eq!(status, 2, "{name} {option}: {said}");
            assert!(
                said.contains(&format!("{option} 2000: {name} ")) && said.contains(&format!("at {most} mm/s at most")),
                "{said}"
            );
            let (_, _, said) = run(option, most);
            assert!(!said.contains("at most"), "{name} {option} {most}: {said}");
        }
    }
}

#[test]
fn the_example_of_pens_works_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let (status, example, _) = drypoint(folder.path(), &["profiles", "--pens-example"]);
    assert_eq!(status, 0);
    fs::write(folder.path().join("pens.toml"), example).unwrap();
    let red =
        "</g><g id=\"b\" inkscape:groupmode=\"layer\" inkscape:label=\"2 any\"><path stroke=\"#b22\" d=\"M30 40h40\"/></g></svg>";
    fs::write(folder.path().join("a.svg"), THREE.replace("</g></svg>", red)).unwrap();
    for name in built_in_names() {
        let profile = Profile::built_in(name).unwrap();
        let (out, is_mute) = match profile.language() {
            Language::Hpgl => ("x-{layer}.hpgl", false),
            Language::Gcode => ("x-{layer}.gcode", !profile.can_pause()),
            _ => ("x-{layer}.svg", false),
        };
        // A machine that cannot wait draws one layer per file.
        let out = if is_mute { out.to_owned() } else { out.replace("-{layer}", "") };
        let (status, _, said) =
            drypoint(folder.path(), &["plot", "a.svg", "-q", "--profile", name, "--pens", "pens.toml", "-o", &out]);
        assert_eq!(status, 0, "{name}: {said}");
    }
    let (_, help, _) = drypoint(folder.path(), &["plot", "--help"]);
    assert!(help.contains("--pens-example") && help.contains("[black]"), "{help}");
}

#[test]
fn a_wrong_file_of_pens_names_the_key_and_what_it_takes() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.svg"), THREE).unwrap();
    for (text, words) in [
        ("[black]\nslot = { a = 1 }\n", "pens.toml, line 2: [black] slot takes a whole number from 1"),
        ("[pen.1]\nwidth = 0.3\n", "pens.toml, line 1: [pen.1] is a table within a table"),
        ("[black]\nwith = 0.3\n", "pens.toml, line 2: [black] has no key 'with'; it takes width, slot, colour"),
    ] {
        fs::write(folder.path().join("pens.toml"), text).unwrap();
        let arguments = ["plot", "a.svg", "--profile", "grbl-servo", "--pens", "pens.toml", "-o", "x.gcode"];
        let (status, _, said) = drypoint(folder.path(), &arguments);
        assert_eq!(status, 1, "{said}");
        assert!(said.contains(words) && said.contains("--pens-example"), "{said}");
    }
}
