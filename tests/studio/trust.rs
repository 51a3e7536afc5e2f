//! Who may ask, and for what.

use crate::asking::{Studio, folder};
use serde_json::json;

#[test]
fn only_the_page_itself_is_answered() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    let own = format!("127.0.0.1:{}", studio.port);
    let token = studio.token.clone();
    let asked = |headers: &[(&str, &str)]| studio.raw("GET /api/scene", headers, &[]).status;
    assert_eq!(asked(&[("Host", &own), ("X-Drypoint-Token", &token)]), 200);
    assert_eq!(asked(&[("Host", &own)]), 403);
    assert_eq!(asked(&[("Host", &own), ("X-Drypoint-Token", "")]), 403);
    assert_eq!(asked(&[("Host", &own), ("X-Drypoint-Token", &token[1..])]), 403);
    assert_eq!(asked(&[("Host", &own), ("X-Drypoint-Token", &"0".repeat(32))]), 403);
    for host in ["example.org", "localhost", "127.0.0.1", "127.0.0.1:1", "example.org:80"] {
        assert_eq!(asked(&[("Host", host), ("X-Drypoint-Token", &token)]), 403, "{host}");
    }
    for origin in ["http://example.org", "null", "http://127.0.0.1:1", "https://127.0.0.1", "file://"] {
        assert_eq!(asked(&[("Host", &own), ("X-Drypoint-Token", &token), ("Origin", origin)]), 403, "{origin}");
    }
    assert_eq!(asked(&[("Host", &own), ("X-Drypoint-Token", &token), ("Origin", &format!("http://{own}"))]), 200);
    assert_eq!(studio.raw("GET /", &[("Host", &own)], &[]).status, 403);
    assert_eq!(studio.raw(&format!("GET /?token={token}"), &[("Host", &own)], &[]).status, 200);
}

#[test]
fn nothing_outside_the_scene_s_folder_is_read_or_written() {
    let folder = folder();
    let studio = Studio::open(folder.path(), Some("portrait.jpg"));
    for path in [
        "/../etc/passwd",
        "/api/../../etc/passwd",
        "/api/mask/..%2f..%2fetc%2fpasswd",
        "/api/mask/sight",
        "/etc/passwd",
        "/api/stage/..%2f..%2fetc",
        "/api/thumbnail/..%2f..%2fetc",
    ] {
        assert_eq!(studio.get(path).status, 404, "{path}");
    }
    for file in ["/etc/passwd", "../x.svg", "a/b.svg", "..", "", "-o", "portrait.toml"] {
        let refusal = studio.post("/api/export", &json!({ "file": file })).refusal();
        assert!(!refusal.is_empty(), "{file}");
    }
    for (key, value) in [
        ("photograph", json!("/etc/passwd")),
        ("photograph", json!("../portrait.jpg")),
        ("mask", json!({ "hair": "/etc/passwd" })),
        ("sight", json!("/etc")),
        ("preview", json!("/tmp/x.svg")),
        ("send", json!("/dev/ttyUSB0")),
        ("region", json!([{ "mask": "/etc/passwd" }])),
    ] {
        let refusal = studio.change("x", &json!([{ "path": [key], "value": value }])).refusal();
        assert!(refusal.contains("studio"), "{key}: {refusal}");
    }
    for port in ["", "-o", "--yes"] {
        assert!(studio.post("/api/send", &json!({ "port": port, "profile": "grbl-servo" })).refusal().contains("port"), "{port}");
    }
    assert!(studio.post("/api/send", &json!({ "port": "/dev/null", "profile": "../x" })).refusal().contains("machine"));
    assert!(studio.post("/api/send/continue", &json!(null)).refusal().contains("nothing was sent"));
    assert!(studio.post("/api/send/stop", &json!(null)).refusal().contains("nothing is being sent"));
    let text = json!({ "toml": "photograph = \"/etc/passwd\"\n" });
    assert!(studio.ask("PUT", "/api/scene", text.to_string().as_bytes()).refusal().contains("/etc/passwd"));
    std::fs::write(folder.path().join("evil.toml"), "photograph = \"/etc/passwd\"\n").unwrap();
    assert!(studio.post("/api/open", &json!({ "file": "evil.toml" })).refusal().contains("/etc/passwd"));
    assert_eq!(studio.get("/api/plot?profile=../../etc/passwd").status, 422);
    assert_eq!(studio.get("/api/scene").accepted()["values"], json!({ "photograph": "portrait.jpg" }));
}

#[test]
fn what_cannot_be_used_is_told_in_words() {
    let folder = folder();
    let studio = Studio::open(folder.path(), None);
    assert!(studio.get("/api/masks").refusal().contains("drop a photograph"));
    let drop = |name: &str, bytes: &[u8]| studio.ask("POST", &format!("/api/photograph?name={name}"), bytes);
    let refusal = drop("notes.jpg", b"this is no photograph").refusal();
    assert!(refusal.contains("notes.jpg") && !refusal.contains("/tmp"), "{refusal}");
    assert!(drop("empty.png", b"").refusal().contains("empty.png"));
    let photograph = std::fs::read(folder.path().join("portrait.jpg")).unwrap();
    assert!(drop("cut.jpg", &photograph[..2000]).refusal().contains("cut.jpg"));
    // A photograph of 100 MB: what follows the picture's end is of no interest.
    let mut large = photograph.clone();
    large.resize(100 << 20, 0);
    let told = drop("large.jpg", &large);
    assert!(told.status == 200 || !told.refusal().is_empty());
    let state = drop("portrait.jpg", &photograph).accepted();
    assert_eq!((&state["file"], &state["photograph"]["name"]), (&json!("portrait.toml"), &json!("portrait.jpg")));
    assert!(studio.ask("PUT", "/api/mask/hair", b"no picture").refusal().contains("PNG"));
    assert!(studio.ask("PUT", "/api/mask/moustache", b"").refusal().contains("facial-hair"));
    assert!(studio.change("x", &json!([{ "path": [], "value": 1 }])).refusal().contains("path"));
    assert!(studio.post("/api/scene", &json!({ "label": 3 })).refusal().contains("cannot be read"));
    std::fs::write(folder.path().join("notes.txt"), "words").unwrap();
    assert!(studio.post("/api/open", &json!({ "file": "notes.txt" })).refusal().contains("notes.txt"));
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"));
    let ended = command.current_dir(folder.path()).args(["studio", "--no-browser", "notes.txt"]).output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr);
    assert!(!ended.status.success() && ended.stdout.is_empty(), "{said}");
    assert!(said.contains("notes.txt") && said.trim().lines().count() == 1, "{said}");
    assert!(!folder.path().join("notes.toml").exists());
    let wrong = json!({ "toml": "photograph = " });
    assert!(studio.ask("PUT", "/api/scene", wrong.to_string().as_bytes()).refusal().contains("portrait.toml"));
}
