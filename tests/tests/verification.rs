//! Two engines that part: the first step and the first stage are found, and the program says them.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus::engine::{Engine, EngineError, Kind, Machinery, ShowsField, Stage, Trace, Traced};
use meniscus::golden::Record;
use meniscus::verification::{Contradiction, Parting, Steps, first_contradiction};
use meniscus_core::assignment::Crowded;
use meniscus_core::dynamics::{Clock, Disc, Dynamics};
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::fields::Fields;
use meniscus_core::forces::Forces;
use meniscus_core::memory::Memory;
use meniscus_core::parameters::Parameters;
use meniscus_core::stages::{Scalar, Stages};
use meniscus_core::torus::Fraction;
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_tests::arrays::Arrays;
use meniscus_tests::program::{Program, errors};
use meniscus_tests::states::{scattered, with_ids};

const GRID: usize = 32;
const DISCS: usize = 90;

/// The core's stages, of which one flips the lowest bit of one value at one step.
struct Flipping {
    scalar: Scalar<AnySize>,
    stage: Stage,
    step: u64,
    steps: u64,
    /// Storage of the disc to be hit.
    slot: usize,
}

impl Flipping {
    fn hits(&self, stage: Stage) -> bool {
        self.stage == stage && self.steps == self.step
    }
}

impl Stages for Flipping {
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool {
        self.scalar.fits(forces, memory)
    }

    fn arrange(&mut self, _: &Forces, memory: &mut Memory<'_>) {
        self.steps += 1;
        self.slot = memory.slots[7] as usize;
    }

    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded> {
        self.scalar.mesh(forces, memory)?;
        if self.hits(Stage::Masses) {
            memory.nodes[100] ^= 1;
        }
        if self.hits(Stage::Field) {
            let value = &mut memory.field[100].im;
            *value = f32::from_bits(value.to_bits() ^ 1);
        }
        if self.hits(Stage::MeshForce) {
            memory.force_x[self.slot] ^= 1;
        }
        Ok(())
    }

    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.scalar.add_pairs(forces, memory);
        if self.hits(Stage::PairForce) {
            memory.force_y[self.slot] ^= 1;
        }
    }

    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.scalar.add_fields(forces, memory);
        if self.hits(Stage::ExternalForce) {
            memory.force_x[self.slot] ^= 1;
        }
    }

    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64 {
        self.scalar.largest_force(memory) ^ u64::from(self.hits(Stage::LargestForce))
    }

    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox> {
        self.scalar.displacements(displacement, memory)?;
        if self.hits(Stage::Displacement) {
            memory.displacement_x[self.slot] ^= 1;
        }
        Ok(())
    }

    fn displace(&mut self, memory: &mut Memory<'_>) {
        self.scalar.displace(memory);
        if self.hits(Stage::Positions) {
            let y = &mut memory.y[self.slot];
            *y = Fraction::from_bits(y.to_bits() ^ 1);
        }
    }
}

impl ShowsField for Flipping {
    fn field<'a>(&'a self, grid: usize, memory: &'a Memory<'_>) -> Box<dyn Iterator<Item = Complex32> + 'a> {
        self.scalar.field(grid, memory)
    }
}

/// A run with a planted fault.
struct Faulty {
    arrays: Arrays,
    dynamics: Dynamics,
    stages: Flipping,
}

impl Faulty {
    fn new(parameters: &Parameters, discs: &[Disc], stage: Stage, step: u64) -> Self {
        let mut arrays = Arrays::new(GRID, 1, DISCS);
        let discs = discs.iter().copied().rev();
        let dynamics = Dynamics::new(parameters, Clock::START, discs, &mut arrays.memory()).unwrap();
        Self {
            arrays,
            dynamics,
            stages: Flipping { scalar: Scalar(AnySize), stage, step, steps: 0, slot: 0 },
        }
    }
}

impl Steps for Faulty {
    fn traced_step(&mut self, trace: &mut Trace) -> Result<Clock, EngineError> {
        let clock = self.dynamics.clock();
        let step = self.dynamics.step(&mut Traced::new(&mut self.stages, trace), &mut self.arrays.memory());
        let step = step.map_err(|error| EngineError::Step(error, clock))?;
        trace.note_step(&step);
        Ok(step.clock)
    }

    fn clock(&self) -> Clock {
        self.dynamics.clock()
    }

    fn record(&self) -> Record {
        let Arrays { slots, x, y, strengths, .. } = &self.arrays;
        self.dynamics.state(slots, (x, y), strengths, self.arrays.held()).digest_by_field().into()
    }
}

fn parameters() -> Parameters {
    let fields = Fields { uniform_force: [1.0, 0.0], ..Parameters::DEFAULT.fields };
    Parameters { side: GRID as f64, grid: GRID, fields, ..Parameters::DEFAULT }.with_p3m()
}

fn discs() -> Vec<Disc> {
    with_ids(&scattered(5, DISCS)).into_iter().map(Disc::from).collect()
}

fn engine(kind: Kind, threads: usize, parameters: &Parameters) -> Engine {
    Engine::with_machinery(Machinery { kind, threads }, parameters, Clock::START, discs()).unwrap()
}

fn advance(engine: &mut Engine, steps: u64) {
    for _ in 0..steps {
        engine.step().unwrap();
    }
}

#[test]
fn a_flipped_bit_is_found_in_its_step_and_its_stage() {
    for (stage, index) in [
        (Stage::Masses, 100),
        (Stage::Field, 201),
        (Stage::MeshForce, 14),
        (Stage::PairForce, 15),
        (Stage::ExternalForce, 14),
        (Stage::LargestForce, 0),
        (Stage::Displacement, 14),
        (Stage::Positions, 15),
    ] {
        for (kind, step) in [(Kind::Host, 5), (Kind::Core, 1)] {
            let mut faulty = Faulty::new(&parameters(), &discs(), stage, step);
            let found = first_contradiction(&mut engine(kind, 2, &parameters()), &mut faulty, 8).unwrap();
            let Some(Contradiction { step: found_step, parting: Parting::Stage(difference) }) = &found else {
                panic!("{stage}: {found:?}");
            };
            assert_eq!((*found_step, difference.stage, difference.index), (step, stage, index));
            let [one, other] = difference.values.map(Option::unwrap);
            assert_eq!((one - other).abs(), 1, "{found:?}");
            let said = found.unwrap().to_string();
            assert!(said.starts_with(&format!("step {step}, {stage}")), "{said}");
            assert!(said.contains(&format!("{one}")) || stage == Stage::Field, "{said}");
        }
    }
}

#[test]
fn what_is_first_is_named_and_not_what_follows() {
    // A flip of the pair force reaches the total force, and perhaps what comes after it.
    let mut faulty = Faulty::new(&parameters(), &discs(), Stage::PairForce, 3);
    let mut sound = engine(Kind::Core, 1, &parameters());
    let mut traces = [Trace::default(), Trace::default()];
    for _ in 0..3 {
        faulty.traced_step(&mut traces[0]).unwrap();
        Steps::traced_step(&mut sound, &mut traces[1]).unwrap();
    }
    let differ = |stage: Stage| traces[0].of(stage) != traces[1].of(stage);
    // Whether the displacement is rounded to another one is chance.
    let differing = Stage::ALL.into_iter().take_while(|&stage| stage != Stage::Displacement);
    let differing: Vec<Stage> = differing.filter(|&stage| differ(stage)).collect();
    assert_eq!(differing, [Stage::PairForce, Stage::TotalForce]);
    assert_eq!(traces[0].first_difference(&traces[1]).unwrap().stage, Stage::PairForce);
}

#[test]
fn engines_that_keep_the_contract_do_not_part() {
    for mesh_refresh in [0.0, 0.2] {
        let parameters = Parameters { mesh_refresh, ..parameters() };
        let mut one = engine(Kind::Host, 2, &parameters);
        let mut other = engine(Kind::Core, 1, &parameters);
        assert_eq!(first_contradiction(&mut one, &mut other, 20).unwrap(), None);
        assert_eq!(one.clock().step, 20);
        let mut traced = engine(Kind::Host, 1, &parameters);
        advance(&mut traced, 20);
        assert_eq!(traced.state().digest(), one.state().digest(), "looking changes no bit");
    }
}

#[test]
fn an_engine_that_forgot_what_it_held_is_found_by_its_masses() {
    let parameters = Parameters { mesh_refresh: 4.0, ..parameters() };
    let mut one = engine(Kind::Host, 1, &parameters);
    advance(&mut one, 2);
    let other = |held: bool| {
        let core = Machinery { kind: Kind::Core, threads: 1 };
        let mut other = Engine::with_machinery(core, &parameters, one.clock(), one.discs()).unwrap();
        if held {
            other.hold(&one.held().unwrap()).unwrap();
        }
        other
    };
    let [mut sound, mut forgetful] = [other(true), other(false)];
    let held = one.held();
    assert_eq!(first_contradiction(&mut one, &mut sound, 4).unwrap(), None);
    assert!(one.held() == held, "held all the time");
    let mut one = engine(Kind::Host, 1, &parameters);
    advance(&mut one, 2);
    let found = first_contradiction(&mut one, &mut forgetful, 4).unwrap().unwrap();
    assert_eq!(found.step, 3);
    let Parting::Stage(difference) = found.parting else { panic!("{found:?}") };
    assert_eq!((difference.stage, difference.values[0]), (Stage::Masses, None));
}

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"))
}

/// Spoils the digest of x in the record of a step.
fn spoil(program: &Program, golden: &str, step: u64) {
    let text = program.text(golden);
    let row = text.lines().find(|line| line.starts_with(&format!("  [{step},"))).unwrap();
    let digest_of_x = row.split('"').nth(3).unwrap();
    program.write(golden, text.replace(digest_of_x, &"0".repeat(64)));
}

#[test]
fn records_that_do_not_follow_each_other_are_refused() {
    let program = program();
    program.succeed(&["run", "small.toml", "--out", "run", "--every", "10"]);
    let text = program.text("run/golden.toml");
    for step in ["0", "10"] {
        program.write("wrong.toml", text.replacen("  [20,", &format!("  [{step},"), 1));
        let expected = "wrong.toml: records[2]: expected a later step than that of the record before";
        program.refuse(&["verify", "wrong.toml"], &[expected]);
    }
}

#[test]
fn verify_bisects_from_a_state_that_holds_mesh_forces() {
    let program = program();
    let run = ["run", "small.toml", "--set", "force.mesh_refresh=0.3"];
    program.succeed(&[&run[..], &["--out", "part", "--until", "0.2"]].concat());
    let state = program.read("part/final.state");
    assert!(state.windows(4).any(|four| four == b"HELD"));
    let from = ["--set", "start.kind=file", "--set", "start.path=part/final.state"];
    let golden = ["--out", "rest", "--golden", "rest.toml", "--every", "10"];
    program.succeed(&[&run[..], &from, &golden].concat());
    for machinery in [["--engine", "host", "--threads", "2"], ["--engine", "core", "--threads", "1"]] {
        program.succeed(&[&["verify", "rest.toml"][..], &machinery].concat());
    }
    let text = program.text("rest.toml");
    let steps: Vec<u64> =
        text.lines().filter_map(|line| line.strip_prefix("  [")?.split(',').next()?.parse().ok()).collect();
    let (before, step) = (steps[1], steps[2]);
    spoil(&program, "rest.toml", step);
    for machinery in [["--engine", "host"], ["--engine", "core"]] {
        let output = program.start(&[&["verify", "rest.toml", "--bisect"][..], &machinery].concat());
        assert_eq!(output.status.code(), Some(1), "{}", errors(&output));
        let said = String::from_utf8(output.stdout).unwrap();
        for part in [
            format!("step {step}: x differs"),
            format!("equal up to the record of step {before}"),
            "agrees with itself in every stage of every step".to_owned(),
            format!("steps {} to {step}:", before + 1),
        ] {
            assert!(said.contains(&part), "{part} is not in {said}");
        }
    }
}

#[test]
fn the_stages_of_a_step_are_printed_alike_by_every_engine() {
    let program = program();
    program.succeed(&["run", "small.toml", "--until", "0.1", "--out", "run", "--every", "1"]);
    let stages = |more: &[&str]| {
        program.succeed(&[&["verify", "run/golden.toml", "--stages", "3"][..], more].concat())
    };
    let table = stages(&["--engine", "core"]);
    let words: Vec<&str> = table.lines().map(|line| line[..15].trim_end()).collect();
    assert_eq!(
        words,
        [
            "masses",
            "field",
            "mesh force",
            "pair force",
            "total force",
            "largest force",
            "time step",
            "displacement",
            "positions"
        ]
    );
    assert_eq!(stages(&["--threads", "2"]), table);
    assert_eq!(program.start(&["verify", "run/golden.toml", "--stages", "0"]).status.code(), Some(2));
    spoil(&program, "run/golden.toml", 3);
    let output = program.start(&["verify", "run/golden.toml", "--bisect"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains("step 3, which is the first that differs") && said.contains("--stages 3"),
        "{said}"
    );
    spoil(&program, "run/golden.toml", 0);
    let output = program.start(&["verify", "run/golden.toml", "--bisect"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("the state that the run starts from differs already"), "{said}");
}
