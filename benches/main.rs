//! All benchmarks, in one binary: `make bench` prints them. A layer's benches are a module here and a name in the list.

#[allow(dead_code, reason = "benches use a part of what tests share")]
#[path = "../tests/it/support.rs"]
mod support;

mod optimize;

criterion::criterion_main!(optimize::benches);
