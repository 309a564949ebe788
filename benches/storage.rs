//! Digests and files of tables.

use std::hint::black_box;

use criterion::{Criterion, criterion_group};

use crate::brief;
use declare::digest::Writer;
use studygraph::store::parquet;
use studygraph::table::data::{Data, Table};
use studygraph::table::schema::{Column, Schema};

criterion_group!(name = benches; config = brief(); targets = storage);

const ROWS: usize = 100_000;

/// Like a curve of the transmission error: two keys, eight numbers that a compressor finds nothing in.
fn table() -> Table {
    let float = |column: usize| -> Data {
        let frequency = 0.37 * (column + 1) as f64;
        Data::Float((0..ROWS).map(|row| libm::sin(frequency * row as f64)).collect())
    };
    let names: [_; 8] = std::array::from_fn(|column| format!("value_{column}"));
    let mut columns = vec![Column::text("design", "").key(), Column::integer("point", "").key()];
    columns.extend(names.iter().map(|name| Column::float(name, "um", "")));
    let count = i64::try_from(ROWS).expect("it is small");
    let mut data = vec![Data::Text(vec!["optimum".to_owned(); ROWS]), Data::Integer((1..=count).collect())];
    data.extend((0..names.len()).map(float));
    Table::from_columns(Schema::new("curve", "", columns), data).expect("keys ascend")
}

fn storage(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("store");
    group.sample_size(10);
    let floats: Vec<f64> = (0..1_000_000).map(|index| libm::sin(f64::from(index))).collect();
    group.bench_function("digest 1e6 floats", |bencher| {
        bencher.iter(|| Writer::new("bench").floats(black_box(&floats)).finish());
    });
    let table = table();
    group.bench_function("parquet write 1e5 rows", |bencher| bencher.iter(|| parquet::write(black_box(&table))));
    let bytes = parquet::write(&table).expect("it is a table");
    group.bench_function("parquet read 1e5 rows", |bencher| bencher.iter(|| parquet::read(black_box(bytes.clone()))));
    #[cfg(feature = "hdf5")]
    {
        use studygraph::store::hdf5::Writer;
        group.bench_function("hdf5 of 1e5 rows, in memory", |bencher| {
            bencher.iter(|| {
                let mut writer = Writer::new("bench.h5").expect("there is memory");
                writer.add("stage", black_box(&table)).expect("the file is ours");
                writer.finish(<[u8]>::len)
            });
        });
    }
}
