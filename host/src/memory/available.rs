//! How much memory there is.

use std::fs;
use std::path::Path;

/// How many bytes of memory this process can still have, and who says so; None where nobody does.
#[must_use]
pub fn available() -> Option<(u64, &'static str)> {
    let read = |path: &str| fs::read_to_string(path).ok();
    let of_system = read("/proc/meminfo").and_then(|text| of_meminfo(&text));
    let of_group = read("/proc/self/cgroup").and_then(|text| {
        let unified = text.lines().find_map(|line| line.strip_prefix("0::"))?;
        let folders = Path::new(unified.trim()).ancestors();
        let limits = folders.filter_map(|folder| {
            let folder = folder.strip_prefix("/").unwrap_or(folder);
            let path = Path::new("/sys/fs/cgroup").join(folder).join("memory.max");
            fs::read_to_string(path).ok()?.trim().parse().ok()
        });
        limits.min()
    });
    // The first version of control groups.
    let of_group =
        of_group.or_else(|| read("/sys/fs/cgroup/memory/memory.limit_in_bytes")?.trim().parse().ok());
    let of_process = read("/proc/self/limits").and_then(|text| of_limits(&text)).map(|limit| {
        let taken = read("/proc/self/status").and_then(|text| kilobytes(&text, "VmSize:")).unwrap_or(0);
        limit.saturating_sub(taken)
    });
    [
        of_system.map(|bytes| (bytes, "the system's memory")),
        of_group.map(|bytes| (bytes, "the limit of the control group")),
        of_process.map(|bytes| (bytes, "the limit of the address space, ulimit -v")),
    ]
    .into_iter()
    .flatten()
    .min()
}

/// The number of a line `name   12 kB`, in bytes.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let number = text.lines().find_map(|line| line.strip_prefix(name))?;
    number.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

/// What `/proc/meminfo` calls available, and free swap.
fn of_meminfo(text: &str) -> Option<u64> {
    Some(kilobytes(text, "MemAvailable:")?.saturating_add(kilobytes(text, "SwapFree:").unwrap_or(0)))
}

/// The soft limit of the address space in `/proc/self/limits`; None if there is none.
fn of_limits(text: &str) -> Option<u64> {
    text.lines()
        .find_map(|line| line.strip_prefix("Max address space"))?
        .split_whitespace()
        .next()?
        .parse()
        .ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_says_is_understood() {
        let meminfo = "MemTotal:  16 kB\nMemFree:   1 kB\nMemAvailable:    5 kB\nSwapFree:   2 kB\n";
        assert_eq!(of_meminfo(meminfo), Some(7 * 1024));
        assert_eq!(of_meminfo("MemTotal: 16 kB\n"), None);
        let limits = |limit: &str| {
            format!("Limit  Soft Limit  Hard Limit  Units\nMax address space   {limit}   unlimited   bytes\n")
        };
        assert_eq!(of_limits(&limits("1000")), Some(1000));
        assert_eq!(of_limits(&limits("unlimited")), None);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn this_machine_has_memory() {
        assert!(available().is_some_and(|(bytes, _)| bytes > 1 << 20));
    }
}
