//! The `finegrain` command.
#![forbid(unsafe_code)]

use std::error::Error;
use std::io;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use finegrain::framework::instructions;

mod cli;

/// Fine-grained parallel time stepping on multi-core machines.
///
/// Without a command it does the main job, `bench cylinder` with its defaults.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Run a scene: a built-in one by name, or a TOML file.
    Run(cli::run::RunArguments),
    /// List the built-in scenes, or one with its parameters.
    Scenes(cli::scenes::ScenesArguments),
    /// Measure speed, speed-up and efficiency.
    #[command(subcommand)]
    Bench(cli::bench::BenchCommand),
    /// Run many cases and say what they tell together.
    #[command(subcommand)]
    Report(cli::report::ReportCommand),
}

fn main() -> ExitCode {
    let command = Arguments::parse().command;
    let outcome = instructions::check().map_err(Into::into).and_then(|()| match command {
        Some(Command::Run(arguments)) => cli::run::run(arguments),
        Some(Command::Scenes(arguments)) => {
            cli::scenes::scenes(&arguments, &mut std::io::stdout().lock())
        }
        Some(Command::Bench(command)) => cli::bench::bench(command),
        Some(Command::Report(command)) => cli::report::report(command),
        None => cli::bench::bench(cli::bench::BenchCommand::default()),
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        // Who closes our output (`| head`) has seen enough.
        Err(error) if is_broken_pipe(error.as_ref()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}", with_causes(error.as_ref()));
            ExitCode::FAILURE
        }
    }
}

fn is_broken_pipe(error: &(dyn Error + 'static)) -> bool {
    let error = error.downcast_ref::<io::Error>();
    error.is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}

/// What went wrong, and why, as far as the message does not say so itself.
fn with_causes(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        let why = cause.to_string();
        if !text.contains(&why) {
            text += &format!(": {why}");
        }
        source = cause.source();
    }
    text
}
