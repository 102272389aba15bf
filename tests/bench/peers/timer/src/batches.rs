//! The conversation with the comparison: after a line `ready DESCRIPTION`, each number on a line of standard input is a
//! batch of so many repetitions, answered with the CPU time of this process and the time on the wall that it took, in
//! seconds; `check` is answered with some values of the result.

use std::error::Error;
use std::io::{Write, stdin, stdout};
use std::time::Instant;

/// Something that can be done again and again.
pub trait Work {
    /// Does it once.
    fn once(&mut self) -> Result<(), Box<dyn Error>>;

    /// Values by which the result can be compared with that of others.
    fn values(&self) -> Vec<f32> {
        Vec::new()
    }
}

/// Serves batches until standard input ends.
pub fn serve(description: &str, work: &mut impl Work) -> Result<(), Box<dyn Error>> {
    say(&format!("ready {description}"))?;
    for line in stdin().lines() {
        let line = line?;
        if line == "check" {
            work.once()?;
            let values: Vec<String> = work.values().iter().map(f32::to_string).collect();
            say(&values.join(" "))?;
            continue;
        }
        let repetitions: u32 = line.parse()?;
        let (cpu, wall) = (cpu_seconds(), Instant::now());
        for _ in 0..repetitions {
            work.once()?;
        }
        say(&format!("{:e} {:e}", cpu_seconds() - cpu, wall.elapsed().as_secs_f64()))?;
    }
    Ok(())
}

fn say(line: &str) -> std::io::Result<()> {
    let mut output = stdout();
    writeln!(output, "{line}")?;
    output.flush()
}

fn cpu_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is to a live timespec, and the clock exists on every Unix.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &raw mut time) };
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
