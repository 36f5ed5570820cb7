//! Runs other programs.

use std::{
    path::Path,
    process::{Command, Stdio},
};

/// Runs `cargo` with these arguments and environment, and shows its output.
pub fn cargo(arguments: &[&str], environment: &[(&str, &str)]) -> Result<(), String> {
    finish("cargo", arguments, command(arguments, environment))
}

/// Runs a program that was built, and shows its output.
pub fn program(path: &Path, arguments: &[&str]) -> Result<(), String> {
    let mut command = Command::new(path);
    command.args(arguments).stdin(Stdio::null());
    finish(&path.display().to_string(), arguments, command)
}

fn finish(name: &str, arguments: &[&str], mut command: Command) -> Result<(), String> {
    let line = format!("{name} {}", arguments.join(" "));
    println!("$ {line}");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{line} ended with {status}")),
        Err(why) => Err(format!("{line}: {why}")),
    }
}

/// Returns the command without running it.
pub fn command(arguments: &[&str], environment: &[(&str, &str)]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    command.args(arguments).envs(environment.iter().copied()).stdin(Stdio::null());
    command
}
