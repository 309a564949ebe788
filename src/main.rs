//! The program: hands the words of the command line to `cli` and its exit code to the system.

use std::panic;

use gearstudy::cli;

/// Counts what a stage asks to be measured, and is the system's otherwise.
#[global_allocator]
static ALLOCATOR: cli::Allocator = cli::Allocator;

fn main() {
    cli::tell_panics();
    // A panic is a bug of this program, never the user's: it gets its own exit code and asks to be reported.
    let code = panic::catch_unwind(|| cli::main(std::env::args_os())).unwrap_or_else(|_| {
        cli::complain("gearstudy: this is a bug; please report it with the study and the lines above");
        cli::BUG
    });
    std::process::exit(code);
}
