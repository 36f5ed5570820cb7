//! Lists of keys as rows: a time and the values at that time, each with its unit. Rows can be added and
//! removed.

use super::{
    TipBeside,
    number::{self, tidy},
};
use crate::{
    field::{self, Field, Keys, of},
    key::Key,
    session::Action,
};
use eframe::egui::{Response, Ui};
use toml_edit::{Array, InlineTable, Value};

/// Time between the last key and an added one [s].
const LATER: f64 = 0.5;
/// Minimum time between two keys [s].
const APART: f64 = 1e-3;

impl Keys {
    /// Number of values in the column named `column`.
    fn width(column: &str) -> usize {
        if column == "time" { 1 } else { 3 }
    }

    /// Number of values of a key.
    fn numbers(&self) -> usize {
        self.columns.iter().map(|c| Self::width(c)).sum()
    }

    /// Each column, and the index of its first value.
    fn columns(&self) -> Vec<(&'static str, usize)> {
        let start = |k: usize| self.columns[..k].iter().map(|c| Self::width(c)).sum();
        self.columns.iter().enumerate().map(|(k, column)| (*column, start(k))).collect()
    }

    /// Whether the keys have times.
    fn timed(&self) -> bool {
        self.columns.first() == Some(&"time")
    }

    /// The values of each key; missing ones are 0.
    fn read(&self, list: Option<&toml::Value>) -> Vec<Vec<f64>> {
        fn flat(value: Option<&toml::Value>, out: &mut Vec<f64>) {
            match value {
                Some(toml::Value::Array(list)) => list.iter().for_each(|x| flat(Some(x), out)),
                Some(value) => out.extend(value.as_float().or_else(|| value.as_integer().map(|i| i as f64))),
                None => {}
            }
        }
        let row = |key: &toml::Value| {
            let mut numbers = Vec::new();
            if self.plain {
                flat(Some(key), &mut numbers);
            } else {
                for column in self.columns {
                    let end = numbers.len() + Self::width(column);
                    flat(key.get(column), &mut numbers);
                    numbers.resize(end, 0.0);
                }
            }
            numbers.resize(self.numbers(), 0.0);
            numbers
        };
        list.and_then(toml::Value::as_array).into_iter().flatten().map(row).collect()
    }

    /// A key in the form of the file.
    fn written(&self, numbers: &[f64]) -> Value {
        if self.plain {
            return numbers.iter().copied().collect::<Array>().into();
        }
        let mut table = InlineTable::new();
        let mut rest = numbers;
        for column in self.columns {
            let (own, others) = rest.split_at(Self::width(column));
            rest = others;
            table.insert(*column, column_value(own));
        }
        table.into()
    }

    /// The row to insert after `k`: between its neighbors, or later than the last one.
    fn after(&self, rows: &[Vec<f64>], k: usize) -> Vec<f64> {
        let row = rows[k].clone();
        match rows.get(k + 1) {
            Some(next) => row.iter().zip(next).map(|(a, b)| 0.5 * (a + b)).collect(),
            None if self.timed() => [row[0] + LATER].into_iter().chain(row[1..].iter().copied()).collect(),
            None => row,
        }
    }
}

fn column_value(numbers: &[f64]) -> Value {
    match numbers {
        [one] => (*one).into(),
        three => three.iter().copied().collect::<Array>().into(),
    }
}

/// Shows the list of keys `value` at `key`. `first` is the first key of an empty list. If a change restarts
/// the scene (`slow`), it is applied when the drag ends.
pub fn show(
    ui: &mut Ui,
    (key, field, keys): (&Key, &Field, Keys),
    value: Option<&toml::Value>,
    (first, slow): (&[f64], bool),
    actions: &mut Vec<Action>,
) {
    let rows = keys.read(value);
    let all = |rows: &[Vec<f64>]| {
        let list: Array = rows.iter().map(|row| keys.written(row)).collect();
        Action::Set(key.clone(), Some(list.into()))
    };
    let columns = keys.columns();
    // The time is on a line above the values, because four numbers and two buttons are wider than the panel.
    let (first_line, others) = columns.split_at(1);
    for (k, row) in rows.iter().enumerate() {
        let cell = |ui: &mut Ui, (column, at): (&'static str, usize), actions: &mut Vec<Action>| {
            let mut own = row[at..at + Keys::width(column)].to_vec();
            let range = if column == "time" { between(&rows, k) } else { (f64::MIN, f64::MAX) };
            if !edited(ui, (key, column), &mut own, range, slow) {
                return;
            }
            actions.push(if keys.plain {
                let mut whole = row.clone();
                whole[at..at + own.len()].copy_from_slice(&own);
                Action::Set(key.place(k), Some(keys.written(&whole)))
            } else {
                Action::Set(key.place(k).field(column), Some(column_value(&own)))
            });
        };
        ui.push_id(k, |ui| {
            ui.horizontal(|ui| {
                ui.label(format!("{}", k + 1));
                first_line.iter().for_each(|column| cell(ui, *column, actions));
                if ui.small_button("+").tip_beside(ui, "Adds a key after this one").clicked() {
                    let mut rows = rows.clone();
                    rows.insert(k + 1, keys.after(&rows, k));
                    actions.push(all(&rows));
                }
                if ui.small_button("-").tip_beside(ui, "Removes this key").clicked() {
                    let mut rows = rows.clone();
                    rows.remove(k);
                    let left = !rows.is_empty();
                    actions.push(if left { all(&rows) } else { Action::Set(key.clone(), None) });
                }
            });
            for column in others {
                ui.horizontal(|ui| {
                    ui.add_space(16.0);
                    ui.label(of("", column.0).map_or(column.0, |field| field.label));
                    cell(ui, *column, actions);
                });
            }
        });
    }
    if rows.is_empty() && ui.small_button("Add a key").tip_beside(ui, &field::tip(field, key)).clicked() {
        actions.push(all(&[first.to_vec()]));
    }
}

/// The range of times that key `k` may have [s].
fn between(rows: &[Vec<f64>], k: usize) -> (f64, f64) {
    let before = k.checked_sub(1).map_or(0.0, |k| rows[k][0] + APART);
    let after = rows.get(k + 1).map_or(f64::MAX, |next| next[0] - APART);
    (before, after.max(before))
}

/// Shows the values of a column. Returns whether they changed.
fn edited(
    ui: &mut Ui,
    (key, column): (&Key, &str),
    numbers: &mut [f64],
    (low, high): (f64, f64),
    slow: bool,
) -> bool {
    let (unit, tip) = field::column(key, column);
    let axes = ["x", "y", "z"];
    let mut changed = false;
    for (axis, x) in numbers.iter_mut().enumerate() {
        let id = ui.scope_id().with((column, axis));
        // The panel keeps a dragged value until it is applied.
        let held: Option<f64> = ui.data(|d| d.get_temp(id));
        let mut shown = held.unwrap_or(*x);
        let speed = match unit {
            "°" => 0.5,
            _ => 0.005,
        };
        let name = if column == "time" { "Time" } else { axes[axis % 3] };
        let drag = number::drag(&mut shown).speed(speed).range(low..=high);
        let drag = if column == "time" { drag.suffix(" s") } else { drag };
        let response = ui.add(drag).tip_beside(ui, &format!("{name} [{unit}]: {tip}"));
        if slow && !rests(&response) {
            if response.changed() {
                ui.data_mut(|d| d.insert_temp(id, shown));
            }
        } else if shown != *x {
            *x = tidy(shown);
            changed = true;
            ui.data_mut(|d| d.remove::<f64>(id));
        }
    }
    if column != "time" && !unit.is_empty() {
        ui.weak(unit);
    }
    changed
}

/// Whether a number is neither dragged nor being typed.
fn rests(response: &Response) -> bool {
    !response.dragged() && !response.has_focus()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Kind;

    fn keys_of(list: &str, name: &str) -> Keys {
        match of(list, name).unwrap().kind {
            Kind::Keys(keys) => keys,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn keys_are_written_in_the_form_they_were_read_in() {
        for (list, name, text) in [
            ("hand", "path", "[[0.0, 0.1, 0.2, 0.3], [1.0, 0.4, 0.5, 0.6]]"),
            ("charged", "path", "[{ time = 1.0, center = [0.1, 0.2, 0.3] }]"),
            ("clip", "keys", "[{ time = 0.0, position = [0.0, 0.0, 0.0], rotation = [0.0, 45.0, 0.0] }]"),
            ("collider", "points", "[[0.0, 1.4, 0.1], [-0.2, 1.3, 0.0]]"),
        ] {
            let keys = keys_of(list, name);
            let table: toml::Table = format!("x = {text}").parse().unwrap();
            let rows = keys.read(table.get("x"));
            let list: Array = rows.iter().map(|row| keys.written(row)).collect();
            assert_eq!(Value::from(list).to_string().replace(' ', ""), text.replace(' ', ""));
        }
    }

    #[test]
    fn missing_values_of_a_key_are_0_and_an_inserted_key_is_interpolated() {
        let keys = keys_of("clip", "keys");
        let table: toml::Table =
            "x = [{ time = 0.0 }, { time = 1.0, rotation = [0, 90, 0] }]".parse().unwrap();
        let rows = keys.read(table.get("x"));
        assert_eq!(rows[1], [1.0, 0.0, 0.0, 0.0, 0.0, 90.0, 0.0]);
        assert_eq!(keys.after(&rows, 0), [0.5, 0.0, 0.0, 0.0, 0.0, 45.0, 0.0]);
        assert_eq!(keys.after(&rows, 1)[0], 1.5);
        assert_eq!(between(&rows, 0), (0.0, 1.0 - APART));
    }
}
