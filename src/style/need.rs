//! Conditions for a parameter to have an effect: other settings, a mask, no depth map. They stand in the parameter tables and are
//! checked in one place, so that a new style warns of idle settings without code of its own.

use super::Settings;
use crate::source::{MaskRole, Portrait};

/// One condition of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Need {
    /// A choice is one of these words.
    Word(&'static str, &'static [&'static str]),
    /// A number, a count or a length in millimetres lies above this.
    Above(&'static str, f64),
    /// A length lies below this number of pitches.
    BelowPitches(&'static str, f64),
    /// A number or a length is not 0.
    Nonzero(&'static str),
    /// A number is 0.
    Zero(&'static str),
    /// This mask is given.
    With(MaskRole),
    /// This mask is not given.
    Without(MaskRole),
    /// No depth map is given.
    WithoutDepth,
    /// A depth map is given, not estimated.
    WithGivenDepth,
    /// No depth map is given; one may be estimated.
    WithoutGivenDepth,
    /// A face is known.
    WithFace,
    /// No face is known.
    WithoutFace,
    /// All conditions of at least one of these lists.
    AnyOf(&'static [&'static [Self]]),
}

impl Need {
    /// True if this portrait and these settings meet it.
    pub fn is_met(&self, settings: &Settings, portrait: &Portrait) -> bool {
        let has = |role: &MaskRole| match role {
            MaskRole::Scribbles => portrait.scribbles.is_some(),
            role => portrait.masks.contains_key(role),
        };
        match self {
            Self::Word(name, words) => words.contains(&settings.word(name)),
            Self::Above(name, least) => settings.number(name) > *least,
            Self::BelowPitches(name, most) => settings.pitch().is_some_and(|pitch| settings.number(name) < most * pitch),
            Self::Nonzero(name) => settings.number(name) != 0.0,
            Self::Zero(name) => settings.number(name) == 0.0,
            Self::With(role) => has(role),
            Self::Without(role) => !has(role),
            Self::WithoutDepth => portrait.depth.is_none(),
            Self::WithGivenDepth => portrait.has_given_depth(),
            Self::WithoutGivenDepth => !portrait.has_given_depth(),
            Self::WithFace => !portrait.faces.is_empty(),
            Self::WithoutFace => portrait.faces.is_empty(),
            Self::AnyOf(lists) => lists.iter().any(|all| all.iter().all(|need| need.is_met(settings, portrait))),
        }
    }

    /// The condition in words.
    pub fn text(&self) -> String {
        match self {
            Self::Word(name, words) => format!("{name}={}", words.join(" or ")),
            Self::Above(name, least) => format!("{name} above {least}"),
            Self::BelowPitches(name, most) => format!("{name} below {} pitches", (most * 100.0).round() / 100.0),
            Self::Nonzero(name) => format!("{name} other than 0"),
            Self::Zero(name) => format!("{name}=0"),
            Self::With(role) => format!("the {} mask", role.name()),
            Self::Without(role) => format!("no {} mask", role.name()),
            Self::WithoutDepth => "no depth map".to_owned(),
            Self::WithGivenDepth => "a depth map".to_owned(),
            Self::WithoutGivenDepth => "no depth map of one's own".to_owned(),
            Self::WithFace => "a face".to_owned(),
            Self::WithoutFace => "no face".to_owned(),
            Self::AnyOf(lists) => lists.iter().map(|all| all_text(all)).collect::<Vec<_>>().join(", or "),
        }
    }
}

/// All conditions of a list, in words.
pub(super) fn all_text(needs: &[Need]) -> String {
    needs.iter().map(Need::text).collect::<Vec<_>>().join(" and ")
}
