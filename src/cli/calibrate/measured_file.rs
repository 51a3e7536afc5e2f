//! A file of pens with their colours as measured; all else stays as it was written, comments too.

use toml_edit::{Array, DocumentMut, InlineTable, Item, TableLike, Value};

/// Decimals of L\*, a\* and b\*: nobody sees a tenth.
const TENTHS: f64 = 10.0;

/// A pen as measured, by its table's name.
pub(super) struct MeasuredPen<'a> {
    pub name: &'a str,
    /// L\*, a\*, b\*.
    pub colour: [f64; 3],
    /// Its colours over other pens, by their names.
    pub over: Vec<(&'a str, [f64; 3])>,
    /// Its colour over all other pens together.
    pub over_all: Option<[f64; 3]>,
}

/// The file's text with the pens' colours; `None` if a pen is not in it.
pub(super) fn with_colours(text: &str, pens: &[MeasuredPen<'_>]) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    for MeasuredPen { name, colour, over, over_all } in pens {
        let pen = document.get_mut(name)?.as_table_like_mut()?;
        set(pen, "lab", Value::Array(rounded(*colour)));
        if !over.is_empty() {
            let table: InlineTable = over.iter().map(|(lower, colour)| (*lower, Value::Array(rounded(*colour)))).collect();
            pen.remove("over");
            set(pen, "over", Value::InlineTable(table));
        }
        if let Some(colour) = over_all {
            set(pen, "over_all", Value::Array(rounded(*colour)));
        }
    }
    Some(document.to_string())
}

fn rounded(lab: [f64; 3]) -> Array {
    lab.map(|v| (v * TENTHS).round() / TENTHS + 0.0).into_iter().collect()
}

/// Sets a key; the comment beside an old value stays.
fn set(pen: &mut dyn TableLike, key: &str, mut value: Value) {
    match pen.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        None => drop(pen.insert(key, Item::Value(value))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pen(name: &str, colour: [f64; 3]) -> MeasuredPen<'_> {
        MeasuredPen { name, colour, over: Vec::new(), over_all: None }
    }

    #[test]
    fn overprints_stand_with_the_upper_pen() {
        let (over, over_all) = (vec![("a b", [30.04, -1.0, 2.0])], Some([9.0, 0.5, 0.0]));
        let upper = MeasuredPen { over, over_all, ..pen("c", [50.0, 0.0, 0.0]) };
        let made = with_colours("[\"a b\"]\n[c]\nslot = 2\nover.x = [1, 2, 3]\n", &[pen("a b", [1.0; 3]), upper]).unwrap();
        let read: toml::Table = toml::from_str(&made).unwrap();
        assert_eq!(read["c"]["over"].to_string(), "{ \"a b\" = [30.0, -1.0, 2.0] }", "{made}");
        assert_eq!(read["c"]["over_all"].to_string(), "[9.0, 0.5, 0.0]", "{made}");
        assert!(!read["a b"].as_table().unwrap().contains_key("over") && read["c"]["slot"].as_integer() == Some(2), "{made}");
    }

    #[test]
    fn only_colours_change() {
        let text = "# mine\n[a]\ncolour = \"red\" # cap\nslot = 2\n\n[b]\nlab = [1, 2, 3] # old\nspeed = 3\n";
        let made = with_colours(text, &[pen("a", [52.04, 70.0, -0.01]), pen("b", [10.26, 0.0, -4.5])]).unwrap();
        assert_eq!(
            made,
            "# mine\n[a]\ncolour = \"red\" # cap\nslot = 2\nlab = [52.0, 70.0, 0.0]\n\n[b]\nlab = [10.3, 0.0, -4.5] # old\nspeed = 3\n"
        );
    }

    #[test]
    fn tables_in_line_and_dotted_keys_are_kept() {
        let made = with_colours("a = { slot = 1 }\nb.slot = 2\n", &[pen("a", [1.0; 3]), pen("b", [2.0; 3])]).unwrap();
        let read: toml::Table = toml::from_str(&made).unwrap();
        assert_eq!(read["a"]["lab"].as_array().map(Vec::len), Some(3), "{made}");
        assert_eq!((read["b"]["lab"][0].as_float(), read["b"]["slot"].as_integer()), (Some(2.0), Some(2)), "{made}");
        assert_eq!(with_colours("[a]\n", &[pen("b", [1.0; 3])]), None);
    }
}
