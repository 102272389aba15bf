//! Which members of an ensemble to run: all, one, or a share, so that a batch system can spread them.
//!
//! ```
//! use meniscus::ensemble::Selection;
//!
//! let shard: Selection = "2/3".parse()?;
//! let chosen: Vec<usize> = (1..=8).filter(|&index| shard.holds(index)).collect();
//! assert_eq!(chosen, [2, 5, 8]);
//! assert!("4/3".parse::<Selection>().is_err());
//! # Ok::<(), String>(())
//! ```

use std::str::FromStr;

/// Which members to run; they are numbered from 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// All of them.
    #[default]
    All,
    /// The one of this number.
    Index(usize),
    /// Every `of`-th, from the `number`-th on: so each share has cheap and dear ones.
    Shard {
        /// Number of the share, 1 to `of`.
        number: usize,
        /// How many shares there are.
        of: usize,
    },
}

impl Selection {
    /// Whether the member of this number, from 1, is to be run.
    #[must_use]
    pub fn holds(&self, index: usize) -> bool {
        match *self {
            Self::All => true,
            Self::Index(one) => index == one,
            Self::Shard { number, of } => index % of.max(1) == number % of.max(1),
        }
    }
}

/// A share as on the command line, `K/N`.
impl FromStr for Selection {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Self::Shard { number, of }),
            _ => Err("expected K/N, the K-th of N shares, K from 1 to N".to_owned()),
        }
    }
}
