//! A floating-point environment that would change the bits is refused by every constructor.

use meniscus_core::engine::Engine;
use meniscus_core::environment;
use meniscus_core::parameters::Parameters;
use meniscus_core::torus::Position;

#[test]
fn the_usual_environment_is_accepted() {
    assert_eq!(environment::check(), Ok(()));
    let mut engine = Box::new(Engine::<64, 1>::new());
    assert_eq!(engine.init(&Parameters::default(), [(0, Position::from_bits(0, 0))]), Ok(()));
}

/// Where the control register can be set from here.
#[cfg(all(target_arch = "x86_64", unix))]
mod with_another_control_register {
    use super::*;
    use core::arch::asm;
    use meniscus_core::dynamics::{Clock, Dynamics, InitError};
    use meniscus_core::environment::EnvironmentError;
    use meniscus_core::parameters::{Assignment, Noise};
    use meniscus_tests::arrays::Arrays;

    /// Bits of MXCSR (Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, section 10.2.3).
    const SUBNORMAL_OPERANDS_ARE_ZERO: u32 = 1 << 6;
    const SUBNORMAL_RESULTS_ARE_ZERO: u32 = 1 << 15;
    const ROUND_DOWN: u32 = 1 << 13;
    const ROUND_UP: u32 = 2 << 13;
    const ROUND_TO_ZERO: u32 = 3 << 13;

    /// An attempt at every constructor, and what came of it.
    struct Attempt {
        engine: Box<Engine<16, 1>>,
        arrays: Arrays,
        outcomes: [Result<(), InitError>; 3],
    }

    const PARAMETERS: Parameters = Parameters {
        side: 16.0,
        capillary_strength: 0.0,
        capillary_length: 1.0,
        grid: 16,
        assignment: Assignment::CloudInCell,
        noise: Noise::None,
        ..Parameters::DEFAULT
    };

    extern "C" fn construct(attempt: &mut Attempt) {
        let disc = || [(0, Position::from_bits(0, 0))];
        let Attempt { engine, arrays, outcomes } = attempt;
        *outcomes = [
            engine.init(&PARAMETERS, disc()),
            engine.init_at(&PARAMETERS, Clock { step: 3, time: 4 }, disc()),
            Dynamics::new(&PARAMETERS, Clock::START, disc(), &mut arrays.memory()).map(|_| ()),
        ];
    }

    fn attempt_with(bits: u32) -> Attempt {
        let mut attempt = Attempt {
            engine: Box::new(Engine::new()),
            arrays: Arrays::new(16, 1, 1),
            outcomes: [Err(InitError::NoParticles); 3],
        };
        let mut usual = 0_u32;
        // SAFETY: stores MXCSR into four bytes that are ours; changes nothing else.
        unsafe {
            asm!("stmxcsr [{usual}]", usual = in(reg) &raw mut usual, options(nostack, preserves_flags))
        };
        let changed = usual | bits;
        // SAFETY: the register is as before when the block ends. Within it runs one call as the C ABI has it, as from
        // a program in another language that has changed the register, which is what the check is there for:
        // its argument is the attempt, borrowed here exclusively; r12 and r13 are kept by the callee; what
        // the callee may change is declared; the stack is aligned for a call, and the red zone not used, as `nostack`
        // is not given. `construct` does not unwind, being `extern "C"`.
        unsafe {
            asm!(
                "ldmxcsr [r13]",
                "call {construct}",
                "ldmxcsr [r12]",
                construct = sym construct,
                in("r12") &raw const usual,
                in("r13") &raw const changed,
                in("rdi") &raw mut attempt,
                clobber_abi("C"),
            );
        }
        attempt
    }

    #[test]
    fn a_changed_environment_is_refused_by_every_constructor() {
        let cases = [
            (SUBNORMAL_RESULTS_ARE_ZERO, EnvironmentError::SubnormalsFlushed),
            (SUBNORMAL_OPERANDS_ARE_ZERO, EnvironmentError::SubnormalsFlushed),
            (SUBNORMAL_RESULTS_ARE_ZERO | SUBNORMAL_OPERANDS_ARE_ZERO, EnvironmentError::SubnormalsFlushed),
            (ROUND_DOWN, EnvironmentError::Rounding),
            (ROUND_UP, EnvironmentError::Rounding),
            (ROUND_TO_ZERO, EnvironmentError::Rounding),
            (ROUND_UP | SUBNORMAL_RESULTS_ARE_ZERO, EnvironmentError::SubnormalsFlushed),
        ];
        for (bits, error) in cases {
            let attempt = attempt_with(bits);
            assert_eq!(attempt.outcomes, [Err(InitError::Environment(error)); 3], "MXCSR with {bits:#x}");
            assert_eq!(attempt.engine.count(), 0);
            // It is over afterwards.
            assert_eq!(environment::check(), Ok(()));
        }
    }

    #[test]
    fn an_unchanged_environment_is_accepted_by_every_constructor() {
        let attempt = attempt_with(0);
        assert_eq!(attempt.outcomes, [Ok(()); 3]);
        assert_eq!((attempt.engine.count(), attempt.engine.clock().step), (1, 3));
    }
}
