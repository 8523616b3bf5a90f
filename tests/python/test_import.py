"""`import ribbonrs` is quick and loads nothing that only figures, files or the command line need."""

import subprocess
import sys

HEAVY = ("matplotlib", "pydantic", "rich", "scipy", "tomllib", "argparse")

TIMED = """
import sys, time
import numpy
start = time.perf_counter()
import ribbonrs
print(time.perf_counter() - start)
"""


def run(program):
    """What a fresh interpreter prints."""
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout


def test_import_leaves_heavy_packages_alone():
    loaded = run("import ribbonrs, sys; print(*sys.modules)").split()
    assert "ribbonrs._core" in loaded
    assert not set(HEAVY) & set(loaded)


def test_import_costs_at_most_60_ms_beyond_numpy():
    # The quickest run is the cost; the others show what else the machine was doing.
    assert any(float(run(TIMED)) <= 0.060 for _ in range(20))


def test_solving_and_tracing_need_no_tables_files_or_functions_of_s():
    program = """
import numpy, sys
known = set(sys.modules)
import ribbonrs as rb
scene = rb.Scene(rb.Ribbon(10, 1, 0.1), rb.growth.edge(0.06), end=rb.Free(force=(1e-5, 0, 0)))
rb.trace(scene, "growth.edge.amplitude", (0.0, 0.02), start=None).branches[0].state(-1).position
print(*(set(sys.modules) - known))
"""
    assert not {"csv", "difflib", "json", "numpy.polynomial", "tempfile"} & set(run(program).split())


def test_solving_and_saving_data_needs_no_heavy_package(tmp_path):
    program = f"""
import sys, ribbonrs as rb
state = rb.solve(rb.Scene(rb.Ribbon(10, 1, 0.1), rb.growth.edge(0.06)))
state.save({str(tmp_path / "a.vtp")!r})
state.save({str(tmp_path / "a.npz")!r})
print(*sys.modules)
"""
    loaded = run(program).split()
    assert not {"matplotlib", "pydantic", "rich"} & set(loaded)


def test_every_public_name_is_there():
    program = """
import ribbonrs
for name in ribbonrs.__all__:
    assert getattr(ribbonrs, name).__doc__, name
"""
    run(program)
