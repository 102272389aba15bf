//! Meniscus for callers in C: the core in the caller's memory.
//!
//! `include/meniscus.h` is the interface, made from this crate by cbindgen. A caller asks [`meniscus_size`] how much
//! memory a mesh and a number of discs need, lends it to [`meniscus_create`], hands parameters and discs to
//! [`meniscus_set`], and then steps, reads and digests. Nothing is allocated, and there is nothing to free: the
//! engine is gone when its memory is.
//!
//! ```c
//! size_t length = meniscus_size(64, 2);
//! void *memory = malloc(length);
//! MeniscusEngine *engine;
//! meniscus_create(memory, length, 64, 2, &engine);
//! MeniscusParameters parameters = meniscus_default_parameters();
//! uint32_t x[2] = {0, 0x10000000}, y[2] = {0, 0};
//! MeniscusStatus status = meniscus_set(engine, &parameters, NULL, NULL, x, y, NULL, 2);
//! if (status == MENISCUS_STATUS_OK) status = meniscus_step(engine, NULL);
//! puts(meniscus_status_message(status));
//! ```
//!
//! Null, misaligned and short pointers are answered with a [`MeniscusStatus`]; so is every error of the core. What
//! cannot be checked is the caller's promise and stands under "Safety". The bits are those of the core, as long as
//! the caller leaves the floating-point environment alone: rounding to nearest, subnormals kept.
//!
//! Feature `std` (default) is for programs on an operating system; without it the library is for targets without one
//! (thumbv7em-none-eabihf and the like), and needs nothing below.
#![no_std]

#[cfg(feature = "std")]
extern crate std;

mod layout;
mod status;
mod values;

pub use layout::MeniscusEngine;
pub use status::{MeniscusStatus, meniscus_status_message};
pub use values::{
    MENISCUS_STRENGTH_ONE, MeniscusAssignment, MeniscusClock, MeniscusDigest, MeniscusGradient,
    MeniscusInfluence, MeniscusMethod, MeniscusNoise, MeniscusParameters, MeniscusStep,
    meniscus_default_parameters, meniscus_with_p3m,
};

use core::ffi::{c_char, c_void};
use core::slice;
use layout::{Element, Layout, Span};
use meniscus_core::dynamics::{Clock, Disc, Dynamics};
use meniscus_core::grid::Grid;
use meniscus_core::parameters::Parameters;
use meniscus_core::refresh::{HeldForce, HeldForces};
use meniscus_core::stages::Scalar;
use meniscus_core::torus::{Fraction, Position, Torus};
use meniscus_core::transform::AnySize;

/// Nobody is there to be told: stops.
#[cfg(not(feature = "std"))]
#[panic_handler]
fn stop(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}

/// Whether one value can be read from or written to `pointer`, as far as can be seen.
fn check<T>(pointer: *const T) -> Result<(), MeniscusStatus> {
    if pointer.is_null() {
        Err(MeniscusStatus::NullPointer)
    } else if !pointer.is_aligned() {
        Err(MeniscusStatus::Misaligned)
    } else {
        Ok(())
    }
}

/// `Ok`, or what went wrong.
fn status_of(result: Result<(), MeniscusStatus>) -> MeniscusStatus {
    result.err().unwrap_or(MeniscusStatus::Ok)
}

/// Writes `value` where `target` points.
///
/// # Safety
/// Null, misaligned, or valid for writes.
unsafe fn put<T>(target: *mut T, value: T) -> Result<(), MeniscusStatus> {
    check(target)?;
    // SAFETY: neither null nor misaligned, hence valid for writes by the caller's promise.
    unsafe { target.write(value) };
    Ok(())
}

/// The first `count` values `source` points to.
///
/// # Safety
/// Null, misaligned, or valid for reads of `count` values that nobody changes meanwhile, `count` of them at most
/// half the address space.
unsafe fn array<'a, T>(source: *const T, count: usize) -> Result<&'a [T], MeniscusStatus> {
    check(source)?;
    // SAFETY: neither null nor misaligned, hence valid for reads by the caller's promise.
    Ok(unsafe { slice::from_raw_parts(source, count) })
}

/// The same, or nothing if `source` is null.
///
/// # Safety
/// That of [`array`].
unsafe fn array_or_none<'a, T>(source: *const T, count: usize) -> Result<Option<&'a [T]>, MeniscusStatus> {
    // SAFETY: as promised.
    if source.is_null() { Ok(None) } else { unsafe { array(source, count) }.map(Some) }
}

/// Bytes of memory that an engine takes, for a mesh of `grid` nodes a side (a power of two from 16 to 4096) and room
/// for `capacity` discs (1 to 4194304); 0 if one of them is out of range.
#[unsafe(no_mangle)]
pub extern "C" fn meniscus_size(grid: u32, capacity: usize) -> usize {
    Layout::new(grid, capacity, false).map_or(0, |layout| layout.size())
}

/// The same for an engine that can hold mesh forces over several steps, mesh_refresh of the parameters: 40 bytes more for
/// each disc.
#[unsafe(no_mangle)]
pub extern "C" fn meniscus_size_to_hold(grid: u32, capacity: usize) -> usize {
    Layout::new(grid, capacity, true).map_or(0, |layout| layout.size())
}

/// Alignment of that memory in bytes; what malloc returns is always aligned so.
#[unsafe(no_mangle)]
pub extern "C" fn meniscus_alignment() -> usize {
    layout::ALIGNMENT
}

/// Makes an engine without discs in `length` bytes of the caller's memory, which is lent to it from now on, and
/// writes where it is to `engine` (null if that fails). In memory of meniscus_size_to_hold bytes or more it can hold mesh
/// forces.
///
/// The memory need not be initialised. It may be freed or used otherwise as soon as the engine is no longer needed.
/// It must not be moved or copied: the copy is no engine.
///
/// # Safety
/// `memory` is null or points to `length` bytes that nothing else uses; `engine` is null or points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_create(
    memory: *mut c_void,
    length: usize,
    grid: u32,
    capacity: usize,
    engine: *mut *mut MeniscusEngine,
) -> MeniscusStatus {
    // SAFETY: `engine` as promised.
    if let Err(status) = unsafe { put(engine, core::ptr::null_mut()) } {
        return status;
    }
    // SAFETY: `memory` as promised.
    let made = unsafe { layout::create(memory, length, grid, capacity) };
    // SAFETY: `engine` as promised.
    status_of(made.and_then(|made| unsafe { put(engine, made) }))
}

/// Starts a run of `count` discs, also where another run was before.
///
/// `x` and `y` are fractions of the side, unit side / 2^32 (see meniscus_fraction). `ids` are 0 to count - 1, each
/// once, in any order; null if the discs are given in the order of their ids. `strengths` are their capillary strengths,
/// unit 2^-20: discs attract each other with the capillary strength of the parameters times both of theirs, and repel
/// each other if the signs differ; null if all of them are 1, MENISCUS_STRENGTH_ONE. `clock` is where the run stands: null
/// for the start, the clock of a state reached before to go on as if the run had never stopped (with meniscus_hold if mesh
/// forces were held). Crossings and forces are 0 then. If anything is refused, the engine has no discs.
///
/// # Safety
/// `engine` is null or from meniscus_create and used by nobody else meanwhile. Each other pointer is null or points
/// to what its type says, `ids`, `x`, `y` and `strengths` to `count` of them, outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_set(
    engine: *mut MeniscusEngine,
    parameters: *const MeniscusParameters,
    clock: *const MeniscusClock,
    ids: *const u32,
    x: *const u32,
    y: *const u32,
    strengths: *const i32,
    count: usize,
) -> MeniscusStatus {
    let discs = Discs { ids, x, y, strengths, count };
    // SAFETY: all pointers as promised.
    status_of(unsafe { set(engine, parameters, clock, &discs) })
}

/// The discs as the caller has them.
struct Discs {
    ids: *const u32,
    x: *const u32,
    y: *const u32,
    strengths: *const i32,
    count: usize,
}

/// [`meniscus_set`].
///
/// # Safety
/// That of [`meniscus_set`].
unsafe fn set(
    engine: *mut MeniscusEngine,
    parameters: *const MeniscusParameters,
    clock: *const MeniscusClock,
    discs: &Discs,
) -> Result<(), MeniscusStatus> {
    let count = discs.count;
    check(engine)?;
    // SAFETY: an engine of meniscus_create, used by nobody else.
    let (dynamics, layout, mut memory) = unsafe { layout::parts(engine) };
    *dynamics = Dynamics::blank();
    check(parameters)?;
    // SAFETY: neither null nor misaligned, hence readable as promised.
    let parameters = Parameters::try_from(unsafe { &*parameters })?;
    parameters.validate()?;
    if Grid::new(parameters.grid) != Some(layout.grid()) {
        return Err(MeniscusStatus::GridMismatch);
    }
    if count == 0 {
        return Err(MeniscusStatus::NoParticles);
    }
    if count > layout.capacity() {
        return Err(MeniscusStatus::TooManyParticles);
    }
    let clock = if clock.is_null() {
        Clock::START
    } else {
        check(clock)?;
        // SAFETY: neither null nor misaligned, hence readable as promised.
        unsafe { *clock }.into()
    };
    // SAFETY: `count` values each as promised, few enough since they fit the engine.
    let (x, y) = unsafe { (array(discs.x, count)?, array(discs.y, count)?) };
    // SAFETY: null, or the same.
    let (ids, strengths) =
        unsafe { (array_or_none(discs.ids, count)?, array_or_none(discs.strengths, count)?) };
    let positions = x.iter().zip(y).map(|(&x, &y)| Position::from_bits(x, y));
    let discs = (0..).zip(positions).map(|(place, position)| {
        let at = place as usize;
        Disc {
            id: ids.and_then(|ids| ids.get(at).copied()).unwrap_or(place),
            position,
            strength: strengths
                .and_then(|strengths| strengths.get(at).copied())
                .unwrap_or(MENISCUS_STRENGTH_ONE),
        }
    });
    memory.force_x.fill(0);
    memory.force_y.fill(0);
    *dynamics = Dynamics::new(&parameters, clock, discs, &mut memory)?;
    Ok(())
}

/// Goes on with the mesh forces that were held where the run stands, as meniscus_held wrote them: after meniscus_set with the
/// clock and positions of that state, so that the run goes on as if it had never stopped. A run that holds none ignores
/// them. If they are refused, none are held.
///
/// # Safety
/// `engine` is null or from meniscus_create and used by nobody else meanwhile. Each other pointer is null or points to
/// `count` values outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_hold(
    engine: *mut MeniscusEngine,
    reference_x: *const u32,
    reference_y: *const u32,
    force_x: *const i64,
    force_y: *const i64,
    count: usize,
) -> MeniscusStatus {
    let run = || {
        check(engine)?;
        // SAFETY: an engine of meniscus_create, used by nobody else.
        let (dynamics, _, mut memory) = unsafe { layout::parts(engine) };
        match dynamics.count() {
            0 => return Err(MeniscusStatus::NotInitialised),
            discs if count < discs => return Err(MeniscusStatus::ArrayTooShort),
            discs if count > discs => return Err(MeniscusStatus::TooManyParticles),
            _ => {}
        }
        // SAFETY: `count` values each as promised, few enough since they are as many as discs.
        let (x, y) = unsafe { (array(reference_x, count)?, array(reference_y, count)?) };
        // SAFETY: the same.
        let (force_x, force_y) = unsafe { (array(force_x, count)?, array(force_y, count)?) };
        let references = x.iter().zip(y).map(|(&x, &y)| Position::from_bits(x, y));
        let forces = force_x.iter().copied().zip(force_y.iter().copied());
        let held = references.zip(forces).map(|(reference, force)| HeldForce { reference, force });
        Ok(dynamics.hold(held, &mut memory)?)
    };
    status_of(run())
}

/// Does one step and writes what happened to `step`, which may be null. If the step is refused, the state is as it
/// was.
///
/// # Safety
/// `engine` is null or from meniscus_create and used by nobody else meanwhile; `step` is null or points to a
/// MeniscusStep outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_step(
    engine: *mut MeniscusEngine,
    step: *mut MeniscusStep,
) -> MeniscusStatus {
    let run = || {
        check(engine)?;
        if !step.is_null() {
            check(step)?;
        }
        // SAFETY: an engine of meniscus_create, used by nobody else.
        let (dynamics, _, mut memory) = unsafe { layout::parts(engine) };
        let done = dynamics.step(&mut Scalar(AnySize), &mut memory)?;
        if !step.is_null() {
            // SAFETY: `step` as promised.
            unsafe { put(step, done.into()) }?;
        }
        Ok(())
    };
    status_of(run())
}

/// Computes the forces at the present positions, for meniscus_forces. The state stays as it is.
///
/// # Safety
/// `engine` is null or from meniscus_create and used by nobody else meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_compute_forces(engine: *mut MeniscusEngine) -> MeniscusStatus {
    let run = || {
        check(engine)?;
        // SAFETY: an engine of meniscus_create, used by nobody else.
        let (dynamics, _, mut memory) = unsafe { layout::parts(engine) };
        Ok(dynamics.forces(&mut Scalar(AnySize), &mut memory)?)
    };
    status_of(run())
}

/// Number of discs; 0 before a run is set, and for no engine.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_count(engine: *const MeniscusEngine) -> usize {
    if check(engine).is_err() {
        return 0;
    }
    // SAFETY: an engine of meniscus_create, not changed meanwhile.
    unsafe { layout::header(engine) }.0.count()
}

/// Writes how many steps were done and what time was reached to `clock`.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile; `clock` is null or points to a MeniscusClock
/// outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_clock(
    engine: *const MeniscusEngine,
    clock: *mut MeniscusClock,
) -> MeniscusStatus {
    let run = || {
        check(engine)?;
        // SAFETY: an engine of meniscus_create, not changed meanwhile.
        let (dynamics, _) = unsafe { layout::header(engine) };
        // SAFETY: `clock` as promised.
        unsafe { put(clock, dynamics.clock().into()) }
    };
    status_of(run())
}

/// Copies a pair of arrays, one value for each disc, in the order of the ids.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile; the targets are null or point to `length`
/// values outside the engine's memory.
unsafe fn read<T: Element, U>(
    engine: *const MeniscusEngine,
    pick: impl Fn(&Layout) -> (Span<T>, Span<T>),
    convert: impl Fn(T) -> U,
    (x, y): (*mut U, *mut U),
    length: usize,
) -> Result<(), MeniscusStatus> {
    check(engine)?;
    check(x)?;
    check(y)?;
    // SAFETY: an engine of meniscus_create, not changed meanwhile.
    let (dynamics, layout) = unsafe { layout::header(engine) };
    if length < dynamics.count() {
        return Err(MeniscusStatus::ArrayTooShort);
    }
    let (from_x, from_y) = pick(layout);
    // SAFETY: the layout is that engine's.
    let (slots, from_x, from_y) =
        unsafe { (layout.slots.shared(engine), from_x.shared(engine), from_y.shared(engine)) };
    for (id, &slot) in slots.iter().take(dynamics.count()).enumerate() {
        let slot = slot as usize;
        if let (Some(&from_x), Some(&from_y)) = (from_x.get(slot), from_y.get(slot)) {
            // SAFETY: `id` is less than the number of discs, hence less than `length`.
            unsafe {
                x.add(id).write(convert(from_x));
                y.add(id).write(convert(from_y));
            }
        }
    }
    Ok(())
}

/// Writes the positions in the order of the ids to `x` and `y`, unit side / 2^32.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile; `x` and `y` are null or point to `length`
/// numbers outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_positions(
    engine: *const MeniscusEngine,
    x: *mut u32,
    y: *mut u32,
    length: usize,
) -> MeniscusStatus {
    // SAFETY: all pointers as promised.
    status_of(unsafe { read(engine, |layout| (layout.x, layout.y), Fraction::to_bits, (x, y), length) })
}

/// Writes how many borders each disc has crossed since the run was set, in the order of the ids, + to the right and
/// up.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile; `x` and `y` are null or point to `length`
/// numbers outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_crossings(
    engine: *const MeniscusEngine,
    x: *mut i32,
    y: *mut i32,
    length: usize,
) -> MeniscusStatus {
    let pick = |layout: &Layout| (layout.crossings_x, layout.crossings_y);
    // SAFETY: all pointers as promised.
    status_of(unsafe { read(engine, pick, |boxes| boxes, (x, y), length) })
}

/// Writes the forces as last computed, by meniscus_step before it moved the discs or by meniscus_compute_forces, in
/// the order of the ids, unit 2^-24 kBT/R0.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile; `x` and `y` are null or point to `length`
/// numbers outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_forces(
    engine: *const MeniscusEngine,
    x: *mut i64,
    y: *mut i64,
    length: usize,
) -> MeniscusStatus {
    let pick = |layout: &Layout| (layout.force_x, layout.force_y);
    // SAFETY: all pointers as promised.
    status_of(unsafe { read(engine, pick, |force| force, (x, y), length) })
}

/// Writes the mesh forces that are held, and where the discs were when they were computed, in the order of the ids: x and y in
/// units of side / 2^32, forces in 2^-24 kBT/R0. They belong to the state, and meniscus_hold takes them. Before the first step
/// nothing is held, nor ever without mesh_refresh.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile; the other pointers are null or point to `length`
/// numbers outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_held(
    engine: *const MeniscusEngine,
    reference_x: *mut u32,
    reference_y: *mut u32,
    force_x: *mut i64,
    force_y: *mut i64,
    length: usize,
) -> MeniscusStatus {
    let run = || {
        check(engine)?;
        // SAFETY: an engine of meniscus_create, not changed meanwhile.
        if !unsafe { layout::header(engine) }.0.is_held() {
            return Err(MeniscusStatus::NothingHeld);
        }
        let references = |layout: &Layout| (layout.reference_x, layout.reference_y);
        // SAFETY: all pointers as promised.
        unsafe { read(engine, references, Fraction::to_bits, (reference_x, reference_y), length) }?;
        // SAFETY: the same.
        unsafe {
            read(engine, |layout| (layout.held_x, layout.held_y), |force| force, (force_x, force_y), length)
        }
    };
    status_of(run())
}

/// Writes length and SHA-256 of the canonical bytes of the state to `digest`.
///
/// # Safety
/// `engine` is null or from meniscus_create and not changed meanwhile; `digest` is null or points to a
/// MeniscusDigest outside the engine's memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_digest(
    engine: *const MeniscusEngine,
    digest: *mut MeniscusDigest,
) -> MeniscusStatus {
    let run = || {
        check(engine)?;
        // SAFETY: an engine of meniscus_create, not changed meanwhile.
        let (dynamics, layout) = unsafe { layout::header(engine) };
        // SAFETY: the layout is that engine's.
        let (slots, x, y) =
            unsafe { (layout.slots.shared(engine), layout.x.shared(engine), layout.y.shared(engine)) };
        // SAFETY: the same.
        let strengths = unsafe { layout.strengths.shared(engine) };
        // SAFETY: the same.
        let held = unsafe {
            HeldForces {
                reference_x: layout.reference_x.shared(engine),
                reference_y: layout.reference_y.shared(engine),
                force_x: layout.held_x.shared(engine),
                force_y: layout.held_y.shared(engine),
            }
        };
        // SAFETY: `digest` as promised.
        unsafe { put(digest, dynamics.state(slots, (x, y), strengths, held).digest().into()) }
    };
    status_of(run())
}

/// Writes the SHA-256 of `digest` as 64 hexadecimal digits and a zero to `text`, which has room for 65 characters.
///
/// # Safety
/// `digest` is null or points to a MeniscusDigest; `text` is null or points to 65 characters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_digest_text(
    digest: *const MeniscusDigest,
    text: *mut c_char,
) -> MeniscusStatus {
    let run = || {
        check(digest)?;
        // SAFETY: neither null nor misaligned, hence readable as promised.
        let digest = unsafe { *digest };
        // SAFETY: `text` as promised.
        unsafe { put(text.cast(), digest.text()) }
    };
    status_of(run())
}

/// Writes the fraction of the side nearest to `coordinate` to `fraction`, unit side / 2^32. `coordinate` and `side`
/// in R0, 0 <= coordinate < side. Back again: fraction * (side / 4294967296.0).
///
/// # Safety
/// `fraction` is null or points to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn meniscus_fraction(side: f64, coordinate: f64, fraction: *mut u32) -> MeniscusStatus {
    let nearest = || Ok::<_, MeniscusStatus>(Torus::new(side)?.fraction(coordinate)?);
    // SAFETY: `fraction` as promised.
    status_of(nearest().and_then(|nearest| unsafe { put(fraction, nearest.to_bits()) }))
}
