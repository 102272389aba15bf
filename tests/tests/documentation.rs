//! The commands in the documentation do what it says.

use meniscus_tests::program::{Program, errors};
use std::fs;
use std::path::Path;

/// The blocks of a page that are marked as `language`, without their indentation.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut lines = page.lines().map(str::trim_start);
    while let Some(line) = lines.next() {
        if line == format!("```{language}") {
            blocks.push(
                lines.by_ref().take_while(|line| *line != "```").map(|line| format!("{line}\n")).collect(),
            );
        }
    }
    blocks
}

#[test]
fn the_page_on_golden_runs_can_be_followed() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../host/docs/golden-runs.md");
    let page = fs::read_to_string(page).unwrap();
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    let shell = blocks(&page, "sh");
    assert_eq!(shell.len(), 4);
    let run = |line: &str| {
        let output = program.shell(&format!("set -e\n{line}"));
        assert!(output.status.success(), "{line}: {}", errors(&output));
        String::from_utf8(output.stdout).unwrap()
    };
    run(&shell[0]);
    let records = program.text("collapse.golden").lines().filter(|line| line.starts_with("  [")).count();
    assert!((3..=30).contains(&records), "{records} records");
    let workflow = blocks(&page, "yaml").concat();
    let line = workflow.lines().find_map(|line| line.strip_prefix("- run: meniscus ")).unwrap();
    assert!(run(&format!("meniscus {line}")).starts_with("equal: "));
    assert_eq!(run(&shell[1]).matches("equal: ").count(), 3);
    assert!(run(&shell[2]).starts_with('{'));
    let stages = run(&shell[3]);
    let words = "masses, field, mesh force, pair force, external force, total force, largest force, time step, \
                 displacement and positions";
    let text: Vec<&str> = page.split_whitespace().collect();
    assert!(text.join(" ").contains(words), "the stages are named");
    for line in stages.lines() {
        assert!(words.contains(line[..15].trim_end()), "{line}");
    }
    assert!(page.contains(&format!("--tag v{} meniscus", env!("CARGO_PKG_VERSION"))));
}

#[test]
fn the_page_on_ensembles_can_be_followed() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../host/docs/ensembles.md");
    let page = fs::read_to_string(page).unwrap();
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    let shell = blocks(&page, "sh");
    assert_eq!(shell.len(), 4);
    for block in &shell {
        let output = program.shell(&format!("set -e\n{block}"));
        assert!(output.status.success(), "{block}: {}", errors(&output));
    }
    let table = program.text("lengths/observables.csv");
    let header = table.lines().next().unwrap();
    let expected = "system.capillary_length,motion.noise,bin,time,time_over_jeans,runs,dt,dt_error,";
    assert!(header.starts_with(expected), "{header}");
    for name in ["members.csv", "observables.csv", "sweep.toml", "runs/"] {
        assert!(
            page.contains(&format!("`{name}")) && program.folder().join("lengths").join(name).exists(),
            "{name}"
        );
    }
    assert_eq!(program.text("lengths/members.csv").matches(",finished,").count(), 8);
}
