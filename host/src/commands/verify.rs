//! `meniscus verify GOLDEN [--bisect]`

use super::machinery::MachineryArguments;
use super::{CommandError, Verdict};
use crate::configuration::Configuration;
use crate::golden::{Difference, Golden};
use crate::simulation::Simulation;
use crate::verification::{compare, compare_with_core};
use std::io::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A golden file, as `run` writes it.
    golden: PathBuf,
    /// If a record differs, run up to it in this engine and in the scalar core, with the discs stored in two orders, and
    /// compare every step: this tells whether the program contradicts itself, and where first.
    #[arg(long)]
    bisect: bool,
    #[command(flatten)]
    machinery: MachineryArguments,
}

pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<Verdict, CommandError> {
    let golden = Golden::read(&arguments.golden)?;
    if golden.records.is_empty() {
        return Err(CommandError::GoldenRecords { path: arguments.golden.clone(), found: "no record" });
    }
    let machinery = arguments.machinery.read()?;
    let name = format!("{}: configuration", arguments.golden.display());
    let simulation = || -> Result<Simulation, CommandError> {
        let configuration = Configuration::from_text(&name, &golden.configuration, &[])?;
        Ok(Simulation::with_machinery(configuration, machinery)?)
    };
    let mut agreed = None;
    let difference = compare(&golden, &mut simulation()?.engine, |record| agreed = Some(record.step))?;
    let Some(difference) = difference else {
        let steps = agreed.unwrap_or_default();
        writeln!(output, "equal: {} records to step {steps}", golden.records.len())?;
        return Ok(Verdict::Ok);
    };
    describe(&golden, agreed, &difference, output)?;
    if arguments.bisect {
        bisect(simulation()?, difference.step, agreed, output)?;
    }
    Ok(Verdict::Different)
}

fn describe(
    golden: &Golden,
    agreed: Option<u64>,
    difference: &Difference,
    output: &mut impl Write,
) -> std::io::Result<()> {
    writeln!(output, "different: {difference}")?;
    match agreed {
        Some(step) => writeln!(output, "equal up to the record of step {step}")?,
        None => writeln!(output, "no record before it")?,
    }
    writeln!(output, "minted by meniscus {}, this is {}", golden.version, env!("CARGO_PKG_VERSION"))
}

fn bisect(
    simulation: Simulation,
    last: u64,
    agreed: Option<u64>,
    output: &mut impl Write,
) -> Result<(), CommandError> {
    match compare_with_core(simulation, last)? {
        Some(difference) => {
            writeln!(
                output,
                "this program contradicts itself, the core with discs stored in reverse: {difference}"
            )?;
        }
        None => writeln!(
            output,
            "this program agrees with itself at every step; the first difference lies in steps {} to {last}: \
             mint these with --every 1 where the file came from to see which",
            agreed.map_or(0, |step| step + 1)
        )?,
    }
    Ok(())
}
