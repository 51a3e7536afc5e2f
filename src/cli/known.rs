//! What is known about a photograph before it is drawn. Decided here role by role: a mask given by the user, else one in the
//! `--sight` folder, else what detection finds. If no face is found, nothing detected is used.

use super::arguments::{Background, PictureOptions, Tone};
use super::failure::Failure;
use super::masks::{RoleMask, photograph};
use super::roles::ALWAYS;
use super::seen::{Depth, Seen};
use super::words::counted;
use crate::source::{Landmarks, MaskRole, Photograph, ToneTarget};
use crate::style::Style;
use crate::tone;
use std::sync::Arc;

/// The inputs of a drawing other than the photograph.
pub(super) struct Known {
    pub masks: Vec<RoleMask>,
    /// Mask of the people if the background is drawn too; the portrait tone uses it.
    pub people: Option<RoleMask>,
    pub faces: Vec<Landmarks>,
    pub depth: Option<Depth>,
    pub tone: Wanted,
    /// What was found but this style does not use; `stages` shows it.
    pub unused: Seen,
    /// Notices about these decisions, each with the option that reverses it.
    pub notices: Vec<String>,
}

impl Known {
    /// True if portraits made with both on one grid are the same. The faces are always those of the photograph.
    pub(super) fn makes_the_same_as(&self, other: &Self) -> bool {
        let masks = |known: &Self| -> Vec<_> {
            known.masks.iter().chain(&known.people).map(|mask| (mask.role, Arc::as_ptr(&mask.mask))).collect()
        };
        let depth = |known: &Self| known.depth.as_ref().map(|depth| Arc::as_ptr(&depth.map));
        masks(self) == masks(other)
            && self.people.is_some() == other.people.is_some()
            && depth(self) == depth(other)
            && self.tone == other.tone
    }
}

/// The tone that the ink reproduces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Wanted {
    /// The photograph's own tone.
    Own(ToneTarget),
    /// The portrait tone, with its strength from 0 to 1.
    Portrait(f64),
}

/// True if a style or the tone uses masks of a role.
pub(super) fn takes(style: &dyn Style, role: MaskRole) -> bool {
    style.masks().contains(&role) || tone::ROLES.contains(&role) || ALWAYS.contains(&role)
}

/// Makes the decisions for a style; `painted` are the masks given by the user.
pub(super) fn of(
    options: &PictureOptions,
    style: &dyn Style,
    photograph: &Photograph,
    painted: Vec<RoleMask>,
    mut seen: Seen,
) -> Result<Known, Failure> {
    let tone = wanted_tone(options, &seen)?;
    let mut known = Known {
        masks: painted,
        people: None,
        faces: seen.faces.clone(),
        depth: depth(options)?,
        tone,
        unused: Seen::default(),
        notices: Vec::new(),
    };
    decide_background(&mut known, &mut seen, options, style, photograph.is_cut_out())?;
    let by_tone: &[MaskRole] = if matches!(known.tone, Wanted::Portrait(_)) { tone::ROLES } else { &[] };
    for role in style.masks().iter().chain(by_tone).chain(ALWAYS).filter(|role| **role != MaskRole::Subject) {
        if known.masks.iter().all(|mask| mask.role != *role) {
            known.masks.extend(seen.take(*role));
        }
    }
    if style.card().uses_depth && known.depth.is_none() {
        known.depth = seen.depth.take();
    }
    add_tone_notice(&mut known, options);
    add_idle_mask_notices(&mut known, style);
    known.unused = seen;
    Ok(known)
}

/// The portrait tone if there are faces, unless `--tone` says otherwise.
fn wanted_tone(options: &PictureOptions, seen: &Seen) -> Result<Wanted, Failure> {
    let has_faces = !seen.faces.is_empty();
    match options.tone {
        Some(Tone::Lightness) => Ok(Wanted::Own(ToneTarget::Lightness)),
        Some(Tone::Linear) => Ok(Wanted::Own(ToneTarget::Linear)),
        Some(Tone::Portrait) if !has_faces => {
            let lack = seen.lack.as_deref().unwrap_or("there are no faces in sight.json");
            Err(Failure::Work(format!(
                "{}: {lack}, and --tone portrait needs a face; --tone lightness needs none",
                options.photo
            )))
        }
        None if !has_faces => Ok(Wanted::Own(ToneTarget::Lightness)),
        Some(Tone::Portrait) | None => Ok(Wanted::Portrait(options.tone_strength)),
    }
}

fn depth(options: &PictureOptions) -> Result<Option<Depth>, Failure> {
    options.depth.as_ref().map(|file| Ok(Depth { map: Arc::new(photograph(file)?), file: Some(file.clone()) })).transpose()
}

/// Decides whether the background is drawn.
fn decide_background(
    known: &mut Known,
    seen: &mut Seen,
    options: &PictureOptions,
    style: &dyn Style,
    is_cut_out: bool,
) -> Result<(), Failure> {
    let is_left_out = match options.background {
        Background::Auto => style.card().leaves_out_background,
        Background::Keep => false,
        Background::None => true,
    };
    let is_given = is_cut_out || known.masks.iter().any(|mask| mask.role == MaskRole::Subject);
    if is_given {
        return Ok(());
    }
    let subject = seen.take(MaskRole::Subject);
    if !is_left_out {
        known.people = subject;
        return Ok(());
    }
    if let Some(subject) = subject {
        if subject.file.is_none() {
            let faces = counted(seen.faces.len(), "face");
            known.notices.push(format!("background left out: {faces} found; --background keep draws it"));
        }
        known.masks.push(subject);
        return Ok(());
    }
    let lack = seen
        .lack
        .clone()
        .unwrap_or_else(|| format!("there is no subject.png in {}", options.sight.as_deref().unwrap_or("the sight's folder")));
    if options.background == Background::None {
        return Err(Failure::Work(format!(
            "{}: {lack}, so --background none does not know what to leave out; give --mask subject=FILE",
            options.photo
        )));
    }
    known.notices.push(format!("background drawn: {lack}; --mask subject=FILE leaves it out"));
    Ok(())
}

fn add_tone_notice(known: &mut Known, options: &PictureOptions) {
    if options.tone.is_none() && matches!(known.tone, Wanted::Portrait(_)) {
        known.notices.push("tone made for the face; --tone lightness keeps the photograph's".to_owned());
    }
}

/// Adds a notice for each given mask that only the portrait tone uses, if the portrait tone is off.
fn add_idle_mask_notices(known: &mut Known, style: &dyn Style) {
    if matches!(known.tone, Wanted::Portrait(_)) {
        return;
    }
    let idle = known
        .masks
        .iter()
        .filter(|mask| mask.role != MaskRole::Subject && !style.masks().contains(&mask.role) && !ALWAYS.contains(&mask.role));
    let told = idle.map(|mask| format!("--mask {} changes nothing here: only the portrait tone uses it", mask.name()));
    let told: Vec<String> = told.collect();
    known.notices.extend(told);
}
