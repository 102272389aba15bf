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
        let left = folders.filter_map(|folder| {
            let folder = folder.strip_prefix("/").unwrap_or(folder);
            let file = |name: &str| {
                fs::read_to_string(Path::new("/sys/fs/cgroup").join(folder).join(name)).unwrap_or_default()
            };
            of_control_group(
                &file("memory.max"),
                &file("memory.current"),
                &file("memory.stat"),
                "inactive_file",
            )
        });
        left.min()
    });
    // The first version of control groups.
    let of_group = of_group.or_else(|| {
        let file = |name: &str| read(&format!("/sys/fs/cgroup/memory/memory.{name}")).unwrap_or_default();
        of_control_group(
            &file("limit_in_bytes"),
            &file("usage_in_bytes"),
            &file("stat"),
            "total_inactive_file",
        )
    });
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

/// What a control group's `limit` leaves beside what it has taken, less the part of that (in `statistics`, by the name
/// `reclaimed`) which files hold that are given up first; None without a limit.
fn of_control_group(limit: &str, taken: &str, statistics: &str, reclaimed: &str) -> Option<u64> {
    let limit: u64 = limit.trim().parse().ok()?;
    let taken: u64 = taken.trim().parse().unwrap_or(0);
    let named = |line: &str| line.strip_prefix(reclaimed)?.strip_prefix(' ')?.trim().parse::<u64>().ok();
    let of_files = statistics.lines().find_map(named).unwrap_or(0);
    Some(limit.saturating_sub(taken.saturating_sub(of_files)))
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
        let group = |limit: &str, taken: &str| {
            of_control_group(limit, taken, "file 9\ninactive_file 30\n", "inactive_file")
        };
        assert_eq!(group("100\n", "70\n"), Some(60));
        assert_eq!(group("100\n", "200\n"), Some(0));
        assert_eq!(group("100\n", ""), Some(100));
        assert_eq!(group("max\n", "70\n"), None);
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
