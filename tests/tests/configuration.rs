//! Configurations: files that must be accepted, files that must be refused with one exact line, and
//! properties over random ones.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::path::{Path, PathBuf};

use meniscus::configuration::keys::{KEYS, Kind, TABLES};
use meniscus::configuration::{
    ACCURACY_RANGE, Assignment, Attraction, Configuration, Fields, Force, Gradient, Influence, Lattice, Mesh,
    Motion, Noise, Output, Physical, Start, System, Time, VERSION,
};
use meniscus::files::trajectory::Format;
use meniscus::strengths::{ONE, Strengths};
use meniscus_tests::long_tests;
use proptest::prelude::*;

/// The TOML files of a directory beside this test's package, in the order of their names.
fn files_of(directory: &str) -> Vec<PathBuf> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(directory);
    let mut files: Vec<PathBuf> = std::fs::read_dir(&directory)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    files
}

/// Reads a file under its bare name.
fn read(path: &Path) -> Result<Configuration, String> {
    let name = path.file_name().unwrap().to_str().unwrap();
    let bytes = std::fs::read(path).unwrap();
    Configuration::from_bytes(name, &bytes, &[]).map_err(|error| error.to_string())
}

#[track_caller]
fn assert_round_trip(configuration: &Configuration) {
    let text = configuration.to_toml();
    let again = Configuration::from_text("written.toml", &text, &[]);
    assert_eq!(again.as_ref(), Ok(configuration), "{text}");
}

#[test]
fn good_files_are_accepted_and_read_back_equal() {
    let files = files_of("good");
    assert!(!files.is_empty());
    for path in files {
        let configuration = read(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_round_trip(&configuration);
        assert_eq!(configuration.parameters().validate(), Ok(()));
    }
}

/// Run with `MENISCUS_WRITE_EXPECTED=1` to write the messages down; then read them.
#[test]
fn bad_files_are_refused_with_exactly_their_message() {
    let files = files_of("bad");
    assert!(files.len() >= 120, "{}", files.len());
    for path in files {
        let message = read(&path).expect_err(&path.display().to_string());
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(!message.ends_with('.'), "{message}");
        let expected = path.with_extension("expected");
        if std::env::var_os("MENISCUS_WRITE_EXPECTED").is_some() {
            std::fs::write(&expected, format!("{message}\n")).unwrap();
        }
        let expected = std::fs::read_to_string(&expected).unwrap_or_default();
        assert_eq!(message, expected.trim_end(), "{}", path.display());
    }
}

#[test]
fn presets_read_back_equal_with_all_that_was_chosen() {
    let presets = meniscus::configuration::PRESETS.iter();
    // What is chosen takes seconds without optimisation.
    for preset in presets.filter(|preset| long_tests() || preset.name == "fig-12") {
        let configuration = Configuration::from_preset(preset.name, &[]).unwrap();
        assert!(configuration.estimated_error().unwrap() <= 1e-3, "{}", preset.name);
        assert_round_trip(&configuration);
        let complete = preset.complete().unwrap();
        assert_eq!(Configuration::from_text("complete", &complete, &[]), Ok(configuration));
    }
}

#[test]
fn strengths_take_the_place_of_one_in_jeans_time() {
    let with = |strengths: &str| {
        let overrides = [format!("system.strengths={strengths}"), "force.method=pm".to_owned()];
        Configuration::from_preset("table-1", &overrides).unwrap()
    };
    let one = with("[1]");
    for (strengths, mean_square) in [("[1, -1]", 1.0), ("[2]", 4.0), ("[0, 0, 1, 0]", 0.25), ("[3, 1]", 5.0)]
    {
        let other = with(strengths);
        let [expected, found] = [&one, &other].map(|configuration| configuration.instability().unwrap());
        assert!((expected.jeans_time / found.jeans_time / mean_square - 1.0).abs() < 1e-15, "{strengths}");
        let ratio = found.jeans_wavenumber / expected.jeans_wavenumber;
        assert!((ratio * ratio / mean_square - 1.0).abs() < 1e-14, "{strengths}");
    }
    // 2500 discs are one more than 833 times three.
    assert_eq!(with("[1, 0, 0]").strengths.mean_square(2500), 834.0 / 2500.0);
    let free = with("[0]");
    assert_eq!((free.jeans_time(), free.end_time(), free.attraction()), (None, 5.0, 0.0));
}

#[test]
fn a_missing_file_is_named() {
    let error = Configuration::read(Path::new("no/such/file.toml"), &[]).unwrap_err();
    assert!(error.to_string().starts_with("no/such/file.toml: cannot be read: "), "{error}");
}

#[test]
fn a_read_file_is_named_with_its_path() {
    let path = files_of("bad").into_iter().find(|path| path.ends_with("seed-negative.toml")).unwrap();
    let error = Configuration::read(&path, &[]).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}:1: seed: ", path.display())), "{error}");
}

#[test]
fn overrides_mend_what_a_file_lacks() {
    let overrides = ["system.particles=10", "system.box=50", "system.capillary_strength=0"];
    let overrides = overrides.map(str::to_owned);
    let configuration = Configuration::from_text("short.toml", "version = 1", &overrides).unwrap();
    assert_eq!(configuration.system.particles, 10);
    assert_eq!(configuration.force.method_word(), "p3m");
    assert_eq!(configuration.estimated_error(), Some(0.0));
}

/// Numbers of all magnitudes in (0, `most`].
fn positive(most: f64) -> impl Strategy<Value = f64> {
    (1.0_f64..10.0, -12_i32..5).prop_map(move |(digits, exponent)| {
        let number: f64 = format!("{digits:?}e{exponent}").parse().unwrap();
        number.min(most)
    })
}

/// Intervals and ends.
fn times() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.0_f64..10.0, positive(10.0)]
}

fn capillary_length() -> impl Strategy<Value = f64> {
    prop_oneof![Just(f64::INFINITY), 0.011_f64..10_000.0]
}

/// A mesh whose spacing is allowed, and a box with it.
fn mesh_and_side() -> impl Strategy<Value = (Mesh, f64)> {
    let assignment = prop::sample::select(Assignment::ALL.to_vec());
    let influence = prop_oneof![Just(Influence::Paper), Just(Influence::Continuum)];
    let gradient =
        prop_oneof![Just(Gradient::Spectral), Just(Gradient::Difference2), Just(Gradient::Difference4)];
    (4_u32..13, 0.3_f64..16.0, assignment, influence, gradient).prop_map(
        |(exponent, spacing, assignment, influence, gradient)| {
            let grid = 1 << exponent;
            let side = (grid as f64 * spacing).clamp(4.5, 65_535.0);
            (Mesh { grid, assignment, influence, gradient }, side)
        },
    )
}

/// A start that fits in a box of `side`, and its number of discs.
fn start_in(side: f64) -> impl Strategy<Value = (Start, usize)> {
    let fits = |area: f64| 1..(0.15 * area).clamp(2.0, 4_194_304.0) as usize;
    let lattice = prop_oneof![Just(Lattice::Square), Just(Lattice::Hexagonal)];
    prop_oneof![
        fits(side * side).prop_map(|particles| (Start::Random, particles)),
        (0.1_f64..1.0).prop_map(move |part| (Start::Disc { radius: part * side / 2.0 }, 1)),
        (1_u32..20, 1_u32..20, 0.01_f64..0.9).prop_map(move |(rings, per_ring, part)| {
            let spacing = part * side / 2.0 / f64::from(rings);
            let particles = 1 + per_ring * rings * (rings + 1) / 2;
            (Start::Rings { rings, spacing, per_ring }, particles as usize)
        }),
        (lattice, 1_usize..4_194_305)
            .prop_map(|(lattice, particles)| (Start::Lattice { lattice }, particles)),
        (any::<String>(), 1_usize..4_194_305)
            .prop_filter("a path is not empty", |(path, _)| !path.is_empty())
            .prop_map(|(path, particles)| (Start::File { path: path.into(), density: None }, particles)),
    ]
}

fn motion() -> impl Strategy<Value = Motion> {
    let noise = prop_oneof![Just(Noise::Uniform), Just(Noise::Gaussian), Just(Noise::None)];
    (noise, positive(1.0), positive(0.5)).prop_map(|(noise, max_step, max_displacement)| Motion {
        noise,
        max_step,
        max_displacement,
    })
}

/// Of a run in a box of `side`, with radii if it starts from a patch. On the heap: the stack of a test is short.
fn output(side: f64, is_patch: bool) -> BoxedStrategy<Output> {
    let steps = prop_oneof![Just(0), 1_u64..1000, Just(i64::MAX as u64)];
    let format = prop::sample::select(Format::WORDS.map(|(_, format)| format).to_vec());
    let lengths = (5_u32..9, prop_oneof![Just(7.5), positive(100.0)]);
    let thresholds = prop::collection::btree_set(1_u32..10_000, 1..5)
        .prop_map(|set| set.into_iter().map(|number| f64::from(number) / 1000.0).collect::<Vec<_>>());
    let intervals = prop::array::uniform5(times());
    (prop::array::uniform3(times()), format, steps, times(), intervals, (thresholds, lengths, 1_u32..1025))
        .prop_map(
            move |(usual, trajectory_format, checkpoint_steps, checkpoint_minutes, series, settings)| {
                let [observables, trajectory, snapshots] = usual;
                let [minkowski, modes, radial_distribution, structure_factor, radii] = series;
                let (minkowski_thresholds, (cells, radii_width), modes_shells) = settings;
                Output {
                    observables,
                    trajectory,
                    trajectory_format,
                    snapshots,
                    minkowski,
                    minkowski_spacing: side / f64::from(cells),
                    minkowski_thresholds,
                    modes,
                    modes_shells,
                    radial_distribution,
                    structure_factor,
                    radii: if is_patch { radii } else { 0.0 },
                    radii_width,
                    checkpoint_steps,
                    checkpoint_minutes,
                }
            },
        )
        .boxed()
}

fn capillary_strength() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.001_f64..1000.0]
}

/// Fields in a box of `side`.
fn fields_in(side: f64) -> impl Strategy<Value = Fields> {
    let (force, part) = (|| prop_oneof![Just(0.0), -1e6_f64..1e6], || prop_oneof![Just(0.5), 0.0_f64..=1.0]);
    let stiffness = prop_oneof![Just(0.0), 0.0_f64..1e3];
    (force(), force(), stiffness, part(), part()).prop_map(move |(x, y, trap_stiffness, part_x, part_y)| {
        Fields { uniform_force: [x, y], trap_stiffness, trap_center: [part_x * side, part_y * side] }
    })
}

/// How far discs may move in a box of `side`.
fn mesh_refresh(side: f64) -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 1e-6_f64..(0.249 * side).min(16.0)]
}

/// Strengths that V0 = `capillary_strength` (kBT) allows.
fn strengths_with(capillary_strength: f64) -> impl Strategy<Value = Strengths> {
    let largest = (0.999 * (1000.0 / capillary_strength.max(1e-3)).sqrt()).min(1000.0);
    let largest = (largest * f64::from(ONE)) as i32;
    let strength = prop_oneof![-largest..=largest, Just(0), Just(-ONE.min(largest))];
    prop_oneof![
        Just(Strengths::default()),
        prop::collection::vec(strength, 1..20).prop_map(Strengths::Pattern),
    ]
}

/// A valid configuration in reduced units, its force summed on the mesh alone.
fn configuration() -> impl Strategy<Value = Configuration> {
    mesh_and_side()
        .prop_flat_map(|(mesh, side)| (Just(mesh), Just(side), start_in(side)))
        .prop_flat_map(|(mesh, side, (start, particles))| {
            let is_patch = !matches!(start, Start::Random | Start::Lattice { .. });
            (
                (Just(mesh), Just(side), Just(start), Just(particles)),
                capillary_strength().prop_flat_map(|strength| (Just(strength), strengths_with(strength))),
                (capillary_length(), any::<bool>()),
                (
                    motion(),
                    times(),
                    output(side, is_patch),
                    0_u64..1 << 63,
                    fields_in(side),
                    mesh_refresh(side),
                ),
            )
        })
        .prop_map(|((mesh, side, start, particles), (strength, strengths), (length, repulsion), rest)| {
            let (motion, until, output, seed, fields, mesh_refresh) = rest;
            Configuration {
                version: VERSION,
                seed,
                physical: None,
                system: System {
                    particles,
                    side,
                    capillary_strength: strength,
                    capillary_length: length,
                    repulsion,
                },
                strengths,
                force: Force::ParticleMesh,
                mesh_refresh,
                mesh,
                fields,
                motion,
                start,
                time: Time { until },
                output,
            }
        })
        .prop_filter("the end can be held", |configuration| configuration.end_time() < 1e7)
}

/// The same with the system in SI.
fn physical_configuration() -> impl Strategy<Value = Configuration> {
    (configuration(), 1e-9_f64..1e-4, 1.0_f64..1000.0, 1e3_f64..1e12, any::<bool>())
        .prop_map(|(configuration, radius, temperature, mobility, by_force)| {
            let System { particles, side, capillary_strength, capillary_length, repulsion } =
                configuration.system;
            let attraction = if by_force {
                Attraction::Force { force: -1e-11, surface_tension: 0.072 }
            } else {
                Attraction::Strength(capillary_strength)
            };
            let physical = Physical {
                particles,
                radius,
                side: side * radius,
                capillary_length: capillary_length * radius,
                attraction,
                temperature,
                mobility,
                repulsion,
            };
            let strengths = if by_force { Strengths::default() } else { configuration.strengths.clone() };
            Configuration { physical: Some(physical), system: physical.reduced(), strengths, ..configuration }
        })
        .prop_filter("the end can be held", |configuration| configuration.end_time() < 1e7)
}

/// TOML that is nearly a configuration: known and unknown keys with values of any kind.
fn nearly_configuration() -> impl Strategy<Value = String> {
    let names: Vec<String> = KEYS
        .iter()
        .map(|key| key.name)
        .chain(TABLES.iter().map(|table| table.name))
        .map(str::to_owned)
        .collect();
    let words: Vec<String> = KEYS
        .iter()
        .filter_map(|key| match key.kind {
            Kind::Choice(words) => Some(words),
            _ => None,
        })
        .flatten()
        .map(|word| format!("{word:?}"))
        .collect();
    let name = prop_oneof![4 => prop::sample::select(names), 1 => "[a-z_.]{1,12}", 1 => "\"\\PC{0,6}\""];
    let value = prop_oneof![
        prop::sample::select(words),
        any::<i64>().prop_map(|number| number.to_string()),
        any::<f64>().prop_map(|number| format!("{number:?}")),
        Just("inf".to_owned()),
        Just("true".to_owned()),
        Just("{ grid = 16 }".to_owned()),
        Just("[[1], 2]".to_owned()),
        Just("1979-05-27T07:32:00Z".to_owned()),
        "\\PC{0,8}",
    ];
    let line = prop_oneof![
        6 => (name.clone(), value).prop_map(|(name, value)| format!("{name} = {value}\n")),
        1 => name.clone().prop_map(|name| format!("[{name}]\n")),
        1 => name.prop_map(|name| format!("[[{name}]]\n")),
    ];
    prop::collection::vec(line, 0..12).prop_map(|lines| lines.concat())
}

/// A message is one line that names the text.
fn assert_one_line(result: Result<Configuration, meniscus::configuration::ConfigurationError>) {
    if let Err(error) = result {
        let message = error.to_string();
        assert_eq!(message.lines().count(), 1, "{message:?}");
        assert!(!message.chars().any(char::is_control), "{message:?}");
    }
}

proptest! {
    #[test]
    fn valid_configurations_read_back_equal(configuration in configuration()) {
        assert_round_trip(&configuration);
    }

    #[test]
    fn valid_configurations_in_si_read_back_equal(configuration in physical_configuration()) {
        assert_round_trip(&configuration);
    }

    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        assert_one_line(Configuration::from_bytes("bytes", &bytes, &[]));
    }

    #[test]
    fn arbitrary_text_never_panics(text in any::<String>(), name in any::<String>()) {
        assert_one_line(Configuration::from_text(&name, &text, &[]));
    }

    #[test]
    fn near_misses_never_panic(text in nearly_configuration()) {
        assert_one_line(Configuration::from_text("near.toml", &text, &[]));
    }

    #[test]
    fn arbitrary_overrides_never_panic(text in any::<String>(), key in 0..KEYS.len()) {
        assert_one_line(Configuration::from_preset("table-1", std::slice::from_ref(&text)));
        let text = format!("{}={text}", KEYS[key].name);
        assert_one_line(Configuration::from_preset("fig-12", std::slice::from_ref(&text)));
        assert_one_line(Configuration::from_preset("table-1-si", &[text]));
    }

    #[test]
    fn arbitrary_preset_names_never_panic(name in any::<String>()) {
        assert_one_line(Configuration::from_preset(&name, &[]));
    }
}

proptest! {
    // What is chosen takes a second without optimisation.
    #![proptest_config(ProptestConfig::with_cases(if long_tests() { 100 } else { 3 }))]

    #[test]
    fn what_is_chosen_for_an_accuracy_reads_back_equal(
        configuration in configuration(), digits in -5.0_f64..-2.0,
    ) {
        let accuracy = libm::pow(10.0, digits).clamp(ACCURACY_RANGE.0, ACCURACY_RANGE.1);
        let text = configuration.to_toml();
        let overrides = ["force.method=p3m".to_owned(), format!("force.accuracy={accuracy:?}")];
        let chosen = Configuration::from_text("chosen.toml", &text, &overrides);
        if let Ok(chosen) = &chosen {
            assert_round_trip(chosen);
            prop_assert!(chosen.estimated_error().unwrap() <= accuracy);
            prop_assert_eq!(chosen.parameters().validate(), Ok(()));
            let pm = ["force.method=pm".to_owned()];
            let back = Configuration::from_text("back.toml", &chosen.to_toml(), &pm).unwrap();
            let paper = Mesh { influence: Influence::Paper, ..chosen.mesh };
            prop_assert_eq!((back.force, back.mesh), (Force::ParticleMesh, paper));
        }
        assert_one_line(chosen);
    }
}
