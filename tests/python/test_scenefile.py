"""Scene files say the same as the Python objects, and say in one line what is wrong with them."""

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


@pytest.fixture
def job(tmp_path, monkeypatch):
    """Read a scene given as text, in an empty current directory."""
    monkeypatch.chdir(tmp_path)

    def read_text(text):
        content = text if isinstance(text, bytes) else text.encode()
        Path("scene.toml").write_bytes(content)
        return read("scene.toml")

    return read_text


@pytest.fixture
def refusal(job):
    """The one line in which a scene is refused."""

    def line(text):
        with pytest.raises(rb.InputError) as caught:
            job(text)
        assert len(str(caught.value).splitlines()) == 1
        return str(caught.value)

    return line


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


@pytest.mark.parametrize(
    ("text", "line"),
    [
        # unknown keys, with the nearest known one
        (
            SCENE.replace("length", "lenght"),
            "ribbon.lenght = 10.0: expected one of length, width, thickness, width_profile, "
            "thickness_profile; the nearest is length",
        ),
        (
            SCENE.replace("[growth]", "[grwoth]"),
            "grwoth = {'edge': 0.06}: expected one of ribbon, material, growth, start, end, gravity, weight, "
            "loads, law, solve, trace, sweep, output; the nearest is growth",
        ),
        (
            SCENE + '[end]\nkind = "free"\nforces = 1',
            "end.forces = 1: expected one of kind, force, moment; the nearest is force",
        ),
        (
            SCENE + '[[growth.profile]]\nname = "a"\n[[growth.profile]]\ngamma3 = 1',
            "growth.profile[1].gamma3 = 1: expected one of name, amplitude, breaks, spline, gamma33, d33, "
            "d22, d23, g21, g31, gamma22, gamma23; the nearest is gamma33",
        ),
        (
            SCENE + '[output]\n"sur\\nface" = 1',
            "output.'sur\\nface' = 1: expected one of figure, surface, data, diagram, table, branches, map, "
            "phases; the nearest is surface",
        ),
        (
            RIBBON + "[growth]\nedge = {S = [0, 1], value = [0, 1]}",
            "growth.edge.value = [0, 1]: expected one of S, values; the nearest is values",
        ),
        (
            RIBBON + "width_profile = {x = [0, 1], values = [0, 1]}\n" + GROWTH,
            "ribbon.width_profile.x = [0, 1]: expected one of S, values; the nearest is ",
        ),
        (
            RIBBON + '[growth]\ncsv = {file = "leaf.csv"}',
            "growth.csv.file = 'leaf.csv': expected one of path, name, width, breaks, spline; the nearest",
        ),
        # missing keys and tables
        ("", "ribbon is missing: expected a table"),
        (SCENE.replace("width = 1.0\n", ""), "ribbon.width is missing: expected a value"),
        (
            SCENE + "[start]\nposition = [0, 0, 0]",
            "start.kind is missing: expected one of clamped, free, pinned, hinged, sliding, closed",
        ),
        (SCENE + '[material]\nkind = "mooney-rivlin"\nc1 = 1', "material.c2 is missing: expected a value"),
        (SCENE + '[trace]\nparameter = "growth.edge.amplitude"', "trace.span is missing: expected a value"),
        (
            RIBBON + "[growth]\nthickness = {S = [0, 10], values = [0, 0.1], xi = 0.1}",
            "growth.thickness.S = [0, 10]: expected one of xi, transverse; the nearest is ",
        ),
        (RIBBON + "[growth]\ncsv = {}", "growth.csv.path is missing: expected a value"),
        (
            RIBBON + "[growth.profile]\ngamma33 = {x = [0, 1]}",
            "growth.profile[0].gamma33.values is missing: expected a value",
        ),
        (RIBBON + "[growth]", "growth = {}: expected at least one of edge, thickness, chiral, profile, csv"),
        (
            RIBBON + "[growth.profile]",
            "growth.profile = {}: expected at least one of gamma33, d33, d22, d23, g21, g31, gamma22, ",
        ),
        # wrong tables
        ("ribbon = 3\n" + GROWTH, "ribbon = 3: expected a table"),
        (
            SCENE.replace("[ribbon]", "[[ribbon]]"),
            "ribbon = [{'length': 10.0, 'thickness': 0.1, 'width': 1.0}]: ",
        ),
        (SCENE + "[[end]]", "end = [{}]: expected a table"),
        (SCENE + "profile = 1", "growth.profile[0] = 1: expected a table"),
        (SCENE + "[growth.edge]", "scene file = 'scene.toml': expected TOML, not: "),
        (
            SCENE + '[end]\nkind = "closed"',
            "end.kind = 'closed': expected one of clamped, free, pinned, hinged, sliding",
        ),
        (
            SCENE + "[material]\nkind = []",
            "material.kind = []: expected one of isotropic, mooney-rivlin, orthotropic",
        ),
        # values
        (SCENE.replace("10.0", '"10"'), "ribbon.length = '10': expected a positive finite number"),
        (SCENE.replace("10.0", "true"), "ribbon.length = True: expected a positive finite number"),
        (SCENE.replace("10.0", "nan"), "ribbon.length = nan: expected a positive finite number"),
        (SCENE.replace("10.0", "-inf"), "ribbon.length = -inf: expected a positive finite number"),
        (
            SCENE.replace("10.0", "1979-05-27"),
            "ribbon.length = datetime.date(1979, 5, 27): expected a positive",
        ),
        (SCENE.replace("0.1", "1.0"), "ribbon.thickness = 1.0: expected less than ribbon.width = 1.0"),
        (SCENE.replace("0.06", "inf"), "growth.edge = inf: expected a finite number"),
        (
            SCENE.replace("0.06", "0.7"),
            "growth.size = 0.7: expected at most 0.5, since the theory is for small",
        ),
        (SCENE + "thickness = [1]", "growth.thickness.xi = [1]: expected a finite number"),
        (
            RIBBON + "[growth]\nedge = {S = 1, values = 2}",
            "growth.edge.S = [1]: expected at least 2 samples",
        ),
        (
            RIBBON + "[growth]\nedge = {S = [0, 1, 0.5], values = [0, 1, 2]}",
            "growth.edge.S[2] = 0.5: expected ascending numbers, after 1.0",
        ),
        (
            RIBBON + "[growth]\nchiral = {S = [0, 1], values = [0, nan]}",
            "growth.chiral.values[1] = nan: expected a list of finite numbers",
        ),
        (
            RIBBON + "[growth.profile]\ngamma33 = {x = 0.1, values = 0.2}",
            "growth.profile.gamma33.x = [0.1]: expected at least 2 samples",
        ),
        (
            RIBBON + "[growth.profile]\ngamma33 = [[0], [1]]",
            "growth.profile.gamma33 = [[0], [1]]: expected one polynomial for each of the pieces that",
        ),
        (
            RIBBON + "[growth.profile]\ngamma33 = [0]\nbreaks = [0.6]",
            "growth.profile.breaks[0] = 0.6: expected a number inside (-1/2, 1/2)",
        ),
        (
            RIBBON + "[growth.profile]\ngamma33 = [0]\nspline = 1",
            "growth.profile.spline = 1: expected true or false",
        ),
        (
            RIBBON + "width_profile = {S = [0, 9], values = [1, 1]}\n" + GROWTH,
            "ribbon.width_profile = (0.0, 9.0): expected samples from S = 0 to S = 10.0",
        ),
        (
            RIBBON + "width_profile = 2\n" + GROWTH,
            "ribbon.width_profile = 2: expected samples (S, values) or a function of S",
        ),
        (
            RIBBON + '[growth]\ncsv = "none.csv"',
            "growth.csv = 'none.csv': expected a readable file, not: No such file or directory",
        ),
        (RIBBON + "[growth]\ncsv = 3", "growth.csv = 3: expected the name of a file"),
        (
            SCENE + '[growth.profile]\nname = "edge"\nd33 = [1]',
            "growth.name = 'edge': expected a different name for each growth of a sum",
        ),
        (
            SCENE + '[material]\nkind = "isotropic"\nnu = 0.6',
            "material.nu = 0.6: expected a number in (-1, 0.5]",
        ),
        ('law = "Full"\n' + SCENE, "law = 'Full': expected one of full, quadratic, linear"),
        # ends know which they are
        (
            SCENE + '[start]\nkind = "clamped"\nrotation = [1, 1, 0, 0]',
            "start.rotation = [1, 1, 0, 0]: expected a unit quaternion, scalar first, or",
        ),
        (
            SCENE + '[end]\nkind = "free"\nforce = [0, nan, 0]',
            "end.force[1] = nan: expected a finite number",
        ),
        (
            SCENE + '[end]\nkind = "hinged"\ndirector = 4',
            "end.director = 4: expected a whole number from 1 to 3",
        ),
        (
            SCENE + '[end]\nkind = "sliding"\naxis = [0, 0, 0]',
            "end.axis = [0, 0, 0]: expected a direction",
        ),
        (
            SCENE + '[start]\nkind = "closed"\nlink = 0.25',
            "start.link = 0.25: expected a multiple of 1/2",
        ),
        (
            SCENE + '[start]\nkind = "closed"\n[end]\nkind = "clamped"',
            "end = Clamped(position=None, rotation=None, twist_turns=0.0): expected nothing: a closed ribbon",
        ),
        (
            SCENE + '[end]\nkind = "pinned"\nposition = [0, 0, 12]',
            "end.position = (0.0, 0.0, 12.0): expected at most 11.2 from the start, which is as far as the",
        ),
        (SCENE + '[start]\nkind = "free"', "start = Free("),
        # loads
        (SCENE + "[[loads]]", "loads[0].kind is missing: expected one of point, line"),
        (SCENE + '[loads]\nkind = "edge"', "loads[0].kind = 'edge': expected one of point, line"),
        ("loads = 3\n" + SCENE, "loads[0] = 3: expected a table"),
        (SCENE + '[[loads]]\nkind = "point"', "loads[0].S is missing: expected a value"),
        (
            SCENE + '[[loads]]\nkind = "line"\n[[loads]]\nkind = "point"\nforces = 1',
            "loads[1].forces = 1: expected one of kind, S, force, moment; the nearest is force",
        ),
        (
            SCENE + '[[loads]]\nkind = "point"\nS = 10.0',
            "loads[0].S = 10.0: expected a number inside (0, 10); the ends take Free(force=, moment=)",
        ),
        (
            SCENE + '[[loads]]\nkind = "point"\nS = 1\nforce = [0, nan, 0]',
            "loads[0].force[1] = nan: expected a finite number",
        ),
        (
            SCENE + '[[loads]]\nkind = "line"\nforce = {S = [0, 10], values = [0, 1]}',
            "loads[0].force.values.shape = (2,): expected samples (S, values), S a list (m,) of numbers and",
        ),
        (
            SCENE + '[[loads]]\nkind = "line"\nforce = {S = [0, 9], values = [[0, 0, 1], [0, 0, 2]]}',
            "loads[0].force = (0.0, 9.0): expected samples from S = 0 to S = 10.0",
        ),
        (
            SCENE + '[[loads]]\nkind = "line"\nforce = {x = [0, 9], values = [1, 2]}',
            "loads[0].force.x = [0, 9]: expected one of S, values; the nearest is ",
        ),
        ("gravity = 9.81\n" + SCENE, "gravity = 9.81: expected three finite numbers"),
        ("gravity = [0, 0, inf]\n" + SCENE, "gravity[2] = inf: expected a finite number"),
        (
            "gravity = [0, 0, 1]\n" + SCENE + "[weight]\ndensity = 1\ng = [0, 0, 1]",
            "gravity = [0, 0, 1]: expected none beside the table [weight]",
        ),
        (SCENE + "[weight]\ndensity = 1", "weight.g is missing: expected a value"),
        (
            SCENE + "[weight]\ndensity = 0\ng = [0, 0, 1]",
            "weight.density = 0: expected a positive finite number",
        ),
        # laws and settings
        (RIBBON + "[law]\nEA = 1\nEI1 = 1\nEI2 = 1", "law.GJ is missing: expected a value"),
        (RIBBON + "[law]\nEI1 = 1\nEI2 = 1\nGJ = 1", "law.EA is missing: expected the stiffness in"),
        (
            RIBBON + "[law]\nEI = 1\nEI2 = 1\nGJ = 1",
            "law.EI = 1: expected one of EA, EI1, EI2, GJ, inextensible, intrinsic; the nearest is EI",
        ),
        (
            SCENE + "[law]\nEA = 1\nEI1 = 1\nEI2 = 1\nGJ = 1",
            "growth = Growth(terms=(Term(name='edge'",
        ),
        (SCENE + "[solve]\ntol = 1", "solve.tol = 1: expected a number in [1e-14, 1)"),
        (SCENE + "[solve]\ndegree = 9", "solve.degree = 9: expected a whole number from 1 to 8"),
        (SCENE + "[solve]\nn = 9", "solve.n = 9: expected one of tol, degree; the nearest is "),
        # trace
        (SCENE + "[trace]\nparameter = 1\nspan = [0, 1]", "trace.parameter = 1: expected a name, such as"),
        (
            SCENE + '[trace]\nparameter = "a"\nspan = [0, 1, 2]',
            "trace.span = [0, 1, 2]: expected two finite numbers, the lower one first",
        ),
        (
            SCENE + '[trace]\nparameter = "a"\nspan = [0, nan]',
            "trace.span[1] = nan: expected a finite number",
        ),
        (
            SCENE + '[trace]\nparameter = "a"\nspan = [1, 0]',
            "trace.span = [1, 0]: expected two finite numbers, the lower one first",
        ),
        (
            SCENE + '[trace]\nparameter = "growth.edge.amplitud"\nspan = [0, 1]',
            "trace.parameter = 'growth.edge.amplitud': expected a name that parameters(scene) lists; the "
            "nearest is growth.edge.amplitude",
        ),
        (
            SCENE + '[trace]\nparameter = "ribbon.length"\nspan = [5, 9]\nvalues = [6, 10]',
            "trace.values[1] = 10.0: expected a number in the span, from 5 to 9",
        ),
        (
            SCENE + '[trace]\nparameter = "ribbon.length"\nspan = [5, 9]\nquantity = "k2"',
            "trace.quantity = 'k2': expected one of eps, K1, K2, K3, energy, load_potential, ",
        ),
        (
            SCENE + '[output]\ntable = "a.csv"',
            "trace is missing: expected a table, of which output.table asks for a file",
        ),
        # outputs
        (SCENE + "[output]\nfigure = 3", "output.figure = 3: expected a file name"),
        (SCENE + '[output]\nfigure = "a\\u0000.png"', "output.figure = 'a\\x00.png': expected a file name"),
        (
            SCENE + '[output]\nfigure = "a.vtp"',
            "output.figure = 'a.vtp': expected a file name ending in .png or .pdf or .svg",
        ),
        (
            SCENE + '[output]\nsurface = "a"',
            "output.surface = 'a': expected a file name ending in .vtp or .obj",
        ),
        (
            SCENE + '[output]\ndata = "no/such/a.npz"',
            "output.data = 'no/such/a.npz': expected a file in a directory that exists",
        ),
        (
            SCENE + '[output]\nsurface = ["a.vtp", "./a.vtp"]',
            "output.surface[1] = './a.vtp': expected a different file for each output",
        ),
        # broken TOML, with its place
        (
            "[ribbon]\nlength = = 3",
            "scene file = 'scene.toml': expected TOML, not: Invalid value (at line 2, column 10)",
        ),
        ("[ribbon", "scene file = 'scene.toml': expected TOML, not: "),
        ("a = " + "[" * 20000, "scene file = 'scene.toml': expected "),
        (b"a = '\xff'", "scene file = 'scene.toml': expected UTF-8 text, unlike byte 5"),
    ],
)
def test_one_line_says_what_is_wrong(refusal, text, line):
    assert refusal(text).startswith(line)


def test_huge_values_make_short_lines(refusal):
    assert len(refusal(SCENE.replace("10.0", "0x" + "f" * 9000))) < 200
    assert len(refusal(SCENE.replace("10.0", "1" * 9000))) < 200
    assert len(refusal(SCENE.replace("10.0", "'" + "x" * 9000 + "'"))) < 200
    assert len(refusal(SCENE.replace("10.0", "[" + "1," * 9000 + "]"))) < 200
    assert len(refusal(SCENE + "edge" + ".a" * 9000 + " = 1")) < 200


def test_directory_in_the_place_of_an_output(refusal, tmp_path):
    (tmp_path / "a.png").mkdir()
    line = refusal(SCENE + '[output]\nfigure = "a.png"')
    assert line == "output.figure = 'a.png': expected a file, not a directory"


def test_files_that_cannot_be_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, reason in (("none.toml", "No such file or directory"), (".", "Is a directory")):
        with pytest.raises(rb.InputError) as caught:
            read(name)
        assert str(caught.value) == f"scene file = '{name}': expected a readable file, not: {reason}"


def test_growth_at_the_limit_of_the_theory_warns(job):
    with pytest.warns(rb.RibbonWarning):
        size = job(SCENE.replace("0.06", "0.5")).scene.growth.size(0.1)
    assert math.isclose(size, 0.5)
