//! Whether what is behind a person is drawn. One place decides: a mask or alpha that is given, else what is found in the photograph,
//! else nothing is left out.

use super::arguments::{Background, PictureOptions};
use super::draw::RoleMask;
use super::failure::Failure;
use super::interruption::interrupt;
use super::words::counted;
use crate::see::{SeeError, can_see, look};
use crate::source::{MaskRole, Photograph};
use crate::style::Style;

/// The subject found in the photograph, where it is wanted and none is given, and what to tell the user.
pub(super) fn decide(
    options: &PictureOptions,
    style: &dyn Style,
    photograph: &Photograph,
    has_subject: bool,
) -> Result<(Option<RoleMask>, Option<String>), Failure> {
    let is_wanted = match options.background {
        Background::Auto => style.leaves_out_background(),
        Background::Keep => false,
        Background::None => true,
    };
    if !is_wanted || has_subject || photograph.is_cut_out() {
        return Ok((None, None));
    }
    let reason = if options.sight.is_some() {
        "there is no subject.png in --sight".to_owned()
    } else if can_see() {
        match found(options, photograph)? {
            Ok(found) => return Ok(found),
            Err(reason) => reason,
        }
    } else {
        "this drypoint was built without the networks that find faces (cargo feature `see`)".to_owned()
    };
    if options.background == Background::None {
        return Err(Failure::Work(format!(
            "{}: {reason}, so it is not known what --background none leaves out; say it with --mask subject=FILE",
            options.photo
        )));
    }
    Ok((None, Some(format!("background drawn: {reason}; --mask subject=FILE leaves it out"))))
}

/// The people found, or why there are none.
#[allow(clippy::type_complexity)]
fn found(
    options: &PictureOptions,
    photograph: &Photograph,
) -> Result<Result<(Option<RoleMask>, Option<String>), String>, Failure> {
    let sight = look(photograph, interrupt()).map_err(|error| failure(&options.photo, error))?;
    let Some(subject) = &sight.subject else { return Ok(Err("no face found".to_owned())) };
    let mask = RoleMask { role: MaskRole::Subject, file: None, mask: Photograph::from_grey(subject) };
    let notice = format!("background left out: {} found; --background keep draws it", counted(sight.faces.len(), "face"));
    Ok(Ok((Some(mask), Some(notice))))
}

/// What a photograph that could not be looked at means.
pub(super) fn failure(photo: &str, error: SeeError) -> Failure {
    match error {
        SeeError::Interrupted(stopped) => stopped.into(),
        other => Failure::about(photo)(&other),
    }
}
