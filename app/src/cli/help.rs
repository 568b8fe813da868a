//! The help as a person reads it: commands in groups, options of all commands in the main help alone.

use super::Cli;
use clap::builder::styling::Style;
use clap::{Command, CommandFactory};
use std::fmt::Write;

/// The commands by what a user does with them.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Start", &["new", "doctor", "schema", "completions", "man", "help"]),
    ("Compute", &["reduced", "reference", "mesh", "fmu", "live"]),
    ("Compare", &["compare", "gate", "coverage", "diff"]),
    ("Study", &["study", "uncertainty", "calibrate", "optimise"]),
    ("Test the program", &["bench", "stress"]),
];
/// Options of every command.
const GLOBAL: [&str; 3] = ["store", "quiet", "verbose"];

/// The command line with the help that is shown.
pub(super) fn command() -> Command {
    let mut command = Cli::command();
    command.build();
    let groups = groups(&command);
    let options = painted(*command.get_styles().get_header(), "Options:");
    command.mut_subcommands(without_global).help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n{groups}\n{options}\n{{options}}{{after-help}}"
    ))
}

/// `command` and those in it without the options that the main help shows.
fn without_global(command: Command) -> Command {
    let hidden = command.mut_args(|argument| {
        let is_global = GLOBAL.contains(&argument.get_id().as_str());
        argument.hide(is_global)
    });
    hidden.mut_subcommands(without_global)
}

/// The list of commands.
fn groups(command: &Command) -> String {
    let style = *command.get_styles().get_header();
    let name = *command.get_styles().get_literal();
    let mut text = String::new();
    for (heading, names) in GROUPS {
        let _ = writeln!(text, "\n{}", painted(style, &format!("{heading}:")));
        for subcommand in names.iter().filter_map(|name| command.find_subcommand(name)) {
            let about = subcommand.get_about().map(ToString::to_string).unwrap_or_default();
            let padding = " ".repeat(13usize.saturating_sub(subcommand.get_name().len()));
            let _ = writeln!(text, "  {}{padding}{about}", painted(name, subcommand.get_name()));
        }
    }
    text
}

fn painted(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}

#[cfg(test)]
mod tests {
    use super::{GLOBAL, GROUPS, command};

    #[test]
    fn every_command_is_in_one_group_and_fits_a_terminal() {
        let command = command();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        let mut there: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        grouped.sort_unstable();
        there.sort_unstable();
        assert_eq!(grouped, there);
        for subcommand in command.get_subcommands() {
            let about = subcommand.get_about().expect("a line").to_string();
            assert!(15 + about.len() <= 80, "{about}");
        }
    }

    #[test]
    fn only_the_main_help_shows_the_global_options() {
        let mut command = command();
        let main = command.render_help().to_string();
        let study = command.find_subcommand_mut("study").expect("a command").render_help().to_string();
        for option in GLOBAL.map(|name| format!("--{name}")) {
            assert!(main.contains(&option) && !study.contains(&option), "{option}");
        }
    }
}
