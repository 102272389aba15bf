//! Times this engine and RustFFT, batch by batch as the comparison asks (see [`batches`]).
//!
//! - `meniscus-timer solvers` prints who can solve a mesh on this machine, the widest registers first, one a line;
//! - `meniscus-timer mesh SOLVER GRID` times the mesh solve of one of them;
//! - `meniscus-timer realfft GRID` times the same solve made with RustFFT;
//! - `meniscus-timer step host|core THREADS KEY=VALUE...` times whole steps of Table I with these keys changed.

mod batches;
mod ours;
mod problem;
mod realfft_solve;

use std::error::Error;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match serve(&arguments.iter().map(String::as_str).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn serve(arguments: &[&str]) -> Result<(), Box<dyn Error>> {
    match *arguments {
        ["solvers"] => {
            ours::solvers().for_each(|solver| println!("{solver}"));
            Ok(())
        }
        ["mesh", solver, grid] => batches::serve("mesh solve", &mut ours::Mesh::new(solver, grid.parse()?)?),
        ["realfft", grid] => batches::serve("AVX planner", &mut realfft_solve::Mesh::new(grid.parse()?)?),
        ["step", engine, threads, ref overrides @ ..] => {
            let mut run = ours::Run::new(engine, threads.parse()?, overrides)?;
            batches::serve(&run.describe(), &mut run)
        }
        _ => {
            Err("usage: solvers, mesh SOLVER GRID, realfft GRID, or step host|core THREADS [KEY=VALUE]..."
                .into())
        }
    }
}
