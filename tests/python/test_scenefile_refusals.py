"""Scene files say in one line what is wrong with them."""

import pytest
import ribbonrs as rb
from ribbonrs.scenefile import read

RIBBON = "[ribbon]\nlength = 10.0\nwidth = 1.0\nthickness = 0.1\n"
GROWTH = "[growth]\nedge = 0.06\n"
SCENE = RIBBON + GROWTH
LEAF = "x, g33\n-0.5, 0.01\n0.5, 0.02\n"


@pytest.fixture
def refusal(job):
    """The one line in which a scene is refused."""

    def line(text):
        with pytest.raises(rb.InputError) as caught:
            job(text)
        assert len(str(caught.value).splitlines()) == 1
        return str(caught.value)

    return line


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
            SCENE + '[start]\nkind = "closed"\n[end]\nkind = "free"',
            "end.kind = 'free': expected no table [end]: a closed ribbon has no ends",
        ),
        (
            SCENE + '[[growth.profile]]\nname = "a"\ngamma33 = [0.1]\n[[growth.profile]]\ngamma33 = ["b"]',
            "growth.profile[1].gamma33[0] = 'b': expected a finite number",
        ),
        (
            SCENE + '[[growth.profile]]\ngamma33 = ["b"]',
            "growth.profile.gamma33[0] = 'b': expected a finite number",
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
            "end.kind = 'clamped': expected no table [end]: a closed ribbon has no ends",
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


def test_measurements_are_not_overwritten(refusal, tmp_path):
    measured = "x,gamma33\n-0.5,0.02\n0.0,0.0\n0.5,0.02\n"
    (tmp_path / "leaf.csv").write_text(measured)
    (tmp_path / "here").symlink_to(tmp_path)
    asked = RIBBON + '[growth]\ncsv = { path = "leaf.csv", width = 1.0 }\n'
    asked += '[trace]\nparameter = "ribbon.thickness"\nspan = [0.05, 0.1]\n[output]\n'
    for name in ("leaf.csv", "./leaf.csv", "here/leaf.csv"):
        line = refusal(asked + f'table = "{name}"')
        assert line.startswith(f"output.table = '{name}': expected a file that the scene does not read")
    line = refusal(asked + 'table = ["new.csv", "here/new.csv"]')
    assert line.startswith("output.table[1] = 'here/new.csv': expected a different file for each output")
    assert (tmp_path / "leaf.csv").read_text() == measured


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
