//! A studio that runs, and requests to it.

use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longest wait for a drawing; a small one takes a second, but the machine may be busy.
const PATIENCE: Duration = Duration::from_mins(2);

/// A studio that ends with its owner.
pub struct Studio {
    child: Child,
    pub port: u16,
    pub token: String,
}

/// An answer: its status and its body.
pub struct Answer {
    pub status: u16,
    pub body: Vec<u8>,
}

impl Answer {
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&self.body)))
    }

    /// Why it was refused; panics if it was not.
    pub fn refusal(&self) -> String {
        assert!(self.status >= 400, "{}: {}", self.status, String::from_utf8_lossy(&self.body));
        self.json()["error"].as_str().unwrap().to_owned()
    }

    pub fn accepted(self) -> Value {
        assert_eq!(self.status, 200, "{}", String::from_utf8_lossy(&self.body));
        self.json()
    }
}

impl Studio {
    /// Opens a file of the folder; without one the page waits for a photograph.
    pub fn open(folder: &Path, file: Option<&str>) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
        command.current_dir(folder).args(["studio", "--no-browser"]).args(file);
        // Not among the recent scenes of whoever runs the tests.
        command.env("XDG_STATE_HOME", env!("CARGO_TARGET_TMPDIR"));
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let rest = address.trim().strip_prefix("http://127.0.0.1:").expect("an address on loopback");
        let (port, token) = rest.split_once("/?token=").expect("a token");
        Self { child, port: port.parse().unwrap(), token: token.to_owned() }
    }

    /// A request with these headers besides.
    pub fn raw(&self, head: &str, headers: &[(&str, &str)], body: &[u8]) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let mut request = format!("{head} HTTP/1.1\r\nConnection: close\r\nContent-Length: {}\r\n", body.len());
        request.extend(headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")));
        request.push_str("\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        // A refused body may not be read to its end.
        let _ = stream.write_all(body);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        parsed(&answer)
    }

    pub fn ask(&self, method: &str, path: &str, body: &[u8]) -> Answer {
        let host = format!("127.0.0.1:{}", self.port);
        self.raw(&format!("{method} {path}"), &[("Host", &host), ("X-Drypoint-Token", &self.token)], body)
    }

    pub fn get(&self, path: &str) -> Answer {
        self.ask("GET", path, &[])
    }

    pub fn post(&self, path: &str, body: &Value) -> Answer {
        self.ask("POST", path, body.to_string().as_bytes())
    }

    /// Sets keys of the scene.
    pub fn change(&self, label: &str, changes: &Value) -> Answer {
        self.post("/api/scene", &serde_json::json!({ "label": label, "changes": changes }))
    }

    /// What happens, as names and data, until `enough`.
    pub fn events(&self, mut enough: impl FnMut(&str, &Value) -> bool) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
        let request = format!("GET /api/events?token={} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", self.token, self.port);
        stream.write_all(request.as_bytes()).unwrap();
        let (begun, mut lines, mut name, mut line) = (Instant::now(), BufReader::new(stream), String::new(), String::new());
        loop {
            assert!(begun.elapsed() < PATIENCE, "nothing happened");
            match lines.read_line(&mut line) {
                Ok(0) => panic!("the studio has ended"),
                // Time is up, and the line goes on later.
                Err(_) => continue,
                Ok(_) => {}
            }
            if let Some(event) = line.trim().strip_prefix("event: ") {
                event.clone_into(&mut name);
            } else if let Some(data) = line.trim().strip_prefix("data: ")
                && enough(&name, &serde_json::from_str(data).unwrap())
            {
                return;
            }
            line.clear();
        }
    }

    /// Waits for the full drawing of the present scene; returns it, or why there is none.
    pub fn drawn(&self) -> Result<Value, String> {
        let revision = self.get("/api/scene").accepted()["revision"].clone();
        let mut found = Err(String::new());
        self.events(|name, data| {
            let is_wanted = data["revision"] == revision;
            match name {
                "finished" if is_wanted && data["quality"] == "full" => found = Ok(data["id"].clone()),
                "failed" if is_wanted => found = Err(data["message"].as_str().unwrap().to_owned()),
                _ => return false,
            }
            true
        });
        found.map(|id| self.get(&format!("/api/drawing/{id}")).accepted())
    }

    /// Ends it without a warning, as a crash would.
    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn parsed(answer: &[u8]) -> Answer {
    let split = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").expect("an answer");
    let head = String::from_utf8_lossy(&answer[..split]);
    let status = head.split(' ').nth(1).unwrap().parse().unwrap();
    assert!(!head.to_ascii_lowercase().contains("transfer-encoding"), "{head}");
    Answer { status, body: answer[split + 4..].to_vec() }
}

/// A folder with a small portrait.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(sample("grace-hopper.jpg"), folder.path().join("portrait.jpg")).unwrap();
    folder
}

pub fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name)
}

/// Settings with which a drawing takes little time.
pub fn small() -> Value {
    serde_json::json!([{ "path": ["size"], "value": "20x25mm" }])
}
