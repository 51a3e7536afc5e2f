//! `drypoint draw`: photograph to drawing to file.

use super::advice;
use super::affordable;
use super::arguments::{DrawOptions, Format, PictureOptions, PlacingOptions};
use super::crop;
use super::dry_run;
use super::eyes;
use super::failure::Failure;
use super::interruption::{interrupt, is_interrupted};
use super::job;
use super::known::{self, Known, Wanted};
use super::layer_files::{self, LayerFile, split_by_layer};
use super::layout::{self, Layout, lay_out};
use super::lists::{role_names, roles_of, styles_with_role};
use super::long_waits;
use super::max_time;
use super::messages::{self, say};
use super::output;
use super::pens::PenSet;
use super::progress::Watcher;
use super::remedies::advised;
use super::seen_stages;
use super::toolpaths;
use super::words::counted;
use crate::drawing::{Drawing, Layer, Mixing, Page, Painted};
use crate::geometry::Rect;
use crate::plot::write_inkml;
use crate::plot::{Hides, InkModel, Job, Profile, mount, occluded};
use crate::press::Press;
use crate::source::{DepthSense, Limits, MaskRole, Photograph, Placement, Portrait, ToneCurve, ToneTarget};
use crate::style::{self, Cost, Observer, Settings, Style, StyleError};
use crate::tone::portrait_tone;
use crate::write::{SvgHead, write_pdf, write_svg};
use image::DynamicImage;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::path::Path;

pub(super) fn run(options: &DrawOptions) -> Result<(), Failure> {
    limit_threads(options.picture.threads)?;
    match options.max_time {
        Some(limit) => draw(&max_time::within(options, limit)?),
        None => draw(options),
    }
}

fn draw(options: &DrawOptions) -> Result<(), Failure> {
    let format = toolpaths::format_of(&options.output, options.format)?;
    if options.reporting.json && options.output == "-" {
        return Err(Failure::Usage("--json and -o - would both write to stdout".to_owned()));
    }
    let mut profile = options.profile.as_deref().map(|name| toolpaths::profile(name, &options.toolpaths)).transpose()?;
    toolpaths::check_language(format, profile.as_ref())?;
    press(options)?;
    if profile.is_none() && options.toolpaths.preview.is_some() {
        return Err(Failure::Usage("--preview shows what a machine will do; it needs --profile".to_owned()));
    }
    let mut pens = PenSet::read(options.toolpaths.pens.as_deref(), options.pen, profile.as_mut())?;
    let task = Task::placed(&options.picture, &options.placing, reach_of(profile.as_ref()))?;
    toolpaths::check_preview(&options.output, &options.toolpaths)?;
    let notice = layout::empty_box_notice(&options.picture, &task.layout).filter(|_| !options.reporting.quiet);
    let tell = || notice.iter().for_each(|notice| say!("drypoint: {notice}"));
    if options.dry_run {
        task.tell(options.reporting.quiet);
        let told = dry_run::run(&task, options, profile.as_ref(), &mut pens);
        return told.map_err(|failure| advice::for_draw(failure, options, &task, profile.as_ref())).inspect(|()| tell());
    }
    let is_warned = long_waits::warn_if_long(&task, options, profile.as_ref(), &mut pens)?;
    let watcher = Watcher::new(options.reporting.quiet);
    let (drawing, painting) = drawing_of(&task, options, profile.as_ref(), &mut pens, &watcher)?;
    let visible = match profile {
        Some(_) => uncovered(&drawing, &painting)?,
        None => Cow::Borrowed(&drawing),
    };
    let head = head(options, &task.recipe(options));
    let files = split_by_layer(&visible, &options.output);
    toolpaths::check_layer_files(&files, &options.toolpaths)?;
    let mut jobs = Vec::new();
    for file in &files {
        if is_interrupted() {
            return Err(Failure::Interrupted);
        }
        let machine = profile.as_ref().map(|profile| (profile, &pens));
        let written = write_one(file, format, machine, options, &head, &watcher);
        jobs.extend(written.map_err(|failure| advice::for_draw(failure, options, &task, profile.as_ref()))?);
    }
    let seconds = watcher.finish();
    for job in &jobs {
        toolpaths::warn(job, if is_warned { None } else { Some("; a larger --pitch makes it shorter") });
    }
    max_time::warn_if_longer(&jobs, options.max_time);
    tell();
    task.tell(options.reporting.quiet);
    report(options, &drawing, &pens, (&files, &jobs), &seconds, watcher.elapsed())
}

/// A function that gives the part of a page that the machine reaches.
pub(super) fn reach_of(profile: Option<&Profile>) -> impl Fn(&Page) -> Option<Rect> {
    move |page| Some(mount(profile?, page).ok()?.reach_on_page())
}

/// The selected layers, each with its ink and its pen, and the painting order of their marks.
pub(super) fn drawing_of(
    task: &Task<'_>,
    options: &DrawOptions,
    profile: Option<&Profile>,
    pens: &mut PenSet,
    observer: &dyn Observer,
) -> Result<(Drawing, Vec<Painted>), Failure> {
    let mut drawing = inked(task.draw(observer)?, options, observer)?;
    let painting = pens.assign(&mut drawing, profile)?;
    Ok((drawing, painting))
}

/// The selected layers, each with its ink, compensated for the press.
pub(super) fn inked(mut drawing: Drawing, options: &DrawOptions, observer: &dyn Observer) -> Result<Drawing, Failure> {
    for layer in &mut drawing.layers {
        layer.ink = options.ink.clone();
    }
    drawing.layers = chosen(drawing.layers, &options.layers)?;
    if let Some(press) = press(options)? {
        observer.begin("press");
        drawing = press.compensated_until(&drawing, interrupt())?;
    }
    Ok(drawing)
}

/// Writes one file; returns the job if the file is for a machine.
fn write_one<'a>(
    file: &LayerFile,
    format: Format,
    machine: Option<(&'a Profile, &PenSet)>,
    options: &DrawOptions,
    head: &SvgHead,
    observer: &dyn Observer,
) -> Result<Option<Job<'a>>, Failure> {
    let LayerFile { name, drawing, .. } = file;
    let Some((profile, pens)) = machine else {
        observer.begin("writing");
        let date = output::source_date()?;
        let fill = |mut out: &mut dyn std::io::Write| match format {
            Format::Pdf => write_pdf(drawing, head, date, &mut out),
            Format::Inkml => write_inkml(drawing, &head.title, &mut out),
            _ => write_svg(drawing, head, &mut out),
        };
        output::write(name, fill)?;
        return Ok(None);
    };
    affordable::check_line(drawing, pens.nibs(), InkModel::Ink, 1.0)?;
    let job = job::of_drawing(drawing, InkModel::Ink, Some(profile), &options.toolpaths, pens, observer)?;
    observer.begin("writing");
    toolpaths::write(name, format, &job, head)?;
    toolpaths::write_preview_of(&job, &options.toolpaths, Some(&file.layer))?;
    Ok(Some(job))
}

/// The drawing without the parts of opaque paint that other paint covers.
pub(super) fn uncovered<'a>(drawing: &'a Drawing, painting: &[Painted]) -> Result<Cow<'a, Drawing>, Failure> {
    if drawing.layers.iter().any(|layer| layer.mixing == Mixing::Paint) {
        Ok(Cow::Owned(occluded(drawing, painting, Hides::PaintOnOtherColours, interrupt())?))
    } else {
        Ok(Cow::Borrowed(drawing))
    }
}

/// The press to compensate for; `None` if no compensation is requested.
fn press(options: &DrawOptions) -> Result<Option<Press>, Failure> {
    if options.dot_gain == 0.0 && options.min_mark == 0.0 {
        return Ok(None);
    }
    if options.profile.is_some() {
        return Err(Failure::Usage("--dot-gain and --min-mark are for print; a plotter's nib is set with --pen".to_owned()));
    }
    Ok(Some(Press::new(options.dot_gain, options.dot_gain_screen, options.min_mark)))
}

/// Minimum number of pitches across the short side of a picture in advice: with fewer, nothing is left of a face.
const LEAST_PITCHES: f64 = 25.0;

/// A mask of the photograph.
pub(super) struct RoleMask {
    pub role: MaskRole,
    /// Its file; `None` if it was found in the photograph.
    pub file: Option<String>,
    pub mask: Photograph,
}

impl RoleMask {
    /// The name of its role on the command line.
    pub(super) fn name(&self) -> &'static str {
        self.role.name()
    }

    /// Its origin, for the recipe.
    fn recipe(&self) -> Value {
        match &self.file {
            Some(file) => json!({ "file": file_name(file), "sha256": self.mask.info.sha256 }),
            None => json!({ "found": true }),
        }
    }
}

/// Everything that determines a drawing.
pub(super) struct Task<'a> {
    options: &'a PictureOptions,
    pub style: &'static dyn Style,
    pub settings: Settings,
    photograph: Photograph,
    known: Known,
    pub layout: Layout,
    /// The parameters given by the user.
    given: Vec<(String, String)>,
}

impl<'a> Task<'a> {
    /// A task with the default placing.
    pub(super) fn new(options: &'a PictureOptions, reach: impl Fn(&Page) -> Option<Rect>) -> Result<Self, Failure> {
        Self::placed(options, &PlacingOptions::default(), reach)
    }

    pub(super) fn placed(
        options: &'a PictureOptions,
        placing: &PlacingOptions,
        reach: impl Fn(&Page) -> Option<Rect>,
    ) -> Result<Self, Failure> {
        let style = find_style(&options.style)?;
        let given = given(options)?;
        let settings = Settings::resolve(style.name(), style.parameters(), &given)?;
        if options.black >= options.white {
            return Err(Failure::Usage(format!("--black {} must be below --white {}", options.black, options.white)));
        }
        let mask_files: Vec<(MaskRole, &str)> =
            options.mask.iter().map(|(role, file)| Ok((role_of(style, role)?, file.as_str()))).collect::<Result<_, Failure>>()?;
        if let Some((role, _)) =
            options.mask.iter().enumerate().find_map(|(i, mask)| options.mask[..i].iter().find(|m| m.0 == mask.0))
        {
            return Err(Failure::Usage(format!("--mask {role}= is given twice")));
        }
        if options.depth.is_some() && !style.uses_depth() {
            let able: Vec<&str> = style::STYLES.iter().filter(|s| s.uses_depth()).map(|s| s.name()).collect();
            let able = able.join(", ");
            return Err(Failure::Usage(format!("--depth: {} does not use a depth map; it is for {able}", style.name())));
        }
        let photograph = photograph(&options.photo)?;
        let painted = mask_files
            .into_iter()
            .map(|(role, file)| Ok(RoleMask { role, file: Some(file.to_owned()), mask: self::photograph(file)? }));
        let mut known = known::of(options, style, &photograph, painted.collect::<Result<_, Failure>>()?)?;
        // Marks on the picture's border extend beyond it by less than a pitch.
        let pitch = settings.number("pitch");
        let crop = crop::part(options, &photograph, &known.faces)?;
        let layout = lay_out(options, placing, crop, |page| Some(reach(page)?.inset(-pitch)))?;
        if style.leaves_out_background() {
            known.notices.extend(eyes::eyes_notice(&known.faces, &layout, pitch, options.crop));
        }
        let task = Self { options, style, settings, photograph, known, layout, given };
        affordable::check(&task)?;
        Ok(task)
    }

    /// True if the picture with other options, including all its ink, would lie within the machine's reach.
    pub(super) fn would_fit(&self, picture: &PictureOptions, placing: &PlacingOptions, profile: &Profile) -> bool {
        let Ok(crop) = crop::part(picture, &self.photograph, &self.known.faces) else { return false };
        let Ok(layout) = lay_out(picture, placing, crop, reach_of(Some(profile))) else { return false };
        let (width, height) = layout.sheet();
        let page = Page { width, height, ..layout.page };
        let drawable = mount(profile, &page).map(|mounting| mounting.drawable(&page).inflate(0.01, 0.01));
        drawable.is_ok_and(|drawable| drawable.union(layout.placed()) == drawable)
    }

    /// Prints the decisions made from what was found. Called after the work, so that a failure has a single message.
    pub(super) fn tell(&self, is_quiet: bool) {
        self.known.notices.iter().filter(|_| !is_quiet).for_each(|notice| say!("drypoint: {notice}"));
    }

    /// Pictures of what was found in the photograph, by name.
    pub(super) fn seen(&self) -> Result<Vec<(&'static str, DynamicImage)>, Failure> {
        seen_stages::pictures(&self.photograph, &self.known).map_err(|error| Failure::about(&self.options.photo)(&error))
    }

    /// The parameters with another pitch; `None` if the style does not accept it.
    pub(super) fn settings_at(&self, pitch: f64) -> Option<Settings> {
        let mut given = self.given.clone();
        given.push(("pitch".to_owned(), pitch.to_string()));
        Settings::resolve(self.style.name(), self.style.parameters(), &given).ok()
    }

    /// The largest pitch that the style accepts and that leaves the picture recognisable.
    pub(super) fn largest_useful_pitch(&self) -> f64 {
        let pitch = self.style.parameters().iter().find(|parameter| parameter.name == "pitch");
        let most = pitch.and_then(|parameter| parameter.kind.ends()).map_or(f64::INFINITY, |ends| ends[1]);
        most.min(self.layout.picture.width().min(self.layout.picture.height()) / LEAST_PITCHES)
    }

    /// The smallest short side, in millimetres, that leaves the picture recognisable at this pitch.
    pub(super) fn smallest_useful_side(&self) -> f64 {
        LEAST_PITCHES * self.settings.number("pitch")
    }

    /// Memory and time for drawing a picture, including the photographs already in memory.
    pub(super) fn cost(&self, settings: &Settings, picture: Rect) -> Cost {
        let cost = self.style.cost(settings, picture, self.resolution(settings, picture));
        let unused = &self.known.unused;
        let masks = self.known.masks.iter().chain(&self.known.people).chain(&unused.masks).map(|mask| &mask.mask);
        let others = masks.chain(self.known.depth.iter().chain(&unused.depth).map(|depth| &depth.map));
        let photographs: usize = others.chain([&self.photograph]).map(Photograph::bytes).sum();
        Cost { bytes: cost.bytes + photographs as f64, ..cost }
    }

    /// Working resolution in pixels per millimetre.
    pub(super) fn resolution(&self, settings: &Settings, picture: Rect) -> f64 {
        let roles: Vec<MaskRole> = self.known.masks.iter().map(|mask| mask.role).collect();
        self.style.resolution(settings, &roles, picture)
    }

    pub(super) fn draw(&self, observer: &dyn Observer) -> Result<Drawing, Failure> {
        for warning in &self.photograph.info.warnings {
            observer.warn(&format!("{}: {warning}", self.options.photo));
        }
        let picture = self.layout.picture;
        self.draw_in(&self.settings, Placement::new(picture, self.resolution(&self.settings, picture)), observer)
    }

    /// Draws the picture with other parameters or at another placement.
    pub(super) fn draw_in(&self, settings: &Settings, placement: Placement, observer: &dyn Observer) -> Result<Drawing, Failure> {
        observer.begin("photograph");
        let portrait = self.portrait(placement)?;
        let drawing = self.style.draw(&portrait, settings, self.options.seed, observer).map_err(|error| match error {
            StyleError::Interrupted => Failure::Interrupted,
            nothing => Failure::Work(format!("{}: {}", self.options.photo, advised(&nothing))),
        })?;
        Ok(self.layout.turning.turned(drawing))
    }

    fn portrait(&self, placement: Placement) -> Result<Portrait, Failure> {
        let target = if let Wanted::Own(target) = self.known.tone { target } else { ToneTarget::Lightness };
        let curve =
            ToneCurve { black: self.options.black as f32, white: self.options.white as f32, gamma: self.options.gamma as f32 };
        let about = |name: &str| {
            let name = name.to_owned();
            move |error: crate::source::SourceError| Failure::about(&name)(&advised(&error))
        };
        let mut portrait = Portrait::new(&self.photograph, self.layout.crop, self.layout.page, placement, target, curve)
            .map_err(about(&self.options.photo))?;
        let (photograph, crop) = (&self.photograph, self.layout.crop);
        for RoleMask { role, file, mask } in &self.known.masks {
            let name = file.as_deref().unwrap_or(&self.options.photo);
            portrait.add_mask(*role, mask, photograph, crop).map_err(about(name))?;
        }
        if let Some(RoleMask { file, mask, .. }) = &self.known.people {
            portrait.add_people(mask, photograph, crop).map_err(about(file.as_deref().unwrap_or(&self.options.photo)))?;
        }
        if let Some(depth) = &self.known.depth {
            let sense = if self.options.depth_far_white { DepthSense::FarWhite } else { DepthSense::NearWhite };
            let name = depth.file.as_deref().unwrap_or(&self.options.photo);
            portrait.add_depth(&depth.map, sense, photograph, crop).map_err(about(name))?;
        }
        portrait.add_faces(&self.known.faces, photograph, crop).map_err(about(&self.options.photo))?;
        if let Wanted::Portrait(strength) = self.known.tone
            && let Some(tone) = portrait_tone(&portrait, strength as f32)
        {
            portrait.set_portrait_tone(&tone, curve);
        }
        Ok(portrait)
    }

    /// Everything needed to reproduce the picture.
    fn recipe(&self, options: &DrawOptions) -> Value {
        let set: serde_json::Map<String, Value> =
            self.settings.entries().map(|(key, value)| (key.to_owned(), Value::String(value))).collect();
        let masks: serde_json::Map<String, Value> =
            self.known.masks.iter().map(|mask| (mask.name().to_owned(), mask.recipe())).collect();
        let picture = self.options;
        let (sheet, placed) = (self.layout.sheet(), self.layout.placed());
        let depth = self.known.depth.as_ref().map(|depth| match &depth.file {
            Some(file) => {
                json!({ "file": file_name(file), "sha256": depth.map.info.sha256, "far_white": picture.depth_far_white })
            }
            None => json!({ "found": true }),
        });
        let (tone, strength) = match self.known.tone {
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
            "style": self.style.name(),
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

fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// The last component of a path: recipes must not reveal folders of this machine.
fn file_name(name: &str) -> &str {
    Path::new(name).file_name().and_then(|n| n.to_str()).unwrap_or(name)
}

fn find_style(name: &str) -> Result<&'static dyn Style, Failure> {
    let names: Vec<&str> = style::STYLES.iter().map(|s| s.name()).collect();
    style::find(name).ok_or_else(|| Failure::Usage(format!("there is no style '{name}'; there are {}", names.join(", "))))
}

fn role_of(style: &dyn Style, name: &str) -> Result<MaskRole, Failure> {
    let refuse = || {
        let others: Vec<&str> = styles_with_role(name).map(Style::name).collect();
        let others = if others.is_empty() { String::new() } else { format!("; {name} is for {}", others.join(", ")) };
        Failure::Usage(format!("--mask {name}: {} takes {}{others}", style.name(), role_names(style)))
    };
    roles_of(style).find(|(known, _)| *known == name).map(|(_, role)| role).ok_or_else(refuse)
}

/// Parameters from the file, then from --pitch, then from --set; later ones win.
fn given(options: &PictureOptions) -> Result<Vec<(String, String)>, Failure> {
    let mut given = Vec::new();
    if let Some(path) = &options.params {
        given.extend(parameter_file(&path.to_string_lossy())?);
    }
    if let Some(pitch) = options.pitch {
        given.push(("pitch".to_owned(), pitch.to_string()));
    }
    given.extend(options.set.iter().cloned());
    Ok(given)
}

fn parameter_file(name: &str) -> Result<Vec<(String, String)>, Failure> {
    let text = output::read_settings(name)?;
    let table: toml::Table =
        text.parse().map_err(|error: toml::de::Error| Failure::Work(format!("{name}: {}", error.message())))?;
    table
        .into_iter()
        .map(|(key, value)| match value {
            toml::Value::String(text) => Ok((key, text)),
            toml::Value::Integer(number) => Ok((key, number.to_string())),
            toml::Value::Float(number) => Ok((key, number.to_string())),
            toml::Value::Boolean(is_on) => Ok((key, if is_on { "on" } else { "off" }.to_owned())),
            other => Err(Failure::Work(format!("{name}: {key} = {other} is not a string, a number or a boolean"))),
        })
        .collect()
}

pub(super) fn photograph(name: &str) -> Result<Photograph, Failure> {
    let shown = if name == "-" { "stdin" } else { name };
    Photograph::read(output::open(name)?, Limits::default()).map_err(|error| {
        let is_svg = Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
        let other = if is_svg { "; an SVG is plotted with `drypoint plot`" } else { "" };
        Failure::about(shown)(&format_args!("{error}{other}"))
    })
}

pub(super) fn limit_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build_global()
        .map_err(|error| Failure::Work(format!("cannot start {threads} threads: {error}")))
}

/// The selected layers, in the drawing's order.
fn chosen(layers: Vec<Layer>, wanted: &[String]) -> Result<Vec<Layer>, Failure> {
    if wanted.is_empty() {
        return Ok(layers);
    }
    let matches = |layer: &Layer, name: &String| layer.name == *name || layer.pen.to_string() == *name;
    if let Some(missing) = wanted.iter().find(|name| !layers.iter().any(|layer| matches(layer, name))) {
        let names: Vec<&str> = layers.iter().map(|l| l.name.as_str()).collect();
        return Err(Failure::Usage(format!("there is no layer '{missing}'; there are {}", names.join(", "))));
    }
    Ok(layers.into_iter().filter(|layer| wanted.iter().any(|name| matches(layer, name))).collect())
}

fn head(options: &DrawOptions, recipe: &Value) -> SvgHead {
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

fn report(
    options: &DrawOptions,
    drawing: &Drawing,
    pens: &PenSet,
    (files, jobs): (&[LayerFile], &[Job<'_>]),
    seconds: &[(String, f64)],
    elapsed: f64,
) -> Result<(), Failure> {
    if options.reporting.json {
        return output::print_json(&report_json(drawing, pens, (files, jobs), seconds));
    }
    if !options.reporting.quiet {
        let counts =
            drawing.layers.iter().map(Layer::counts).fold([0; 3], |sum, c| [sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]]);
        let ink: f64 = drawing.ink_mm2().iter().sum();
        let areas = if counts[2] > 0 { format!(", {}", counted(counts[2], "area")) } else { String::new() };
        say!(
            "{}: {:.1} x {:.1} mm, {}, {}{areas}, {ink:.0} mm2 of ink, in {elapsed:.1} s",
            layer_files::names(files),
            drawing.page.width,
            drawing.page.height,
            counted(counts[0], "dot"),
            counted(counts[1], "stroke")
        );
        for (file, job) in files.iter().zip(jobs) {
            let name = if files.len() > 1 { format!("{}: ", file.name) } else { String::new() };
            say!("{name}{}", toolpaths::summary(job.report()));
            toolpaths::pen_lines(job).iter().for_each(|line| say!("{line}"));
        }
    }
    Ok(())
}

fn report_json(drawing: &Drawing, pens: &PenSet, (files, jobs): (&[LayerFile], &[Job<'_>]), seconds: &[(String, f64)]) -> Value {
    let layers: Vec<Value> = drawing.layers.iter().zip(drawing.ink_mm2()).map(|(layer, ink)| {
        let [dots, strokes, areas] = layer.counts();
        json!({ "name": layer.name, "pen": layer.pen, "pen_mm": pens.nibs().of(layer.pen), "ink": layer.ink.to_string(), "dots": dots, "strokes": strokes, "areas": areas, "ink_mm2": ink })
    }).collect();
    let mut value = json!({
        "files": files.iter().map(|file| &file.name).collect::<Vec<_>>(),
        "page_mm": [drawing.page.width, drawing.page.height],
        "layers": layers,
        "seconds": seconds_of_steps(seconds),
    });
    if let Some(report) = toolpaths::combined_report(jobs) {
        value["pens"] = json!(report.pens);
        value["total"] = json!(report.total);
        value["duplicates"] = json!(jobs.iter().map(Job::duplicates).sum::<usize>());
    }
    value["warnings"] = json!(messages::warnings());
    value
}

/// Seconds by step; steps repeated for several files are summed.
pub(super) fn seconds_of_steps(seconds: &[(String, f64)]) -> serde_json::Map<String, Value> {
    seconds.iter().fold(serde_json::Map::new(), |mut sums, (step, taken)| {
        let before = sums.get(step).and_then(Value::as_f64).unwrap_or(0.0);
        sums.insert(step.clone(), json!(before + taken));
        sums
    })
}
