//! How far a run's files had come when a checkpoint was written: the text of its section `PROG`.
//!
//! It is JSON on one line.
//!
//! | Key | What |
//! |---|---|
//! | `version` | version of Meniscus that wrote it |
//! | `tables` | by the name of each series that is written: `next`, the number of the next due time; `bytes`, the length of its file |
//! | `start` | SHA-256 of `start.state`, null if no table compares with it |
//! | `trajectory` | `next`; `frames` and `bytes` of the trajectory |
//! | `snapshots` | `next` |
//! | `golden` | `path` of the golden file, null for `golden.toml` in the directory; `every` how many steps there is a record; `records` in it |
//! | `mesh_reuse` | what holding mesh forces has saved |
//! | `checkpoints` | checkpoints written, this one included |

use crate::engine::MeshReuse;
use crate::files::trajectory::Extent;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Progress {
    pub version: String,
    pub tables: BTreeMap<String, Table>,
    pub start: Option<String>,
    pub trajectory: Frames,
    pub snapshots: Pictures,
    pub golden: Records,
    pub mesh_reuse: MeshReuse,
    pub checkpoints: u64,
}

/// Of a table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Table {
    pub next: u64,
    pub bytes: u64,
}

/// Of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Frames {
    pub next: u64,
    pub frames: u64,
    pub bytes: u64,
}

impl Frames {
    pub(super) fn extent(self) -> Extent {
        Extent { frames: self.frames, bytes: self.bytes }
    }
}

/// Of snapshots, a file each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Pictures {
    pub next: u64,
}

/// Of golden records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Records {
    pub path: Option<String>,
    pub every: u64,
    pub records: usize,
}

impl Progress {
    pub(super) fn to_text(&self) -> serde_json::Result<String> {
        serde_json::to_string(self)
    }

    pub(super) fn from_text(text: &str) -> serde_json::Result<Self> {
        serde_json::from_str(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let progress = Progress {
            version: "0.1.0".to_owned(),
            tables: BTreeMap::from([("modes".to_owned(), Table { next: 3, bytes: u64::MAX })]),
            start: Some("12ab".to_owned()),
            trajectory: Frames { next: 1, frames: 2, bytes: 3 },
            snapshots: Pictures { next: 0 },
            golden: Records { path: Some("a \"b\"/\n.toml".to_owned()), every: 1000, records: 7 },
            mesh_reuse: MeshReuse::default(),
            checkpoints: 4,
        };
        let text = progress.to_text().unwrap();
        assert_eq!(text.lines().count(), 1);
        assert_eq!(Progress::from_text(&text).unwrap(), progress);
        assert!(Progress::from_text(&text.replace("next", "nxet")).is_err());
    }
}
