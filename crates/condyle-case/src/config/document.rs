//! Changes of a parsed file before it is read: keys with new names, and values set from outside.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Most dots of a path whose tables are added; no key of a case or study has as many. The reader of a document recurses
/// into its tables, so a path from outside must not nest them at will.
const MAX_DOTS: usize = 16;

/// Returns the value at a dotted path; a table of a list is found by its `name`.
pub(crate) fn value_at<'a, 'i>(
    table: &'a DeTable<'i>,
    path: &str,
) -> Option<&'a Spanned<DeValue<'i>>> {
    let (first, rest) = path.split_once('.').unwrap_or((path, ""));
    let value = table.get(first)?;
    match value.get_ref() {
        _ if rest.is_empty() => Some(value),
        DeValue::Table(inside) => value_at(inside, rest),
        DeValue::Array(list) => {
            let (name, rest) = rest.split_once('.')?;
            let mut tables = list.iter().filter_map(|item| item.get_ref().as_table());
            value_at(tables.find(|table| is_called(table, name))?, rest)
        }
        _ => None,
    }
}

fn is_called(table: &DeTable<'_>, name: &str) -> bool {
    let called = table.get("name").and_then(|value| value.get_ref().as_str());
    called == Some(name)
}

/// Removes the entry at a dotted path, and returns the place of its key and its value.
pub(crate) fn take<'i>(
    table: &mut DeTable<'i>,
    path: &str,
) -> Option<(Range<usize>, Spanned<DeValue<'i>>)> {
    let (above, name) = path.rsplit_once('.').unwrap_or(("", path));
    let (key, value) = table_at(table, above, None)?.remove_entry(name)?;
    Some((key.span(), value))
}

/// Moves the entry at the dotted path `from`, with its place, to `to`, unless that is given too.
pub(crate) fn rename(table: &mut DeTable<'_>, from: &str, to: &str) -> bool {
    if value_at(table, to).is_some() {
        return false;
    }
    let Some((place, value)) = take(table, from) else {
        return false;
    };
    set_value(table, to, place, value);
    true
}

/// Puts `value` at a dotted path, whose key is at `place`; tables that are missing are added. A path with more than
/// [`MAX_DOTS`] dots is put as one key of `table`, which the reader reports as unknown.
pub(crate) fn set_value<'i>(
    table: &mut DeTable<'i>,
    path: &str,
    place: Range<usize>,
    value: Spanned<DeValue<'i>>,
) {
    let is_deep = path.matches('.').nth(MAX_DOTS).is_some();
    let split = path.rsplit_once('.').filter(|_| !is_deep);
    let (above, name) = split.unwrap_or(("", path));
    if let Some(table) = table_at(table, above, Some(&place)) {
        table.remove(name);
        table.insert(Spanned::new(place, Cow::Owned(name.to_owned())), value);
    }
}

/// Returns the table at a dotted path; with `place`, a missing table is added and replaces a value that is not a
/// table, so that the reader reports its missing entries.
fn table_at<'a, 'i>(
    table: &'a mut DeTable<'i>,
    path: &str,
    place: Option<&Range<usize>>,
) -> Option<&'a mut DeTable<'i>> {
    if path.is_empty() {
        return Some(table);
    }
    let (first, rest) = path.split_once('.').unwrap_or((path, ""));
    if let Some(place) = place
        && !matches!(
            table.get(first).map(Spanned::get_ref),
            Some(DeValue::Table(_) | DeValue::Array(_))
        )
    {
        table.remove(first);
        table.insert(
            Spanned::new(place.clone(), Cow::Owned(first.to_owned())),
            empty(place),
        );
    }
    match table.get_mut(first)?.get_mut() {
        DeValue::Table(inside) => table_at(inside, rest, place),
        DeValue::Array(list) => {
            let (name, rest) = rest.split_once('.').unwrap_or((rest, ""));
            let called = |item: &Spanned<DeValue<'_>>| {
                item.get_ref()
                    .as_table()
                    .is_some_and(|table| is_called(table, name))
            };
            let index = match (list.iter().position(called), place) {
                (Some(index), _) => index,
                (None, Some(place)) => {
                    list.push(empty(place));
                    let added = list.iter_mut().last()?.get_mut();
                    if let DeValue::Table(added) = added {
                        let name = DeValue::String(Cow::Owned(name.to_owned()));
                        set_value(
                            added,
                            "name",
                            place.clone(),
                            Spanned::new(place.clone(), name),
                        );
                    }
                    list.len() - 1
                }
                (None, None) => return None,
            };
            match list.get_mut(index)?.get_mut() {
                DeValue::Table(inside) => table_at(inside, rest, place),
                _ => None,
            }
        }
        _ => None,
    }
}

fn empty<'i>(place: &Range<usize>) -> Spanned<DeValue<'i>> {
    Spanned::new(place.clone(), DeValue::Table(DeTable::new()))
}
