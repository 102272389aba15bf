//! Ensembles: seeds times values of configuration keys, run side by side, and their tables gathered.
//!
//! In: a sweep, a file of TOML such as
//!
//! ```toml
//! version = 1
//! preset = "fig-5"              # or configuration = "base.toml", relative to this file
//! set = ["time.until=3"]        # overrides of every member, as `--set`
//! seeds = 10                    # 1 to 10, or an array of seeds
//!
//! [sweep]                       # every combination; dotted keys of configurations, each with an array
//! "system.capillary_length" = [5, 10, 25, 50, 270, 1500, 5000]
//! ```
//!
//! Out: a directory with `sweep.toml`, the run directory of each member below `runs`, `members.csv`, and one gathered
//! table for each [series](crate::observables::series) that runs write ([`gather()`]). Every configuration is checked before anything runs.
//! A member's directory is named after its configuration, so finished members are kept and unfinished ones go on
//! ([`run()`]), whoever runs the sweep again, after whatever stop. What is left does not depend on threads, shares, order or
//! stops; of the gathered tables and `members.csv` not one byte. (`run.json` and checkpoints tell of machines and stops.) A
//! file of positions that members start from is not part of their names: one that has changed needs another directory.
//!
//! ```
//! use meniscus::ensemble::{Nobody, Request, Selection, Sweep, gather, run};
//! use meniscus::files::table::Table;
//! use std::path::Path;
//! use std::sync::atomic::AtomicBool;
//!
//! let text = r#"
//! version = 1
//! preset = "fig-5"
//! set = ["system.particles=20", "force.method=pm", "time.until=0.001", "output.observables=0.001"]
//! seeds = 2
//! [sweep]
//! "system.box" = [40, 50]
//! "#;
//! let sweep = Sweep::from_text("small.toml", text, Path::new(""))?;
//! assert_eq!(sweep.members()[3].label(), "seed 2, system.box = 50");
//!
//! let folder = tempfile::tempdir()?;
//! let stop = AtomicBool::new(false);
//! let request = Request { selection: Selection::All, workers: 2, deadline: None, stop: &stop };
//! assert!(run(&sweep, folder.path(), &request, &Nobody)?.is_complete());
//! assert_eq!(gather(folder.path())?.finished, 4);
//!
//! let table = Table::read(&folder.path().join("observables.csv"))?.with("system.box", "40")?;
//! assert_eq!(table.text("runs")?, ["2", "2"]);
//! assert_eq!(table.numbers("clusters_error")?.len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bins;
mod error;
mod gather;
mod member;
mod observer;
mod pool;
mod read;
mod selection;
mod standing;
mod sweep;

pub(crate) use bins::Bins;
pub use error::{EnsembleError, MemberError};
pub use gather::{Gathered, gather, gather_sweep};
pub use member::{Member, RUNS, Setting};
pub use observer::{Limited, Nobody, Observer};
pub use pool::{Fate, LARGE_GRID, LARGE_PARTICLES, Report, Request, run};
pub use selection::Selection;
pub use standing::{Finished, Standing};
pub use sweep::{LARGEST_COUNT, Sweep, VERSION};

use crate::files::atomic::write_atomically;
use std::fs;
use std::path::Path;

/// Name of the sweep in the directory of an ensemble.
pub const SWEEP: &str = "sweep.toml";

/// Name of the table of members in the directory of an ensemble.
pub const MEMBERS: &str = "members.csv";

/// Writes `sweep` to the directory of its ensemble, unless it is there.
fn keep_sweep(sweep: &Sweep, directory: &Path) -> Result<(), EnsembleError> {
    let text = sweep.to_toml();
    for (name, text) in [(sweep::CONFIGURATION, sweep.configuration()), (SWEEP, Some(text.as_str()))] {
        let path = directory.join(name);
        if let Some(text) = text
            && !fs::read(&path).is_ok_and(|found| found == text.as_bytes())
        {
            write_atomically(&path, text.as_bytes())?;
        }
    }
    Ok(())
}
