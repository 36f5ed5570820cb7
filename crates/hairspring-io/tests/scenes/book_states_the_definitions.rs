//! Promise: the book states what the definitions of the parameters say. The page of a parameter begins with
//! its unit, range and default, and with the condition under which it has an effect. The page of a group and
//! the summary list the parameters that have a page in the group's folder.
//!
//! With `HAIRSPRING_BOOK=write` the test writes these lines; `cargo xtask parameters` sets it. The prose of a
//! page, its TOML and its pictures are written by hand.

use crate::book::{docs, files, is_a_group, name_of, parameter_pages, read};
use hairspring::settings::{Parameter, When};
use hairspring_io::scene::parameters;
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

#[test]
fn pages_groups_and_summary_agree_with_the_definitions() {
    let pages: BTreeMap<String, PathBuf> =
        parameter_pages().into_iter().map(|page| (name_of(&page).to_owned(), page)).collect();
    for (name, page) in &pages {
        let parameter = parameters::parameter(name);
        let parameter = parameter.unwrap_or_else(|| panic!("{}: `{name}` is no parameter", page.display()));
        agree(page, &stated(&read(page), name, parameter, &pages));
    }
    let mut summary = read(&docs().join("SUMMARY.md"));
    for group in files(&docs().join("parameters"), "md").iter().filter(|page| is_a_group(page)) {
        let text = read(group);
        let names = in_order(&text, &group.with_extension(""));
        agree(group, &with_rows(&text, name_of(group), &names, &pages));
        summary = with_entries(&summary, name_of(group), &names);
    }
    agree(&docs().join("SUMMARY.md"), &summary);
}

/// Checks that a page has this text, or writes it.
fn agree(page: &Path, text: &str) {
    if std::env::var("HAIRSPRING_BOOK").is_ok_and(|value| value == "write") {
        fs::write(page, text).unwrap();
    }
    let now = read(page);
    let differs = now.lines().zip(text.lines()).find(|(now, right)| now != right);
    assert!(
        now == text,
        "{} differs from the definition of its parameter; run `cargo xtask parameters`: {differs:#?}",
        page.display()
    );
}

/// The text of a parameter's page with the lines of its definition.
fn stated(text: &str, name: &str, parameter: &Parameter, pages: &BTreeMap<String, PathBuf>) -> String {
    let written = |line: &&str| line.starts_with("Unit: ") || line.starts_with("Applies only if ");
    let rest: Vec<&str> = text.lines().skip(1).filter(|line| !written(line)).collect();
    let range = grouped(&parameter.range_text());
    let facts =
        format!("Unit: {}. Range: {range}. Default: {}.", parameter.unit, parameter.default_or_required());
    let mut page = format!("# `{name}`\n\n{}\n\n", linked(&facts, name, pages));
    if parameter.when != When::Always {
        let label = |name: &str| match parameters::contents(name) {
            Some(contents) => contents.to_owned(),
            None => format!("`{name}`"),
        };
        let condition = format!("Applies only if {}.", parameter.when.phrase(&label));
        page += &format!("{}\n\n", linked(&condition, name, pages));
    }
    page + rest.join("\n").trim_start() + "\n"
}

/// The text with commas in whole numbers of five digits and more.
fn grouped(text: &str) -> String {
    let is_long = |word: &str| word.len() > 4 && word.bytes().all(|b| b.is_ascii_digit());
    let commas = |word: &str| {
        let digit = |(k, digit): (usize, char)| match (word.len() - k) % 3 {
            0 if k > 0 => format!(",{digit}"),
            _ => digit.to_string(),
        };
        word.chars().enumerate().map(digit).collect::<String>()
    };
    // Without a sign and the comma of the sentence.
    let of_word = |word: &str| {
        let number = word.trim_start_matches('-').trim_end_matches(',');
        if is_long(number) { word.replacen(number, &commas(number), 1) } else { word.to_owned() }
    };
    let words = text.split(' ').map(of_word);
    words.collect::<Vec<_>>().join(" ")
}

/// The text with a link for each name in backticks that is a parameter: by its full name, or in the same
/// table as the parameter `from`, or in it. A table in brackets leads to the page of its group.
fn linked(text: &str, from: &str, pages: &BTreeMap<String, PathBuf>) -> String {
    let table = from.rsplit_once('.').map_or(String::new(), |(table, _)| format!("{table}."));
    let folder = pages[from].parent();
    let link = |word: &str| {
        if let Some(group) = word.strip_prefix('[').and_then(|word| word.strip_suffix(']')) {
            let page = docs().join(format!("parameters/{group}.md"));
            return page.is_file().then(|| format!("[`{word}`](../{group}.md)"));
        }
        let names = [word.to_owned(), format!("{table}{word}"), format!("{from}.{word}")];
        let name = names.into_iter().find(|name| name != from && pages.contains_key(name))?;
        let page = &pages[&name];
        let group = page.parent().unwrap().file_name().unwrap().to_str().unwrap();
        let path = if page.parent() == folder { String::new() } else { format!("../{group}/") };
        Some(format!("[`{word}`]({path}{name}.md)"))
    };
    let parts = text.split('`').enumerate();
    let parts = parts.map(|(k, part)| match k % 2 {
        0 => part.to_owned(),
        _ => link(part).unwrap_or_else(|| format!("`{part}`")),
    });
    parts.collect()
}

/// The parameters of a group: those that its page lists, in that order, then new ones.
fn in_order(text: &str, folder: &Path) -> Vec<String> {
    let there: Vec<String> = files(folder, "md").iter().map(|page| name_of(page).to_owned()).collect();
    let listed = text.lines().filter_map(|line| line.strip_prefix("| [`")?.split('`').next());
    let mut names: Vec<String> = listed.map(str::to_owned).filter(|name| there.contains(name)).collect();
    names.extend(there.into_iter().filter(|name| !names.contains(name)).collect::<Vec<_>>());
    names
}

/// The text of a group's page with a row for each of its parameters.
fn with_rows(text: &str, group: &str, names: &[String], pages: &BTreeMap<String, PathBuf>) -> String {
    let row = |name: &String| {
        let page = read(&pages[name]);
        let mut parts = page.lines().skip(1).filter(|l| !l.is_empty() && !l.starts_with("Applies only if "));
        let facts = parts.next().unwrap().strip_prefix("Unit: ").unwrap();
        let (unit, rest) = facts.split_once(". Range: ").unwrap();
        let default = rest.split(" Default: ").nth(1).unwrap().trim_end_matches('.');
        let first = parts.next().unwrap().split_inclusive(". ").next().unwrap().trim_end();
        format!("| [`{name}`]({name}.md) | {first} | {unit} | {default} |")
    };
    let is_row = |line: &&str| line.starts_with("| [`");
    let before = text.lines().take_while(|line| !is_row(line)).map(str::to_owned);
    let after = text.lines().skip_while(|line| !is_row(line)).skip_while(is_row).map(str::to_owned);
    let lines: Vec<String> =
        before.chain(names.iter().map(|name| relative_to_group(&row(name), group))).chain(after).collect();
    lines.join("\n") + "\n"
}

/// A line of a parameter's page with its links as they are on the page of the group, one folder above.
fn relative_to_group(line: &str, group: &str) -> String {
    let mut parts = line.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| match part.strip_prefix("../") {
        Some(above) => format!("{text}]({above}"),
        None => format!("{text}]({group}/{part}"),
    })
}

/// The summary with an entry for each parameter of a group.
fn with_entries(summary: &str, group: &str, names: &[String]) -> String {
    let header = format!("](parameters/{group}.md)");
    let start = summary.lines().position(|line| line.ends_with(&header));
    let start = 1 + start.unwrap_or_else(|| panic!("docs/SUMMARY.md does not list {group}"));
    let after = summary.lines().skip(start).skip_while(|line| line.starts_with("    - "));
    let entries = names.iter().map(|name| format!("    - [{name}](parameters/{group}/{name}.md)"));
    let lines: Vec<String> = summary
        .lines()
        .take(start)
        .map(str::to_owned)
        .chain(entries)
        .chain(after.map(str::to_owned))
        .collect();
    lines.join("\n") + "\n"
}
