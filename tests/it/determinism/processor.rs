//! The same bits on a processor without AVX2, FMA and AVX-512, as far as the C library can be made to believe in one.
//!
//! `GLIBC_TUNABLES` masks features for the C library's own choice among its functions. What a Rust library finds out by
//! itself (`cpuid`) is not masked: see "Same bits anywhere" in docs/methods.md.

use std::process::Command;

use crate::desk::Desk;

const MASK: &str =
    "glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-FMA4,-AVX512F,-AVX512VL,-AVX512BW,-AVX512DQ,-ERMS";

/// Contents of a study run by this many threads, with or without the mask.
fn contents(study: &str, jobs: u16, masked: bool) -> Vec<(String, String)> {
    let desk = Desk::with(&format!("{study}.yaml"));
    let mut command = desk.command(&["run", &format!("{study}.yaml"), "--quiet", "--jobs", &jobs.to_string()]);
    if masked {
        command.env("GLIBC_TUNABLES", MASK);
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    desk.contents(study)
}

fn the_same_everywhere(study: &str, threads: &[u16]) {
    let plain = contents(study, 2, false);
    assert!(plain.len() >= 20, "{}", plain.len());
    for &jobs in threads {
        for ((name, content), (_, masked)) in plain.iter().zip(contents(study, jobs, true)) {
            assert_eq!(*content, masked, "{study}, {name}: {jobs} threads, masked");
        }
    }
}

#[test]
fn the_quick_study_has_the_same_contents_on_a_lesser_processor() {
    the_same_everywhere("quick", &[1, 2, 3, 8]);
}

#[test]
fn the_article_energy_ga_has_the_same_contents_on_a_lesser_processor() {
    the_same_everywhere("energy_ga", &[1, 8]);
}

#[test]
fn the_article_harris_map_has_the_same_contents_on_a_lesser_processor() {
    the_same_everywhere("harris_map", &[1, 8]);
}

#[test]
fn the_article_zhai2020_has_the_same_contents_on_a_lesser_processor() {
    the_same_everywhere("zhai2020", &[1, 8]);
}

/// Its finite elements are factorised by a library that the mask does not reach: the same processor to it, the same bits.
#[test]
fn the_article_mei2016_has_the_same_contents_with_any_number_of_threads() {
    the_same_everywhere("mei2016", &[1, 8]);
}

/// The mask works: where the processor has FMA, the C library's sine is another one without it. Were it misspelt, the
/// tests above could not fail.
#[test]
fn the_mask_changes_the_c_library() {
    let digest = |masked: bool| {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(["--exact", "determinism::processor::digest_of_the_c_library", "--nocapture"]);
        if masked {
            command.env("GLIBC_TUNABLES", MASK);
        }
        let output = command.output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        text.split("digest ").nth(1).unwrap_or_else(|| panic!("{text}")).split_whitespace().next().unwrap().to_owned()
    };
    assert_eq!(digest(false), digest(false));
    if std::arch::is_x86_feature_detected!("fma") {
        assert_ne!(digest(false), digest(true), "GLIBC_TUNABLES masks nothing here: {MASK}");
    }
}

#[test]
fn digest_of_the_c_library() {
    let mut hasher = blake3::Hasher::new();
    for step in 1..200_000 {
        let x = f64::from(step) * 1.000_123e-3;
        for value in [x.sin(), x.exp(), x.powf(1.7), x.atan()] {
            hasher.update(&value.to_le_bytes());
        }
    }
    println!("digest {}", hasher.finalize());
}
