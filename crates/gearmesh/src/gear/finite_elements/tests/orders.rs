//! By how much a sector moves when the sums of its factorisation are made in another order.

use super::super::element::elasticity;
use crate::gear::material::Plane;
use cholesky::Order;

use super::super::sector::Sector;
use super::{gear, model, standard};
use crate::gear::geometry::root::RootShape;

/// Largest difference over the largest value.
fn movement(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0_f64, |maximum, value| maximum.max(value.abs()));
    a.iter().zip(b).fold(0.0_f64, |maximum, (a, b)| maximum.max((a - b).abs())) / largest
}

/// Tier: second method; column by column without dense blocks, and in another order of elimination: the same stiffness and
/// displacements to 1e-11, and not the same bits. Tolerances of columns, 1e-9 and more, are far outside (docs/methods.md,
/// "Same bits anywhere").
#[test]
fn sums_in_another_order_move_results_by_rounding_alone() {
    for (teeth, bore_ratio, across) in [(19, 1.758, 6), (30, 4.0, 8)] {
        let (gear, root) = gear(&standard(teeth, bore_ratio), RootShape::Trochoid);
        let mesh = model(&gear, &root, across).unwrap().mesh;
        let load = vec![(mesh.nodes.len() / 2, [0.6, -0.8])];
        let of = |order: Order| {
            let sector = Sector::factorised(&mesh, &elasticity(Plane::Strain, 0.3), order).unwrap();
            let response = sector.responses(std::slice::from_ref(&load)).remove(0);
            let edges = vec![0.0; sector.stiffness().len()];
            let moved: Vec<f64> = sector.displacements(&response, &edges).into_iter().flatten().collect();
            (sector.stiffness().concat(), moved)
        };
        let (stiffness, moved) = of(Order::Blocks);
        for order in [Order::Columns, Order::Numbered] {
            let other = of(order);
            for (what, found) in [("stiffness", movement(&stiffness, &other.0)), ("moved", movement(&moved, &other.1))]
            {
                println!("{teeth} teeth, {order:?}, {what}: {found:.1e}");
                assert!(found > 0.0 && found < 1e-11, "{teeth} {order:?} {what}: {found:e}");
            }
        }
    }
}
