//! PDF for print: one page at exact size, the drawing's ink as vectors, its layers as optional content. There are no fonts.
//!
//! ```text
//! catalog   optional-content groups, named like the SVG's layers; XMP metadata with the recipe
//! page      MediaBox = TrimBox = the drawing's page
//! contents  /OC /L0 BDC q (ink) marks Q EMC          one block per layer
//! ```
//!
//! Ink `k` is `DeviceGray`, which a press puts on the black plate alone; `spot:NAME` is a Separation; colours are `DeviceRGB`
//! (ISO 32000-1, 8.6). Ink on ink overprints where it has plates of its own; colours are multiplied, each layer as a transparency
//! group (11.6.6).

mod content;
mod ink;
mod metadata;

use crate::drawing::{Colour, Drawing};
use crate::parallel::mapped;
use crate::write::SvgHead;
use content::Content;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use ink::Inks;
use pdf_writer::types::{BlendMode, OverprintMode};
use pdf_writer::{Chunk, Dict, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use sha2::{Digest, Sha256};
use std::io::{self, Write};

/// PDF points per millimetre.
const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// Maximum side of a page in units (Acrobat's limit, ISO 32000-1, annex C); on a larger sheet each unit is several points.
const MOST_UNITS: f64 = 14_400.0;
/// Compression level, 0 to 10: one higher saves a percent and takes half as long again.
const COMPRESSION: Compression = Compression::new(6);

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const INFO: Ref = Ref::new(4);
const METADATA: Ref = Ref::new(5);
const KNOCK_OUT: Ref = Ref::new(6);
const OVERPRINT: Ref = Ref::new(7);
const MULTIPLY: Ref = Ref::new(8);
const PAPER: Ref = Ref::new(9);
const FIRST_LAYER: i32 = 10;

/// Writes a drawing with its ink at exact size. `seconds` since 1970 is the file's date, if any.
///
/// The ink is that of [`write_svg`](crate::write::write_svg): the same coordinates on the same grid.
pub fn write_pdf(drawing: &Drawing, head: &SvgHead, seconds: Option<u64>, out: &mut impl io::Write) -> io::Result<()> {
    let scale = Scale::of(drawing);
    let inks = Inks::of(&drawing.layers);
    let content = Content::of(drawing, &inks, scale.units_per_mm);
    let texts: Vec<&String> = content.pieces.iter().chain(content.groups.iter().map(|(_, text)| text)).collect();
    let streams: Vec<Vec<u8>> = mapped(&texts, &|text| compressed(text.as_bytes())).into_iter().collect::<io::Result<_>>()?;
    let layers: Vec<Ref> = (0..drawing.layers.len()).map(|i| Ref::new(FIRST_LAYER + i as i32)).collect();
    let written: Vec<Ref> = (0..streams.len()).map(|i| Ref::new(FIRST_LAYER + (layers.len() + i) as i32)).collect();
    let (contents, grouped) = written.split_at(content.pieces.len());
    let groups: Vec<(usize, Ref)> = content.groups.iter().map(|(layer, _)| *layer).zip(grouped.iter().copied()).collect();

    let mut pdf = Pdf::new();
    catalog(&mut pdf, drawing, &layers);
    page(&mut pdf, drawing, &Parts { inks: &inks, layers: &layers, contents, groups: &groups }, scale);
    graphics_states(&mut pdf);
    for (id, stream) in contents.iter().zip(&streams) {
        pdf.stream(*id, stream).filter(Filter::FlateDecode);
    }
    for (id, stream) in grouped.iter().zip(&streams[contents.len()..]) {
        group(&mut pdf, *id, stream, drawing);
    }
    metadata::info(&mut pdf.document_info(INFO), head, seconds);
    let packet = metadata::packet(head, seconds);
    pdf.metadata(METADATA, packet.as_bytes());
    let id = identifier(&streams, &packet);
    pdf.set_file_id((id.clone(), id));
    out.write_all(&pdf.finish())
}

fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut out = ZlibEncoder::new(Vec::new(), COMPRESSION);
    out.write_all(bytes)?;
    out.finish()
}

/// Conversion of millimetres to the file's units.
#[derive(Clone, Copy)]
struct Scale {
    units_per_mm: f64,
    /// Points per unit: 1, except for very large sheets.
    user_unit: f64,
}

impl Scale {
    fn of(drawing: &Drawing) -> Self {
        let longest = drawing.page.width.max(drawing.page.height) * POINTS_PER_MM;
        let user_unit = (longest / MOST_UNITS).ceil().max(1.0);
        Self { units_per_mm: POINTS_PER_MM / user_unit, user_unit }
    }
}

fn has_paper(drawing: &Drawing) -> bool {
    drawing.page.paper != Colour::WHITE
}

fn catalog(pdf: &mut Pdf, drawing: &Drawing, layers: &[Ref]) {
    let mut groups = layers.to_vec();
    if has_paper(drawing) {
        groups.insert(0, PAPER);
    }
    let mut catalog = pdf.catalog(CATALOG);
    catalog.pages(PAGES).metadata(METADATA);
    let mut properties = catalog.insert(Name(b"OCProperties")).dict();
    properties.insert(Name(b"OCGs")).array().items(&groups);
    let mut shown = properties.insert(Name(b"D")).dict();
    shown.pair(Name(b"BaseState"), Name(b"ON"));
    shown.insert(Name(b"Order")).array().items(&groups);
    if has_paper(drawing) {
        let mut events = shown.insert(Name(b"AS")).array();
        for event in [Name(b"View"), Name(b"Print")] {
            let mut rule = events.push().dict();
            rule.pair(Name(b"Event"), event);
            rule.insert(Name(b"Category")).array().item(event);
            rule.insert(Name(b"OCGs")).array().item(PAPER);
        }
    }
    shown.finish();
    properties.finish();
    catalog.finish();
    pdf.pages(PAGES).kids([PAGE]).count(1);
    for (id, layer) in layers.iter().zip(&drawing.layers) {
        let label = format!("{} {}", layer.pen, layer.name);
        pdf.indirect(*id).dict().pair(Name(b"Type"), Name(b"OCG")).pair(Name(b"Name"), TextStr(&label));
    }
    if has_paper(drawing) {
        paper_group(pdf);
    }
}

/// Adds the optional-content group of the paper's colour, which is shown but not printed.
fn paper_group(chunk: &mut Chunk) {
    let mut group = chunk.indirect(PAPER).dict();
    group.pair(Name(b"Type"), Name(b"OCG")).pair(Name(b"Name"), TextStr("paper"));
    let mut usage = group.insert(Name(b"Usage")).dict();
    usage.insert(Name(b"View")).dict().pair(Name(b"ViewState"), Name(b"ON"));
    usage.insert(Name(b"Print")).dict().pair(Name(b"PrintState"), Name(b"OFF"));
}

/// What a page refers to.
struct Parts<'a> {
    inks: &'a Inks<'a>,
    layers: &'a [Ref],
    contents: &'a [Ref],
    /// Groups of marks, by the number of their layer.
    groups: &'a [(usize, Ref)],
}

fn page(pdf: &mut Pdf, drawing: &Drawing, parts: &Parts<'_>, scale: Scale) {
    let sheet =
        Rect::new(0.0, 0.0, (drawing.page.width * scale.units_per_mm) as f32, (drawing.page.height * scale.units_per_mm) as f32);
    let mut page = pdf.page(PAGE);
    page.parent(PAGES).media_box(sheet).trim_box(sheet).contents_array(parts.contents.iter().copied());
    if scale.user_unit > 1.0 {
        page.user_unit(scale.user_unit as f32);
    }
    if !parts.groups.is_empty() {
        page.group().transparency().color_space().device_rgb();
    }
    let mut resources = page.resources();
    spaces(&mut resources.color_spaces(), &parts.inks.spots);
    if !parts.inks.spots.is_empty() || !parts.groups.is_empty() {
        let mut states = resources.ext_g_states();
        states.pair(Name(ink::KNOCK_OUT.as_bytes()), KNOCK_OUT).pair(Name(ink::OVERPRINT.as_bytes()), OVERPRINT);
        states.pair(Name(ink::MULTIPLY.as_bytes()), MULTIPLY);
    }
    if !parts.groups.is_empty() {
        let mut forms = resources.x_objects();
        for (layer, id) in parts.groups {
            forms.pair(Name(content::group_name(*layer).as_bytes()), *id);
        }
    }
    let mut groups = resources.insert(Name(b"Properties")).dict();
    for (i, id) in parts.layers.iter().enumerate() {
        groups.pair(Name(content::layer_name(i).as_bytes()), *id);
    }
    if has_paper(drawing) {
        groups.pair(Name(content::PAPER.as_bytes()), PAPER);
    }
}

/// The spot inks: tint 0 is white, and 1 their colour on screen, as in the SVG.
fn spaces(spaces: &mut Dict<'_>, spots: &[(&str, Colour)]) {
    for (i, (name, shown)) in spots.iter().enumerate() {
        let mut separation = spaces
            .insert(Name(ink::space_name(i).as_bytes()))
            .start::<pdf_writer::writers::ColorSpace>()
            .separation(Name(name.as_bytes()));
        let [r, g, b] = [shown.r, shown.g, shown.b].map(|v| f32::from(v) / 255.0);
        if r == g && g == b {
            separation.alternate_color_space().device_gray();
            separation.tint_exponential().domain([0.0, 1.0]).range([0.0, 1.0]).c0([1.0]).c1([r]).n(1.0);
        } else {
            separation.alternate_color_space().device_rgb();
            let all = [0.0, 1.0, 0.0, 1.0, 0.0, 1.0];
            separation.tint_exponential().domain([0.0, 1.0]).range(all).c0([1.0; 3]).c1([r, g, b]).n(1.0);
        }
    }
}

/// A layer's marks as one group, in which they cover one another, in millimetres.
fn group(pdf: &mut Pdf, id: Ref, stream: &[u8], drawing: &Drawing) {
    let mut group = pdf.form_xobject(id, stream);
    group.filter(Filter::FlateDecode);
    group.bbox(Rect::new(0.0, 0.0, drawing.page.width as f32, drawing.page.height as f32));
    group.group().transparency().isolated(true).color_space().device_rgb();
    group.resources().ext_g_states().pair(Name(ink::KNOCK_OUT.as_bytes()), KNOCK_OUT);
}

fn graphics_states(chunk: &mut Chunk) {
    chunk.ext_graphics(KNOCK_OUT).overprint(false).overprint_fill(false);
    chunk.ext_graphics(OVERPRINT).overprint(true).overprint_fill(true).overprint_mode(OverprintMode::IgnoreZeroChannel);
    chunk.ext_graphics(MULTIPLY).blend_mode(BlendMode::Multiply);
}

/// The file identifier, a hash of the content: the same drawing gets the same identifier.
fn identifier(streams: &[Vec<u8>], packet: &str) -> Vec<u8> {
    let mut hash = Sha256::new();
    for stream in streams {
        hash.update(stream);
    }
    hash.update(packet);
    hash.finalize()[..16].to_vec()
}

#[cfg(test)]
mod tests;
