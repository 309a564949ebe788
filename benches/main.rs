//! All measurements, in one binary: `make bench` prints them. What is measured of a layer is a module here.
//!
//! Criterion measures what takes less than a second; whole runs of the program are started several times. At the end
//! come the tables of error against run time, and one table of everything against its target. With a name on the command
//! line only the benches whose names contain it are measured, and no table follows.

#![allow(clippy::disallowed_methods, reason = "a measurement that cannot read a file fails")]

mod accuracy;
mod article;
mod designs;
mod diff;
mod finite_elements;
mod geometry;
mod kernels;
mod measured;
mod optimize;
mod pages;
mod program;
mod shards;
mod storage;
mod summary;
mod sweep;

use std::time::Duration;

use criterion::Criterion;

fn main() {
    kernels::benches();
    measured::benches();
    geometry::benches();
    optimize::benches();
    finite_elements::benches();
    storage::benches();
    designs::benches();
    diff::benches();
    program::benches();
    brief().final_summary();
    if std::env::args().skip(1).all(|word| word == "--bench") {
        let processes = program::processes();
        accuracy::print();
        finite_elements::print();
        designs::print();
        designs::print_optimizer();
        sweep::print();
        shards::print();
        pages::print();
        summary::print(&processes);
    }
}

/// Half a second of warming up and two of measuring: medians repeat within a few per cent, and all takes two minutes.
fn brief() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_millis(1500))
        .sample_size(30)
        .without_plots()
        .configure_from_args()
}
