//! Which discs are nearer to a place than a given distance.
//!
//! In: the box, positions, a distance in R0. Out: ids and squared distances, unit (L·2⁻³²)². Distances
//! are those of the nearest images and are compared as integers, so the answer is the same everywhere.
//!
//! The box is cut into square cells at least as wide as the distance, so that the nine cells around a
//! place hold all that is near it. The cells are kept in a table of hashed cell numbers: memory goes with
//! the number of discs and not with the number of cells, however large an empty box is.
//!
//! ```
//! use meniscus::observables::neighbours::{Neighbours, closest_pair};
//! use meniscus_core::torus::{Position, Torus};
//!
//! let torus = Torus::new(128.0).unwrap();
//! // On both sides of the border, 2 R0 apart.
//! let positions =
//!     [127.0, 1.0].map(|x| Position { x: torus.fraction(x).unwrap(), y: torus.fraction(50.0).unwrap() });
//! assert_eq!(closest_pair(&torus, &positions), Some(2.0));
//!
//! let neighbours = Neighbours::new(&torus, &positions, 2.5);
//! let near: Vec<u32> = neighbours.near(positions[0]).map(|neighbour| neighbour.id).collect();
//! assert_eq!(near.len(), 2, "a disc is near itself");
//! ```

use meniscus_core::torus::{Position, Torus, UNITS, minimum_image};

/// 2⁶⁴ divided by the golden ratio, odd: its multiples are spread evenly (Knuth, The Art of Computer
/// Programming, volume 3, section 6.4).
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// The end of a chain of discs that share a place of the table.
const END: u32 = u32::MAX;

/// A disc near a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Neighbour {
    /// Its id: its number in the order of insertion.
    pub id: u32,
    /// The squared distance of the nearest images, unit (L·2⁻³²)².
    pub square: u64,
}

/// Discs sorted into cells, to be asked which of them are near a place.
#[derive(Clone, Debug)]
pub struct Neighbours {
    /// Number of cells along a side.
    cells: u64,
    /// Squared distance under which a disc is near, unit (L·2⁻³²)².
    square: u64,
    /// The shift that leaves of 64 hashed bits those that number a place of the table.
    shift: u32,
    /// The last disc inserted at each place of the table.
    heads: Vec<u32>,
    /// For each disc the one inserted before it at the same place of the table.
    chain: Vec<u32>,
    positions: Vec<Position>,
}

/// The squared distance of the nearest images of two positions, unit (L·2⁻³²)².
#[must_use]
pub fn squared_distance(first: Position, second: Position) -> u64 {
    let along_x = u64::from(minimum_image(first.x, second.x).unsigned_abs());
    let along_y = u64::from(minimum_image(first.y, second.y).unsigned_abs());
    along_x * along_x + along_y * along_y
}

/// The smallest square of units (L·2⁻³²)² that is no longer closer than `distance` (R0).
fn squared_units(torus: &Torus, distance: f64) -> u64 {
    let units = distance / torus.side() * UNITS;
    libm::ceil(units * units) as u64
}

/// The length in R0 whose square is `square` (L·2⁻³²)².
fn length(torus: &Torus, square: u64) -> f64 {
    libm::sqrt(square as f64) * (torus.side() / UNITS)
}

impl Neighbours {
    /// No discs yet, room for about `capacity`, and "near" meaning closer than `distance` (R0).
    ///
    /// Only nearest images are seen: beyond L/2 the farther images of a disc are not counted.
    #[must_use]
    pub fn with_capacity(torus: &Torus, capacity: usize, distance: f64) -> Self {
        let reach = libm::ceil(distance / torus.side() * UNITS).max(1.0) as u64;
        let fitting = (1_u64 << 32) / reach;
        let places = capacity.max(1).next_power_of_two().max(2);
        Self {
            // With fewer than three cells the nine around a place are not all different.
            cells: if fitting < 3 { 1 } else { fitting },
            square: squared_units(torus, distance),
            shift: 64 - places.trailing_zeros(),
            heads: vec![END; places],
            chain: Vec::with_capacity(capacity),
            positions: Vec::with_capacity(capacity),
        }
    }

    /// The discs at `positions`, their ids being their places in the slice.
    #[must_use]
    pub fn new(torus: &Torus, positions: &[Position], distance: f64) -> Self {
        let mut neighbours = Self::with_capacity(torus, positions.len(), distance);
        for position in positions {
            neighbours.insert(*position);
        }
        neighbours
    }

    /// Adds a disc; its id is the number of discs before it.
    pub fn insert(&mut self, position: Position) {
        let place = self.place(self.cell(position));
        if let Some(head) = self.heads.get_mut(place) {
            self.chain.push(*head);
            *head = self.positions.len() as u32;
            self.positions.push(position);
        }
    }

    /// The positions in the order of insertion.
    #[must_use]
    pub fn into_positions(self) -> Vec<Position> {
        self.positions
    }

    /// The discs closer to `position` than the distance, each once, in an order of no meaning.
    ///
    /// A disc that sits at `position` is among them.
    pub fn near(&self, position: Position) -> impl Iterator<Item = Neighbour> + '_ {
        let (column, row) = self.cell(position);
        let span = if self.cells == 1 { 1 } else { 3 };
        (0..span * span).flat_map(move |number| {
            let around = |cell: u64, offset: u64| (cell + self.cells - 1 + offset) % self.cells;
            self.within((around(column, number % span), around(row, number / span)), position)
        })
    }

    /// The discs in `cell` that are closer to `position` than the distance.
    fn within(&self, cell: (u64, u64), position: Position) -> impl Iterator<Item = Neighbour> + '_ {
        let follow = |id: &u32| self.chain.get(*id as usize).copied().filter(|id| *id != END);
        let head = self.heads.get(self.place(cell)).copied().filter(|id| *id != END);
        std::iter::successors(head, follow).filter_map(move |id| {
            let other = *self.positions.get(id as usize)?;
            let square = squared_distance(other, position);
            // Other cells may share the place in the table: their discs are met when it is their turn.
            (square < self.square && self.cell(other) == cell).then_some(Neighbour { id, square })
        })
    }

    /// Column and row of the cell that holds `position`.
    fn cell(&self, position: Position) -> (u64, u64) {
        let along = |bits: u32| (u64::from(bits) * self.cells) >> 32;
        (along(position.x.to_bits()), along(position.y.to_bits()))
    }

    /// The place of a cell in the table.
    fn place(&self, (column, row): (u64, u64)) -> usize {
        ((column | (row << 32)).wrapping_mul(GOLDEN) >> self.shift) as usize
    }
}

/// The smallest distance between the nearest images of two discs in R0; none with fewer than two discs.
///
/// Discs overlap where it is below 2 R0.
#[must_use]
pub fn closest_pair(torus: &Torus, positions: &[Position]) -> Option<f64> {
    if positions.len() < 2 {
        return None;
    }
    // No pair being closer than a distance bounds how many discs a cell of twice that width holds.
    let mut distance = (torus.side() / libm::sqrt(positions.len() as f64)).min(1.0);
    loop {
        let neighbours = Neighbours::new(torus, positions, distance);
        let squares = positions.iter().zip(0_u32..).filter_map(|(position, id)| {
            neighbours.near(*position).filter(|other| other.id < id).map(|other| other.square).min()
        });
        match squares.min() {
            Some(square) => return Some(length(torus, square)),
            // All distances are below L/√2.
            None if distance >= torus.side() => return None,
            None => distance *= 2.0,
        }
    }
}
