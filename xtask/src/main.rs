//! All developer commands: `cargo xtask NAME`. CI runs the same ones.

mod consumer;
mod fuzz;
mod layers;
mod pictures;
mod promises;
mod python;
mod run;
mod test;

const HELP: &str = "cargo xtask NAME

  test           all tests, in release; closes on one line with the sum
  python         the tests of the Python package only: it is installed in target/python
  lint           layers, promises, formatting, clippy with warnings refused (the library also without its features), the docs, and where all dependencies come from and under which licence
  layers         modules of the library import each other in one direction only
  promises       every promise names a test that exists, and every test of a promise is named
  package        every crate that is not private can be packaged for publication
  consumer       a crate outside of the workspace links the library, builds it without optimization and steps 100 strands
  fuzz [SECONDS] every fuzz target, so long each (default 60), two at a time
  window         draws the pictures of docs/window.md, on a desktop; Sintel's from ../shared/data
  monkey [MINUTES] random presses in the window, so long (default 10)
  golden         writes the golden pictures (look at them before you commit)
  meshes         makes the meshes of the example scenes (draw the scenes that show them, and look)
  parameters     writes what the book states of each parameter from its definition: unit, range, default, condition, lists; `test`
                 checks that it is up to date
  pictures [NAME] draws the pictures of the book, all or those whose name contains NAME (look at them too); needs no build where
                 HAIRSPRING names the program
  ci             lint, package, consumer, fuzz (ten seconds each), test: what CI runs";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["test"] => test::all(),
        ["python"] => python::test().and_then(|[_, failed, _]| match failed {
            0 => Ok(()),
            _ => Err(format!("{failed} tests failed")),
        }),
        ["lint"] => lint(),
        ["layers"] => layers::check(),
        ["promises"] => promises::check(),
        ["package"] => package(),
        ["consumer"] => consumer::run(),
        ["fuzz"] => fuzz::all(60, None),
        ["fuzz", seconds] => match seconds.parse() {
            Ok(seconds) => fuzz::all(seconds, None),
            Err(_) => Err(format!("'{seconds}' is not a number of seconds")),
        },
        ["window"] => window("docs/tour.txt").and_then(|()| window("docs/tour-sintel.txt")),
        ["monkey"] => monkey("10"),
        ["monkey", minutes] => monkey(minutes),
        ["meshes"] => {
            let test = [
                "test",
                "--release",
                "-p",
                "hairspring-io",
                "--test",
                "files",
                "example_meshes_are_made_by_code",
            ];
            run::cargo(&test, &[("HAIRSPRING_MESHES", "write")])
        }
        ["golden"] => {
            run::cargo(&["test", "--release", "-p", "hairspring-view"], &[("HAIRSPRING_GOLDEN", "write")])
        }
        ["parameters"] => {
            let test = [
                "test",
                "--release",
                "-p",
                "hairspring-io",
                "--test",
                "scenes",
                "book_states_the_definitions",
            ];
            run::cargo(&test, &[("HAIRSPRING_BOOK", "write")])
        }
        ["pictures"] => pictures::draw(""),
        ["pictures", part] => pictures::draw(part),
        ["ci"] => lint()
            .and_then(|()| package())
            .and_then(|()| consumer::run())
            .and_then(|()| fuzz::all(10, fuzz::ALWAYS_THE_SAME))
            .and_then(|()| test::all()),
        ["help" | "--help" | "-h"] => {
            println!("{HELP}");
            Ok(())
        }
        _ => Err(format!("no such command\n\n{HELP}")),
    };
    if let Err(why) = done {
        eprintln!("xtask: {why}");
        std::process::exit(1);
    }
}

/// Draws the pictures of a page about the window with a script.
fn window(script: &str) -> Result<(), String> {
    run::cargo(&["run", "--release", "--", "live", "--script", script], &[])
}

/// Presses the window's controls at random.
fn monkey(minutes: &str) -> Result<(), String> {
    let minutes: f64 = minutes.parse().map_err(|_| format!("'{minutes}' is not a number of minutes"))?;
    let seconds = format!("{}", (minutes * 60.0).round() as u64);
    let test = ["test", "--release", "-p", "hairspring-app", "--test", "random_input_breaks_nothing"];
    run::cargo(&[&test[..], &["--", "--nocapture"]].concat(), &[("HAIRSPRING_MONKEY", &seconds)])
}

/// Packages every crate that is not private. The packages are not compiled again: `test` compiles the same files.
fn package() -> Result<(), String> {
    // Private: the developer commands, the helpers of the tests, the scalar build of the library's files, and the
    // program that may link it.
    let private = [
        "xtask",
        "hairspring-test",
        "hairspring-scalar",
        "hairspring-one-lane",
        "hairspring-cli",
        "hairspring-python",
    ];
    let exclude = private.iter().flat_map(|name| ["--exclude", name]);
    let package = ["package", "--quiet", "--workspace", "--no-verify", "--allow-dirty"];
    run::cargo(&package.into_iter().chain(exclude).collect::<Vec<_>>(), &[])
}

fn lint() -> Result<(), String> {
    layers::check()?;
    promises::check()?;
    run::cargo(&["fmt", "--all", "--check"], &[])?;
    run::cargo(
        &["clippy", "--release", "--workspace", "--all-targets", "--all-features", "--", "-D", "warnings"],
        &[],
    )?;
    // Without rayon and serde, which no other crate of the workspace leaves out.
    let bare = ["clippy", "--release", "-p", "hairspring", "--no-default-features", "--", "-D", "warnings"];
    run::cargo(&bare, &[])?;
    run::cargo(&["doc", "--release", "--workspace", "--no-deps"], &[("RUSTDOCFLAGS", "-D warnings")])?;
    // Advisories are left out: their database comes from the network, and no check of ours may depend on it.
    run::cargo(&["deny", "--workspace", "check", "bans", "licenses", "sources"], &[])
}
