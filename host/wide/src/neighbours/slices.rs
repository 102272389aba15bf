//! The neighbours of sixteen discs side by side, one disc a lane.
//!
//! Each lane has its own disc, so that its position and the sum of its forces stay in registers while row after row
//! of neighbours goes by. Discs with about as many neighbours share a slice, so that few places stay empty.

use crate::lanes::{LARGEST_WIDTH, Lanes};

/// Discs among which those with about as many neighbours are brought together.
pub(super) const WINDOW: usize = 256;

/// Lanes whose longest list is known, the narrowest registers'.
const QUARTER: usize = 4;

/// Lists of neighbours, sixteen side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct Slices {
    /// The disc of each lane, sixteen a slice.
    members: Vec<[u32; LARGEST_WIDTH]>,
    /// The number of rows that each quarter of a slice needs.
    rows: Vec<[u32; LARGEST_WIDTH / QUARTER]>,
    /// Where discs begin that are likely to be needed soon after each slice.
    ahead: Vec<u32>,
    /// Row after row the neighbours, or a disc itself where it has no more.
    neighbours: Vec<[u32; LARGEST_WIDTH]>,
    /// Neighbours in all.
    count: usize,
}

/// A part of a slice as wide as registers: its discs, and their neighbours row by row.
pub(crate) struct Part<'a> {
    pub(crate) members: &'a [u32],
    pub(crate) neighbours: &'a [[u32; LARGEST_WIDTH]],
    /// Where in a row the part begins.
    pub(crate) lane: usize,
    /// Where discs begin that are likely to be needed soon.
    pub(crate) ahead: u32,
}

impl Slices {
    /// Empties the lists, keeping their memory.
    pub(super) fn clear(&mut self) {
        self.members.clear();
        self.rows.clear();
        self.ahead.clear();
        self.neighbours.clear();
        self.count = 0;
    }

    /// Neighbours in all lists.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Bytes in use.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.members.as_slice())
            + size_of_val(self.rows.as_slice())
            + size_of_val(self.ahead.as_slice())
            + size_of_val(self.neighbours.as_slice())
    }

    /// The parts of all slices, `width` lanes each.
    #[inline(always)]
    pub(crate) fn parts(&self, width: usize) -> impl Iterator<Item = Part<'_>> {
        let mut rest = self.neighbours.as_slice();
        self.members.iter().zip(&self.rows).zip(&self.ahead).flat_map(move |((members, rows), &ahead)| {
            let all = rows.iter().copied().max().unwrap_or(0) as usize;
            let (own, next) = rest.split_at_checked(all).unwrap_or((&[], &[]));
            rest = next;
            let quarters = rows.chunks((width / QUARTER).max(1));
            members.chunks(width).zip(quarters).enumerate().map(move |(part, (members, rows))| {
                let rows = rows.iter().copied().max().unwrap_or(0) as usize;
                Part { members, neighbours: own.get(..rows).unwrap_or(own), lane: part * width, ahead }
            })
        })
    }

    /// Adds the lists of consecutive discs, the first of them `first`: disc `first + i` has the neighbours
    /// `found[begins[i]..begins[i + 1]]`. At most [`WINDOW`] discs.
    #[inline(always)]
    pub(super) fn append<L: Lanes>(&mut self, lanes: L, first: u32, begins: &[u32], found: &[u32]) {
        let count = |disc: usize| match begins.get(disc..disc + 2) {
            Some(&[begin, end]) => end - begin,
            _ => 0,
        };
        let discs = begins.len().saturating_sub(1).min(WINDOW);
        self.count += found.len();
        let mut order = [0_u8; WINDOW];
        let filled = by_falling_count(discs, count, &mut order);
        // In the order of cells the discs of the next window have their farthest neighbours beyond the farthest of these.
        let mut ahead = found.iter().copied().max().unwrap_or(0);
        for members in order.get(..filled).unwrap_or(&[]).chunks(LARGEST_WIDTH) {
            self.ahead.push(ahead);
            ahead = ahead.saturating_add(LARGEST_WIDTH as u32);
            let place = usize::from(members.first().copied().unwrap_or(0));
            let mut own = [first + place as u32; LARGEST_WIDTH];
            let (mut starts, mut counts) = ([0; LARGEST_WIDTH], [0; LARGEST_WIDTH]);
            let lane = own.iter_mut().zip(&mut starts).zip(&mut counts);
            for (((own, start), length), &member) in lane.zip(members) {
                let member = usize::from(member);
                *own = first + member as u32;
                *start = begins.get(member).copied().unwrap_or(0);
                *length = count(member);
            }
            let mut rows = [0; LARGEST_WIDTH / QUARTER];
            for (rows, counts) in rows.iter_mut().zip(counts.chunks(QUARTER)) {
                *rows = counts.iter().copied().max().unwrap_or(0);
            }
            self.members.push(own);
            self.rows.push(rows);
            let all = rows.into_iter().max().unwrap_or(0);
            self.neighbours.reserve(all as usize);
            for row in 0..all {
                let mut neighbours = [0; LARGEST_WIDTH];
                let step = lanes.splat_u32(row);
                for lane in (0..LARGEST_WIDTH).step_by(L::WIDTH) {
                    let index = lanes.add_u32(lanes.load_u32(&starts[lane..]), step);
                    let is_filled = lanes.less_i32(step, lanes.load_u32(&counts[lane..]));
                    let neighbour = lanes.gather_u32(found, index);
                    let own = lanes.load_u32(&own[lane..]);
                    lanes.store_u32(lanes.select_u32(is_filled, neighbour, own), &mut neighbours[lane..]);
                }
                self.neighbours.push(neighbours);
            }
        }
    }
}

/// Puts the discs that have neighbours in `order`, those with more of them roughly before those with fewer; says how many.
#[inline(always)]
fn by_falling_count(discs: usize, count: impl Fn(usize) -> u32, order: &mut [u8; WINDOW]) -> usize {
    const KEYS: u32 = 128;
    let largest = (0..discs).map(&count).max().unwrap_or(0);
    let mut shift = 0;
    while largest >> shift >= KEYS {
        shift += 1;
    }
    // Those with the most neighbours have the lowest key.
    let key = |count: u32| (KEYS - (count >> shift)) as usize;
    let mut ends = [0_u16; KEYS as usize + 1];
    let mut filled = 0;
    for count in (0..discs).map(&count).filter(|&count| count > 0) {
        if let Some(end) = ends.get_mut(key(count)) {
            *end += 1;
        }
        filled += 1;
    }
    let mut begin = 0;
    for end in &mut ends {
        (begin, *end) = (begin + *end, begin);
    }
    // Those that follow each other come from different places, so that they seldom have a neighbour in common.
    let spread = (0..WINDOW).map(|place| place % 16 * 16 + place / 16);
    for disc in spread.filter(|&disc| disc < discs && count(disc) > 0) {
        if let Some(next) = ends.get_mut(key(count(disc))) {
            if let Some(place) = order.get_mut(usize::from(*next)) {
                *place = disc as u8;
            }
            *next += 1;
        }
    }
    filled
}
