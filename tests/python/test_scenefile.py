"""Scene files say the same as the Python objects."""

import math
from pathlib import Path

import pytest
import ribbonrs as rb
from ribbonrs import growthtable, scenefile
from ribbonrs.scenefile import read

EXAMPLES = Path(__file__).parents[2] / "examples"

RIBBON = "[ribbon]\nlength = 10.0\nwidth = 1.0\nthickness = 0.1\n"
GROWTH = "[growth]\nedge = 0.06\n"
SCENE = RIBBON + GROWTH
LEAF = "x, g33\n-0.5, 0.01\n0.5, 0.02\n"


def test_example_equals_its_python_objects(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    job = read(EXAMPLES / "helical_leaf.toml")
    leaf = rb.Ribbon(length=30.0, width=1.0, thickness=0.1)
    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04)
    assert job.scene == rb.Scene(leaf, growth, start=rb.Clamped(), end=rb.Free())
    assert [(output.field, str(output.path)) for output in job.outputs] == [
        ("output.figure", "helical_leaf.png"),
        ("output.surface", "helical_leaf.vtp"),
        ("output.data", "helical_leaf.npz"),
    ]
    assert (job.trace.parameter, job.trace.span) == ("growth.edge.amplitude", (0.0, 0.08))
    assert (job.trace.options, job.trace.quantity, job.traced) == ({}, "K3", ())


def test_documented_file_has_every_key_and_is_read(job):
    text = (EXAMPLES.parent / "docs" / "scene-files.md").read_text()
    block = text.split("```toml\n")[1].split("```")[0]
    page = (EXAMPLES.parent / "docs" / "growth.md").read_text()
    Path("leaf.csv").write_text(page.split("```csv\n")[1].split("```")[0])
    read = job(block)
    names = ["edge", "thickness", "chiral", "vein", "station0_measured", "station1_measured"]
    assert [term.name for term in read.scene.growth.terms] == names
    assert len(read.outputs) == 4
    assert [output.kind for output in read.traced] == ["diagram", "table", "branches"]
    assert read.trace.options == {"values": (0.05,), "depth": 2, "max_steps": 1000}
    known = [*vars(scenefile).values(), *vars(growthtable).values()]
    tables = [name for name in known if isinstance(name, type) and hasattr(name, "model_fields")]
    for key in {key for table in tables for key in table.model_fields}:
        assert key in text
    other = job(RIBBON + text.split("```toml\n")[2].split("```")[0]).scene
    assert other.gravity == rb.weight(other.ribbon, 1000.0, (0.0, 0.0, -9.81))
    assert other.law == rb.LinearLaw(EA=1.0, EI1=0.0833, EI2=8.33e-4, GJ=1.11e-3, intrinsic=(0, 0, 0.1, 0))


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_name_their_outputs_after_themselves(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    job = read(path)
    assert job.outputs
    assert {output.path.stem for output in job.outputs} == {path.stem}
    # a picture of branches or phases would have the name of the figure
    drawn = {output.path.stem for output in (*job.traced, *job.swept)}
    assert drawn <= {f"{path.stem}_diagram", f"{path.stem}_map"}


def test_tables_left_out_have_the_defaults_of_python(job):
    read = job(SCENE)
    assert read.scene == rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.06))
    assert read.outputs == ()
    assert read.options == {}
    assert read.trace is None


def test_every_growth(job):
    text = """
    edge = 0.01
    thickness = { xi = 0.02, transverse = -0.01 }
    chiral = 0.03
    [[growth.profile]]
    gamma33 = [0.0, 0.01]
    g21 = [0, 1e-3]
    [[growth.profile]]
    name = "vein"
    amplitude = 0.5
    gamma22 = [0.01]
    """
    growth = rb.growth.edge(0.01) + rb.growth.thickness(0.02, transverse=-0.01) + rb.growth.chiral(0.03)
    growth += rb.growth.Profile(gamma33=[0.0, 0.01], g21=[0.0, 1e-3])
    growth += rb.growth.Profile(gamma22=[0.01], amplitude=0.5, name="vein")
    assert job(RIBBON + "[growth]" + text).scene.growth == growth


def test_growth_that_varies_along_the_ribbon(job):
    text = """
    edge = {S = [0, 10], values = [0.01, 0.05]}
    thickness = {xi = {S = [0, 5, 5, 10], values = [0, 0, 0.1, 0.1]}, transverse = -0.02}
    chiral = {S = [0, 10], values = [0, 0.03]}
    [growth.profile]
    amplitude = {S = [0, 10], values = [1, 2]}
    gamma33 = [0.0, 0.01]
    """
    growth = rb.growth.edge(([0, 10], [0.01, 0.05]))
    growth += rb.growth.thickness(([0, 5, 5, 10], [0, 0, 0.1, 0.1]), transverse=-0.02)
    growth += rb.growth.chiral(([0, 10], [0, 0.03]))
    growth += rb.growth.Profile(gamma33=[0.0, 0.01], amplitude=([0, 10], [1, 2]))
    assert job(RIBBON + "[growth]" + text).scene.growth == growth


def test_growth_in_pieces_and_samples(job):
    text = """
    [growth.profile]
    breaks = [0.1]
    spline = true
    gamma33 = [[0.0], [0.02, 0.1]]
    d22 = {x = [-0.5, -0.3, -0.1, 0.1, 0.1, 0.2, 0.3, 0.5], values = [0, 0.1, 0, 0.2, 0.3, 0, 0.1, 0]}
    """
    x = [-0.5, -0.3, -0.1, 0.1, 0.1, 0.2, 0.3, 0.5]
    growth = rb.growth.Profile(
        gamma33=[[0.0], [0.02, 0.1]],
        d22=(x, [0, 0.1, 0, 0.2, 0.3, 0, 0.1, 0]),
        breaks=[0.1],
        spline=True,
    )
    assert job(RIBBON + "[growth]" + text).scene.growth == growth


def test_growth_from_a_table_beside_the_scene(tmp_path, monkeypatch):
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "leaf.csv").write_text(LEAF)
    scene = tmp_path / "scenes" / "leaf.toml"
    monkeypatch.chdir(tmp_path)
    growth = rb.growth.from_csv("scenes/leaf.csv")
    for text in ('csv = "leaf.csv"', 'csv = { path = "leaf.csv" }'):
        scene.write_text(RIBBON + "[growth]\n" + text)
        assert read(scene).scene.growth == growth
        assert read("scenes/leaf.toml").scene.growth == growth
    scene.write_text(RIBBON + '[growth]\ncsv = { path = "leaf.csv", name = "leaf", width = 2, breaks = [0] }')
    with pytest.raises(rb.InputError) as caught:
        read(scene)
    assert str(caught.value).startswith("growth.csv, gamma33.x")


def test_dimensions_along_the_ribbon(job):
    text = "width_profile = {S = [0, 10], values = [1, 0.5]}\n"
    text += "thickness_profile = {S = [0, 10], values = [1, 0.8]}\n"
    ribbon = rb.Ribbon(
        10.0, 1.0, 0.1, width_profile=([0, 10], [1, 0.5]), thickness_profile=([0, 10], [1, 0.8])
    )
    assert job(RIBBON + text + GROWTH).scene.ribbon == ribbon


def test_short_forms_of_growth(job):
    assert job(RIBBON + "[growth]\nthickness = 0.02").scene.growth == rb.growth.thickness(0.02)
    samples = "{S = [0, 10], values = [0, 0.1]}"
    along = rb.growth.thickness(([0, 10], [0, 0.1]))
    assert job(RIBBON + f"[growth]\nthickness = {samples}").scene.growth == along
    assert job(RIBBON + "[growth.profile]\nd22 = [0.1]").scene.growth == rb.growth.Profile(d22=[0.1])


@pytest.mark.parametrize(
    ("text", "material"),
    [
        ('kind = "isotropic"', rb.Isotropic()),
        ('kind = "isotropic"\nY = 2\nnu = 0.3', rb.Isotropic(2.0, 0.3)),
        ('kind = "mooney-rivlin"\nc1 = 1\nc2 = 0.5', rb.MooneyRivlin(1.0, 0.5)),
        ('kind = "orthotropic"\nQ33 = 3\nQ22 = 2\nQ23 = 1\nG = 0.5', rb.Orthotropic(3.0, 2.0, 1.0, 0.5)),
    ],
)
def test_materials(job, text, material):
    assert job(SCENE + "[material]\n" + text).scene.ribbon.material == material


def test_start_end_and_law(job):
    text = 'law = "quadratic"\n' + SCENE + '[start]\nkind = "clamped"\nposition = [1, 2, 3]\n'
    text += 'rotation = [0.0, 0.6, 0.0, 0.8]\ntwist_turns = 0.5\n[end]\nkind = "free"\nforce = [0, 0, 0]\n'
    scene = job(text).scene
    assert scene.start == rb.Clamped((1.0, 2.0, 3.0), (0.0, 0.6, 0.0, 0.8), 0.5)
    assert scene.end == rb.Free()
    assert scene.law == "quadratic"


@pytest.mark.parametrize(
    ("text", "end"),
    [
        ('kind = "clamped"\ntwist_turns = 2', rb.Clamped(twist_turns=2.0)),
        ('kind = "free"\nforce = [0, 0, -1e-5]', rb.Free(force=(0, 0, -1e-5))),
        ('kind = "pinned"\nposition = [0, 0, 9]\nmoment = [0, 1, 0]', rb.Pinned((0, 0, 9), (0, 1, 0))),
        ('kind = "hinged"\ndirector = 1\nposition = [0, 0, 9]\nmoment = 2', rb.Hinged(1, (0, 0, 9), 2)),
        (
            'kind = "sliding"\naxis = [1, 0, 1]\nrotation = [0, 1, 0]\ntwist_turns = 1\nforce = 2',
            rb.Sliding((1, 0, 1), (0, 1, 0), 1, 2),
        ),
    ],
)
def test_ends(job, text, end):
    assert job(SCENE + "[end]\n" + text).scene.end == end
    held = (
        SCENE
        + '[end]\nkind = "clamped"\nposition = [0, 0, 5]\n[start]\n'
        + text.replace("[0, 0, 9]", "[0, 0, 1]")
    )
    start = job(held).scene.start
    assert type(start) is type(end)


def test_closed(job):
    assert job(SCENE + '[start]\nkind = "closed"\nlink = 1.5').scene.start == rb.Closed(1.5)


def test_loads_gravity_law_and_settings(job):
    text = """
    [[loads]]
    kind = "point"
    S = 2
    force = [1, 2, 3]
    [[loads]]
    kind = "line"
    force = [0, 0, 1]
    moment = {S = [0, 5, 5, 10], values = [[0, 0, 0], [1, 2, 3], [0, 0, 0], [0, 0, 1]]}
    [solve]
    tol = 1e-8
    degree = 3
    """
    read = job("gravity = [0, 0, -1]\n" + 'law = "linear"\n' + SCENE + text)
    moment = ([0, 5, 5, 10], [[0, 0, 0], [1, 2, 3], [0, 0, 0], [0, 0, 1]])
    loads = (rb.PointLoad(2.0, (1, 2, 3)), rb.LineLoad((0, 0, 1), moment))
    assert read.scene == rb.Scene(
        rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.06), gravity=(0, 0, -1), loads=loads, law="linear"
    )
    assert read.options == {"tol": 1e-8, "degree": 3}
    single = job(SCENE + '[loads]\nkind = "point"\nS = 2').scene
    assert single.loads == (rb.PointLoad(2.0),)


def test_no_growth(job):
    assert job(RIBBON).scene == rb.Scene(rb.Ribbon(10.0, 1.0, 0.1))


def test_a_rod(job):
    text = "[law]\nEI1 = inf\nEI2 = 2\nGJ = 1\ninextensible = true\nintrinsic = [0, 0, 1, 0]"
    law = rb.LinearLaw(EI1=math.inf, EI2=2, GJ=1, inextensible=True, intrinsic=(0, 0, 1, 0))
    assert job(RIBBON + text).scene.law == law


def test_windows_text(job):
    assert job(b"\xef\xbb\xbf" + SCENE.replace("\n", "\r\n").encode()).scene == job(SCENE).scene


def test_growth_at_the_limit_of_the_theory_warns(job):
    with pytest.warns(rb.RibbonWarning):
        size = job(SCENE.replace("0.06", "0.5")).scene.growth.size(0.1)
    assert math.isclose(size, 0.5)
