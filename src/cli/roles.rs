//! Which masks which style takes.

use super::known::takes;
use crate::source::MaskRole;
use crate::style::{STYLES, Style};

/// The masks that change the tone of every drawing.
pub(super) const ALWAYS: &[MaskRole] = &[MaskRole::Highlights];

/// The mask roles that a style or the tone takes, with their names.
pub(super) fn roles_of(style: &dyn Style) -> impl Iterator<Item = (&'static str, MaskRole)> {
    MaskRole::ALL.into_iter().filter(|(_, role)| takes(style, *role))
}

pub(super) fn role_names(style: &dyn Style) -> String {
    roles_of(style).map(|(name, _)| name).collect::<Vec<_>>().join(", ")
}

/// The styles that take a role of this name.
pub(super) fn styles_with_role(name: &str) -> impl Iterator<Item = &'static dyn Style> {
    STYLES.iter().copied().filter(move |style| roles_of(*style).any(|(known, _)| known == name))
}

/// The help of `--mask`: what each style takes.
pub(super) fn mask_roles() -> String {
    let styles: Vec<String> = STYLES.iter().map(|style| format!("{} takes {}", style.name(), role_names(*style))).collect();
    format!(
        "A mask with the photograph's proportions, a picture that is white inside or an SVG whose shapes are the inside, such as --mask subject=cutout.png, or for charcoal --mask face=face.png \
         --mask hair=hair.png; once per role. Of the styles, {}; `drypoint styles NAME` explains each role",
        styles.join("; ")
    )
}
