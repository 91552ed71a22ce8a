//! Finds circles between source files: which file takes items of which, resolved through re-exports.
//!
//! Resolved are `use` and paths in the code that begin with `crate`, `super`, `self`, a child
//! module or an imported module; an item counts for the file that defines it, however many
//! `pub use` lead there, and a re-export alone is no need of the file that has it. Not resolved
//! are imports with `*` and what is reached without a path: methods, fields, macros.

use super::Source;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A path's parts, from the root of `src` on once it is absolute.
type Parts = Vec<String>;

/// One name that a `use` brings in.
struct Import {
    path: Parts,
    name: String,
    is_public: bool,
}

/// What the parser knows of a file.
struct File<'a> {
    source: &'a Source,
    module: Parts,
    imports: Vec<Import>,
    /// Its code without `use`.
    rest: String,
}

/// All files by the modules that they are.
struct Modules<'a>(BTreeMap<Parts, File<'a>>);

/// Groups of files that need each other, directly or by way of others. What a file takes of the
/// module that it stands in does not count where it has an `impl` block for a type or of a trait
/// of that module: such a file is a part of its parent.
pub fn circles(sources: &[Source]) -> BTreeSet<Vec<String>> {
    let modules = Modules(sources.iter().map(File::of).map(|file| (file.module.clone(), file)).collect());
    let needs: BTreeMap<&Path, BTreeSet<&Path>> =
        modules.0.values().map(|file| (file.source.path.as_path(), modules.needs(file))).collect();
    let reach: BTreeMap<&Path, BTreeSet<&Path>> = needs.keys().map(|&file| (file, reached(&needs, file))).collect();
    let circle = |(file, reached): (&&Path, &BTreeSet<&Path>)| -> Vec<String> {
        let back = reached.iter().filter(|other| reach[**other].contains(file));
        back.map(|other| other.display().to_string()).collect()
    };
    reach.iter().map(circle).filter(|circle| !circle.is_empty()).collect()
}

/// All files that a file needs, directly or by way of others.
fn reached<'a>(needs: &BTreeMap<&'a Path, BTreeSet<&'a Path>>, from: &'a Path) -> BTreeSet<&'a Path> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(file) = open.pop() {
        open.extend(needs[file].iter().filter(|&&next| found.insert(next)));
    }
    found
}

impl<'a> File<'a> {
    fn of(source: &'a Source) -> Self {
        let mut module: Parts = source.path.with_extension("").iter().map(|p| p.to_string_lossy().into()).collect();
        if module.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
            module.pop();
        }
        let (mut imports, mut rest, mut lines) = (Vec::new(), String::new(), source.text.lines());
        while let Some(line) = lines.next() {
            let (is_public, is_use) =
                (line.trim().starts_with("pub"), line.trim().split(' ').any(|word| word == "use"));
            if !is_use {
                rest += &format!("{line}\n");
                continue;
            }
            let mut tree = line.split_once("use ").map_or("", |(_, tree)| tree).to_owned();
            while !tree.ends_with(';') {
                let Some(line) = lines.next() else { break };
                tree += line.trim();
            }
            let found = leaves(tree.trim_end_matches(';'));
            imports.extend(found.into_iter().map(|(path, name)| Import { path: parts(&path), name, is_public }));
        }
        Self { source, module, imports, rest }
    }

    /// What it has an `impl` block for or of.
    fn implements(&self, name: &str) -> bool {
        let heads = self.rest.lines().filter_map(|line| line.strip_prefix("impl"));
        let heads =
            heads.map(|head| if head.starts_with('<') { head.split_once('>').map_or("", |h| h.1) } else { head });
        heads
            .filter_map(|head| words(head).into_iter().next())
            .any(|word| parts(word).last().is_some_and(|w| w == name))
    }
}

impl Modules<'_> {
    /// The files that a file takes something of.
    fn needs<'s>(&'s self, file: &File<'_>) -> BTreeSet<&'s Path> {
        let words = words(&file.rest);
        let is_used = |import: &&Import| !import.is_public || words.contains(&import.name.as_str());
        let imported = file.imports.iter().filter(is_used).map(|import| import.path.clone());
        let named = words.iter().filter(|word| word.contains("::")).map(|word| {
            let mut path = parts(word);
            // The module that a name was imported as.
            if let Some(import) = file.imports.iter().find(|import| import.name == path[0]) {
                path.splice(..1, import.path.clone());
            }
            path
        });
        let takes: Vec<(&File<'_>, String)> =
            imported.chain(named).filter_map(|path| self.definition(&file.module, path, 9)).collect();
        let parent = file.module.split_last().and_then(|(_, parent)| self.0.get(parent)).map(|parent| &parent.module);
        let is_parent = |of: &File<'_>| Some(&of.module) == parent;
        let is_part = takes.iter().any(|(of, name)| is_parent(of) && file.implements(name));
        let others = takes.iter().filter(|(of, _)| of.module != file.module && !(is_part && is_parent(of)));
        others.map(|(of, _)| of.source.path.as_path()).collect()
    }

    /// The file that defines what a module calls by this path, and the item's name; `None` for
    /// what is of another crate. Follows so many re-exports.
    fn definition(&self, module: &[String], path: Parts, most: usize) -> Option<(&File<'_>, String)> {
        let path = self.absolute(module, path)?;
        let depth = (0..=path.len()).rev().find(|&depth| self.0.contains_key(&path[..depth]))?;
        let file = &self.0[&path[..depth]];
        let name = path.get(depth).cloned().unwrap_or_default();
        match file.imports.iter().find(|import| import.name == name) {
            Some(import) if most > 0 => self.definition(&file.module, import.path.clone(), most - 1),
            _ => Some((file, name)),
        }
    }

    /// A path from the root of `src` on.
    fn absolute(&self, module: &[String], mut path: Parts) -> Option<Parts> {
        let program = if module.first().is_some_and(|room| room == "bin") { module.get(..2)? } else { &[] };
        let mut base = module.to_vec();
        match path.first()?.as_str() {
            "crate" => base = program.to_vec(),
            "super" | "self" => {
                while path.first().is_some_and(|part| part == "super" || part == "self") {
                    if path.remove(0) == "super" {
                        base.pop();
                    }
                }
                base.append(&mut path);
                return Some(base);
            }
            child => {
                base.push(child.to_owned());
                if !self.0.contains_key(&base) {
                    return None;
                }
            }
        }
        base.extend(path.drain(1..));
        Some(base)
    }
}

fn parts(path: &str) -> Parts {
    path.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect()
}

/// The names and paths in a text.
fn words(text: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    text.split(|c| !is_part(c)).map(|word| word.trim_matches(':')).filter(|word| !word.is_empty()).collect()
}

/// The paths of a `use` and the names that they have in the file.
fn leaves(tree: &str) -> Vec<(String, String)> {
    let Some((before, inside)) = tree.split_once('{') else {
        let (path, name) = tree.split_once(" as ").unwrap_or((tree, tree.rsplit("::").next().unwrap_or_default()));
        return vec![(path.trim().to_owned(), name.trim().to_owned())];
    };
    let inside = inside.strip_suffix('}').unwrap_or(inside);
    let mut open = 0_usize;
    let branches = inside.split(|c: char| {
        open = if c == '{' { open + 1 } else { open.saturating_sub(usize::from(c == '}')) };
        c == ',' && open == 0
    });
    let whole = before.trim_end_matches("::");
    let found = branches.filter(|branch| !branch.trim().is_empty()).flat_map(|branch| leaves(branch.trim()));
    found
        .map(|(path, name)| match path.as_str() {
            "self" => (whole.to_owned(), whole.rsplit("::").next().unwrap_or_default().to_owned()),
            _ => (format!("{before}{path}"), name),
        })
        .collect()
}
