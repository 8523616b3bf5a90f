"""Growth at stations, and from tables of comma-separated values."""

import contextlib
import math
from pathlib import Path

import numpy as np
import pytest
import ribbonrs as rb
from hypothesis import given
from hypothesis import strategies as st
from refusal import refuses
from scipy.interpolate import CubicSpline

EPS = np.finfo(float).eps

X = np.linspace(-0.5, 0.5, 41)


# stations


def test_stations_pass_over_linearly():
    places = [0.0, 2.0, 3.0, 10.0]
    edges = [0.02, 0.06, -0.01, 0.05]
    growth = rb.growth.stations(places, [rb.growth.edge(xi) for xi in edges])
    S = np.linspace(0.0, 10.0, 301)
    assert growth.values(0.5, S)["gamma33"] == pytest.approx(np.interp(S, places, edges), abs=1e-16)
    assert growth.values(0.5, places)["gamma33"].tolist() == edges
    assert growth.domain == (0.0, 10.0)


def test_stations_pass_over_by_splines():
    places = np.array([0.0, 2.0, 3.0, 7.0, 10.0])
    edges = [0.02, 0.06, -0.01, 0.05, 0.03]
    growth = rb.growth.stations(places, [rb.growth.edge(xi) for xi in edges], spline=True)
    S = np.linspace(0.0, 10.0, 301)
    # Each cardinal spline is rounded at 1e-16 of its powers, which are below 10 in size.
    assert growth.values(0.5, S)["gamma33"] == pytest.approx(CubicSpline(places, edges)(S), abs=1e-15)


def test_stations_of_different_growths():
    first = rb.growth.edge(0.02) + rb.growth.chiral(0.3)
    last = rb.growth.Profile(gamma33=(X, np.cos(X)), amplitude=0.1, name="measured")
    growth = rb.growth.stations([0.0, 4.0], [first, last])
    assert [term.name for term in growth.terms] == ["station0_edge", "station0_chiral", "station1_measured"]
    values = growth.values(X, 1.0)
    assert values["gamma33"] == pytest.approx(0.75 * 0.02 * 4 * X**2 + 0.25 * 0.1 * np.cos(X), abs=1e-16)
    assert values["d23"] == pytest.approx(0.75 * 0.3 + 0 * X, rel=2 * EPS)
    twice = growth + rb.growth.stations([0.0, 4.0], [first, last], name="again")
    assert twice.values(X, 1.0)["gamma33"] == pytest.approx(2 * values["gamma33"], rel=4 * EPS)


def test_a_station_ends_at_its_neighbours():
    growth = rb.growth.stations([0.0, 1.0, 3.0, 4.0], [rb.growth.chiral(1.0)] * 4)
    (breaks, second) = growth.core_terms()[1][0]
    assert breaks == [0.0, 1.0, 3.0, 4.0]
    assert second == [[0.5, 0.5], [0.5, -0.5], [0.0]]


@given(st.lists(st.floats(0.1, 2.0), min_size=3, max_size=9), st.booleans())
def test_equal_stations_are_uniform(steps, spline):
    places = np.cumsum([0.0, *steps])
    growth = rb.growth.stations(places, [rb.growth.edge(0.06)] * places.size, spline)
    S = np.linspace(0.0, places[-1], 53)
    # The weights sum to 1; those of splines at very uneven stations are large, and cancel.
    assert growth.values(0.5, S)["gamma33"] == pytest.approx(0.06 + 0 * S, rel=1e-12 if spline else 4 * EPS)


EDGE = rb.growth.edge(0.06)


@pytest.mark.parametrize(
    ("field", "S", "growths", "spline"),
    [
        ("S", [0.0], [EDGE], False),
        ("S", [0.0, 1.0, 2.0], [EDGE] * 3, True),
        ("S", [[0.0, 1.0]], [EDGE] * 2, False),
        ("S", "ab", [EDGE] * 2, False),
        ("S[0]", [-1.0, 1.0], [EDGE] * 2, False),
        ("S[1]", [0.0, 0.0], [EDGE] * 2, False),
        ("S[2]", [0.0, 2.0, 1.0], [EDGE] * 3, False),
        ("S[1]", [0.0, math.nan], [EDGE] * 2, False),
        ("S", np.arange(1001.0), [EDGE] * 1001, False),
        ("growths", [0.0, 1.0], [EDGE], False),
        ("growths", [0.0, 1.0], EDGE, False),
        ("growths[1]", [0.0, 1.0], [EDGE, 0.06], False),
        ("growths[0].edge", [0.0, 1.0], [rb.growth.edge(([0, 1], [0.0, 0.1])), EDGE], False),
        ("growths[1].edge", [0.0, 1.0], [EDGE, rb.growth.edge(np.sin)], False),
    ],
)
def test_stations_are_refused(field, S, growths, spline):
    refuses(f"growth.station.{field}", lambda: rb.growth.stations(S, growths, spline))


@pytest.mark.parametrize("spline", [1, "yes", None])
def test_splines_of_stations_are_true_or_false(spline):
    refuses("growth.station.spline", lambda: rb.growth.stations(np.arange(4.0), [EDGE] * 4, spline))


def test_names_of_stations_are_identifiers():
    refuses("growth.name", lambda: rb.growth.stations([0.0, 1.0], [EDGE, EDGE], name="a b"))
    refuses("growth.name", lambda: rb.growth.from_csv("leaf.csv", name="1st"))


# tables


@pytest.fixture
def table(tmp_path):
    """Read a table given as text."""

    def read(text, **given):
        path = tmp_path / "leaf.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return rb.growth.from_csv(path, **given)

    return read


@pytest.fixture
def refusal(table):
    """The one line in which a table is refused."""

    def line(text, **given):
        with pytest.raises(rb.InputError) as caught:
            table(text, **given)
        assert len(str(caught.value).splitlines()) == 1
        assert len(str(caught.value)) < 400
        return str(caught.value)

    return line


def test_a_table_is_samples_across_the_width(table):
    text = """
    # a leaf, measured
    x, g33, d22

    -0.5, 0.01, 0.1
     0.0, 0.03, 0.2
     # and the other side
     0.5, 0.02, 0.0
    """
    x, g33, d22 = [-0.5, 0.0, 0.5], [0.01, 0.03, 0.02], [0.1, 0.2, 0.0]
    assert table(text) == rb.growth.Profile(gamma33=(x, g33), d22=(x, d22), name="measured")
    assert table(text, name="leaf").terms[0].name == "leaf"


def test_rows_come_in_any_order(table):
    rows = ["0.5,3", "-0.5,1", "0.1,2"]
    expected = rb.growth.Profile(gamma33=([-0.5, 0.1, 0.5], [1, 2, 3]), name="measured")
    assert table("x,gamma33\n" + "\n".join(rows)) == expected
    assert table("gamma33,x\n" + "\n".join(",".join(row.split(",")[::-1]) for row in rows)) == expected


def test_every_field(table):
    fields = ("gamma33", "d33", "d22", "d23", "g21", "g31", "gamma22", "gamma23")
    growth = table("x," + ",".join(fields) + "\n-0.5,1,2,3,4,5,6,7,8\n0.5,1,2,3,4,5,6,7,8\n")
    assert {name: float(value) for name, value in growth.values(0.1).items()} == {
        name: float(i + 1) for i, name in enumerate(fields)
    }


def test_splines_and_breaks(table):
    x = [-0.5, -0.3, -0.1, 0.1, 0.1, 0.2, 0.4, 0.5]
    v = [0.0, 0.3, 0.1, 0.2, -0.5, 0.0, 0.1, -0.2]
    text = "x,g33\n" + "".join(f"{a},{b}\n" for a, b in zip(x, v, strict=True))
    expected = rb.growth.Profile(gamma33=(x, v), breaks=[0.1], spline=True, name="measured")
    assert table(text, breaks=[0.1], spline=True) == expected


@pytest.mark.parametrize("places", [(0.1 + 0.2, 0.1 + 0.2), (0.1 + 0.2, 0.3), (0.3, 0.1 + 0.2)])
def test_rows_are_at_breaks_but_for_rounding(table, places):
    assert 0.1 + 0.2 != 0.3
    text = "x,g33\n-0.5,0\n{!r},1\n{!r},2\n0.5,3\n".format(*places)
    assert table(text, breaks=[0.3]) == table("x,g33\n-0.5,0\n0.3,1\n0.3,2\n0.5,3\n", breaks=[0.3])


@pytest.mark.parametrize("spline", [False, True])
def test_stations_have_x_of_their_own(table, spline):
    rng = np.random.default_rng(3)
    places = [0.0, 1.5, 4.0, 9.0, 12.0]
    profiles = []
    rows = []
    for S in places:
        x = np.concatenate([[-0.5], np.sort(rng.uniform(-0.45, 0.45, 5)), [0.5]])
        v = rng.uniform(0.0, 0.1, x.size)
        rows += [f"{S!r},{a!r},{b!r}" for a, b in zip(x.tolist(), v.tolist(), strict=True)]
        profiles.append(rb.growth.Profile(gamma33=(x, v), spline=spline, name="measured"))
    rng.shuffle(rows)
    found = table("S,x,gamma33\n" + "\n".join(rows), spline=spline)
    assert found == rb.growth.stations(places, profiles, spline)


def test_lengths_in_the_unit_of_the_width(table):
    text = "S,x,g33\n0,-25,0.01\n0,25,0.02\n500,-25,0.03\n500,5,0.03\n500,5,0.05\n500,25,0.05\n"
    text += "0,5,0.02\n0,5,0.01\n"
    scaled = "S,x,g33\n0,-0.5,0.01\n0,0.5,0.02\n10,-0.5,0.03\n10,0.1,0.03\n10,0.1,0.05\n10,0.5,0.05\n"
    scaled += "0,0.1,0.02\n0,0.1,0.01\n"
    assert table(text, width=50, breaks=[5]) == table(scaled, breaks=[0.1])


def test_text_of_any_kind(table):
    expected = table("x,g33\n-0.5,0.01\n0.5,0.02\n")
    assert table(b"\xef\xbb\xbfx,g33\r\n-0.5,0.01\r\n0.5,0.02") == expected
    assert table("x,g33\r-0.5,0.01\r0.5,0.02\r") == expected
    assert table('"x" , "g33"\n" -0.5 ",1e-2\n0.5,"+2.0E-2"\n') == expected


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("S,g33\n0,1\n", "growth.csv column x is missing: expected x = X2/a besides S, gamma33"),
        ("x\n0\n", "growth.csv column is missing: expected at least one of gamma33, d33, d22, d23, g21, "),
        (
            "\nx,gama33\n",
            "growth.csv line 2 = 'gama33': expected one of x, S, gamma33, d33, d22, d23, g21, g31, gamma22, "
            "gamma23, g33; the nearest is gamma33",
        ),
        ("x;g33\n", "growth.csv line 1 = 'x;g33': expected columns separated by commas"),
        ("x\tgrowth\n", "growth.csv line 1 = 'x\\tgrowth': expected columns separated by commas"),
        ("S x g33\n", "growth.csv line 1 = 'S x g33': expected columns separated by commas"),
        ("x (mm),g33\n", "growth.csv line 1 = 'x (mm)': expected plain x; width= is for lengths"),
        ("x,g33 [%]\n", "growth.csv line 1 = 'g33 [%]': expected plain g33"),
        ("x,g33,\n", "growth.csv line 1 = '': expected one of x, S, "),
        ("x,g33,gamma33\n", "growth.csv line 1 = 'g33': expected each column once"),
        ("x,x,g33\n", "growth.csv line 1 = 'x': expected each column once"),
        ("x,g33\n", "growth.csv = "),
        ("x,g33\n\n0\n", "growth.csv line 3 = '1 cells': expected 2, as in the header"),
        ("x,g33\n0,1,2\n", "growth.csv line 2 = '3 cells': expected 2, as in the header"),
        ("x,g33\n0,a\n", "growth.csv line 2, column g33 = 'a': expected a finite number"),
        ("x,g33\n0,\n", "growth.csv line 2, column g33 = '': expected a finite number"),
        ("x,g33\n-0.5,0\n\n0,nan\n", "growth.csv line 4, column g33 = 'nan': expected a finite number"),
        ("x,g33\ninf,0\n", "growth.csv line 2, column x = 'inf': expected a finite number"),
        ("x,g33\n0,1_0\n", "growth.csv line 2, column g33 = '1_0': expected a finite number"),
        ("x,g33\n0,0.1j\n", "growth.csv line 2, column g33 = '0.1j': expected a finite number"),
        ("x,g33\n0.5,0\n-0.6,0\n", "growth.csv line 3, column x = -0.6: expected a number in [-1/2, 1/2]"),
        (
            "x,g33\n0.5,0\n-0.5,0\n0.5,1\n",
            "growth.csv line 4, column x = 0.5: expected each x once at a station",
        ),
        ("x,g33\n0,0\n", "growth.csv, gamma33.x = [0.0]: expected at least 2 samples"),
        ("x,g33\n0,0\n0.1,0\n", "growth.csv, gamma33.x[0] = 0.0: expected samples from x = -0.5 to x = 0.5"),
        ("x,g33\n-0.5,1e61\n0.5,0\n", "growth.csv, gamma33.values[0] = 1e+61: expected a number of at most"),
        ("S,x,g33\n0,-0.5,0\n0,0.5,0\n", "growth.csv column S = '1 stations': expected at least 2 stations"),
        (
            "S,x,g33\n0,-0.5,0\n2.5,0.1,1\n0,0.5,0\n",
            "growth.csv at S = 2.5, gamma33.x = [0.1]: expected at least 2 samples",
        ),
        ("S,x,g33\n-1,-0.5,0\n-1,0.5,0\n2,0.5,0\n2,-0.5,0", "growth.station.S[0] = -1.0: expected 2 to 1000"),
        (b"x,g33\n0,\xff\n", "growth.csv = "),
        ("x,g33\n" + "1" * 200_000 + "\n", "growth.csv line 2 = "),
    ],
)
def test_tables_are_refused(refusal, text, line):
    assert refusal(text).startswith(line)


@pytest.mark.parametrize("text", ["", "# only this\n", "\n \n"])
def test_tables_without_a_header_are_refused(refusal, text):
    assert refusal(text).endswith(
        "leaf.csv': expected a header, such as x,gamma33, and rows of numbers below it"
    )


def test_rows_are_refused_while_they_are_read(refusal):
    rows = "0,0\n" * 250_000
    assert "each x once" in refusal(f"x,g33\n{rows}")
    # The row beyond the last, before what is wrong with it.
    line = "growth.csv line 250002 = 'one row more': expected at most 250000 rows of numbers"
    assert refusal(f"x,g33\n{rows}0,a\n") == line


def test_too_few_for_splines(refusal):
    text = "S,x,g33\n" + "".join(f"{S},{x},0\n" for S in range(3) for x in (-0.5, -0.1, 0.1, 0.5))
    assert "at least 4 stations" in refusal(text, spline=True)
    assert "at least 4 samples" in refusal("x,g33\n-0.5,0\n0,0\n0.5,0\n", spline=True)


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("growth.csv width", {"width": 0.0}),
        ("growth.csv width", {"width": "1"}),
        ("growth.csv breaks", {"breaks": 0.1}),
        ("growth.csv breaks[0]", {"breaks": [math.nan]}),
        ("growth.csv, breaks[0]", {"breaks": [0.6]}),
        ("growth.csv, spline", {"spline": 1}),
    ],
)
def test_options_are_refused(table, field, given):
    refuses(field, lambda: table("x,g33\n-0.5,0\n0.5,0\n", **given))


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("none.csv", "a readable file, not: No such file or directory"),
        (".", "a readable file, not: Is a directory"),
        ("\0", "a readable file, not: embedded null byte"),
        ("a" * 5000, "a readable file, not: File name too long"),
        (3, "the name of a file"),
        (None, "the name of a file"),
    ],
)
def test_files_that_cannot_be_read(path, reason):
    with pytest.raises(rb.InputError, match=r"^growth\.csv = ") as caught:
        rb.growth.from_csv(path)
    assert caught.value.expected == reason


@given(st.binary(max_size=60) | st.text('xSg3,\n-.5e# 0"', max_size=60).map(str.encode))
def test_any_bytes_are_read_or_refused(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    Path(path).write_bytes(content)
    with contextlib.suppress(rb.InputError):
        rb.growth.from_csv(path)
