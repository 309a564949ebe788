//! Measured flanks in a CSV file beside the study: it counts as the study's own text, and what is wrong with it has its place in it.

use std::fmt::Write as _;
use std::fs;

use crate::desk::Desk;
use declare::digest::Writer;
use gearstudy::program::{load, load_text};

const STUDY: &str = "\
study: traced
seed: 1
stages:
  pair: { kind: geometry, module: 3 mm, pinion: { teeth: 19, face_width: 20 mm, bore_radius: 10 mm }, gear: { teeth: 48, face_width: 18 mm, bore_radius: 20 mm } }
  designs:
    kind: modification
    pair: pair
    designs:
      made:
        - measured: { gear: pinion, file: traces/tooth.csv }
  stiffness: { kind: stiffness, pair: pair, method: energy }
  ste: { kind: ste, stiffness: stiffness, designs: designs, torque: 100 N m }
";

/// A relief of so many micrometres, as a machine with decimal commas and lines of Windows writes it.
fn trace(relief: f64) -> String {
    let mut text =
        "\u{feff}# Machine: P 40\r\n# teeth: 19\r\n# module: 3 mm\r\nroll_lengths [mm]; deviations [um]\r\n".to_owned();
    for at in 0..60 {
        let share = f64::from(at) / 59.0;
        let line = format!("{:.4};{:.4}", 2.5 + 14.0 * share, -relief * share * share);
        let _ = write!(text, "{}\r\n", line.replace('.', ","));
    }
    text
}

fn desk(text: &str) -> Desk {
    let desk = Desk::with("quick.yaml");
    fs::create_dir(desk.path("traces")).unwrap();
    fs::write(desk.path("traced.yaml"), STUDY).unwrap();
    fs::write(desk.path("traces/tooth.csv"), text).unwrap();
    desk
}

/// The content of a table of the last run.
fn content(desk: &Desk, table: &str) -> String {
    desk.contents("traced").into_iter().find(|(name, _)| name == table).unwrap().1
}

#[test]
fn a_trace_in_a_file_is_part_of_the_study() {
    let desk = desk(&trace(12.0));
    desk.run(&["run", "traced.yaml", "--quiet"], 0);
    let first = content(&desk, "ste.summary");
    assert!(desk.run(&["status", "traced.yaml"], 0).0.contains("up to date"));

    // Other points are another study; a remark is none.
    fs::write(desk.path("traces/tooth.csv"), trace(9.0)).unwrap();
    desk.run(&["run", "traced.yaml", "--quiet"], 0);
    assert_eq!(desk.ran("traced"), ["designs", "ste"]);
    let second = content(&desk, "ste.summary");
    assert_ne!(first, second);
    fs::write(desk.path("traces/tooth.csv"), trace(9.0) + "# seen by nobody\r\n").unwrap();
    desk.run(&["run", "traced.yaml", "--quiet"], 0);
    assert_eq!(desk.ran("traced"), [""; 0]);
    assert_eq!(content(&desk, "ste.summary"), second);

    // Without its file, an archive is the same study, and so is the list in the study.
    desk.run(&["archive", "traced.yaml", "-o", "a.zip"], 0);
    let whole = load(&desk.path("traced.yaml")).unwrap().text;
    fs::remove_dir_all(desk.path("traces")).unwrap();
    assert!(desk.run(&["verify", "a.zip"], 0).0.contains("identical"));
    let record = |text: &str| {
        let study = load_text(text, &desk.path("traced.yaml")).unwrap();
        study.nodes.into_iter().find(|node| node.name == "designs").unwrap().record
    };
    let (mut lengths, mut deviations) = (String::new(), String::new());
    for line in trace(9.0).lines().skip(4) {
        let (length, deviation) = line.split_once(';').unwrap();
        let _ = write!(lengths, "{} mm, ", length.replace(',', "."));
        let _ = write!(deviations, "{}, ", deviation.replace(',', "."));
    }
    let lists = format!(
        "teeth: 19, module: 3 mm, roll_lengths: [{lengths}], deviations: {{ unit: um, values: [{deviations}] }}"
    );
    // What the canonical digest of both is: of values, not of places.
    let digest = |text: &str| {
        let mut writer = Writer::new("record");
        record(text).write(&mut writer);
        writer.finish().to_string()
    };
    assert_eq!(digest(&whole), digest(&STUDY.replace("file: traces/tooth.csv", &lists)));
}

#[test]
fn what_is_wrong_with_a_file_stands_in_it() {
    let desk = desk("");
    let said = |text: &str| {
        fs::write(desk.path("traces/tooth.csv"), text).unwrap();
        let said = desk.run(&["check", "traced.yaml"], 2).1;
        said.lines().next().unwrap().to_owned()
    };
    let good = trace(12.0);
    let lines: Vec<&str> = good.lines().collect();
    let without = |from: usize, to: usize| [&lines[..from], &lines[to..]].concat().join("\n");
    let other = |line: usize, text: &str| [&lines[..line], &[text], &lines[line + 1..]].concat().join("\n");
    let all = |from: &str, to: &str| good.replace(from, to);
    // Some columns of it, with decimal points.
    let columns = |wanted: &[usize]| {
        let row = |line: &&str| {
            let line = line.replace(',', ".");
            if line.trim_start_matches('\u{feff}').starts_with('#') {
                return line;
            }
            let cells: Vec<&str> = line.split(';').collect();
            wanted.iter().map(|at| cells[*at].trim()).collect::<Vec<_>>().join("; ")
        };
        lines.iter().map(row).collect::<Vec<_>>().join("\n")
    };
    let reversed = [&lines[..4], &lines[4..].iter().rev().copied().collect::<Vec<_>>()[..]].concat().join("\n");
    for (text, message) in [
        (without(20, 40), "21:1: there is a gap between points 16 and 17"),
        (other(30, "8,6695;55"), "31:8: deviation 27 stands 57"),
        (reversed, "4:1: `roll_lengths` falls all along"),
        (other(30, "9,0x;-3"), "31:1: "),
        (other(30, "8,6695;NaN"), "31:8: `NaN` stands for a missing value of `deviations`"),
        (other(30, "8,6695;"), "31:8: a value of `deviations` is missing"),
        (other(30, "<<<<<<< HEAD"), "31:1: a merge left both versions at line 31; keep one"),
        (other(30, lines[29]), "31:1: point 27 of `roll_lengths` is the same as the one before it"),
        (all("# teeth: 19", "# teeth: 48"), "2:10: design `made`, measured: a gear of 48 teeth was measured"),
        (all("# module: 3 mm", "# module: 4 mm"), "3:11: design `made`, measured: a gear of module 4"),
        // A column that is missing is missed where columns are named, one that is twice is told of where it is a second time.
        (columns(&[0]), "4:1: `measured` has no `deviations`; a list is expected"),
        (columns(&[1]), "4:1: nothing says where the deviations were measured"),
        (columns(&[0, 0, 1]), "4:20: `roll_lengths` starts again at its point 61"),
        (columns(&[0, 1, 1]), "4:37: there are 120 deviations for 60 `roll_lengths`"),
        (all("# teeth", "# teeht"), "2:3: unknown field `teeht` of `measured`"),
        (all("deviations [um]", "deviations [mm]"), "18:8: deviation 14 is -0.582"),
        (all("deviations [um]", "deviations [nm]"), "4:20: no deviation is larger than 1.2e-2 um"),
        (all("deviations [um]", "depth [um]"), "4:20: unknown field `depth` of `measured`"),
        (all(";", ","), "5:1: this line has 4 values, and there are 2 columns"),
        (
            "roll_lengths [mm], deviations [um]\n".to_owned() + &"1,2\n".repeat(300_000),
            "traced.yaml:10:43: `traces/tooth.csv` is larger than 1024 KiB",
        ),
    ] {
        let said = said(&text);
        assert!(said.contains(message), "{message}\n{said}");
    }
    for (name, message) in [
        ("traces/toth.csv", "there is no file `traces/toth.csv`"),
        ("/etc/passwd.csv", "`/etc/passwd.csv` does not lie beside the study, or below"),
        ("../a.csv", "`../a.csv` does not lie beside the study, or below"),
        ("trace.txt", "`file` is `trace.txt`; the name of a CSV file beside the study"),
    ] {
        fs::write(desk.path("traced.yaml"), STUDY.replace("traces/tooth.csv", name)).unwrap();
        let said = desk.run(&["check", "traced.yaml"], 2).1;
        assert!(said.starts_with(&format!("traced.yaml:10:43: {message}")), "{said}");
    }
    // What is set from outside has its own place.
    let set = "designs.designs.made[0].measured.file=nowhere.csv";
    let said = desk.run(&["check", "traced.yaml", "--set", set], 2).1;
    assert!(said.starts_with(&format!("--set {set}:1:39: there is no file `nowhere.csv`")), "{said}");
}

/// A study with a CSV file, however its text ends: what is archived is one document that gives the same tables.
#[test]
fn a_study_of_any_form_may_have_a_file() {
    let desk = desk(&trace(12.0));
    desk.run(&["run", "traced.yaml", "--quiet"], 0);
    let expected = content(&desk, "ste.summary");
    let json = serde_json::json!({
        "study": "traced",
        "seed": 1,
        "stages": {
            "pair": {
                "kind": "geometry",
                "module": "3 mm",
                "pinion": { "teeth": 19, "face_width": "20 mm", "bore_radius": "10 mm" },
                "gear": { "teeth": 48, "face_width": "18 mm", "bore_radius": "20 mm" },
            },
            "designs": {
                "kind": "modification",
                "pair": "pair",
                "designs": { "made": [{ "measured": { "gear": "pinion", "file": "./traces/tooth.csv" } }] },
            },
            "stiffness": { "kind": "stiffness", "pair": "pair", "method": "energy" },
            "ste": { "kind": "ste", "stiffness": "stiffness", "designs": "designs", "torque": "100 N m" },
        },
    });
    for text in [format!("{STUDY}...\n"), json.to_string(), format!("{json:#}\n...\n")] {
        fs::write(desk.path("traced.yaml"), &text).unwrap();
        desk.run(&["run", "traced.yaml", "--quiet"], 0);
        assert_eq!(content(&desk, "ste.summary"), expected, "{text}");
        desk.run(&["archive", "traced.yaml", "-o", "traced.zip", "--license", "CC-BY-4.0", "--author", "A B"], 0);
        desk.run(&["verify", "traced.zip"], 0);
        fs::remove_file(desk.path("traced.zip")).unwrap();
        desk.run(&["check", "traced.yaml", "--set", "pair.pinion.bore_radius=9 mm"], 0);
        let said = desk.run(&["check", "traced.yaml", "--set", "pair.pinion.bore_radius=9"], 2).1;
        assert!(said.starts_with("--set pair.pinion.bore_radius=9:1:25: "), "{said}");
        // A message about the file of the study, or the CSV file, has a line of that.
        fs::write(desk.path("traced.yaml"), text.replacen("100 N m", "100 N", 1)).unwrap();
        let said = desk.run(&["check", "traced.yaml"], 2).1;
        let line = 1 + text.lines().position(|line| line.contains("100 N m")).unwrap();
        assert!(said.starts_with(&format!("traced.yaml:{line}:")), "{said}");
        fs::write(desk.path("traced.yaml"), &text).unwrap();
        fs::write(desk.path("traces/tooth.csv"), trace(12.0).replacen("teeth: 19", "teeth: 48", 1)).unwrap();
        let said = desk.run(&["check", "traced.yaml"], 2).1;
        assert!(said.contains("traces/tooth.csv:2:10: design `made`"), "{said}");
        fs::write(desk.path("traces/tooth.csv"), trace(12.0)).unwrap();
    }
}

/// One file of all teeth, with marks where nothing was measured, and evaluation limits as diameters.
#[test]
fn a_file_of_several_teeth_is_read_tooth_by_tooth_or_averaged() {
    let desk = desk("");
    let mut text = "# missing: ---\n# teeth: 19\ntooth; roll_lengths [mm]; deviations [um]\n".to_owned();
    for tooth in [1, 6] {
        for at in 0..60 {
            let share = f64::from(at) / 59.0;
            let deviation = -12.0 * f64::from(tooth) * share * share;
            let deviation = if at == 30 { "---".to_owned() } else { format!("{deviation:.4}") };
            let _ = writeln!(text, "{tooth}; {:.4}; {deviation}", 2.5 + 14.0 * share);
        }
    }
    fs::write(desk.path("traces/tooth.csv"), text).unwrap();
    let cells = |condition: &str, more: &str, table: &str, columns: &str| -> Result<Vec<f64>, String> {
        let study = STUDY.replace("traces/tooth.csv", &format!("\"traces/tooth.csv{condition}\"{more}"));
        fs::write(desk.path("traced.yaml"), study).unwrap();
        let output = desk.command(&["run", "traced.yaml", "--quiet", "--want", table]).output().unwrap();
        if !output.status.success() {
            return Err(String::from_utf8(output.stderr).unwrap());
        }
        let csv = desk.run(&["table", "traced.yaml", table, "--columns", columns, "--format", "csv"], 0).0;
        let row = csv.lines().nth(1).unwrap_or_default().to_owned();
        Ok(row.split(',').filter_map(|cell| cell.parse().ok()).collect())
    };
    let amount = |condition: &str, more: &str| {
        cells(condition, more, "designs.resolved", "amount").map(|cells| *cells.last().unwrap())
    };
    assert!(amount("", "").unwrap_err().contains("traces/tooth.csv:3:1: this file has several teeth: `1`, `6`"));
    assert!(amount("[tooth=7]", "").unwrap_err().contains("no line has `7` in the column `tooth`"));
    for (condition, expected) in [("[tooth=1]", 12.0), ("[tooth=6]", 72.0), ("[tooth=mean]", 42.0)] {
        let found = amount(condition, "").unwrap();
        assert!((found - expected).abs() < 1e-3, "{condition}: {found}");
    }
    // d = 2 √(r_b² + L_y²): 8 and 12 mm of roll length on a base radius of 28.5 cos 20° mm.
    let base = 28.5 * 20.0_f64.to_radians().cos();
    let limit = |roll: f64| 2.0 * base.hypot(roll);
    let more = |start: f64, end: f64| {
        format!(", evaluation_start_diameter: {} mm, evaluation_end_diameter: {} mm", limit(start), limit(end))
    };
    let ends = cells("[tooth=1]", &more(8.0, 12.0), "designs.measured", "start,end").unwrap();
    let found = &ends[ends.len() - 2..];
    assert!((found[0] - 8.0).abs() < 1e-9 && (found[1] - 12.0).abs() < 1e-9, "{ends:?}");
    assert!(amount("[tooth=1]", &more(12.0, 8.0)).unwrap_err().contains("the evaluation ends at"));
    let both = format!("{}, evaluation_start: 8 mm", more(8.0, 12.0));
    let said = amount("[tooth=1]", &both).unwrap_err();
    assert!(said.contains("`evaluation_start` and `evaluation_start_diameter` say the same limit"), "{said}");
}
