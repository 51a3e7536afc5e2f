//! What a drawing's file says of how it was made.

use super::arguments::DrawOptions;
use super::known::Wanted;
use super::scene;
use super::task::Task;
use super::words::file_name;
use crate::source::ToneTarget;
use crate::write::SvgHead;
use serde_json::{Value, json};

impl Task<'_> {
    /// Everything needed to reproduce the picture.
    pub(super) fn recipe(&self, options: &DrawOptions) -> Value {
        let set: serde_json::Map<String, Value> =
            self.manner.settings.entries().map(|(key, value)| (key.to_owned(), Value::String(value))).collect();
        let masks: serde_json::Map<String, Value> =
            self.manner.known.masks.iter().map(|mask| (mask.name().to_owned(), mask.recipe())).collect();
        let picture = self.options;
        let (sheet, placed) = (self.layout.sheet(), self.layout.placed());
        let depth = self.manner.known.depth.as_ref().map(|depth| match &depth.file {
            Some(file) => {
                json!({ "file": file_name(file), "sha256": depth.map.info.sha256, "far_white": picture.depth_far_white })
            }
            None => json!({ "found": true }),
        });
        let (tone, strength) = match self.manner.known.tone {
            Wanted::Portrait(strength) => ("portrait", Some(strength)),
            Wanted::Own(ToneTarget::Lightness) => ("lightness", None),
            Wanted::Own(ToneTarget::Linear) => ("linear", None),
        };
        json!({
            "drypoint": env!("CARGO_PKG_VERSION"),
            "command": "draw",
            "source": { "file": file_name(&picture.photo), "sha256": self.photograph.info.sha256 },
            "masks": masks,
            "depth": depth,
            "style": self.manner.style.name(),
            "options": self.options_spelled(options),
            "set": set,
            "seed": picture.seed,
            "page_mm": [round(sheet.0), round(sheet.1)],
            "picture_mm": [round(placed.x0), round(placed.y0), round(placed.width()), round(placed.height())],
            "rotate": self.layout.turning.degrees,
            "mirror": self.layout.turning.is_mirrored,
            "crop_px": [round(self.layout.crop.x), round(self.layout.crop.y), round(self.layout.crop.width), round(self.layout.crop.height)],
            "tone": tone,
            "tone_strength": strength,
            "gamma": picture.gamma,
            "black": picture.black,
            "white": picture.white,
            "pen_mm": options.pen,
            "min_mark_mm": options.min_mark,
            "dot_gain": options.dot_gain,
            "dot_gain_screen": options.dot_gain_screen,
            "ink": options.ink.to_string(),
            "layers": options.layers,
            "profile": options.profile.as_deref().map(file_name),
        })
    }
}

impl Task<'_> {
    /// The options of `draw` that differ from their defaults, parameters by their values and files by their names: `redo` reads it.
    fn options_spelled(&self, options: &DrawOptions) -> Value {
        let mut spelled = serde_json::Map::new();
        for (option, values) in &options.spelled.0 {
            let value = match option.as_str() {
                "set" | "pitch" => continue,
                "mask" => json!(values.iter().map(|value| role_and_name(value)).collect::<Vec<_>>()),
                "region" => json!(values.iter().map(|value| without_folder(value)).collect::<Vec<_>>()),
                _ => match &values[..] {
                    [] => json!(true),
                    [file] if scene::names_file(option, file) => json!(file_name(file)),
                    [value] => json!(value),
                    values => json!(values),
                },
            };
            spelled.insert(option.clone(), value);
        }
        let set = self.manner.settings.changed(self.manner.style.parameters());
        if !set.is_empty() {
            spelled.insert("set".to_owned(), json!(set));
        }
        Value::Object(spelled)
    }
}

/// The keys of a region with its mask's file without folders.
fn without_folder(text: &str) -> String {
    scene::with_mask(text, |file| Some(file_name(file).to_owned())).unwrap_or_else(|| text.to_owned())
}

/// `ROLE=FILE` without folders.
fn role_and_name(text: &str) -> String {
    text.split_once('=').map_or_else(|| text.to_owned(), |(role, file)| format!("{role}={}", file_name(file)))
}

fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

pub(super) fn head(options: &DrawOptions, recipe: &Value) -> SvgHead {
    let style = &options.picture.style;
    SvgHead {
        title: format!("{} of {}", style, file_name(&options.picture.photo)),
        description: format!(
            "Drawn by drypoint {} in the style {style}; the recipe is in the metadata.",
            env!("CARGO_PKG_VERSION")
        ),
        recipe: recipe.to_string(),
    }
}
