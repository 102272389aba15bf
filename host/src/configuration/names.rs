//! The words of a configuration for each choice: one table per choice, read and written from.

use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Noise};

use super::Lattice;

/// The words for one choice.
pub(super) type Words<T, const COUNT: usize> = [(&'static str, T); COUNT];

/// `mesh.assignment`.
pub(super) const ASSIGNMENTS: Words<Assignment, 6> = [
    ("cic", Assignment::CloudInCell),
    ("tsc", Assignment::TriangularShapedCloud),
    ("order-4", Assignment::Order4),
    ("order-5", Assignment::Order5),
    ("order-6", Assignment::Order6),
    ("order-7", Assignment::Order7),
];
/// `mesh.influence`.
pub(super) const INFLUENCES: Words<Influence, 3> =
    [("paper", Influence::Paper), ("continuum", Influence::Continuum), ("optimal", Influence::Optimal)];
/// `mesh.gradient`.
pub(super) const GRADIENTS: Words<Gradient, 3> = [
    ("spectral", Gradient::Spectral),
    ("difference-2", Gradient::Difference2),
    ("difference-4", Gradient::Difference4),
];
/// A method's word and what belongs to it.
pub(super) struct MethodWord {
    /// The method.
    pub(super) method: Method,
    /// The word.
    pub(super) word: &'static str,
    /// Keys that no other method has.
    pub(super) own: &'static [&'static str],
    /// The words of `mesh.influence` that it accepts.
    pub(super) influences: &'static [&'static str],
    /// The words of `mesh.gradient` that it accepts.
    pub(super) gradients: &'static [&'static str],
}

/// `force.method`, the default first.
pub(super) const METHODS: [MethodWord; 2] = [
    MethodWord {
        method: Method::P3m,
        word: "p3m",
        own: &["force.accuracy", "force.splitting", "force.cutoff"],
        influences: &["optimal"],
        gradients: &["spectral"],
    },
    MethodWord {
        method: Method::ParticleMesh,
        word: "pm",
        own: &[],
        influences: &["paper", "continuum"],
        gradients: &["spectral", "difference-2", "difference-4"],
    },
];
/// `motion.noise`.
pub(super) const NOISES: Words<Noise, 3> =
    [("uniform", Noise::Uniform), ("gaussian", Noise::Gaussian), ("none", Noise::None)];
/// `start.lattice`.
pub(super) const LATTICES: Words<Lattice, 2> =
    [("square", Lattice::Square), ("hexagonal", Lattice::Hexagonal)];

/// A start's word and the keys of the table `start` that belong to it.
pub(super) struct StartWord {
    /// The word.
    pub(super) word: &'static str,
    /// Keys that it needs.
    pub(super) required: &'static [&'static str],
    /// Keys that it allows.
    pub(super) optional: &'static [&'static str],
}

/// `start.kind`.
pub(super) const STARTS: [StartWord; 5] = [
    StartWord { word: "random", required: &[], optional: &[] },
    StartWord { word: "disc", required: &["start.radius"], optional: &[] },
    StartWord { word: "rings", required: &["start.rings", "start.spacing", "start.per_ring"], optional: &[] },
    StartWord { word: "lattice", required: &[], optional: &["start.lattice"] },
    StartWord { word: "file", required: &["start.path"], optional: &["start.density"] },
];

/// The words of a table alone, for the table of keys.
pub(super) const fn words<T: Copy, const COUNT: usize>(table: &Words<T, COUNT>) -> [&'static str; COUNT] {
    let mut words = [""; COUNT];
    let mut index = 0;
    while index < COUNT {
        words[index] = table[index].0;
        index += 1;
    }
    words
}

/// The words of [`METHODS`] alone.
pub(super) const fn method_words() -> [&'static str; METHODS.len()] {
    let mut words = [""; METHODS.len()];
    let mut index = 0;
    while index < words.len() {
        words[index] = METHODS[index].word;
        index += 1;
    }
    words
}

/// The words of [`STARTS`] alone.
pub(super) const fn start_words() -> [&'static str; STARTS.len()] {
    let mut words = [""; STARTS.len()];
    let mut index = 0;
    while index < words.len() {
        words[index] = STARTS[index].word;
        index += 1;
    }
    words
}

/// What a word stands for.
pub(super) fn meaning<T: Copy>(table: &[(&'static str, T)], word: &str) -> Option<T> {
    table.iter().find(|(name, _)| *name == word).map(|(_, value)| *value)
}

/// The word for a choice.
pub(super) fn word<T: PartialEq>(table: &[(&'static str, T)], choice: &T) -> &'static str {
    table.iter().find(|(_, value)| value == choice).map_or("", |(name, _)| name)
}

/// The word for a method.
pub(super) fn method_word(method: Method) -> &'static str {
    METHODS.iter().find(|known| known.method == method).map_or("", |known| known.word)
}

/// The word for an assignment.
pub(crate) fn assignment_word(assignment: Assignment) -> &'static str {
    word(&ASSIGNMENTS, &assignment)
}
