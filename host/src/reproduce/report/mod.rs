//! The report: what the paper says, what was found, and the runs that anyone can repeat.
//!
//! In: sections with findings and drawn figures, and the campaigns with the digests of their runs. Out: Markdown that
//! names the figures' files, and one page of HTML with the figures in it. The same report gives the same bytes: nothing of
//! clocks, machines or paths is in it.
//!
//! ```
//! use meniscus::reproduce::campaign::Size;
//! use meniscus::reproduce::finding::{Criterion, Finding};
//! use meniscus::reproduce::report::{Report, Section};
//!
//! let section = Section {
//!     name: "fig-12".to_owned(),
//!     title: "Fig. 12".to_owned(),
//!     paper: "A0 = 1.15".to_owned(),
//!     findings: vec![Finding::new("A0", "1.15", Criterion::equals(1.15, 0.01))],
//!     ..Section::default()
//! };
//! let report = Report { size: Size::Full, sections: vec![section], campaigns: Vec::new() };
//! assert!(report.markdown().contains("| A0 | 1.15 | – |"));
//! assert!(report.html().starts_with("<!DOCTYPE html>"));
//! ```

mod html;
mod markdown;

use super::campaign::Size;
use super::finding::{Finding, Verdict};

/// A figure in a report.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its file below `figures`, without ending.
    pub stem: String,
    /// What is to be seen.
    pub caption: String,
    /// The figure.
    pub svg: String,
}

/// What a report says of one figure of the paper.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Its name on the command line.
    pub name: String,
    /// Its heading.
    pub title: String,
    /// What the paper says.
    pub paper: String,
    /// The figures.
    pub pictures: Vec<Picture>,
    /// The comparisons.
    pub findings: Vec<Finding>,
    /// What else is to be said: how things were measured, what is behind a verdict.
    pub notes: Vec<String>,
    /// How many of its runs have finished.
    pub finished: usize,
    /// How many there are to be.
    pub planned: usize,
}

/// A run in a report.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecord {
    /// Name of its directory.
    pub hash: String,
    /// Its seed.
    pub seed: u64,
    /// λ, R0.
    pub capillary_length: f64,
    /// Steps made.
    pub steps: u64,
    /// SHA-256 of its last state.
    pub digest: String,
}

/// A campaign in a report.
#[derive(Clone, Debug, PartialEq)]
pub struct CampaignRecord {
    /// Its name, and that of its directory.
    pub name: String,
    /// Its sweep, TOML.
    pub sweep: String,
    /// How any of its runs is repeated from nothing but the program.
    pub command: String,
    /// How many runs it is to have.
    pub planned: usize,
    /// Those that have finished.
    pub runs: Vec<RunRecord>,
}

/// All of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How large the runs are.
    pub size: Size,
    /// What it says of each figure, in the order of the paper.
    pub sections: Vec<Section>,
    /// The runs it rests on.
    pub campaigns: Vec<CampaignRecord>,
}

impl Section {
    /// How many of its findings have a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.findings.iter().filter(|finding| finding.verdict() == verdict).count()
    }
}

impl Report {
    /// The report as Markdown (CommonMark with tables); figures are files below `figures`.
    #[must_use]
    pub fn markdown(&self) -> String {
        markdown::markdown(self)
    }

    /// The report as one page of HTML that needs no other file.
    #[must_use]
    pub fn html(&self) -> String {
        html::html(self)
    }

    /// How many findings have a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.sections.iter().map(|section| section.count(verdict)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::finding::Criterion;
    use crate::statistics::Estimate;

    fn made_up() -> Report {
        let finding = |name: &str, value: f64| {
            Finding::new(name, "1.16 | top", Criterion::equals(1.16, 0.01))
                .measured(Some(Estimate::new(value, 0.001)))
        };
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"8\" height=\"8\">\n\n<text>a_b*c*</text></svg>\n";
        let section = Section {
            name: "fig-12".to_owned(),
            title: "Fig. 12: rings & <rings>".to_owned(),
            paper: "A0 ≈ 1.16, *more or less*".to_owned(),
            pictures: vec![Picture {
                stem: "fig-12".to_owned(),
                caption: "R(t)".to_owned(),
                svg: svg.to_owned(),
            }],
            findings: vec![finding("A0 of ring 5", 1.1587), finding("A0 of ring 3", 1.3)],
            notes: vec!["Eq. 30 is fitted.".to_owned()],
            finished: 1,
            planned: 4,
        };
        let campaigns = vec![CampaignRecord {
            name: "rings".to_owned(),
            sweep: "version = 1\n".to_owned(),
            command: "meniscus run fig-13 --set 'time.until=2'".to_owned(),
            planned: 4,
            runs: vec![RunRecord {
                hash: "0123".to_owned(),
                seed: 1,
                capillary_length: f64::INFINITY,
                steps: 7,
                digest: "abcd".to_owned(),
            }],
        }];
        Report { size: Size::Quick, sections: vec![section], campaigns }
    }

    #[test]
    fn markdown_has_each_finding_with_its_verdict() {
        let text = made_up().markdown();
        assert!(text.contains("| A0 of ring 5 | 1.16 \\| top | 1.1587 ± 0.0010 |"), "{text}");
        assert!(text.contains("| reproduced |") && text.contains("| **not reproduced** |"), "{text}");
        assert!(text.contains("![fig-12](figures/fig-12.svg)"), "{text}");
        assert!(text.contains("1 of 4 runs"), "{text}");
        assert_eq!(text, made_up().markdown());
    }

    #[test]
    fn html_is_well_formed_and_needs_nothing_else() {
        let page = made_up().html();
        let document = roxmltree::Document::parse_with_options(
            &page,
            roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() },
        );
        let document = document.unwrap_or_else(|error| panic!("{error}\n{page}"));
        assert_eq!(
            document
                .descendants()
                .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "svg")))
                .count(),
            1
        );
        let names = ["src", "href"];
        let links = document.descendants().flat_map(|node| node.attributes());
        let outside: Vec<_> = links
            .filter(|attribute| names.contains(&attribute.name()) && !attribute.value().starts_with('#'))
            .collect();
        assert!(outside.is_empty(), "{outside:?}");
        assert!(page.contains("a_b*c*"), "the drawing is not taken for Markdown");
        assert_eq!(page, made_up().html());
    }
}
