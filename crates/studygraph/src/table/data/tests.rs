//! Tests of tables: their digests, and parts put together. Must not know: what any row is.

use super::*;

fn table(name: &str, columns: Vec<Column>, rows: Vec<Row>) -> Table {
    Table::from_rows(Schema::new(name, "", columns), rows).unwrap()
}

fn columns() -> Vec<Column> {
    vec![
        Column::text("design", "").key(),
        Column::float("torque", "N m", ""),
        Column::integer("teeth", ""),
        Column::flag("fits", ""),
        Column::float("seconds", "s", "").volatile(),
    ]
}

fn rows() -> Vec<Row> {
    vec![
        vec!["iso".into(), 50.0.into(), Cell::Integer(19), Cell::Flag(true), 3.0.into()],
        vec!["none".into(), 25.0.into(), Cell::Integer(48), Cell::Flag(false), 4.0.into()],
    ]
}

/// Tier: invariant; the cache takes tables of one digest for the same: all that tells two apart must be in it, and nothing
/// that a run of the same study may change.
#[test]
fn the_digest_tells_tables_apart_by_all_they_say() {
    let base = table("summary", columns(), rows()).content_hash();
    let mut others = vec![table("curve", columns(), rows())];
    let changes: [fn(&mut Vec<Column>); 4] = [
        |columns| columns[1].name = "force".to_owned(),
        |columns| columns[1].unit = "kN m".to_owned(),
        |columns| columns[1].key = true,
        |columns| columns.swap(2, 3),
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let (mut columns, mut rows) = (columns(), rows());
        change(&mut columns);
        if index == 3 {
            for row in &mut rows {
                row.swap(2, 3);
            }
        }
        others.push(table("summary", columns, rows));
    }
    let cells: [(usize, Cell); 4] =
        [(0, "is".into()), (1, 50.5.into()), (2, Cell::Integer(20)), (3, Cell::Flag(false))];
    for (at, cell) in cells {
        let mut rows = rows();
        rows[0][at] = cell;
        others.push(table("summary", columns(), rows));
    }
    others.push(table("summary", columns(), rows()[..1].to_vec()));
    let mut digests: Vec<_> = others.iter().map(Table::content_hash).collect();
    digests.push(base);
    for (at, digest) in digests.iter().enumerate() {
        assert!(!digests[..at].contains(digest), "table {at} has the digest of another");
    }
    // Neither what is volatile nor prose.
    let (mut later, mut described) = (rows(), columns());
    for row in &mut later {
        row[4] = 9.0.into();
    }
    described[1].description = "at the pinion".to_owned();
    assert_eq!(table("summary", described, later).content_hash(), base);
}

/// Tier: second method; all rows at once are sorted and looked at as a whole, parts only where they meet.
#[test]
fn parts_together_are_the_table_of_all_their_rows() {
    let columns =
        || vec![Column::text("design", "").key(), Column::integer("point", "").key(), Column::float("x", "", "")];
    let row =
        |at: i64| -> Row { vec![(if at < 4 { "a" } else { "b" }).into(), Cell::Integer(at % 4), (at as f64).into()] };
    let of = |rows: &[i64]| table("curve", columns(), rows.iter().map(|&at| row(at)).collect());
    let whole = of(&[0, 1, 2, 3, 4, 5, 6, 7]);
    let cuts: [&[&[i64]]; 6] = [
        &[&[0, 1, 2, 3, 4, 5, 6, 7]],
        &[&[0, 1, 2], &[3], &[4, 5, 6, 7]],
        &[&[], &[0, 1, 2, 3, 4], &[], &[], &[5, 6, 7], &[]],
        &[&[4, 5, 6, 7], &[0, 1, 2, 3]],
        &[&[0, 2, 4, 6], &[1, 3, 5, 7]],
        &[&[0, 1, 2, 3, 4, 5, 7], &[6]],
    ];
    for cut in cuts {
        let parts = cut.iter().map(|rows| of(rows)).collect();
        assert_eq!(Table::concatenated(parts).unwrap().as_ref(), Some(&whole), "{cut:?}");
    }
    assert_eq!(Table::concatenated(Vec::new()).unwrap(), None);
    for cut in [[&[0, 1][..], &[1, 2]], [&[0, 5], &[0, 4]]] {
        let refused = Table::concatenated(cut.iter().map(|rows| of(rows)).collect()).unwrap_err();
        assert!(matches!(refused, TableError::RepeatedKey { .. }), "{refused}");
    }
    let other = table("curve", columns()[..2].to_vec(), vec![row(0)[..2].to_vec()]);
    assert!(Table::concatenated(vec![of(&[1]), other]).is_err());
}
