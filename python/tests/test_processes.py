"""Threads, processes, pickles, memory: what surrounds the calls."""

import copy
import multiprocessing
import pickle
import resource
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest

import gearstudy as gs
from conftest import ROOT


def value(stiffness, torque):
    relief = gs.TipRelief(gear="both", amount=np.linspace(1e-6, 20e-6, 200), fraction=0.8)
    return gs.peak_to_peak(stiffness, torque, relief, threads=2)


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_processes(stiffness, method):
    # What a fork leaves behind is all there when it forks.
    expected = [value(stiffness, torque) for torque in (40.0, 80.0)]
    context = multiprocessing.get_context(method)
    with context.Pool(2) as pool:
        found = pool.starmap(value, [(stiffness, 40.0), (stiffness, 80.0)])
    assert all((one == other).all() for one, other in zip(found, expected))


def test_a_study_runs_in_a_forked_child(quick, tmp_path):
    context = multiprocessing.get_context("fork")
    child = context.Process(target=quick.run, kwargs={"force": True})
    child.start()
    child.join(120)
    assert child.exitcode == 0


def test_pickles_and_copies(pair, stiffness, relief):
    for whole in (pair, stiffness, relief, gs.Design(pair, [relief]), gs.FiniteElement(elements_across=8)):
        again = pickle.loads(pickle.dumps(whole))
        assert type(again) is type(whole) and repr(again).split(" ")[0] == repr(whole).split(" ")[0]
    other = copy.deepcopy(stiffness)
    assert gs.peak_to_peak(other, 80.0, relief) == gs.peak_to_peak(stiffness, 80.0, relief)
    error = pickle.loads(pickle.dumps(gs.InvalidStudy("wrong", help="so", file="a.yaml", line=3, column=4)))
    assert str(error) == "a.yaml:3:4: wrong; so" and error.line == 3


def test_threads_share_a_stiffness(stiffness):
    expected = gs.peak_to_peak(stiffness, 80.0)
    found, wrong = [], []

    def call(positions):
        try:
            found.append(gs.transmission_error(stiffness, 80.0, positions=positions).peak_to_peak)
        except Exception as error:  # noqa: BLE001
            wrong.append(error)

    threads = [threading.Thread(target=call, args=(64 + index,)) for index in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong and found == pytest.approx([expected] * 16, rel=1e-9)


def test_a_search_is_one_threads():
    search = gs.Optimizer("genetic", [(0.0, 1.0)])
    with pytest.raises((gs.InvalidInput, RecursionError, TypeError)):
        pickle.dumps(search)


def test_many_calls_take_no_more_memory(stiffness):
    """A tenth of a million calls of each kind; a leak of 100 bytes each would be 10 MB. `make bench` makes a million."""
    relief = gs.TipRelief(gear="both", amount=12e-6, fraction=0.8)

    def calls(count):
        for _ in range(count):
            gs.peak_to_peak(stiffness, 80.0, relief, positions=8)
            try:
                gs.peak_to_peak(stiffness, -1.0)
            except gs.InvalidInput:
                pass

    calls(2_000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    calls(10_000)
    curve = gs.transmission_error(stiffness, 80.0, relief)
    for _ in range(100_000):
        curve.transmission_error  # noqa: B018
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 4_000


def test_the_interpreter_may_end_while_something_runs(tmp_path):
    code = """
        import threading, gearstudy as gs, numpy as np
        gear = lambda teeth: gs.GearSpecification(teeth=teeth, face_width=20e-3, bore_radius=10e-3)
        stiffness = gs.Stiffness(gs.Pair(module=3e-3, pinion=gear(24), gear=gear(36)))
        work = lambda: gs.peak_to_peak(stiffness, np.linspace(1, 100, 1_000_000), threads=2)
        threading.Thread(target=work, daemon=True).start()
        import time; time.sleep(0.3)
    """
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0 and "panic" not in ended.stderr, ended.stderr


def test_nothing_but_numpy_is_imported(tmp_path):
    code = """
        import sys
        before = set(sys.modules)
        import gearstudy as gs
        print(gs.minimize(lambda point: point[0], [(0.0, 1.0)], method="grid").value)
        print(*{name.split(".")[0] for name in set(sys.modules) - before})
    """
    said = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, check=True).stdout
    foreign = {name for name in said.split("\n")[1].split() if name not in sys.stdlib_module_names}
    assert foreign <= {"gearstudy", "numpy"}, foreign


@pytest.mark.parametrize("work", ["time.sleep(0.05)", "None", "threading.Event().wait(0.01)"])
def test_the_interpreter_may_end_while_a_run_calls_back(tmp_path, work):
    code = f"""
        import threading, time, gearstudy as gs
        words = dict(force=True, results="results", cache="cache", progress=lambda event: {work})
        threading.Thread(target=lambda: gs.run({str(ROOT / "studies" / "quick.yaml")!r}, **words), daemon=True).start()
        time.sleep(0.1)
    """
    for _ in range(3):
        words = [sys.executable, "-c", textwrap.dedent(code)]
        ended = subprocess.run(words, capture_output=True, text=True, timeout=60, cwd=tmp_path)
        assert ended.returncode == 0 and "panic" not in ended.stderr, ended.stderr


def test_waiting_for_another_run_is_interrupted(tmp_path):
    code = f"""
        import os, signal, subprocess, sys, threading, time, gearstudy as gs
        study = {str(ROOT / "studies" / "quick.yaml")!r}
        words = dict(force=True, results="results")
        if len(sys.argv) > 1:
            def slow(event):
                if event["event"] == "writing":
                    print("writing", flush=True)
                    time.sleep(8)
            gs.run(study, cache="other", progress=slow, **words)
        else:
            other = subprocess.Popen([sys.executable, __file__, "other"], stdout=subprocess.PIPE, text=True)
            other.stdout.readline()
            sent = []
            def send():
                sent.append(time.perf_counter())
                os.kill(os.getpid(), signal.SIGINT)
            threading.Timer(1.5, send).start()
            try:
                gs.run(study, cache="cache", **words)
            except KeyboardInterrupt:
                print(time.perf_counter() - sent[0])
            other.kill()
    """
    program = tmp_path / "program.py"
    program.write_text(textwrap.dedent(code))
    ended = subprocess.run([sys.executable, program], capture_output=True, text=True, timeout=60, cwd=tmp_path)
    assert ended.returncode == 0 and float(ended.stdout) < 1.0, ended


def test_an_interrupted_run_is_left_to_its_end_and_run_again(tmp_path):
    """Ctrl-C at several moments is heard at once; the next run waits for what is left, takes it over, and gives the same bytes."""
    code = f"""
        import os, signal, sys, threading, time, gearstudy as gs
        study = {str(ROOT / "studies" / "methods.yaml")!r}
        for seconds in (0.05, 0.3, 0.9, 1.5):
            sent = []
            def send():
                sent.append(time.perf_counter())
                os.kill(os.getpid(), signal.SIGINT)
            timer = threading.Timer(seconds, send)
            timer.start()
            try:
                gs.run(study, results="results", cache="cache")
                timer.cancel()
            except KeyboardInterrupt:
                print(time.perf_counter() - sent[0])
        gs.run(study, results="results", cache="cache")
        gs.run(study, results="whole", cache="other")
        try:
            gs.run(study, results="left", cache="third", progress=lambda event: os.kill(os.getpid(), signal.SIGINT))
        except KeyboardInterrupt:
            print("0 at the end")
    """
    words = [sys.executable, "-c", textwrap.dedent(code)]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=120, cwd=tmp_path)
    assert ended.returncode == 0 and ended.stdout.endswith("0 at the end\n"), ended
    # A thirtieth of it when the machine is quiet.
    assert all(float(line.split()[0]) < 0.8 for line in ended.stdout.splitlines()), ended.stdout

    def files(folder):
        found = (tmp_path / folder / "methods").rglob("*.parquet")
        # What a computation took is never the same.
        return {file.name: file.read_bytes() for file in found if ".cost." not in file.name}

    assert files("results") == files("whole") and len(files("whole")) > 10


def test_a_fork_in_a_callback_ends(tmp_path):
    code = f"""
        import os, gearstudy as gs
        children = []
        def fork(event):
            if not children:
                child = os.fork()
                if child:
                    children.append(child)
        gs.run({str(ROOT / "studies" / "quick.yaml")!r}, results="results", cache="cache", progress=fork)
        print(os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]))
    """
    words = [sys.executable, "-c", textwrap.dedent(code)]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=60, cwd=tmp_path)
    assert ended.returncode == 0 and ended.stdout == "1\n" and "cannot go on with the run" in ended.stderr, ended


def test_long_calls_are_interrupted(tmp_path):
    code = """
        import gearstudy as gs, signal, sys, threading, time, os
        gear = lambda teeth: gs.GearSpecification(teeth=teeth, face_width=20e-3, bore_radius=10e-3)
        pair = gs.Pair(module=3e-3, pinion=gear(24), gear=gear(36))
        stiffness = gs.Stiffness(pair)
        crown = gs.LeadCrowning(gear="pinion", amount=8e-6)
        calls = [
            lambda: gs.transmission_error(stiffness, 80.0, crown, positions=100_000, slices=10_000),
            lambda: gs.peak_to_peak(stiffness, 80.0, crown, positions=20_000, slices=200, slice_coupling="plate"),
            lambda: gs.peak_to_peak(stiffness, [80.0] * 64, crown, positions=100_000, slices=1001),
            lambda: gs.peak_to_peak(stiffness, [80.0] * 64, crown, positions=100_000, slices=1001, threads=2),
            lambda: gs.Stiffness(pair, method=gs.FiniteElement(elements_across=64)),
        ]
        sent = []
        def send():
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)
        for call in calls:
            timer = threading.Timer(0.1, send)
            timer.start()
            try:
                call()
                timer.cancel()
            except KeyboardInterrupt:
                print(time.perf_counter() - sent[-1])
        sys.stdout.flush()
        os._exit(0)
    """
    words = [sys.executable, "-c", textwrap.dedent(code)]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=120, cwd=tmp_path)
    waits = ended.stdout.split()
    # One may end before the signal comes, on a quick machine; 0.1 s is asked for, of a machine that is idle.
    assert ended.returncode == 0 and len(waits) >= 4, ended.stderr
    assert all(float(wait) < 1.0 for wait in waits), waits
