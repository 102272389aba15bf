//! `meniscus forces CONFIG|PRESET --positions FILE [--out FILE.csv]`

use super::{CommandError, Source, Verdict, say};
use crate::configuration::Configuration;
use crate::engine::Engine;
use crate::files::{atomic::write_atomically, read_positions, state::State};
use crate::simulation::torus;
use crate::strengths::Strengths;
use meniscus_core::dynamics::{Clock, Disc};
use std::fmt::Write as _;
use std::io::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    source: Source,
    /// Positions in [0, L), R0: CSV with columns x,y and perhaps id, extended XYZ (the last frame), or a state file.
    /// Their number replaces `system.particles`, and strengths in the file those of the configuration.
    #[arg(long, value_name = "FILE")]
    positions: PathBuf,
    /// Write to this file instead of standard output.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<Verdict, CommandError> {
    let configuration = arguments.source.read([])?;
    say(&configuration.scheme_line());
    let table = table_of_forces(&configuration, &arguments.positions)?;
    match &arguments.out {
        Some(path) => write_atomically(path, table.as_bytes())?,
        None => output.write_all(table.as_bytes())?,
    }
    Ok(Verdict::Ok)
}

/// One row a disc: `id,x,y,fx,fy`.
fn table_of_forces(configuration: &Configuration, path: &std::path::Path) -> Result<String, CommandError> {
    let torus = torus(configuration)?;
    let State { positions, strengths, .. } = read_positions(path, &torus)?;
    let strengths = strengths.map_or_else(|| configuration.strengths.clone(), Strengths::OfFile);
    let discs = positions.iter().enumerate().map(|(id, &position)| Disc {
        id: id as u32,
        position,
        strength: strengths.of(id),
    });
    let forces = Engine::with_ids(&configuration.parameters(), Clock::START, discs)?.forces()?;
    let mut table = String::from("id,x,y,fx,fy\n");
    for (id, (position, [force_x, force_y])) in positions.iter().zip(forces).enumerate() {
        let (x, y) = (torus.coordinate(position.x), torus.coordinate(position.y));
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{id},{x},{y},{force_x},{force_y}");
    }
    Ok(table)
}
