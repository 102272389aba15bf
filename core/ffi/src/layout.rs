//! The caller's memory: a header, and behind it the arrays of the core.
//!
//! Where each array lies follows from mesh and capacity alone, is computed once and kept in the header.

use crate::status::MeniscusStatus;
use core::ffi::c_void;
use core::marker::PhantomData;
use core::slice;
use meniscus_core::dynamics::{Dynamics, Memory};
use meniscus_core::grid::Grid;
use meniscus_core::influence::influence_length;
use meniscus_core::mesh::LINES;
use meniscus_core::near_part::{LARGEST_TABLE, Segment};
use meniscus_core::parameters::LARGEST_PARTICLE_COUNT;
use meniscus_core::torus::Fraction;
use meniscus_core::transform::Complex32;

/// An engine in the caller's memory.
#[derive(Debug)]
pub struct MeniscusEngine {
    dynamics: Dynamics,
    layout: Layout,
}

/// What the arrays hold.
///
/// # Safety
/// All bits zero are a value, and the alignment is at most [`ALIGNMENT`].
pub(crate) unsafe trait Element: Copy {}

// SAFETY: a number, for which every bit pattern is a value.
unsafe impl Element for u32 {}
// SAFETY: the same.
unsafe impl Element for i32 {}
// SAFETY: the same.
unsafe impl Element for i64 {}
// SAFETY: the same.
unsafe impl Element for f32 {}
// SAFETY: four binary32 numbers.
unsafe impl Element for Segment {}
// SAFETY: 32 bits, each pattern a fraction.
unsafe impl Element for Fraction {}
// SAFETY: two binary32 numbers.
unsafe impl Element for Complex32 {}

/// Alignment of the memory: that of whatever is in it.
pub(crate) const ALIGNMENT: usize = {
    let (header, number) = (align_of::<MeniscusEngine>(), align_of::<i64>());
    if header > number { header } else { number }
};

const _: () = assert!(align_of::<Complex32>() <= ALIGNMENT && align_of::<Fraction>() <= ALIGNMENT);

/// Where an array lies: bytes from the beginning, and number of elements.
#[derive(Debug)]
pub(crate) struct Span<T> {
    offset: usize,
    length: usize,
    element: PhantomData<T>,
}

impl<T> Clone for Span<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Span<T> {}

impl<T: Element> Span<T> {
    /// Takes room for `length` elements at `end`, and moves `end` behind them; `None` if no memory is so large.
    fn take(end: &mut usize, length: usize) -> Option<Self> {
        let offset = end.checked_next_multiple_of(align_of::<T>())?;
        *end = offset.checked_add(length.checked_mul(size_of::<T>())?)?;
        Some(Self { offset, length, element: PhantomData })
    }

    /// The array, to be written.
    ///
    /// # Safety
    /// `engine` was made by [`create`] with the layout of this span, and nothing else refers to the array during 'a.
    unsafe fn exclusive<'a>(self, engine: *mut MeniscusEngine) -> &'a mut [T] {
        // SAFETY: the span lies in the memory that the pointer was made of, aligned and initialised by `create`.
        unsafe { slice::from_raw_parts_mut(engine.cast::<u8>().add(self.offset).cast(), self.length) }
    }

    /// The array, to be read.
    ///
    /// # Safety
    /// `engine` was made by [`create`] with the layout of this span, and nothing changes the array during 'a.
    pub(crate) unsafe fn shared<'a>(self, engine: *const MeniscusEngine) -> &'a [T] {
        // SAFETY: the span lies in the memory that the pointer was made of, aligned and initialised by `create`.
        unsafe { slice::from_raw_parts(engine.cast::<u8>().add(self.offset).cast(), self.length) }
    }
}

/// Where everything lies; the fields are those of [`Memory`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    grid: Grid,
    capacity: usize,
    size: usize,
    ids: Span<u32>,
    pub(crate) slots: Span<u32>,
    pub(crate) x: Span<Fraction>,
    pub(crate) y: Span<Fraction>,
    pub(crate) crossings_x: Span<i32>,
    pub(crate) crossings_y: Span<i32>,
    pub(crate) force_x: Span<i64>,
    pub(crate) force_y: Span<i64>,
    displacement_x: Span<i32>,
    displacement_y: Span<i32>,
    pub(crate) strengths: Span<i32>,
    pub(crate) held_x: Span<i64>,
    pub(crate) held_y: Span<i64>,
    fresh_x: Span<i64>,
    fresh_y: Span<i64>,
    pub(crate) reference_x: Span<Fraction>,
    pub(crate) reference_y: Span<Fraction>,
    next: Span<u32>,
    nodes: Span<u32>,
    field: Span<Complex32>,
    lines: Span<Complex32>,
    influence: Span<f32>,
    gradient: Span<f32>,
    near: Span<Segment>,
}

impl Layout {
    /// For `grid` nodes a side and room for `capacity` discs, that to hold their mesh forces too if asked for; the status
    /// names what is out of range.
    pub(crate) fn new(grid: u32, capacity: usize, holds: bool) -> Result<Self, MeniscusStatus> {
        let grid = usize::try_from(grid).ok().and_then(Grid::new).ok_or(MeniscusStatus::Grid)?;
        if capacity == 0 || capacity > LARGEST_PARTICLE_COUNT {
            return Err(MeniscusStatus::Capacity);
        }
        Self::placed(grid, capacity, if holds { capacity } else { 0 }).ok_or(MeniscusStatus::Capacity)
    }

    fn placed(grid: Grid, capacity: usize, held: usize) -> Option<Self> {
        let (nodes, mut end) = (grid.nodes(), size_of::<MeniscusEngine>());
        let end = &mut end;
        let mut layout = Self {
            grid,
            capacity,
            size: 0,
            force_x: Span::take(end, capacity)?,
            force_y: Span::take(end, capacity)?,
            held_x: Span::take(end, held)?,
            held_y: Span::take(end, held)?,
            fresh_x: Span::take(end, held)?,
            fresh_y: Span::take(end, held)?,
            reference_x: Span::take(end, held)?,
            reference_y: Span::take(end, held)?,
            ids: Span::take(end, capacity)?,
            slots: Span::take(end, capacity)?,
            x: Span::take(end, capacity)?,
            y: Span::take(end, capacity)?,
            crossings_x: Span::take(end, capacity)?,
            crossings_y: Span::take(end, capacity)?,
            displacement_x: Span::take(end, capacity)?,
            displacement_y: Span::take(end, capacity)?,
            strengths: Span::take(end, capacity)?,
            next: Span::take(end, capacity)?,
            nodes: Span::take(end, nodes.checked_mul(nodes)?)?,
            field: Span::take(end, nodes.checked_mul(nodes)?)?,
            lines: Span::take(end, nodes.checked_mul(LINES)?)?,
            influence: Span::take(end, influence_length(nodes))?,
            gradient: Span::take(end, nodes)?,
            near: Span::take(end, LARGEST_TABLE)?,
        };
        layout.size = *end;
        isize::try_from(*end).is_ok().then_some(layout)
    }

    /// Bytes in all.
    pub(crate) fn size(&self) -> usize {
        self.size
    }

    /// The mesh.
    pub(crate) fn grid(&self) -> Grid {
        self.grid
    }

    /// How many discs fit.
    pub(crate) fn capacity(&self) -> usize {
        self.capacity
    }
}

/// Makes an engine without discs, all its arrays zero, with room to hold mesh forces if the memory is long enough.
///
/// # Safety
/// `memory` is null or points to `length` bytes that nothing else uses while the engine is used.
pub(crate) unsafe fn create(
    memory: *mut c_void,
    length: usize,
    grid: u32,
    capacity: usize,
) -> Result<*mut MeniscusEngine, MeniscusStatus> {
    let holding = Layout::new(grid, capacity, true).ok().filter(|layout| layout.size <= length);
    let layout = holding.map_or_else(|| Layout::new(grid, capacity, false), Ok)?;
    if memory.is_null() {
        return Err(MeniscusStatus::NullPointer);
    }
    if !memory.addr().is_multiple_of(ALIGNMENT) {
        return Err(MeniscusStatus::Misaligned);
    }
    if length < layout.size {
        return Err(MeniscusStatus::MemoryTooShort);
    }
    let engine = memory.cast::<MeniscusEngine>();
    // SAFETY: the memory is aligned and, by the caller's promise, holds at least the layout's bytes.
    unsafe {
        memory.cast::<u8>().write_bytes(0, layout.size);
        engine.write(MeniscusEngine { dynamics: Dynamics::blank(), layout });
    }
    Ok(engine)
}

/// The run and its layout, to be read.
///
/// # Safety
/// `engine` is from [`create`], its memory still lent, and nothing changes it during 'a.
pub(crate) unsafe fn header<'a>(engine: *const MeniscusEngine) -> (&'a Dynamics, &'a Layout) {
    // SAFETY: initialised by `create`; nothing changes it meanwhile.
    unsafe { (&(*engine).dynamics, &(*engine).layout) }
}

/// The run, its layout and its arrays, to be changed.
///
/// # Safety
/// `engine` is from [`create`], its memory still lent, and nothing else uses it during 'a.
pub(crate) unsafe fn parts<'a>(engine: *mut MeniscusEngine) -> (&'a mut Dynamics, Layout, Memory<'a>) {
    // SAFETY: initialised by `create`; nothing else uses it meanwhile.
    let (dynamics, layout) = unsafe { (&mut (*engine).dynamics, (*engine).layout) };
    // SAFETY: the layout is this engine's; its spans overlap neither each other nor the header.
    let memory = unsafe {
        Memory {
            ids: layout.ids.exclusive(engine),
            slots: layout.slots.exclusive(engine),
            x: layout.x.exclusive(engine),
            y: layout.y.exclusive(engine),
            crossings_x: layout.crossings_x.exclusive(engine),
            crossings_y: layout.crossings_y.exclusive(engine),
            force_x: layout.force_x.exclusive(engine),
            force_y: layout.force_y.exclusive(engine),
            displacement_x: layout.displacement_x.exclusive(engine),
            displacement_y: layout.displacement_y.exclusive(engine),
            strengths: layout.strengths.exclusive(engine),
            held_x: layout.held_x.exclusive(engine),
            held_y: layout.held_y.exclusive(engine),
            fresh_x: layout.fresh_x.exclusive(engine),
            fresh_y: layout.fresh_y.exclusive(engine),
            reference_x: layout.reference_x.exclusive(engine),
            reference_y: layout.reference_y.exclusive(engine),
            next: layout.next.exclusive(engine),
            nodes: layout.nodes.exclusive(engine),
            field: layout.field.exclusive(engine),
            lines: layout.lines.exclusive(engine),
            influence: layout.influence.exclusive(engine),
            gradient: layout.gradient.exclusive(engine),
            near: layout.near.exclusive(engine),
        }
    };
    (dynamics, layout, memory)
}
