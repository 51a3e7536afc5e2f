//! Where an option stands in a file, so that errors found later can say so.

use crate::cli::failure::Failure;

/// An option's place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::cli) struct Origin {
    /// The file that a value names, as the option received it.
    pub path: String,
    /// Such as `portrait.toml, line 7`.
    pub place: String,
}

/// The files named in scenes and presets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::cli) struct Origins(pub Vec<Origin>);

impl Origins {
    /// Adds to a failure about a file the place where it was named.
    pub(in crate::cli) fn explain(&self, failure: Failure) -> Failure {
        let Failure::Work(message) = failure else { return failure };
        let about = |origin: &&Origin| message.strip_prefix(&origin.path).is_some_and(|rest| rest.starts_with([' ', ':', ',']));
        let place = self.0.iter().filter(about).max_by_key(|origin| origin.path.len()).map(|origin| &origin.place);
        Failure::Work(match place {
            Some(place) => format!("{place}: {message}"),
            None => message,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_about_a_named_file_tells_its_line() {
        let origins = Origins(vec![Origin { path: "a/hair.png".to_owned(), place: "a/p.toml, line 3".to_owned() }]);
        let told = origins.explain(Failure::Work("a/hair.png is 3 x 4 pixels".to_owned())).to_string();
        assert_eq!(told, "a/p.toml, line 3: a/hair.png is 3 x 4 pixels");
        let other = origins.explain(Failure::Work("a/hair.png2 is missing".to_owned())).to_string();
        assert_eq!(other, "a/hair.png2 is missing");
    }
}
