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

/// What was decided.
#[derive(Default)]
pub(super) struct Decision {
    /// The subject found in the photograph, where it is wanted and none is given.
    pub found: Option<RoleMask>,
    /// What the user is told of it, and how to have the other.
    pub notice: Option<String>,
}

/// Looks at the photograph if that decides.
pub(super) fn decide(
    options: &PictureOptions,
    style: &dyn Style,
    photograph: &Photograph,
    has_subject: bool,
) -> Result<Decision, Failure> {
    let is_wanted = match options.background {
        Background::Auto => style.leaves_out_background(),
        Background::Keep => false,
        Background::None => true,
    };
    if !is_wanted || has_subject || photograph.is_cut_out() {
        return Ok(Decision::default());
    }
    let reason = if let Some(folder) = &options.sight {
        format!("there is no subject.png in {folder}")
    } else if !can_see() {
        "this drypoint was built without the networks that find faces (cargo feature `see`)".to_owned()
    } else {
        let sight = look(photograph, interrupt()).map_err(|error| failure(&options.photo, error))?;
        if let Some(subject) = &sight.subject {
            let faces = counted(sight.faces.len(), "face");
            return Ok(Decision {
                found: Some(RoleMask { role: MaskRole::Subject, file: None, mask: Photograph::from_grey(subject) }),
                notice: Some(format!("background left out: {faces} found; --background keep draws it")),
            });
        }
        "no face found".to_owned()
    };
    if options.background == Background::None {
        return Err(Failure::Work(format!(
            "{}: {reason}, so it is not known what --background none leaves out; say it with --mask subject=FILE",
            options.photo
        )));
    }
    Ok(Decision { found: None, notice: Some(format!("background drawn: {reason}; --mask subject=FILE leaves it out")) })
}

/// What a photograph that could not be looked at means.
pub(super) fn failure(photo: &str, error: SeeError) -> Failure {
    match error {
        SeeError::Interrupted(stopped) => stopped.into(),
        other => Failure::about(photo)(&other),
    }
}
