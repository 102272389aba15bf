//! What the core's source may not hold: arithmetic whose bits depend on platform, compiler or order.
//!
//! Lints refuse most of it where types are known; this reads the text, so that a generic or a macro hides nothing.
//! `no-fused-multiply-add` beside this folder looks at the machine code.

use std::path::{Path, PathBuf};

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/src")
}

/// The lines of a source without comments, as (number, code).
fn code(text: &str) -> Vec<(usize, &str)> {
    (1..).zip(text.lines()).map(|(number, line)| (number, line.split("//").next().unwrap_or(""))).collect()
}

/// What a feature that is off by default adds to the root of the core, the kit that tests kernels and links std.
const KIT: [&str; 2] = [
    "#[cfg(feature = \"proptest\")]\nextern crate std;\n",
    "#[cfg(feature = \"proptest\")]\npub mod property;\n",
];

/// Every source of the core but the [`KIT`]: (name, text).
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn all_sources() -> Vec<(String, String)> {
    let mut all = Vec::new();
    let mut folders = vec![sources()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                if !path.ends_with("property") {
                    folders.push(path);
                }
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = path.strip_prefix(sources()).unwrap().display().to_string();
                let text = std::fs::read_to_string(&path).unwrap();
                let text = if name == "lib.rs" {
                    KIT.iter().fold(text, |text, kit| text.replace(kit, ""))
                } else {
                    text
                };
                all.push((name, text));
            }
        }
    }
    all.sort();
    all
}

/// Whether `word` stands in `line` as a word of its own.
fn has_word(line: &str, word: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + word.len()..].chars().next();
        !before.is_some_and(part_of_name) && !after.is_some_and(part_of_name)
    })
}

/// Words no line of the core may hold.
const FORBIDDEN: [&str; 16] = [
    "mul_add",
    "fma",
    "fmaf",
    "fmul_fast",
    "fadd_fast",
    "algebraic_add",
    "algebraic_mul",
    "rsqrt",
    "unsafe",
    "HashMap",
    "HashSet",
    "std",
    "asm",
    "powi",
    "transmute",
    "Instant",
];

/// Methods of floating-point numbers that come from the platform's libraries or fix no order of operations.
const PLATFORM_METHODS: [&str; 26] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "hypot", "cbrt", "sin_cos",
    "sqrt",
];

/// Lines of `text` that the core may not hold, with the word at fault.
fn offences(text: &str) -> Vec<(usize, String)> {
    let mut offences = Vec::new();
    for (number, line) in code(text) {
        for word in FORBIDDEN {
            if has_word(line, word) {
                offences.push((number, word.to_string()));
            }
        }
        for method in PLATFORM_METHODS {
            for call in [format!(".{method}("), format!("f32::{method}"), format!("f64::{method}")] {
                if line.contains(&call) && !line.contains(&format!("libm::{method}")) {
                    offences.push((number, call));
                }
            }
        }
    }
    offences
}

/// The body of the function `name`, braces and all.
fn body<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let heads = [format!("fn {name}("), format!("fn {name}<")];
    let start = heads.iter().find_map(|head| text.find(head.as_str()))?;
    let open = start + text[start..].find('{')?;
    let mut depth = 0_usize;
    for (at, c) in text[open..].char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(&text[start..=open + at]);
        }
    }
    None
}

#[test]
fn the_core_holds_no_arithmetic_that_depends_on_the_platform() {
    let sources = all_sources();
    assert!(sources.len() >= 16, "found {}", sources.len());
    for (name, text) in &sources {
        assert_eq!(offences(text), [], "{name}");
    }
}

#[test]
fn a_planted_offence_is_found() {
    let planted = "fn f(x: f32) -> f32 {\n    // x.mul_add(1.0, 2.0)\n    x.mul_add(1.0, 2.0) + x.powf(2.0) + f32::exp(x)\n}";
    let found: Vec<String> =
        offences(planted).into_iter().map(|(line, word)| format!("{line} {word}")).collect();
    assert_eq!(found, ["3 mul_add", "3 f32::exp", "3 .powf("]);
    assert_eq!(offences("libm::sqrtf(x) + libm::logf(y) + libm::sin(z)"), []);
}

#[test]
fn what_runs_every_step_is_free_of_binary64() {
    // Whole rooms.
    for room in [
        "assignment.rs",
        "cells.rs",
        "crowding.rs",
        "digest.rs",
        "forces.rs",
        "grid.rs",
        "memory.rs",
        "mesh.rs",
        "noise.rs",
        "stages.rs",
        "stencil.rs",
        "transform.rs",
    ] {
        let text = std::fs::read_to_string(sources().join(room)).unwrap();
        for (number, line) in code(&text) {
            assert!(!has_word(line, "f64"), "{room}:{number}: {line}");
        }
    }
    // The kernels of rooms that also set up.
    let kernels = [
        ("dynamics.rs", vec!["forces", "next_step", "step", "compute", "displacement", "keep_forces"]),
        ("fields.rs", vec!["is_zero", "at"]),
        ("near_part.rs", vec!["index_of", "evaluate"]),
        ("pair_force.rs", vec!["of", "over_distance", "product_of_strengths", "quantise"]),
        ("ermak.rs", vec!["largest_force", "step_length", "of", "component", "displace"]),
        ("refresh.rs", vec!["is_due", "holds", "at", "to_bytes"]),
        ("repulsion.rs", vec!["force_over_distance"]),
        ("torus.rs", vec!["minimum_image"]),
        ("units.rs", vec!["round_half_even"]),
    ];
    for (room, functions) in kernels {
        let text = std::fs::read_to_string(sources().join(room)).unwrap();
        for function in functions {
            let body = body(&text, function).unwrap_or_else(|| panic!("{room} has no {function}"));
            for (number, line) in code(body) {
                assert!(!has_word(line, "f64"), "{room}, {function}, line {number}: {line}");
            }
        }
    }
}

#[test]
fn the_core_stands_on_nothing_but_core() {
    let root = std::fs::read_to_string(sources().join("lib.rs")).unwrap();
    assert!(root.contains("#![no_std]") && root.contains("#![forbid(unsafe_code)]"));
    assert!(KIT.iter().all(|kit| root.contains(kit)), "the kit is not behind its feature");
    for (name, text) in all_sources() {
        assert!(!text.contains("extern crate"), "{name}");
    }
}
