"""Studies: what is run, published, read back and compared."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest

import gearstudy as gs
from conftest import ROOT

QUICK = ROOT / "studies" / "quick.yaml"


def test_tables_go_to_other_libraries_with_their_units(quick):
    table = quick.tables["ste.summary"]
    assert table.units["peak_to_peak"] == "um" and "torque" in table.key_columns
    expected = table["peak_to_peak"]
    pyarrow = pytest.importorskip("pyarrow")
    read = pyarrow.table(table)
    assert read.schema.field("torque").metadata[b"unit"] == b"N m"
    assert (read["peak_to_peak"].to_numpy() == expected).all()
    polars = pytest.importorskip("polars")
    assert (polars.DataFrame(table)["peak_to_peak"].to_numpy() == expected).all()
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame.from_arrow(table) if hasattr(pandas.DataFrame, "from_arrow") else read.to_pandas()
    assert (frame["peak_to_peak"].to_numpy() == expected).all()
    told = table.to_pandas()
    assert told.equals(frame) and told.attrs["units"] == table.units and told.attrs["name"] == "ste.summary"
    duckdb = pytest.importorskip("duckdb")
    largest = duckdb.sql("select max(peak_to_peak) from read").fetchall()[0][0]
    assert largest == expected.max()


def test_what_is_not_there_is_told(quick, tmp_path):
    with pytest.raises(KeyError, match="ste.summary"):
        quick.tables["ste.sumary"]
    with pytest.raises(KeyError, match="peak_to_peak"):
        quick.tables["ste.summary"]["peak"]
    with pytest.raises(gs.RunFailed, match="no results yet"):
        list(gs.load(QUICK, results=tmp_path).tables)
    with pytest.raises(gs.InvalidInput, match="not a table or column"):
        quick.run(want=["ste"])
    with pytest.raises(gs.InvalidStudy):
        quick.run(only=["stee"])


def test_verdicts_page_and_plan(quick):
    assert quick.report.is_file() and "<html" in quick.report.read_text()
    assert quick.plan()["up_to_date"] is True
    assert all("verdict" in row for row in quick.verdicts)
    assert quick.stages["ste"] == "ste" and quick.title
    assert "report.html" in quick._repr_html_()


def test_a_mapping_is_a_study_and_values_are_set(tmp_path):
    study = {
        "study": "mapped",
        "stages": {
            "pair": {
                "kind": "geometry",
                "module": "3 mm",
                "pinion": {"teeth": 24, "face_width": "20 mm", "bore_radius": "18 mm"},
                "gear": {"teeth": 36, "face_width": "20 mm", "bore_radius": "28 mm"},
            },
            "stiffness": {"kind": "stiffness", "pair": "pair"},
            "designs": {"kind": "modification", "pair": "pair", "designs": {"none": []}},
            "ste": {"kind": "ste", "stiffness": "stiffness", "designs": "designs", "torque": ["50 N m", "80 N m"]},
        },
    }
    places = {"results": tmp_path / "results", "cache": tmp_path / "cache"}
    one = gs.run(study, **places)
    other = gs.run(study, set={"ste.torque": "60 N m"}, name="mapped-60", **places)
    assert one.tables["ste.summary"]["torque"].tolist() == [50.0, 80.0]
    assert other.tables["ste.summary"]["torque"].tolist() == [60.0] and other.name == "mapped-60"
    found = other.diff(one)
    assert found["state"] != "same" and found["studies"]
    assert one.diff(one)["state"] == "same"
    with pytest.raises(gs.InvalidInput, match="cannot be a study"):
        gs.load({"study": "x", "stages": {"a": object()}})
    with pytest.raises(gs.InvalidStudy):
        gs.load({"study": "x"})


def test_events_are_told_and_what_a_callback_raises_stops_the_run(tmp_path):
    events = []
    places = {"results": tmp_path / "results", "cache": tmp_path / "cache"}

    def stopping(event):
        events.append(event)
        if event["event"] == "stage" and event["state"] == "done":
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        gs.run(QUICK, progress=stopping, **places)
    assert events and json.dumps(events)
    done = gs.run(QUICK, progress=events.append, **places)
    assert {"stage", "writing"} <= {event["event"] for event in events}
    assert done.plan()["up_to_date"] is True


def test_progress_in_lines(tmp_path, capsys):
    gs.run(QUICK, progress=True, results=tmp_path / "results", cache=tmp_path / "cache")
    assert "ste: done" in capsys.readouterr().err


def test_progress_in_a_notebook(tmp_path):
    """One line of its own, which changes: what a kernel sends, as a notebook receives it."""
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    places = f"results={str(tmp_path / 'results')!r}, cache={str(tmp_path / 'cache')!r}"
    cell = nbformat.v4.new_code_cell(f"import gearstudy as gs\ngs.run({str(QUICK)!r}, progress=True, {places})")
    notebook = nbformat.v4.new_notebook(cells=[cell])
    received = []

    class Client(nbclient.NotebookClient):
        def process_message(self, message, *others):
            received.append((message["msg_type"], message["content"]))
            return super().process_message(message, *others)

    Client(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()
    updates = [content["data"]["text/plain"] for kind, content in received if kind == "update_display_data"]
    assert len(updates) >= 6 and "ste: done" in " ".join(updates)
    shown, value = cell["outputs"]
    assert shown["data"]["text/plain"] == updates[-1] == "6 stages looked at"
    assert "report.html" in value["data"]["text/html"]


def test_what_a_stage_warns_of_is_heard(tmp_path):
    gear = {"teeth": 24, "face_width": "20 mm", "bore_radius": "5 mm"}
    pair = {"kind": "geometry", "module": "3 mm", "pinion": gear, "gear": gear}
    study = {"study": "warned", "stages": {"pair": pair, "stiffness": {"kind": "stiffness", "pair": "pair", "contact": "linear"}}}
    places = {"results": tmp_path / "results", "cache": tmp_path / "cache"}
    for run in (lambda: gs.run(study, **places), lambda: gs.load(study, **places).run(force=True)):
        with pytest.warns(gs.StudyWarning, match="stiffness") as warned:
            run()
        assert {warning.filename for warning in warned} == {__file__}


def test_a_study_is_where_it_was_when_it_was_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = gs.load(QUICK, results="results", cache="cache")
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    study.run(only="pair", want="pair.validity")
    assert (tmp_path / "results" / "quick").is_dir() and len(study.tables["pair.validity"]) == 2


def test_names_words_and_numbers_of_numpy(tmp_path):
    changed = gs.load(QUICK, set={"pair.gear.teeth": np.int64(37), "stiffness.coupling": np.str_("none")}, cache=tmp_path)
    assert changed.name != "quick"
    for wrong in (lambda: gs.load(QUICK, set=["a=b"]), lambda: gs.load(QUICK, set={"pair.gear.teeth": object()}),
                  lambda: gs.load({"study": "\ud800", "stages": {}}), lambda: gs.load(QUICK).run(progress=3)):
        with pytest.raises(gs.InvalidInput):
            wrong()


def test_a_table_is_a_mapping_whose_memory_is_shared(quick):
    table = quick.tables["ste.summary"]
    assert list(table) == table.columns and "torque" in table and "tork" not in table and 3 not in table
    assert dict(table)["torque"].tolist() == table["torque"].tolist()
    pyarrow = pytest.importorskip("pyarrow")
    address = lambda: pyarrow.table(table)["torque"].chunk(0).buffers()[1].address
    assert address() == address()


def test_a_run_cannot_be_run_by_its_own_callback(tmp_path):
    places = {"results": tmp_path / "results", "cache": tmp_path / "cache"}
    with pytest.raises(gs.RunFailed, match="what it calls cannot run it again"):
        gs.run(QUICK, progress=lambda event: gs.run(QUICK, **places), **places)
    inner = []
    gs.run(QUICK, progress=lambda event: inner or inner.append(gs.run(QUICK, name="other", **places)), **places)
    assert inner[0].plan()["up_to_date"]


def test_the_command_line_is_there(tmp_path):
    words = [sys.executable, "-m", "gearstudy", "--version"]
    assert subprocess.run(words, capture_output=True, text=True, check=True).stdout.startswith("gearstudy ")
    ended = subprocess.run([*words[:3], "check", "nothing.yaml"], capture_output=True, text=True, cwd=tmp_path)
    assert ended.returncode == 1 and "nothing.yaml" in ended.stderr


def stopped(code, tmp_path, after):
    """How long a program goes on after Ctrl-C, and what it says."""
    program = tmp_path / "program.py"
    program.write_text(textwrap.dedent(code))
    child = subprocess.Popen([sys.executable, program], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "started\n"
    time.sleep(after)
    began = time.perf_counter()
    child.send_signal(signal.SIGINT)
    said, _ = child.communicate(timeout=60)
    return time.perf_counter() - began, said


def test_ctrl_c_stops_a_call_of_many_designs(tmp_path):
    seconds, said = stopped(
        """
        import gearstudy as gs, numpy as np
        gear = lambda teeth: gs.GearSpecification(teeth=teeth, face_width=20e-3, bore_radius=10e-3)
        stiffness = gs.Stiffness(gs.Pair(module=3e-3, pinion=gear(24), gear=gear(36)))
        print("started", flush=True)
        try:
            gs.peak_to_peak(stiffness, np.linspace(1, 100, 10_000_000))
        except KeyboardInterrupt:
            print("interrupted")
        """,
        tmp_path,
        0.7,
    )
    # 0.1 s is what the call takes; the interpreter's own end comes on top.
    assert said == "interrupted\n" and seconds < 2.0


def test_ctrl_c_stops_a_study(tmp_path):
    seconds, said = stopped(
        f"""
        import gearstudy as gs
        print("started", flush=True)
        try:
            gs.run({str(ROOT / "studies" / "stability.yaml")!r})
        except KeyboardInterrupt:
            print("interrupted")
        """,
        tmp_path,
        0.5,
    )
    assert said == "interrupted\n" and seconds < 3.0
