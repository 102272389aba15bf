//! The way from runs to a report, with a few discs.

use super::*;
use crate::ensemble::Nobody;
use catalogue::{CATALOGUE, entry};

#[test]
fn every_campaign_has_its_turn_early() {
    let all: Vec<&Entry> = CATALOGUE.iter().collect();
    let rounds = rounds(&all, Size::Full, None);
    let first: Vec<Campaign> = rounds.iter().take(5).map(|round| round.campaign).collect();
    assert_eq!(first, Campaign::ALL);
    assert_eq!(rounds.last(), Some(&Round { campaign: Campaign::Modes, seeds: 20 }));
    assert_eq!(rounds.iter().filter(|round| round.campaign == Campaign::Rings).count(), 1);
}

#[test]
fn a_report_is_written_of_what_has_finished() {
    let of = |names: &[&str]| -> Vec<&Entry> { names.iter().map(|name| entry(name).unwrap()).collect() };
    let chosen = of(&["fig-2", "fig-5", "fig-7", "fig-13", "fig-14", "meshes"]);
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let report = |entries: &[&Entry]| report_on(entries, directory, Size::Tiny, None).unwrap();
    let stop = AtomicBool::new(false);
    let machinery = Machinery { workers: 2, deadline: None, stop: &stop };
    for round in rounds(&chosen, Size::Tiny, None) {
        let report = advance(round, directory, Size::Tiny, machinery, &Nobody).unwrap();
        assert!(report.is_complete(), "{:?}", report.fates);
    }
    for section in report(&chosen).sections {
        assert_eq!(section.finished, section.planned, "{}", section.name);
        assert!(!section.pictures.is_empty() && !section.findings.is_empty(), "{}", section.name);
    }
    let disc = of(&["fig-14"]);
    write(&files(&report(&disc)).unwrap(), directory).unwrap();
    for name in ["figures/fig-14.svg", "figures/fig-14.png", MARKDOWN] {
        assert!(directory.join(name).metadata().unwrap().len() > 0, "{name}");
    }
    // The same runs give the same report.
    assert_eq!(fs::read_to_string(directory.join(HTML)).unwrap(), report(&disc).html());
    // A table that is gone is named, with what to do.
    let evidence = evidence(&disc, directory, Size::Tiny, None).unwrap();
    let run = evidence.of(Campaign::Disc)[0].directory.clone();
    fs::remove_file(run.join("radii.csv")).unwrap();
    let message = report_on(&disc, directory, Size::Tiny, None).unwrap_err().to_string();
    assert!(
        message.contains("radii.csv") && message.contains(&format!("remove {}", run.display())),
        "{message}"
    );
}
