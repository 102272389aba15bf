//! `meniscus forces CONFIG|PRESET --positions FILE [--out FILE.csv]`

use super::{CommandError, Reporter, Source, Verdict};
use crate::configuration::Configuration;
use crate::engine::Engine;
use crate::files::{atomic::write_atomically, read_positions, state::State};
use crate::simulation::torus;
use crate::strengths::Strengths;
use meniscus_core::dynamics::{Clock, Disc};
use meniscus_core::torus::Position;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    source: Source,
    /// Positions in [0, L), R0: CSV with columns x,y and perhaps id and strength, a state file, or a trajectory (the last
    /// frame).
    /// There may be more or fewer than `system.particles`, for which the scheme of the force is chosen; strengths in the
    /// file are taken unless the configuration has some.
    #[arg(long, value_name = "FILE")]
    positions: PathBuf,
    /// Write to this file, which must not exist, instead of standard output.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let configuration = arguments.source.read([])?;
    if let Some(path) = arguments.out.as_ref().filter(|path| path.exists()) {
        return Err(CommandError::Exists { path: path.clone(), another: "another file" });
    }
    reporter.detail(&configuration.scheme_line());
    let rows = forces(&configuration, &arguments.positions)?;
    match &arguments.out {
        Some(path) => {
            write_atomically(path, table(&rows).as_bytes())?;
            reporter
                .json(|| serde_json::json!({ "file": path.display().to_string(), "discs": rows.len() }))?;
        }
        None => {
            reporter.text(&table(&rows))?;
            reporter.json(|| {
                let column = |index: usize| rows.iter().map(|row| row[index]).collect::<Vec<f64>>();
                serde_json::json!({ "x": column(0), "y": column(1), "fx": column(2), "fy": column(3) })
            })?;
        }
    }
    Ok(Verdict::Ok)
}

/// One row a disc, in the order of ids: x and y in R0, the force along x and y in kBT/R0.
fn forces(configuration: &Configuration, path: &Path) -> Result<Vec<[f64; 4]>, CommandError> {
    let torus = torus(configuration)?;
    let State { positions, strengths, .. } = read_positions(path, &torus)?;
    let strengths = strengths.map_or_else(|| configuration.strengths.clone(), Strengths::OfFile);
    let discs = positions.iter().enumerate().map(|(id, &position)| Disc {
        id: id as u32,
        position,
        strength: strengths.of(id),
    });
    let forces = Engine::with_ids(&configuration.parameters(), Clock::START, discs)?.forces()?;
    let row = |(position, [force_x, force_y]): (&Position, [f64; 2])| {
        [torus.coordinate(position.x), torus.coordinate(position.y), force_x, force_y]
    };
    Ok(positions.iter().zip(forces).map(row).collect())
}

/// `id,x,y,fx,fy`.
fn table(rows: &[[f64; 4]]) -> String {
    let mut table = String::from("id,x,y,fx,fy\n");
    for (id, [x, y, force_x, force_y]) in rows.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{id},{x},{y},{force_x},{force_y}");
    }
    table
}
