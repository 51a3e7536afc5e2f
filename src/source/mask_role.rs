//! What a mask is for.

/// What a mask means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MaskRole {
    /// What is drawn; the rest is background.
    Subject,
    /// Where finer detail is drawn.
    Detail,
    /// Hair.
    Hair,
    /// The face.
    Face,
    /// Clothing.
    Clothing,
    /// Bare skin.
    Skin,
    /// Beards and moustaches.
    FacialHair,
    /// Hats, caps, scarves.
    Headwear,
    /// Hand-made edges, as white lines.
    Edges,
    /// Hand-made isophotes, as white lines.
    Isophotes,
    /// Lines along which marks run.
    Directions,
    /// Where the paper stays open.
    Highlights,
    /// One colour for each region.
    Scribbles,
}

impl MaskRole {
    /// Every role and its name on the command line.
    pub const ALL: [(&'static str, Self); 13] = [
        ("subject", Self::Subject),
        ("detail", Self::Detail),
        ("hair", Self::Hair),
        ("face", Self::Face),
        ("clothing", Self::Clothing),
        ("skin", Self::Skin),
        ("facial-hair", Self::FacialHair),
        ("headwear", Self::Headwear),
        ("edges", Self::Edges),
        ("isophotes", Self::Isophotes),
        ("directions", Self::Directions),
        ("highlights", Self::Highlights),
        ("scribbles", Self::Scribbles),
    ];

    /// The role of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, role)| *role)
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, role)| *role == self).map_or("", |(name, _)| name)
    }

    /// What the mask's picture shows, for the user.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Subject => "what is drawn, white; the rest is background (without this mask: the photograph's alpha)",
            Self::Detail => "where dots are denser, white, such as the eyes",
            Self::Hair => "hair, white, drawn in flowing strokes",
            Self::Face => "the face, white, where eyes, nose and mouth are detected and drawn",
            Self::Clothing => "clothing, white, shaded freehand where it is dark",
            Self::Skin => "bare skin, white, where the portrait tone evens out light and shadow",
            Self::FacialHair => "beards and moustaches, white",
            Self::Headwear => "hats, caps and scarves, white",
            Self::Edges => {
                "edges as white lines, instead of the detected ones (charcoal: which detected edges to keep, and more to add)"
            }
            Self::Isophotes => "isophotes as white lines, instead of the detected ones",
            Self::Directions => "white lines along which marks run near them, instead of the direction found",
            Self::Highlights => "where the paper stays open, white; grey is lighter than the photograph",
            Self::Scribbles => "one flat colour scribbled into each region, on black or transparent",
        }
    }
}
