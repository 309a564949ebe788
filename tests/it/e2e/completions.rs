//! Completions as shells ask for them, `help`, and man pages.

use std::fs;
use std::process::Command;

use crate::desk::Desk;

/// What bash completes where the cursor stands behind these words, parted as readline parts them.
fn bash(desk: &Desk, words: &[&str]) -> Vec<String> {
    let ask = r#"
        source <(gearstudy completions bash) || exit 9
        COMP_WORDS=() word=
        for word in "$@"; do
            if [[ $word == *=* ]]; then
                COMP_WORDS+=("${word%%=*}" "=")
                [[ -z ${word#*=} ]] || COMP_WORDS+=("${word#*=}")
            else
                COMP_WORDS+=("$word")
            fi
        done
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMP_LINE="$*" COMP_POINT=${#COMP_LINE}
        word=${COMP_WORDS[COMP_CWORD]}
        [[ $word != "=" ]] || word=
        registered=$(complete -p gearstudy)
        [[ $registered == *"-F _gearstudy gearstudy" ]] || exit 8
        _gearstudy gearstudy "$word" "${COMP_WORDS[COMP_CWORD - 1]}"
        printf '%s\n' "${COMPREPLY[@]}"
    "#;
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_gearstudy")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let mut command = Command::new("bash");
    command.args(["--norc", "-c", ask, "bash", "gearstudy"]).args(words).current_dir(desk.path("")).env("PATH", path);
    let output = command.env_remove("GEARSTUDY_CACHE").output().unwrap();
    let (out, error) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && error.is_empty(), "{words:?}: {out}{error}");
    out.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

#[test]
fn bash_completes_what_the_study_on_the_line_has() {
    let desk = Desk::with("quick.yaml");
    let has = |words: &[&str], wanted: &[&str]| {
        let found = bash(&desk, words);
        for word in wanted {
            assert!(found.iter().any(|found| found == word), "{words:?}: no {word} in {found:?}");
        }
    };
    let is = |words: &[&str], wanted: &[&str]| assert_eq!(bash(&desk, words), wanted, "{words:?}");
    has(&[""], &["run", "status", "table", "help"]);
    is(&["ru"], &["run"]);
    is(&["run", "qui"], &["quick.yaml"]);
    is(&["run", "quick.yaml", "--only", "st"], &["stiffness", "ste"]);
    is(&["run", "quick.yaml", "--only", "pair,opt"], &["pair,optimum"]);
    // What stands in the list already is not offered again.
    let stages = bash(&desk, &["run", "quick.yaml", "--only", "pair,ste,"]);
    assert_eq!(stages, ["pair,ste,stiffness", "pair,ste,designs", "pair,ste,optimum", "pair,ste,report"]);
    is(&["plan", "quick.yaml", "--want", "optimum."], &["optimum.evaluations"]);
    has(&["plan", "quick.yaml", "--want", "ste.summary.la"], &["ste.summary.largest_pressure"]);
    is(&["run", "quick.yaml", "--set", "pair.pinion.fa"], &["pair.pinion.face_width="]);
    is(&["kinds", "optimizer.design.tip_r"], &["optimizer.design.tip_relief"]);
    is(&["help", "shard", "st"], &["status"]);
    is(&["new", "x.yaml", "--template", ""], &["quick", "sweep"]);
    // Before a run, the tables that it gives; afterwards those that are there, their columns and values.
    has(&["table", "quick.yaml", "ste."], &["ste.summary", "ste.curve"]);
    is(&["table", "quick.yaml", "ste.summary", "--where", "des"], &["design="]);
    is(&["table", "quick.yaml", "ste.summary", "--where", "design="], &["unmodified", "short", "long", "optimum"]);
    desk.run(&["run", "--quiet", "quick.yaml", "--results", "here"], 0);
    is(&["table", "quick.yaml", "--results", "here", "ste.su"], &["ste.summary"]);
    is(
        &["table", "quick.yaml", "--results", "here", "ste.summary", "--columns", "design,peak"],
        &["design,peak_to_peak"],
    );
    is(&["table", "quick.yaml", "--results", "here", "ste.summary", "--where", "des"], &["design="]);
    let line = ["table", "quick.yaml", "--results", "here", "ste.summary", "--where", "design="];
    is(&line, &["long", "optimum", "short", "unmodified"]);
    is(&["table", "quick.yaml", "--results=here", "ste.summary", "--where", "torque=1"], &["100", "150"]);
    is(&["diff", "--results", "here", "--tolerance", "ste.summary.peak"], &["ste.summary.peak_to_peak="]);
    // What is no study completes nothing, and says nothing.
    fs::write(desk.path("broken.yaml"), "study: [").unwrap();
    assert!(bash(&desk, &["run", "broken.yaml", "--only", "p"]).is_empty());
}

/// zsh and fish ask with other words and are given a meaning with each.
#[test]
fn other_shells_are_given_meanings_too() {
    let desk = Desk::with("quick.yaml");
    let asked = |shell: &str, index: &str, words: &[&str]| {
        let mut command = desk.command(&[&["--", "gearstudy"], words].concat());
        command.env("GEARSTUDY_COMPLETE", shell).env("_CLAP_COMPLETE_INDEX", index).env("_CLAP_IFS", "\n");
        String::from_utf8(command.output().unwrap().stdout).unwrap()
    };
    let zsh = asked("zsh", "4", &["run", "quick.yaml", "--only", "pa"]);
    assert!(zsh.starts_with("pair:"), "{zsh}");
    let fish = asked("fish", "", &["table", "quick.yaml", "ste.summary", "--columns", "peak_to"]);
    assert!(fish.starts_with("peak_to_peak\t[um] "), "{fish}");
    let fish = asked("fish", "", &["run", "quick.yaml", "--only", "pa"]);
    assert!(fish.starts_with("pair\t"), "{fish}");
    for shell in ["zsh", "fish", "elvish", "powershell"] {
        let (script, _) = desk.run(&["completions", shell], 0);
        assert!(script.contains("GEARSTUDY_COMPLETE") && script.contains("gearstudy"), "{shell}: {script}");
    }
}

#[test]
fn help_is_a_command_too_and_a_manual() {
    let desk = Desk::with("quick.yaml");
    assert_eq!(desk.run(&["help", "run"], 0), desk.run(&["run", "--help"], 0));
    assert_eq!(desk.run(&["help", "shard", "plan"], 0), desk.run(&["shard", "plan", "--help"], 0));
    assert!(desk.run(&["help"], 0).0.contains("Exit codes: "));
    assert!(desk.run(&["help", "rum"], 1).1.contains("there is no command `rum`; did you mean `run`?"));
    desk.run(&["help", "--man", "man"], 0);
    let listed = desk.run(&["help"], 0).0;
    let commands = listed.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let names = commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<&str> = names.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() > 15, "{names:?}");
    for name in names.into_iter().chain(["shard-plan", "shard-merge"]) {
        let page = fs::read_to_string(desk.path(&format!("man/gearstudy-{name}.1"))).unwrap();
        assert!(page.contains(".SH NAME") && page.contains(".SH SYNOPSIS"), "{name}: {page}");
    }
    let run = fs::read_to_string(desk.path("man/gearstudy-run.1")).unwrap();
    assert!(run.contains("\\-\\-keep\\-going") && run.contains("gearstudy\\-run"), "{run}");
}
