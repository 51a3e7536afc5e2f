//! A file of pens with their colours as measured; all else stays as it was written, comments too.

use toml_edit::{Array, DocumentMut, Item, Value};

/// Decimals of L\*, a\* and b\*: nobody sees a tenth.
const TENTHS: f64 = 10.0;

/// The file's text with the colours L\*, a\*, b\* of pens by their tables' names; `None` if a pen is not in it.
pub(super) fn with_colours(text: &str, colours: &[(&str, [f64; 3])]) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    for (name, lab) in colours {
        let pen = document.get_mut(name)?.as_table_like_mut()?;
        let mut value = Value::Array(lab.map(|v| (v * TENTHS).round() / TENTHS + 0.0).into_iter().collect::<Array>());
        match pen.get_mut("lab").and_then(Item::as_value_mut) {
            Some(old) => {
                *value.decor_mut() = old.decor().clone();
                *old = value;
            }
            None => drop(pen.insert("lab", Item::Value(value))),
        }
    }
    Some(document.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_colours_change() {
        let text = "# mine\n[a]\ncolour = \"red\" # cap\nslot = 2\n\n[b]\nlab = [1, 2, 3] # old\nspeed = 3\n";
        let made = with_colours(text, &[("a", [52.04, 70.0, -0.01]), ("b", [10.26, 0.0, -4.5])]).unwrap();
        assert_eq!(
            made,
            "# mine\n[a]\ncolour = \"red\" # cap\nslot = 2\nlab = [52.0, 70.0, 0.0]\n\n[b]\nlab = [10.3, 0.0, -4.5] # old\nspeed = 3\n"
        );
    }

    #[test]
    fn tables_in_line_and_dotted_keys_are_kept() {
        let made = with_colours("a = { slot = 1 }\nb.slot = 2\n", &[("a", [1.0; 3]), ("b", [2.0; 3])]).unwrap();
        let read: toml::Table = toml::from_str(&made).unwrap();
        assert_eq!(read["a"]["lab"].as_array().map(Vec::len), Some(3), "{made}");
        assert_eq!((read["b"]["lab"][0].as_float(), read["b"]["slot"].as_integer()), (Some(2.0), Some(2)), "{made}");
        assert_eq!(with_colours("[a]\n", &[("b", [1.0; 3])]), None);
    }
}
