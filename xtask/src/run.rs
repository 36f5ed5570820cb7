//! Running other programs.

use std::process::Command;

/// `cargo` with these arguments and environment, its output shown.
pub fn cargo(arguments: &[&str], environment: &[(&str, &str)]) -> Result<(), String> {
    println!("$ cargo {}", arguments.join(" "));
    let status = command(arguments, environment).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("cargo {} ended with {status}", arguments.join(" "))),
        Err(why) => Err(format!("cargo {}: {why}", arguments.join(" "))),
    }
}

/// The command without running it.
pub fn command(arguments: &[&str], environment: &[(&str, &str)]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    command.args(arguments).envs(environment.iter().copied()).stdin(std::process::Stdio::null());
    command
}
