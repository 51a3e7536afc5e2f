//! `drypoint studio`: the page in the browser.

use super::arguments::StudioOptions;
use super::failure::Failure;
use super::interruption::is_interrupted;
use super::masks::photograph;
use super::messages::say;
use super::output;
use super::scene::check;
use crate::source::Crop;
use crate::studio::{Settings, Shown, Ties, serve};
use etcetera::BaseStrategy;
use rand::TryRng;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Bytes of the token in the page's address: as many as cannot be guessed.
const TOKEN: usize = 16;
/// Quality of the page's pictures of photographs, in percent: at 80 skin shows blocks when it is enlarged.
const QUALITY: u8 = 88;

pub(super) fn run(options: &StudioOptions) -> Result<(), Failure> {
    let settings = Settings {
        program: std::env::current_exe()
            .map_err(|error| Failure::Work(format!("drypoint does not find its own program: {error}")))?,
        file: options.file.as_ref().map(PathBuf::from),
        home: std::env::current_dir().map_err(|error| Failure::Work(format!("this folder cannot be used: {error}")))?,
        port: options.port,
        token: token()?,
        show,
    };
    let ties = Ties { recent: recent(), check, is_ending: is_interrupted };
    let mut told = Ok(());
    let served = serve(settings, ties, |address| {
        told = output::to_stdout(format!("{address}\n").as_bytes());
        say!("drypoint: the studio is open at that address, on this computer alone; Ctrl-C ends it");
        if !options.no_browser && !opens(address) {
            say!("drypoint: open it in a browser");
        }
    });
    told?;
    served.map_err(|error| Failure::Work(error.to_string()))
}

/// The file of the scenes that were open last, in the user's folder of states, or of configurations where there is none.
fn recent() -> Option<PathBuf> {
    let strategy = etcetera::choose_base_strategy().ok()?;
    let folder = strategy.state_dir().unwrap_or_else(|| strategy.config_dir());
    Some(folder.join("drypoint").join("recent"))
}

fn token() -> Result<String, Failure> {
    let mut bytes = [0; TOKEN];
    let filled = rand::rngs::SysRng.try_fill_bytes(&mut bytes);
    filled.map_err(|error| Failure::Work(format!("the system gives no random numbers: {error}")))?;
    Ok(format!("{:032x}", u128::from_be_bytes(bytes)))
}

/// Opens the address in the user's browser; false if there is no program for that.
fn opens(address: &str) -> bool {
    let openers: &[&[&str]] = match std::env::consts::OS {
        "macos" => &[&["open"]],
        "windows" => &[&["rundll32", "url.dll,FileProtocolHandler"]],
        _ => &[&["xdg-open"], &["wslview"]],
    };
    openers.iter().any(|words| {
        let mut opener = Command::new(words[0]);
        opener.args(&words[1..]).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        opener.spawn().is_ok()
    })
}

/// A picture of a photograph for the page, upright.
fn show(file: &Path, long: u32) -> Result<Shown, String> {
    let photograph = photograph(&file.to_string_lossy()).map_err(|failure| failure.to_string())?;
    let (width, height) = (photograph.width(), photograph.height());
    let scale = (f64::from(long) / f64::from(width.max(height))).min(1.0);
    let side = |pixels: u32| ((f64::from(pixels) * scale).round() as usize).max(1);
    let (columns, rows) = (side(width), side(height));
    let small = photograph.encoded(Crop::all(&photograph), columns, rows).map_err(|error| error.to_string())?;
    let pixels: Vec<u8> = small.pixels().iter().flatten().copied().collect();
    let mut jpeg = Vec::new();
    let mut encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, QUALITY);
    encoder.encode(&pixels, columns as u32, rows as u32, image::ExtendedColorType::Rgb8).map_err(|error| error.to_string())?;
    Ok(Shown { size: (width, height), jpeg })
}
