//! `help`: what a command does, on the terminal or as man pages.
//!
//! Must not know: what any command does; its words say it.

use std::fs;
use std::path::Path;

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::Ending;
use super::arguments::Arguments;
use super::progress::out;
use declare::error::suggest;

/// Prints what the help of a command says, or writes a page for each command.
pub(super) fn help(words: &[String], man: Option<&Path>) -> Result<(), Ending> {
    let mut root = Arguments::command();
    root.build();
    if let Some(folder) = man {
        return pages(&root, folder);
    }
    let mut command = &mut root;
    for word in words {
        let here = command.get_name().to_owned();
        let known: Vec<String> = names(command);
        let Some(found) = command.find_subcommand_mut(word) else {
            let help = if known.is_empty() {
                format!("`{here}` has no commands of its own")
            } else {
                suggest(word, known.iter().map(String::as_str).collect::<Vec<_>>())
            };
            return Err(Ending::Usage(format!("there is no command `{word}`; {help}")));
        };
        command = found;
    }
    out(&command.render_help().to_string());
    Ok(())
}

fn names(command: &Command) -> Vec<String> {
    command.get_subcommands().map(|command| command.get_name().to_owned()).collect()
}

/// Writes `gearstudy.1`, `gearstudy-run.1` and so on, with nothing in them that differs from day to day.
fn pages(root: &Command, folder: &Path) -> Result<(), Ending> {
    let cannot =
        |path: &Path, error: std::io::Error| Ending::Usage(format!("cannot write {}: {error}", path.display()));
    fs::create_dir_all(folder).map_err(|error| cannot(folder, error))?;
    let mut left = vec![root.clone()];
    let mut count = 0;
    while let Some(command) = left.pop() {
        left.extend(command.get_subcommands().cloned());
        // A command that is built is displayed as `gearstudy-run`.
        let path = folder.join(format!("{}.1", command.get_display_name().unwrap_or(command.get_name())));
        let mut text = Vec::new();
        let page = Man::new(command).manual("gearstudy");
        page.render(&mut text).and_then(|()| fs::write(&path, &text)).map_err(|error| cannot(&path, error))?;
        count += 1;
    }
    out(&format!("wrote {count} pages; read one: man {}\n", folder.join("gearstudy-run.1").display()));
    Ok(())
}
