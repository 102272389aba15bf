//! Other stages than the core's, under the core's own step.

use meniscus_core::assignment::Crowded;
use meniscus_core::dynamics::{Clock, Disc, Dynamics, ForceError, StepError};
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::forces::{Coupling, Forces};
use meniscus_core::memory::Memory;
use meniscus_core::parameters::Parameters;
use meniscus_core::stages::{Scalar, Stages};
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_tests::arrays::Arrays;
use meniscus_tests::states::{scattered, with_ids};

const GRID: usize = 32;

/// The core's stages with a field of their own, and the discs stored in another order before every step.
struct Moving {
    scalar: Scalar<AnySize>,
    field: Vec<Complex32>,
    lines: Vec<Complex32>,
    /// What was called since the last look.
    called: Vec<&'static str>,
    fails: Option<&'static str>,
}

impl Moving {
    fn new() -> Self {
        let zero = Complex32::new(0.0, 0.0);
        let (field, lines) = (vec![zero; GRID * GRID], vec![zero; 2 * GRID]);
        Self { scalar: Scalar(AnySize), field, lines, called: Vec::new(), fails: None }
    }

    fn note(&mut self, stage: &'static str) -> bool {
        self.called.push(stage);
        self.fails == Some(stage)
    }
}

impl Stages for Moving {
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool {
        forces.grid().nodes() == GRID && memory.nodes.len() == GRID * GRID && memory.field.is_empty()
    }

    fn arrange(&mut self, _: &Forces, memory: &mut Memory<'_>) {
        self.note("arrange");
        let by = 7 % memory.ids.len();
        memory.ids.rotate_left(by);
        memory.x.rotate_left(by);
        memory.y.rotate_left(by);
        memory.crossings_x.rotate_left(by);
        memory.crossings_y.rotate_left(by);
        memory.strengths.rotate_left(by);
        // Empty where nothing is held.
        for held in [&mut *memory.held_x, &mut *memory.held_y] {
            held.rotate_left(by.min(held.len()));
        }
        for reference in [&mut *memory.reference_x, &mut *memory.reference_y] {
            reference.rotate_left(by.min(reference.len()));
        }
        for (slot, &id) in (0..).zip(memory.ids.iter()) {
            memory.slots[id as usize] = slot;
        }
        // What these hold is not to be relied on.
        memory.force_x.fill(i64::MIN);
        memory.force_y.fill(i64::MIN);
        memory.displacement_x.fill(i32::MIN);
        memory.next.fill(u32::MAX);
        memory.fresh_x.fill(i64::MIN);
        memory.fresh_y.fill(i64::MIN);
    }

    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded> {
        if self.note("mesh") {
            return Err(Crowded);
        }
        let Self { scalar, field, lines, .. } = self;
        let mut lent = Memory {
            ids: memory.ids,
            slots: memory.slots,
            x: memory.x,
            y: memory.y,
            crossings_x: memory.crossings_x,
            crossings_y: memory.crossings_y,
            force_x: memory.force_x,
            force_y: memory.force_y,
            displacement_x: memory.displacement_x,
            displacement_y: memory.displacement_y,
            strengths: memory.strengths,
            next: memory.next,
            nodes: memory.nodes,
            field,
            lines,
            influence: memory.influence,
            gradient: memory.gradient,
            near: memory.near,
            ..Memory::default()
        };
        scalar.mesh(forces, &mut lent)
    }

    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.note("pairs");
        self.scalar.add_pairs(forces, memory);
    }

    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.note("fields");
        self.scalar.add_fields(forces, memory);
    }

    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64 {
        self.note("largest");
        self.scalar.largest_force(memory)
    }

    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox> {
        if self.note("displacements") {
            return Err(HalfBox);
        }
        self.scalar.displacements(displacement, memory)
    }

    fn displace(&mut self, memory: &mut Memory<'_>) {
        self.note("displace");
        self.scalar.displace(memory);
    }
}

fn parameters() -> Parameters {
    Parameters { side: GRID as f64, grid: GRID, ..Parameters::DEFAULT }.with_p3m()
}

/// Discs of two strengths.
fn discs() -> Vec<Disc> {
    let discs = with_ids(&scattered(5, 90)).into_iter();
    discs.map(|(id, position)| Disc { strength: 1 << (19 + id % 2), ..Disc::from((id, position)) }).collect()
}

/// Arrays without a field.
fn without_field() -> Arrays {
    Arrays { field: Vec::new(), lines: Vec::new(), ..Arrays::new(GRID, 1, 100) }
}

#[test]
fn stages_of_another_engine_that_stores_the_discs_in_another_order_change_no_bit() {
    for mesh_refresh in [0.0, 0.2] {
        compare(&Parameters { mesh_refresh, ..parameters() });
    }
}

#[expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]
fn compare(parameters: &Parameters) {
    let (mut arrays, mut others) = (Arrays::new(GRID, 1, 100), without_field());
    let start =
        |arrays: &mut Arrays| Dynamics::new(parameters, Clock::START, discs(), &mut arrays.memory()).unwrap();
    let (mut dynamics, mut other) = (start(&mut arrays), start(&mut others));
    let (mut moving, mut held) = (Moving::new(), 0);
    for _ in 0..20 {
        let step = dynamics.step(&mut Scalar(AnySize), &mut arrays.memory());
        assert_eq!(other.step(&mut moving, &mut others.memory()), step);
        let mut stages = vec!["arrange", "mesh", "pairs", "largest", "displacements", "displace"];
        if !step.unwrap().refreshed {
            stages.remove(1);
            held += 1;
        }
        assert_eq!(std::mem::take(&mut moving.called), stages);
        let state = dynamics.state(&arrays.slots, (&arrays.x, &arrays.y), &arrays.strengths, arrays.held());
        let same = other.state(&others.slots, (&others.x, &others.y), &others.strengths, others.held());
        assert_eq!(state.digest(), same.digest());
        let next = dynamics.next_step(&mut Scalar(AnySize), &mut arrays.memory());
        assert_eq!(other.next_step(&mut moving, &mut others.memory()), next);
        for (&slot, &moved) in arrays.slots.iter().zip(&others.slots).take(90) {
            let (slot, moved) = (slot as usize, moved as usize);
            assert_eq!(arrays.force_x[slot], others.force_x[moved]);
            assert_eq!(arrays.crossings_y[slot], others.crossings_y[moved]);
        }
        moving.called.clear();
    }
    assert_ne!(arrays.slots, others.slots);
    assert_eq!(held > 5, parameters.mesh_refresh > 0.0, "{held} steps with held forces");
}

#[test]
fn a_stage_that_fails_leaves_the_state_as_it_was() {
    let mut arrays = without_field();
    let mut dynamics = Dynamics::new(&parameters(), Clock::START, discs(), &mut arrays.memory()).unwrap();
    let mut moving = Moving::new();
    dynamics.step(&mut moving, &mut arrays.memory()).unwrap();
    let digest = |dynamics: &Dynamics, arrays: &Arrays| {
        dynamics.state(&arrays.slots, (&arrays.x, &arrays.y), &arrays.strengths, arrays.held()).digest()
    };
    let before = digest(&dynamics, &arrays);
    for (stage, error) in [("mesh", StepError::Crowded), ("displacements", StepError::HalfBox)] {
        moving.fails = Some(stage);
        moving.called.clear();
        assert_eq!(dynamics.step(&mut moving, &mut arrays.memory()), Err(error));
        assert_eq!(moving.called.last(), Some(&stage));
        assert_eq!(digest(&dynamics, &arrays), before);
    }
}

#[test]
fn the_core_s_own_stages_refuse_memory_without_a_field() {
    let mut arrays = without_field();
    let dynamics = Dynamics::new(&parameters(), Clock::START, discs(), &mut arrays.memory()).unwrap();
    let refused = dynamics.forces(&mut Scalar(AnySize), &mut arrays.memory());
    assert_eq!(refused, Err(ForceError::Memory));
}

#[test]
fn stages_are_told_what_the_run_is_made_of() {
    struct Looking(Option<(usize, Coupling, u32, usize)>);
    impl Stages for Looking {
        fn fits(&self, _: &Forces, _: &Memory<'_>) -> bool {
            true
        }
        fn mesh(&mut self, forces: &Forces, _: &mut Memory<'_>) -> Result<(), Crowded> {
            let (grid, reach) = (forces.grid().nodes(), forces.pairs().reach());
            self.0 = Some((grid, forces.coupling(), reach, forces.near_length()));
            assert_eq!(forces.assignment(), parameters().assignment);
            assert!(forces.fields().is_zero());
            Err(Crowded)
        }
        fn add_pairs(&mut self, _: &Forces, _: &mut Memory<'_>) {}
        fn add_fields(&mut self, _: &Forces, _: &mut Memory<'_>) {}
        fn largest_force(&mut self, _: &mut Memory<'_>) -> u64 {
            0
        }
        fn displacements(&mut self, _: &Displacement, _: &mut Memory<'_>) -> Result<(), HalfBox> {
            Ok(())
        }
        fn displace(&mut self, _: &mut Memory<'_>) {}
    }
    let mut arrays = without_field();
    let dynamics = Dynamics::new(&parameters(), Clock::START, discs(), &mut arrays.memory()).unwrap();
    let mut looking = Looking(None);
    assert_eq!(dynamics.forces(&mut looking, &mut arrays.memory()), Err(ForceError::Crowded));
    let (cutoff, side) = (parameters().cutoff, parameters().side);
    let reach = (cutoff / side * 4_294_967_296.0) as u32;
    let near = meniscus_core::near_part::table_length(cutoff);
    assert_eq!(looking.0, Some((GRID, Coupling::Unequal, reach, near)));
}
