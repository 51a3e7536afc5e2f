use super::*;

fn message(text: &str, set: &[(&str, &str)]) -> String {
    let set: Vec<(String, String)> = set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    Profile::parse_with("mine.toml", text, &set).unwrap_err().to_string()
}

#[test]
fn every_built_in_profile_is_sound_and_named_like_its_file() {
    let names = built_in_names();
    assert!(names.len() >= 16, "{names:?}");
    for name in names {
        let profile = Profile::built_in(name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(profile.name, name);
    }
}

#[test]
fn every_number_of_a_built_in_profile_has_its_source() {
    for name in built_in_names() {
        let text = built_in(name).unwrap();
        assert!(text.contains("# Sources:"), "{name}");
    }
}

#[test]
fn a_wrong_profile_says_file_line_and_key() {
    let text = built_in("grbl-servo").unwrap().replace("travel_speed", "travelspeed");
    let line = text.lines().position(|l| l.starts_with("travelspeed")).unwrap() + 1;
    let said = message(&text, &[]);
    assert!(said.starts_with(&format!("mine.toml, line {line}: motion.travelspeed: ")), "{said}");

    let text = built_in("grbl-servo").unwrap().replace("acceleration = 250", "acceleration = 0");
    let line = text.lines().position(|l| l.starts_with("acceleration")).unwrap() + 1;
    assert_eq!(message(&text, &[]), format!("mine.toml, line {line}: motion.acceleration must be above 0"));

    let said = message("extends = \"hp7475a\"\n\n[motion]\ndraw_speed = \"fast\"\n", &[]);
    assert!(said.starts_with("mine.toml, line 4: motion.draw_speed: ") && said.contains("fast"), "{said}");
    let said = message("name = \"x\"\nlanguage = gcode\n", &[]);
    assert!(said.starts_with("mine.toml, line 2: "), "{said}");
    let said = message("extends = \"hp7475a\"\n[[paper]]\nname = \"a4\"\nx = [5, 2]\n", &[]);
    assert_eq!(said, "mine.toml, line 4: paper.a4.x must be [lower, upper] with lower < upper");
    assert!(message("extends = \"nothing\"\n", &[]).contains("there is no plotter profile 'nothing'"));
    assert!(message("name = \"x\"\n", &[]).contains("language is missing; it is one of hpgl, gcode, svg"));
    assert!(
        message("extends = \"hp7475a\"\nlanguage = \"latin\"\n", &[])
            .starts_with("mine.toml, line 2: language: \"latin\" is none of")
    );
}

#[test]
fn a_profile_may_extend_one_of_another_language() {
    let text = "extends = \"hp7475a\"\nname = \"x\"\nlanguage = \"svg\"\n[svg]\nspeed_of_percent = 2.0\n";
    let profile = Profile::parse("mine.toml", text).unwrap();
    assert_eq!((profile.language(), profile.speed_of_percent()), (Language::Svg, Some(2.0)));
    assert_eq!(message("extends = \"hp7475a\"\nlanguage = \"svg\"\n", &[]), "mine.toml: svg is missing, and the language is svg");
}

#[test]
fn numbers_beyond_all_measure_are_refused() {
    for (machine, key) in [
        ("grbl-servo", "units_per_mm"),
        ("grbl-servo", "motion.draw_speed"),
        ("grbl-servo", "motion.acceleration"),
        ("grbl-z", "gcode.height.plunge_speed"),
        ("grbl-z", "motion.planner.z_speed"),
        ("hp7475a", "paper.a4.width"),
        ("hp7475a", "pens.pen_life"),
        ("hp7475a", "pen.2.pen_life"),
        ("axidraw-v3", "svg.speed_of_percent"),
    ] {
        for value in ["1e300", "1e-300", "inf", "nan", "-1"] {
            let said = message(built_in(machine).unwrap(), &[(key, value)]);
            assert!(said.starts_with(&format!("a key set over the profile: {key} must be ")), "{key} = {value}: {said}");
        }
    }
    for (machine, key, value) in [
        ("grbl-servo", "area.x", "[0, 1e300]"),
        ("grbl-servo", "gcode.park", "[0, nan]"),
        ("grbl-z", "gcode.height.up", "1e300"),
        ("hp7475a", "paper.a4.zero", "[-1e300, 0]"),
    ] {
        let said = message(built_in(machine).unwrap(), &[(key, value)]);
        assert!(
            said.starts_with(&format!("a key set over the profile: {key}")) && said.contains("number"),
            "{key} = {value}: {said}"
        );
    }
}

#[test]
fn a_file_changes_one_key_and_keeps_the_others() {
    let base = Profile::built_in("hp7475a").unwrap();
    let text = "extends = \"hp7475a\"\nname = \"mine\"\nscale_x = 1.002\n[[pen]]\nslot = 2\noffset = [0.1, -0.2]\n\
                [[paper]]\nname = \"a4\"\nzero = [10.5, 206]\n";
    let mine = Profile::parse("mine.toml", text).unwrap();
    let mut expected = base.clone();
    expected.name = "mine".into();
    expected.scale_x = 1.002;
    expected.paper.iter_mut().find(|paper| paper.name == "a4").unwrap().zero = [10.5, 206.0];
    expected.pen = vec![PenSlot { slot: 2, offset: [0.1, -0.2], pen_life: None }];
    assert_eq!(mine, expected);
    assert_eq!((mine.offset_of(2), mine.offset_of(1)), ([0.1, -0.2], [0.0, 0.0]));
}

#[test]
fn keys_are_set_from_outside_and_faults_name_the_option() {
    let set = [
        ("motion.draw_speed".to_owned(), "12.5".to_owned()),
        ("paper.a3.zero".to_owned(), "[1, 2]".to_owned()),
        ("pen.4.offset".to_owned(), "[0.5, 0]".to_owned()),
        ("description".to_owned(), "my own".to_owned()),
    ];
    let profile = Profile::parse_with("hp7475a", built_in("hp7475a").unwrap(), &set).unwrap();
    assert_eq!(profile.motion.draw_speed, 12.5);
    assert_eq!(profile.paper.iter().find(|paper| paper.name == "a3").unwrap().zero, [1.0, 2.0]);
    assert_eq!((profile.offset_of(4), profile.description.as_str()), ([0.5, 0.0], "my own"));
    let grbl = built_in("grbl-servo").unwrap();
    assert_eq!(
        message(grbl, &[("motion.travel_speed", "-3")]),
        "a key set over the profile: motion.travel_speed must be above 0"
    );
    assert!(message(grbl, &[("motion.speedy", "3")]).starts_with("a key set over the profile: motion.speedy: unknown field"));
}

#[test]
fn a_dialect_writes_only_what_it_knows() {
    let grbl = built_in("grbl-servo").unwrap();
    let said = message(grbl, &[("gcode.pen_up", "M280 P0 S30")]);
    assert_eq!(said, "a key set over the profile: gcode.pen_up holds M280, which is not in gcode.words");
    assert!(message(grbl, &[("gcode.pause", "M0 what?")]).contains("must be one ASCII line"));
    assert!(message(grbl, &[("gcode.pen_up", "M3 S700")]).contains("must differ"));
}

#[test]
fn a_line_s_width_has_its_height() {
    let swell = Swell { table: vec![[0.2, 1.0], [0.6, 0.0], [1.0, -2.0]] };
    for (width, height) in [(0.1, 1.0), (0.2, 1.0), (0.4, 0.5), (0.6, 0.0), (0.8, -1.0), (3.0, -2.0)] {
        assert!((swell.height(width) - height).abs() < 1e-9, "{width}");
    }
}

#[test]
fn a_pen_that_swells_touches_at_every_height_of_its_table() {
    let toy = built_in("toy").unwrap();
    let with = |table: &str| Profile::parse_with("toy", toy, &[("swell.table".to_owned(), table.to_owned())]);
    assert_eq!(with("[[0.2, 1.2], [0.6, -0.5]]").unwrap().lightest(), Some(1.2));
    assert_eq!(with("[[0.2, -0.3], [0.6, -0.5]]").unwrap().lightest(), Some(-0.2));
    assert!(with("[[0.2, 1.5], [0.6, -0.5]]").unwrap_err().to_string().contains("paper's side"));
    assert_eq!(Profile::built_in("hp7475a").unwrap().lightest(), None);
}
