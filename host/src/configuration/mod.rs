//! A run's configuration: read, checked, and written back.
//!
//! In: TOML from a file, a text or a preset, and overrides `key=value` as on the command line. Out: a
//! [`Configuration`] in which every number is in its range, in units of R0, kBT and R0²/D; or a
//! [`ConfigurationError`] of one line that names the place, the key, what was found and what is
//! accepted. [`Configuration::to_toml`] writes a complete configuration that reads back to an equal one.
//!
//! ```
//! use meniscus::configuration::Configuration;
//!
//! let overrides = ["system.capillary_length=1500".to_owned(), "force.accuracy=3e-4".to_owned()];
//! let configuration = Configuration::from_preset("table-1", &overrides)?;
//! assert_eq!(configuration.system.particles, 2500);
//! assert_eq!(configuration.system.capillary_length, 1500.0);
//! let text = configuration.to_toml();
//! assert_eq!(Configuration::from_text("written.toml", &text, &[])?, configuration);
//! # Ok::<(), meniscus::configuration::ConfigurationError>(())
//! ```

mod assemble;
mod checks;
mod entries;
mod error;
pub mod keys;
mod names;
mod presets;
mod scheme;
mod sections;
mod system;
mod write;

pub use crate::accuracy::ACCURACY_RANGE;
pub(crate) use entries::{describe, line_and_column, repeat, syntax_error};
pub use error::{ConfigurationError, Place};
pub use meniscus_core::fields::Fields;
pub use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Noise};
pub(crate) use names::assignment_word;
pub use presets::{PRESETS, Preset, preset};
pub use sections::{
    DEFAULT_ACCURACY, DEFAULT_DIFFUSION_TIMES, DEFAULT_JEANS_TIMES, FEWEST_SHELLS, Force, Lattice,
    MOST_SHELLS, Mesh, Motion, Output, Start, Time, default_grid,
};
pub use system::{Attraction, BOLTZMANN_CONSTANT, Physical, System};

use core::f64::consts::PI;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use meniscus_core::parameters::Parameters;

use crate::accuracy::{self, Scheme};
use crate::strengths::Strengths;
use crate::theory::Instability;

/// The version of the format that this program reads and writes.
pub const VERSION: u32 = 1;

/// More bytes than any configuration has.
const LARGEST_FILE: u64 = 1 << 20;

/// Everything a run is made of.
///
/// Made by reading, so that its numbers are in range. To change one, read again with an override: the
/// fields are free for those who look, and nothing checks a field that is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// Version of the format, [`VERSION`].
    pub version: u32,
    /// Seed of the start and of the noise, 0 to 2⁶³ − 1.
    pub seed: u64,
    /// The system as it was given in SI, if it was.
    pub physical: Option<Physical>,
    /// The system in R0 and kBT; that of `physical`, reduced, if there is one.
    pub system: System,
    /// Capillary strengths of the discs.
    pub strengths: Strengths,
    /// How the capillary force is summed.
    pub force: Force,
    /// How far a disc moves before the force of the mesh is computed anew, R0; 0 for every step.
    pub mesh_refresh: f64,
    /// The mesh.
    pub mesh: Mesh,
    /// External fields.
    pub fields: Fields,
    /// Thermal motion and the step rule.
    pub motion: Motion,
    /// Where the discs are at time zero.
    pub start: Start,
    /// When the run ends.
    pub time: Time,
    /// What is written how often.
    pub output: Output,
}

impl Configuration {
    /// Reads a file, then `overrides` (each `key=value`, the value in TOML or a bare word).
    ///
    /// An override displaces what the file says of its key. If it changes `start.kind` or `force.method`, what
    /// the file says for its own kind of start or method alone goes; if it gives the attraction in SI by one way, the file's other
    /// way goes. Keys that only overrides give are checked like the file's.
    ///
    /// # Errors
    /// A [`ConfigurationError`] that says in one line what is wrong where.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, ConfigurationError> {
        Self::from_text(&path.display().to_string(), &file_text(path)?, overrides)
    }

    /// Reads the bytes of a file, called `name` in messages; otherwise as [`Configuration::read`].
    ///
    /// # Errors
    /// A [`ConfigurationError`] that says in one line what is wrong where.
    pub fn from_bytes(name: &str, bytes: &[u8], overrides: &[String]) -> Result<Self, ConfigurationError> {
        Self::from_text(name, utf8(name, bytes)?, overrides)
    }

    /// Reads a text, called `name` in messages; otherwise as [`Configuration::read`].
    ///
    /// # Errors
    /// A [`ConfigurationError`] that says in one line what is wrong where.
    pub fn from_text(name: &str, text: &str, overrides: &[String]) -> Result<Self, ConfigurationError> {
        assemble::assemble(entries::Entries::read(name, text, overrides)?)
    }

    /// Reads the preset called `name`; otherwise as [`Configuration::read`].
    ///
    /// # Errors
    /// A [`ConfigurationError`]; for an unknown preset it names the nearest one.
    pub fn from_preset(name: &str, overrides: &[String]) -> Result<Self, ConfigurationError> {
        Self::from_text(&format!("preset {name}"), preset(name)?.text, overrides)
    }

    /// Reads what a command line gives as configuration: a file if there is one of that name, or if it
    /// looks like one (ends in `.toml` or has a `/` or `\\` in it), else a preset.
    ///
    /// # Errors
    /// A [`ConfigurationError`] that says in one line what is wrong where.
    pub fn from_argument(argument: &str, overrides: &[String]) -> Result<Self, ConfigurationError> {
        let path = Path::new(argument);
        if path.is_file() || argument.ends_with(".toml") || argument.contains(['/', '\\']) {
            Self::read(path, overrides)
        } else {
            Self::from_preset(argument, overrides)
        }
    }

    /// The whole configuration as TOML with comments: it reads back to an equal configuration.
    #[must_use]
    pub fn to_toml(&self) -> String {
        write::to_toml(self)
    }

    /// The first key, apart from `but`, whose value is another in `other`, or that is in one of the two alone; with both
    /// values as TOML, None where the key does not apply.
    #[must_use]
    pub fn difference(&self, other: &Self, but: &[&str]) -> Option<(&'static str, [Option<String>; 2])> {
        write::difference(self, other, but)
    }

    /// What the engine needs.
    #[must_use]
    pub fn parameters(&self) -> Parameters {
        let (splitting, cutoff) = match self.force {
            Force::P3m { splitting, cutoff, .. } => (splitting, cutoff),
            Force::ParticleMesh => (Parameters::DEFAULT.splitting, Parameters::DEFAULT.cutoff),
        };
        Parameters {
            side: self.system.side,
            capillary_strength: self.system.capillary_strength,
            capillary_length: self.system.capillary_length,
            repulsion: self.system.repulsion,
            method: self.force.method(),
            splitting,
            cutoff,
            mesh_refresh: self.mesh_refresh,
            grid: self.mesh.grid,
            assignment: self.mesh.assignment,
            influence: self.mesh.influence,
            gradient: self.mesh.gradient,
            fields: self.fields,
            noise: self.motion.noise,
            max_step: self.motion.max_step,
            max_displacement: self.motion.max_displacement,
            seed: self.seed,
        }
    }

    /// What the error of the capillary force depends on besides the scheme.
    #[must_use]
    pub fn force_system(&self) -> accuracy::System {
        let System { particles, side, capillary_strength, capillary_length, .. } = self.system;
        let mean_square_strength = self.strengths.mean_square(particles);
        accuracy::System { side, particles, capillary_strength, capillary_length, mean_square_strength }
    }

    /// Estimated error of the capillary force, rms, relative to the rms force of discs at random; 0 without
    /// attraction, None with `pm`, whose error is not estimated.
    #[must_use]
    pub fn estimated_error(&self) -> Option<f64> {
        let Force::P3m { splitting, cutoff, .. } = self.force else { return None };
        let system = self.force_system();
        let Mesh { grid, assignment, .. } = self.mesh;
        Some(accuracy::estimate(&system, &Scheme { grid, assignment, splitting, cutoff }).relative())
    }

    /// What a run that holds mesh forces over several steps should be told; None if it holds none.
    #[must_use]
    pub fn mesh_refresh_line(&self) -> Option<String> {
        scheme::mesh_refresh_line(self)
    }

    /// How the capillary force is summed, in one line.
    #[must_use]
    pub fn scheme_line(&self) -> String {
        scheme::line(self)
    }

    /// Mean density ρ_h of the discs where they start, R0⁻²: the density in Jeans' time.
    ///
    /// N/L² for a start that fills the box, N/(πR²) for a disc of radius R. In rings of spacing s each
    /// of the `per_ring`·n discs of ring n stands for the same area πs²·2/`per_ring` if ring n owns the
    /// annulus up to s√(n(n+1)); the discs around the central one so fill a patch of radius
    /// s√(rings·(rings+1)) and their density is `per_ring`/(2πs²). (Figs. 12 and 13: 183 R0.) A start
    /// from a file counts as filling the box unless `start.density` says otherwise.
    #[must_use]
    pub fn mean_density(&self) -> f64 {
        let particles = self.system.particles as f64;
        match self.start {
            Start::Disc { radius } => particles / (PI * radius * radius),
            Start::Rings { spacing, per_ring, .. } => f64::from(per_ring) / (2.0 * PI * spacing * spacing),
            Start::File { density: Some(density), .. } => density,
            Start::Random | Start::Lattice { .. } | Start::File { density: None, .. } => {
                particles / (self.system.side * self.system.side)
            }
        }
    }

    /// V0·⟨f²⟩, kBT: the strength of the attraction in Jeans' time and wavenumber, the mean being over all discs.
    #[must_use]
    pub fn attraction(&self) -> f64 {
        let System { particles, capillary_strength, .. } = self.system;
        capillary_strength * self.strengths.mean_square(particles)
    }

    /// Jeans' instability of the start taken as an ideal gas; None without attraction.
    ///
    /// Of discs of unequal strengths f, a pair attracting with V0·f_i·f_j, what grows by Eqs. 7 to 10 is the mode of
    /// the density of f, with V0·⟨f²⟩ in place of V0.
    #[must_use]
    pub fn instability(&self) -> Option<Instability> {
        let capillary_length = self.system.capillary_length;
        Instability::of_ideal_gas(self.attraction(), self.mean_density(), capillary_length)
    }

    /// Jeans' time T of the start, R0²/D (Eq. 7); None without attraction.
    #[must_use]
    pub fn jeans_time(&self) -> Option<f64> {
        self.instability().map(|instability| instability.jeans_time)
    }

    /// What one unit of `time.until` and of the output intervals is, R0²/D: Jeans' time, or 1 without
    /// attraction.
    #[must_use]
    pub fn time_scale(&self) -> f64 {
        self.jeans_time().unwrap_or(1.0)
    }

    /// When the run ends, R0²/D.
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.time.until * self.time_scale()
    }

    /// The unit of time R0²/D in seconds; None unless the system was given in SI.
    #[must_use]
    pub fn seconds_per_time_unit(&self) -> Option<f64> {
        self.physical.map(|physical| physical.seconds_per_time_unit())
    }
}

/// The text of a file that is no larger than a configuration may be.
pub(crate) fn file_text(path: &Path) -> Result<String, ConfigurationError> {
    let name = path.display().to_string();
    let unreadable = |reason| ConfigurationError::Unreadable { file: name.clone(), reason };
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(LARGEST_FILE + 1).read_to_end(&mut bytes))
        .map_err(|error| unreadable(error.to_string()))?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(unreadable(format!("it is larger than {LARGEST_FILE} bytes")));
    }
    utf8(&name, &bytes).map(str::to_owned)
}

/// The text that the bytes of a file are.
fn utf8<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, ConfigurationError> {
    std::str::from_utf8(bytes)
        .map_err(|error| ConfigurationError::Encoding { file: name.to_owned(), byte: error.valid_up_to() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn preset_with(name: &str, overrides: &[&str]) -> Result<Configuration, String> {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        Configuration::from_preset(name, &overrides).map_err(|error| error.to_string())
    }

    /// The same with the splitting given, so that the rest is chosen fast.
    fn quickly(name: &str, overrides: &[&str]) -> Result<Configuration, String> {
        preset_with(name, &[overrides, &["force.splitting=0.1"]].concat())
    }

    #[track_caller]
    fn assert_near(value: f64, expected: f64, relative: f64) {
        assert!((value / expected - 1.0).abs() <= relative, "{value} is not {expected} within {relative}");
    }

    #[test]
    fn jeans_time_of_table_1_in_si() {
        let configuration = quickly("table-1-si", &[]).unwrap();
        let seconds = configuration.seconds_per_time_unit().unwrap();
        assert_near(seconds, 2278.0, 2e-4);
        assert_near(configuration.jeans_time().unwrap() * seconds, 40_780.0, 2e-3);
    }

    #[test]
    fn table_1_in_si_is_table_1() {
        let reduced = quickly("table-1", &[]).unwrap();
        let physical = quickly("table-1-si", &[]).unwrap();
        assert_near(physical.system.side, reduced.system.side, 1e-15);
        assert_near(physical.system.capillary_length, reduced.system.capillary_length, 1e-15);
        assert_eq!(physical.system.particles, reduced.system.particles);
        // An ulp of the side shows in the middle of the box.
        let Configuration { system, fields, .. } = reduced.clone();
        assert_eq!(Configuration { physical: None, system, fields, ..physical }, reduced);
    }

    #[test]
    fn the_force_on_a_disc_gives_the_strength() {
        let tension = 0.072_f64;
        let thermal_energy = BOLTZMANN_CONSTANT * 300.0;
        let force = (0.89 * thermal_energy * 2.0 * PI * tension).sqrt();
        let force = format!("physical.force={force:?}");
        let by_force = quickly("table-1-si", &[&force, "physical.surface_tension=0.072"]).unwrap();
        assert_near(by_force.system.capillary_strength, 0.89, 1e-14);
    }

    #[test]
    fn the_density_of_a_patch_is_that_of_the_patch() {
        let rings = quickly("fig-12", &[]).unwrap();
        assert_near(rings.mean_density(), 450.0 / (PI * 183.0 * 183.0), 1e-4);
        assert_near(rings.jeans_time().unwrap(), 41.81, 1e-4);
        let disc = quickly("fig-14", &[]).unwrap();
        assert_near(disc.mean_density(), 451.0 / (PI * 183.0 * 183.0), 1e-15);
        let random = quickly("fig-2", &[]).unwrap();
        assert_near(random.mean_density(), 0.01, 1e-15);
    }

    #[test]
    fn the_shells_of_modes_are_those_that_grow() {
        let shells = |preset, overrides: &[&str]| quickly(preset, overrides).unwrap().output.modes_shells;
        // K_c = 0.236 R0⁻¹ and 2π/L = 0.0101 R0⁻¹.
        assert_eq!(shells("fig-2", &[]), 23);
        assert_eq!(shells("fig-2", &["system.capillary_length=3"]), FEWEST_SHELLS);
        assert_eq!(shells("fig-2", &["system.capillary_strength=0"]), FEWEST_SHELLS);
        assert_eq!(shells("fig-2", &["system.capillary_strength=20"]), MOST_SHELLS);
        assert_eq!(shells("fig-2", &["output.modes_shells=3"]), 3);
    }

    #[test]
    fn times_are_in_jeans_times_with_attraction_and_in_diffusion_times_without() {
        let attracted = quickly("table-1", &[]).unwrap();
        assert_near(attracted.end_time(), 5.0 * 17.8825, 1e-4);
        let free = quickly("table-1", &["system.capillary_strength=0"]).unwrap();
        assert_eq!(free.jeans_time(), None);
        assert_eq!(free.end_time(), 5.0);
    }

    #[test]
    fn a_minimal_configuration_has_the_defaults_of_table_1() {
        let text = "version = 1\nsystem = { particles = 2500, box = 500, capillary_strength = 0.89, \
                    capillary_length = 270 }";
        let minimal = Configuration::from_text("minimal", text, &["force.splitting=0.1".to_owned()]).unwrap();
        assert_eq!(minimal, quickly("table-1", &[]).unwrap());
        let free = "version = 1\nsystem = { particles = 10, box = 50, capillary_strength = 0 }";
        let free = Configuration::from_text("free", free, &[]).unwrap();
        assert_eq!(free.time.until, DEFAULT_DIFFUSION_TIMES);
        assert_eq!(free.system.capillary_length, f64::INFINITY);
    }

    #[test]
    fn overrides_take_toml_values_and_bare_words() {
        let configuration = quickly(
            "table-1",
            &["mesh.assignment=order-6", "motion.noise = \"none\"", "system.capillary_length=inf", "seed=7"],
        )
        .unwrap();
        assert_eq!(configuration.mesh.assignment, Assignment::Order6);
        assert_eq!(configuration.motion.noise, Noise::None);
        assert_eq!(configuration.system.capillary_length, f64::INFINITY);
        assert_eq!(configuration.seed, 7);
    }

    #[test]
    fn the_last_override_of_a_key_holds() {
        assert_eq!(quickly("table-1", &["seed=7", "seed=8"]).unwrap().seed, 8);
    }

    #[test]
    fn an_overridden_kind_of_start_displaces_the_keys_of_the_other() {
        let disc = quickly("fig-12", &["start.kind=disc", "start.radius=183"]).unwrap();
        assert_eq!(disc.start, Start::Disc { radius: 183.0 });
        let error = preset_with("fig-12", &["start.kind=disc", "start.radius=183", "start.rings=9"]);
        assert_eq!(
            error.unwrap_err(),
            "--set: start.rings: not allowed with start.kind = \"disc\": it belongs to start.kind = \"rings\""
        );
    }

    #[test]
    fn an_overridden_method_displaces_what_belongs_to_the_other() {
        let p3m = preset_with("table-1", &["force.splitting=0.3", "mesh.grid=256"]).unwrap();
        let Force::P3m { accuracy, splitting, .. } = p3m.force else { panic!("{:?}", p3m.force) };
        assert_eq!((accuracy, splitting, p3m.mesh.grid), (DEFAULT_ACCURACY, 0.3, 256));
        let with = |text: &str, overrides: &[&str]| {
            let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
            Configuration::from_text("text", text, &overrides).map_err(|error| error.to_string())
        };
        let pm = with(&p3m.to_toml(), &["force.method=pm", "mesh.gradient=difference-4"]).unwrap();
        assert_eq!((pm.force, pm.mesh.influence), (Force::ParticleMesh, Influence::Paper));
        let again = with(&pm.to_toml(), &["force.method=p3m", "force.accuracy=2e-3"]).unwrap();
        assert_eq!((again.mesh.influence, again.mesh.gradient), (Influence::Optimal, Gradient::Spectral));
        assert_eq!((again.mesh.grid, again.mesh.assignment), (256, p3m.mesh.assignment));
        assert!(again.estimated_error().unwrap() <= 2e-3);
        assert_eq!(
            with(&pm.to_toml(), &["force.method=p3m", "mesh.gradient=difference-4"]).unwrap_err(),
            "--set: mesh.gradient: found \"difference-4\", expected \"spectral\" with force.method = \"p3m\"; \
             \"difference-4\" belongs to force.method = \"pm\""
        );
        assert_eq!(
            with(&p3m.to_toml(), &["force.method=pm", "force.cutoff=9"]).unwrap_err(),
            "--set: force.cutoff: not allowed with force.method = \"pm\": it belongs to force.method = \"p3m\""
        );
    }

    #[test]
    fn a_whole_scheme_need_only_keep_to_the_accuracy() {
        let scheme =
            ["mesh.grid=256", "mesh.assignment=order-4", "force.splitting=0.2731", "force.cutoff=8.538"];
        let estimated = preset_with("table-1", &scheme).unwrap().estimated_error().unwrap();
        let just = format!("force.accuracy={:?}", 1.01 * estimated);
        let again = preset_with("table-1", &[&scheme[..], &[&just]].concat()).unwrap();
        assert_eq!(again.estimated_error(), Some(estimated));
        // What is chosen has a margin.
        let [grid, assignment, splitting, _] = scheme;
        let chosen = preset_with("table-1", &[grid, assignment, splitting, &just]);
        assert!(chosen.is_err() || chosen.unwrap().estimated_error().unwrap() < 0.9 * estimated);
    }

    #[test]
    fn a_scheme_is_told_in_one_line() {
        let p3m = ["force.splitting=0.4", "force.cutoff=10", "mesh.grid=512", "mesh.assignment=order-7"];
        let line = preset_with("table-1", &p3m).unwrap().scheme_line();
        assert!(line.starts_with("force: p3m, accuracy 1e-3 (estimated "), "{line}");
        assert!(line.ends_with("): grid 512, order-7, splitting 0.4, cutoff 10"), "{line}");
        assert_eq!(
            preset_with("table-1", &["force.method=pm"]).unwrap().scheme_line(),
            "force: pm: grid 512 (spacing 0.977 R0), tsc, influence paper, gradient spectral"
        );
    }

    #[test]
    fn bad_overrides_say_so() {
        for (text, message) in [
            ("seed", "--set: found `seed`, expected key=value, such as mesh.grid=512"),
            ("=3", "--set: found `=3`, expected key=value, such as mesh.grid=512"),
            ("mesh.gird=512", "--set: unknown key `mesh.gird`; did you mean `mesh.grid`?"),
            ("grid=512", "--set: unknown key `grid`; did you mean `mesh.grid`?"),
            ("zzz=1", "--set: unknown key `zzz`"),
            (
                "seed=",
                "--set: seed: found \"\" (string), expected a whole number from 0 to 9223372036854775807",
            ),
            ("seed=\"1", "--set: seed: found \"1, expected a TOML value with its quotes and brackets closed"),
            ("a\nb=[", "--set: a\\nb: found [, expected a TOML value with its quotes and brackets closed"),
            ("mesh=512", "--set: mesh: found 512 (whole number), expected a table of keys, as under [mesh]"),
            ("mesh.grid=500", "--set: mesh.grid: found 500, expected a power of two from 16 to 4096"),
            (
                "physical.radius=1e-5",
                "--set: physical: not allowed together with `system`: give the system in R0 and kBT as `system`, \
                 or in SI as `physical`",
            ),
        ] {
            assert_eq!(preset_with("table-1", &[text]).unwrap_err(), message);
        }
    }

    #[test]
    fn a_preset_that_is_not_there_names_its_neighbour() {
        assert_eq!(
            preset_with("fig2", &[]).unwrap_err(),
            "unknown preset `fig2`; did you mean `fig-2`? (`meniscus presets` lists them)"
        );
    }

    #[test]
    fn an_argument_is_a_file_or_a_preset() {
        assert!(Configuration::from_argument("fig-3", &["force.method=pm".to_owned()]).is_ok());
        let missing = Configuration::from_argument("no/such.toml", &[]).unwrap_err();
        assert!(matches!(missing, ConfigurationError::Unreadable { .. }));
    }

    #[test]
    fn bytes_that_are_no_text_are_refused() {
        assert_eq!(
            Configuration::from_bytes("x.toml", b"version\xff", &[]).unwrap_err().to_string(),
            "x.toml: is not text in UTF-8, as TOML must be (byte 7)"
        );
    }
}
