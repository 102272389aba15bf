//! `meniscus reproduce` as its users start it. What it runs is tested in the library, with a few discs.

use meniscus_tests::program::{Program, errors};

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"))
}

#[test]
fn a_figure_that_does_not_exist_is_refused_with_those_that_do() {
    let output = program().start(&["reproduce", "fig-99"]);
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("fig-99") && said.contains("expected all, or some of text, fig-2, fig-3"),
        "{said}"
    );
}

#[test]
fn a_report_is_made_where_nothing_has_been_run() {
    let program = program();
    let said = program.succeed(&["reproduce", "text", "fig-12", "--draw-only", "--out", "paper"]);
    assert!(said.starts_with("0 of 4 runs; "), "{said}");
    let report = program.text("paper/report.md");
    assert!(report.contains("paper's text inconsistent") && report.contains("0 of 4 runs"), "{report}");
    assert!(program.text("paper/report.html").ends_with("</html>\n"));
}
