//! Influences of loads on the stress of roots.

use super::{gear, model, standard};
use crate::gear::geometry::root::RootShape;

#[test]
fn probe_print() {
    for (z, across) in [(19, 16), (48, 16), (19, 8), (19, 24)] {
        let (gear, root) = gear(&standard(z, 1.758), RootShape::Trochoid);
        let model = model(&gear, &root, across).unwrap();
        let (form, tip) = (root.form_roll, gear.tip_roll());
        let rolls: Vec<f64> = [0.1, 0.3, 0.5, 0.7, 0.95].map(|part| form + part * (tip - form)).to_vec();
        let found = model.stress_influences(&rolls, 2).unwrap();
        let direct = model.root_stresses(&rolls).unwrap();
        println!("z {z} across {across}: {} gauges, {} direct", found.gauges.len(), direct[4].len());
        for (load, direct) in direct.iter().enumerate() {
            let ours = &found.stresses[2][load];
            let line: Vec<String> = direct[2..].iter().zip(ours).map(|(d, o)| format!("{:.3}/{:.4}", d.stress, o - d.stress)).collect();
            println!("{}", line.join(" "));
        }
        println!("behind {:?}", found.stresses[1][2]);
        println!("ahead {:?}", found.stresses[3][2]);
    }
}
