//! The command `overact`; see the library.

fn main() -> std::process::ExitCode {
    overact_cli::run()
}
