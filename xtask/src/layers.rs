//! The modules of a crate import each other in one direction only.
//!
//! The check reads the source. An edge goes from one top-level module to another that it names, by `crate::` or by `super::`, outside of tests. Names
//! inside macros count too.

use proc_macro2::{TokenStream, TokenTree};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};
use syn::{
    Attribute, Item, ItemMod, ItemUse, Macro, UseTree,
    visit::{self, Visit},
};

/// Crates whose modules are layers.
const CRATES: [&str; 1] = ["hairspring"];

/// The modules that each module imports, and for each the first file that does.
type Imports = BTreeMap<String, BTreeMap<String, PathBuf>>;

/// Checks every layered crate. The error names one cycle with the files that close it.
pub fn check() -> Result<(), String> {
    for name in CRATES {
        let source = Path::new("crates").join(name).join("src");
        let imports = imports(&source)?;
        if let Some(cycle) = cycle(&imports) {
            let edges = cycle.iter().zip(cycle.iter().cycle().skip(1));
            let lines = edges.map(|(a, b)| format!("\n  {a} imports {b} in {}", imports[a][b].display()));
            return Err(format!(
                "{name}: modules import each other in a circle:{}",
                lines.collect::<String>()
            ));
        }
        println!("{name}: {} modules, no import cycle", imports.len());
    }
    Ok(())
}

/// Reads all files of a crate.
fn imports(source: &Path) -> Result<Imports, String> {
    let root = parse(&source.join("lib.rs"))?;
    let modules: BTreeSet<String> = root
        .items
        .iter()
        .filter_map(|item| match item {
            Item::Mod(module) if !is_test(&module.attrs) => Some(module.ident.to_string()),
            _ => None,
        })
        .collect();
    let mut found = Imports::new();
    for module in &modules {
        found.insert(module.clone(), BTreeMap::new());
        let (file, folder) = (source.join(format!("{module}.rs")), source.join(module));
        let file = if file.exists() { file } else { folder.join("mod.rs") };
        read(&file, &folder, std::slice::from_ref(module), &modules, &mut found)?;
    }
    Ok(found)
}

/// Reads the file of the module `path`, and those of its modules, which lie in `folder`.
fn read(
    file: &Path,
    folder: &Path,
    path: &[String],
    modules: &BTreeSet<String>,
    found: &mut Imports,
) -> Result<(), String> {
    let mut names = Names { path: path.to_vec(), found: Vec::new(), files: Vec::new() };
    names.visit_file(&parse(file)?);
    for name in names.found {
        if name != path[0] && modules.contains(&name) {
            let edges = found.entry(path[0].clone()).or_default();
            edges.entry(name).or_insert_with(|| file.to_owned());
        }
    }
    for module in names.files {
        let (alone, inner) = (folder.join(format!("{module}.rs")), folder.join(&module));
        let file = if alone.exists() { alone } else { inner.join("mod.rs") };
        read(&file, &inner, &[path, &[module]].concat(), modules, found)?;
    }
    Ok(())
}

fn parse(file: &Path) -> Result<syn::File, String> {
    let text = fs::read_to_string(file).map_err(|why| format!("{}: {why}", file.display()))?;
    syn::parse_file(&text).map_err(|why| format!("{}: {why}", file.display()))
}

/// Whether an item is compiled for tests only: `#[cfg(test)]` or `#[cfg(doctest)]`.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Path>().is_ok_and(|p| p.is_ident("test") || p.is_ident("doctest"))
    })
}

/// Collects the top-level modules that a file names.
struct Names {
    /// Path of the module that is being read.
    path: Vec<String>,
    found: Vec<String>,
    /// Modules of this one in files of their own.
    files: Vec<String>,
}

impl Names {
    /// Notes the top-level module of a path, given by its first segments.
    fn note(&mut self, segments: &[String]) {
        match segments.first().map(String::as_str) {
            Some("crate") => self.found.extend(segments.get(1).cloned()),
            Some("super") => {
                let up = segments.iter().take_while(|s| *s == "super").count();
                if up == self.path.len() {
                    self.found.extend(segments.get(up).cloned());
                }
            }
            _ => {}
        }
    }

    fn note_use(&mut self, before: &[String], tree: &UseTree) {
        match tree {
            UseTree::Path(path) => {
                self.note_use(&[before, &[path.ident.to_string()]].concat(), &path.tree);
            }
            UseTree::Name(name) => self.note(&[before, &[name.ident.to_string()]].concat()),
            UseTree::Rename(name) => self.note(&[before, &[name.ident.to_string()]].concat()),
            UseTree::Glob(_) => self.note(before),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.note_use(before, tree)),
        }
    }

    /// Notes `crate::NAME` in the tokens of a macro.
    fn note_tokens(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        for (k, token) in tokens.iter().enumerate() {
            match token {
                TokenTree::Group(group) => self.note_tokens(group.stream()),
                TokenTree::Ident(ident) if ident == "crate" => {
                    if let Some(TokenTree::Ident(name)) = tokens.get(k + 3) {
                        self.found.push(name.to_string());
                    }
                }
                _ => {}
            }
        }
    }
}

impl<'ast> Visit<'ast> for Names {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            Item::Mod(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if !is_test(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if module.content.is_none() {
            self.files.push(module.ident.to_string());
            return;
        }
        self.path.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.path.pop();
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.note_use(&[], &item.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        self.note(&segments);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'ast Macro) {
        self.note_tokens(item.tokens.clone());
        visit::visit_macro(self, item);
    }
}

/// One cycle, each module importing the next and the last the first.
fn cycle(imports: &Imports) -> Option<Vec<String>> {
    /// Depth first; `way` leads to `module`, and from modules that are `done` no cycle is reached.
    fn search(
        module: &String,
        imports: &Imports,
        way: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> Option<Vec<String>> {
        if let Some(at) = way.iter().position(|m| m == module) {
            return Some(way[at..].to_vec());
        }
        if done.contains(module) {
            return None;
        }
        way.push(module.clone());
        let found = imports[module].keys().find_map(|next| search(next, imports, way, done));
        way.pop();
        done.insert(module.clone());
        found
    }
    let mut done = BTreeSet::new();
    imports.keys().find_map(|module| search(module, imports, &mut Vec::new(), &mut done))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A crate in a folder, from pairs of file and text.
    fn found(files: &[(&str, &str)]) -> Imports {
        let folder = std::env::temp_dir().join(format!("layers-{}-{}", std::process::id(), files.len()));
        for (name, text) in files {
            let file = folder.join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, text).unwrap();
        }
        let found = imports(&folder).unwrap();
        fs::remove_dir_all(folder).unwrap();
        found
    }

    #[test]
    fn a_cycle_is_found_through_uses_paths_macros_and_nested_modules() {
        for back in [
            "use crate::a::X;",
            "use crate::{b::Y, a::{X, Z}};",
            "fn f(_: crate::a::X) {}",
            "fn f() { println!(\"{}\", crate::a::X); }",
            "mod inner { use super::super::a::X; }",
        ] {
            let found =
                found(&[("lib.rs", "mod a; mod b;"), ("a.rs", "use crate::b::Y;"), ("b/mod.rs", back)]);
            assert_eq!(cycle(&found), Some(vec!["a".into(), "b".into()]), "{back}");
        }
    }

    #[test]
    fn tests_and_child_modules_add_no_edges_to_the_graph() {
        let found = found(&[
            ("lib.rs", "mod a; mod b;"),
            ("a/mod.rs", "mod c; use crate::b::Y; use self::c::Z;"),
            ("a/c.rs", "use super::W;"),
            ("b.rs", "#[cfg(test)] mod tests { use crate::a::X; }"),
        ]);
        assert_eq!(found["a"].keys().collect::<Vec<_>>(), ["b"]);
        assert_eq!(cycle(&found), None);
    }
}
