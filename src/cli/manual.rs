//! The manual pages, made of the options' own help.

use super::arguments::{Arguments, ManualOptions};
use super::failure::Failure;
use super::output;
use clap::CommandFactory;
use clap_mangen::Man;
use std::io;
use std::path::Path;

/// Prints all pages in a row, or writes each to a file of the folder.
pub(super) fn run(options: &ManualOptions) -> Result<(), Failure> {
    let pages = pages();
    let Some(folder) = &options.folder else {
        let mut text = Vec::new();
        pages.iter().try_for_each(|page| page.render(&mut text)).map_err(Failure::writing("stdout"))?;
        return output::to_stdout(&text);
    };
    std::fs::create_dir_all(folder).map_err(Failure::writing(folder))?;
    for page in &pages {
        let mut text = Vec::new();
        page.render(&mut text).map_err(Failure::writing(folder))?;
        output::write(&Path::new(folder).join(page.get_filename()).to_string_lossy(), |file| io::Write::write_all(file, &text))?;
    }
    Ok(())
}

/// The page of the command, then one of every subcommand: `drypoint-draw` and so on.
fn pages() -> Vec<Man> {
    let mut command = Arguments::command();
    command.build();
    let source = format!("drypoint {}", command.get_version().unwrap_or_default());
    let mut pages = vec![Man::new(command.clone())];
    for subcommand in command.get_subcommands().filter(|one| !one.is_hide_set() && one.get_name() != "help") {
        let name = format!("drypoint-{}", subcommand.get_name());
        pages.push(Man::new(subcommand.clone().name(name.clone()).display_name(name)).source(source.clone()));
    }
    pages
}
