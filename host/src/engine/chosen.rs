//! The stages an engine was asked to work with.

use super::{EngineError, Kind, Machinery, ShowsField};
use meniscus_core::assignment::Crowded;
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::forces::Forces;
use meniscus_core::memory::Memory;
use meniscus_core::parameters::Parameters;
use meniscus_core::stages::{Scalar, Stages};
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_wide::stages::Wide;
use rayon::{ThreadPool, ThreadPoolBuilder};

#[derive(Debug)]
pub(super) enum ChosenStages {
    Core(Scalar<AnySize>),
    Host(Box<Wide>),
}

impl ChosenStages {
    pub(super) fn new(machinery: Machinery, parameters: &Parameters, count: usize) -> Self {
        match machinery.kind {
            Kind::Core => Self::Core(Scalar(AnySize)),
            Kind::Host => Self::Host(Box::new(Wide::new(parameters, count, machinery.threads))),
        }
    }

    pub(super) fn kind(&self) -> Kind {
        match self {
            Self::Core(_) => Kind::Core,
            Self::Host(_) => Kind::Host,
        }
    }

    /// The threads to work in; none where one is enough.
    pub(super) fn threads(&self) -> Result<Option<ThreadPool>, EngineError> {
        let count = match self {
            Self::Core(_) => 1,
            Self::Host(stages) => stages.threads(),
        };
        if count <= 1 {
            return Ok(None);
        }
        let threads = ThreadPoolBuilder::new().num_threads(count).build();
        threads.map(Some).map_err(|_| EngineError::Threads(count))
    }
}

/// Calls a stage of whichever stages were chosen.
macro_rules! chosen {
    ($self:ident.$stage:ident($($argument:expr),*)) => {
        match $self {
            Self::Core(stages) => stages.$stage($($argument),*),
            Self::Host(stages) => stages.$stage($($argument),*),
        }
    };
}

impl Stages for ChosenStages {
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool {
        chosen!(self.fits(forces, memory))
    }

    fn arrange(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        chosen!(self.arrange(forces, memory));
    }

    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded> {
        chosen!(self.mesh(forces, memory))
    }

    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        chosen!(self.add_pairs(forces, memory));
    }

    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        chosen!(self.add_fields(forces, memory));
    }

    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64 {
        chosen!(self.largest_force(memory))
    }

    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox> {
        chosen!(self.displacements(displacement, memory))
    }

    fn displace(&mut self, memory: &mut Memory<'_>) {
        chosen!(self.displace(memory));
    }
}

impl ShowsField for ChosenStages {
    fn field<'a>(&'a self, grid: usize, memory: &'a Memory<'_>) -> Box<dyn Iterator<Item = Complex32> + 'a> {
        match self {
            Self::Core(stages) => stages.field(grid, memory),
            Self::Host(stages) => {
                let field = stages.field();
                let rows = field.nodes.chunks(field.pitch).take(grid);
                Box::new(rows.flat_map(move |row| row.iter().take(grid).copied()))
            }
        }
    }
}
