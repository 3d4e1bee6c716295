//! Resident memory of a process.

/// Whether it can be told on this system.
pub const KNOWN: bool = cfg!(target_os = "linux");

/// Megabytes (of 10⁶ bytes) that a process holds in memory; `None` if it is gone, or if this system does not tell.
pub fn resident_megabytes(process: u32) -> Option<f64> {
    if !KNOWN {
        return None;
    }
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let kibibytes = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    kibibytes.trim().trim_end_matches(" kB").parse::<f64>().ok().map(|k| k * 1024.0 / 1e6)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_is_touched_is_seen() {
        let before = resident_megabytes(std::process::id()).unwrap();
        let held = std::hint::black_box(vec![1_u8; 64_000_000]);
        let after = resident_megabytes(std::process::id()).unwrap();
        assert!((after - before - 64.0).abs() < 16.0, "{before} {after} {}", held.len());
        assert_eq!(resident_megabytes(u32::MAX), None);
    }
}
