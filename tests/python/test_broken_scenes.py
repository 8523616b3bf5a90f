"""Thousands of broken scenes: each is run, or refused in one line; nothing else ever happens."""

import contextlib
import copy
import io
import json
import math
import os
import sys
import warnings
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ribbonrs.cli import main
from ribbonrs.growth import FIELDS
from ribbonrs.scenefile import read

SCENES = [
    {
        "ribbon": {"length": 10.0, "width": 1.0, "thickness": 0.1},
        "growth": {"edge": 0.06, "chiral": 0.04},
        "start": {"kind": "clamped", "position": [0.0, 1.0, 2.0], "rotation": [0.6, 0.0, 0.8, 0.0]},
        "end": {"kind": "free", "force": [0.0, 0.0, 0.0]},
        "trace": {"parameter": "growth.edge.amplitude", "span": [0.0, 0.08]},
        "output": {"data": "a.npz"},
    },
    {
        "law": "full",
        "ribbon": {"length": 3, "width": 0.5, "thickness": 0.01},
        "material": {"kind": "orthotropic", "Q33": 2.0, "Q22": 1.0, "Q23": 0.3, "G": 0.4},
        "growth": {
            "profile": [
                {"gamma33": [0.0, 0.01, 0.02], "d22": [0.3]},
                {"name": "vein", "amplitude": 0.5, "g21": [0.0, 0.01], "g31": [0.0, 0.0, 0.02]},
            ]
        },
    },
    {
        "law": "quadratic",
        "ribbon": {"length": 60.0, "width": 8.0, "thickness": 0.6},
        "material": {"kind": "mooney-rivlin", "c1": 0.1, "c2": 0.05},
        "growth": {"edge": 0.02},
    },
    {
        "ribbon": {"length": 10.0, "width": 1.0, "thickness": 0.1},
        "material": {"kind": "isotropic", "Y": 2.0, "nu": 0.3},
        "growth": {"thickness": {"xi": 0.2, "transverse": -0.1}},
        "start": {"kind": "clamped", "twist_turns": 0.5},
    },
    {
        "ribbon": {"length": 10.0, "width": 1.0, "thickness": 0.1},
        "growth": {
            "profile": [
                {
                    "name": "rib",
                    "breaks": [-0.1, 0.1],
                    "gamma33": [[0.0], [0.02, 0.1], [0.0, 0.01]],
                    "d33": {"x": [-0.5, -0.1, -0.1, 0.1, 0.1, 0.5], "values": [0.0, 0.1, 0.2, 0.2, 0.0, 0.1]},
                },
                {
                    "name": "measured",
                    "spline": True,
                    "gamma33": {"x": [-0.4, -0.2, 0.0, 0.3, 0.5], "values": [0.03, 0.01, 0.0, 0.01, 0.03]},
                },
            ]
        },
    },
]

VARYING = [
    {
        "ribbon": {
            "length": 10.0,
            "width": 1.0,
            "thickness": 0.1,
            "width_profile": {"S": [0.0, 5.0, 10.0], "values": [1.0, 1.0, 0.5]},
        },
        "growth": {"edge": {"S": [0.0, 5.0, 5.0, 10.0], "values": [0.02, 0.05, 0.03, 0.06]}, "chiral": 0.04},
    },
    {
        "ribbon": {"length": 5.0, "width": 1.0, "thickness": 0.1},
        "growth": {
            "thickness": {"xi": {"S": [0, 5], "values": [0.0, 0.3]}, "transverse": 0.1},
            "profile": {"amplitude": {"S": [0, 5], "values": [0.5, 1]}, "gamma33": [0.0, 0.01, 0.05]},
        },
    },
]

LOADED = [
    {
        "gravity": [0.0, 0.0, -1e-6],
        "ribbon": {"length": 10.0, "width": 1.0, "thickness": 0.1},
        "growth": {"edge": 0.02},
        "end": {"kind": "free", "force": [1e-6, 0.0, 0.0], "moment": [0.0, 1e-6, 0.0]},
        "loads": [
            {"kind": "point", "S": 5.0, "force": [0.0, 1e-6, 0.0]},
            {"kind": "line", "force": {"S": [0.0, 10.0], "values": [[0.0, 0.0, 0.0], [1e-7, 0.0, 0.0]]}},
        ],
        "solve": {"tol": 1e-8, "degree": 4},
    },
    {
        "ribbon": {"length": 10.0, "width": 1.0, "thickness": 0.1},
        "start": {"kind": "hinged", "director": 2, "moment": 1e-6},
        "end": {"kind": "sliding", "axis": [0.0, 0.0, 2.0], "twist_turns": 0.1, "force": -1e-6},
        "weight": {"density": 1e-6, "g": [9.81, 0.0, 0.0]},
        "law": {"EA": 1.0, "EI1": 0.1, "EI2": 0.001, "GJ": 0.001, "intrinsic": [0.0, 0.0, 0.1, 0.0]},
    },
    {
        "law": "linear",
        "ribbon": {"length": 10.0, "width": 1.0, "thickness": 0.1},
        "growth": {"chiral": 0.01},
        "start": {"kind": "closed", "link": 0.0},
    },
    {
        "ribbon": {"length": 10.0, "width": 1.0, "thickness": 0.1},
        "start": {"kind": "pinned", "moment": [0.0, 1e-6, 0.0]},
        "end": {"kind": "clamped", "position": [0.5, 0.0, 9.0], "rotation": [0.0, 0.1, 0.0]},
    },
]

EXTREME = [0.0, -0.0, math.inf, -math.inf, math.nan, 5e-324, 1e-160, 1e-8, 1e8, 1e160, sys.float_info.max]
junk = st.one_of(
    st.sampled_from(EXTREME),
    st.floats(),
    st.integers(),
    st.sampled_from([10**400, -(10**5000), 2**63]),
    st.booleans(),
    st.text(st.characters(codec="utf-8", exclude_characters="/"), max_size=8),
    st.sampled_from(["clamped", "free", "pinned", "isotropic", "quadratic", "linear", "edge", "x" * 5000]),
    st.lists(st.floats(-1, 1), max_size=40),
    st.lists(st.lists(st.integers(0, 3), max_size=2), max_size=3),
    st.dictionaries(st.text(max_size=3), st.floats(), max_size=2),
)


@pytest.fixture(autouse=True, scope="module")
def folder(tmp_path_factory):
    """An empty current directory for the whole module."""
    before = Path.cwd()
    os.chdir(tmp_path_factory.mktemp("scenes"))
    yield
    os.chdir(before)


def toml(value):
    """Write a value as TOML, tables inline."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {toml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, bool | str):
        return json.dumps(value)
    return hex(value) if isinstance(value, int) and value >= 2**63 else huge_or_plain(value)


def huge_or_plain(number):
    """Write a number; Python itself does not print integers beyond 4300 digits."""
    return "-1" + "0" * 5000 if number == -(10**5000) else repr(number)


def document(scene):
    """Write a scene as a TOML document."""
    return "\n".join(f"{json.dumps(key)} = {toml(value)}" for key, value in scene.items()).encode()


def places(value, path=()):
    """Every path to an entry of a nested scene."""
    entries = (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    )
    for key, entry in entries:
        yield (*path, key)
        yield from places(entry, (*path, key))


@st.composite
def mutated(draw, scenes=SCENES + VARYING):
    """A valid scene with one to three entries deleted, renamed, replaced, wrapped or moved."""
    scene = copy.deepcopy(draw(st.sampled_from(scenes)))
    for _ in range(draw(st.integers(1, 3))):
        if not scene:
            break
        *path, key = draw(st.sampled_from(list(places(scene))))
        parent = scene
        for step in path:
            parent = parent[step]
        action = draw(st.sampled_from(["delete", "rename", "replace", "replace", "wrap", "move"]))
        entry = parent[key] if action == "wrap" else parent.pop(key) if action != "replace" else None
        if action == "rename" and isinstance(parent, dict):
            at = draw(st.integers(0, len(key)))
            parent[key[:at] + draw(st.text(max_size=2)) + key[at + 1 :]] = entry
        elif action == "replace":
            parent[key] = draw(junk)
        elif action == "wrap":
            parent[key] = draw(st.sampled_from([[entry], {"kind": entry}, {key: entry}, [entry, entry]]))
        elif action == "move" and isinstance(key, str):
            scene[key] = entry
    return document(scene)


@st.composite
def extreme(draw, scenes=SCENES + VARYING):
    """A valid scene whose numbers are any number."""
    scene = copy.deepcopy(draw(st.sampled_from(scenes)))
    size = draw(st.sampled_from([1.0, 1e3, 1e300]))
    number = st.one_of(st.floats(-size, size), st.sampled_from(EXTREME))
    for *path, key in list(places(scene)):
        parent = scene
        for step in path:
            parent = parent[step]
        if isinstance(parent[key], float) and draw(st.booleans()):
            parent[key] = draw(number)
    return document(scene)


def powers(low, high):
    """Positive numbers of any size from 10^low to 10^high."""
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


@st.composite
def sound(draw):
    """A scene that nothing is wrong with, of any size and of growth up to the limit of the theory."""
    width = draw(powers(-50, 50))
    ratio = draw(powers(-3, -0.1))
    ribbon = {"length": width * draw(powers(-3, 5)), "width": width, "thickness": width * ratio}
    breaks = draw(st.sampled_from([[], [0.1], [-0.3, 0.0, 0.45]]))
    growth = {"breaks": breaks}
    for field in draw(st.lists(st.sampled_from(FIELDS), max_size=4, unique=True)):
        # On |x| <= 1/2 these polynomials stay below twice their largest coefficient; growth adds no other.
        limit = draw(powers(-12, -0.7)) / (ratio if field.startswith("d") else 2.0)
        polynomial = st.lists(st.floats(-1, 1).map(lambda c, limit=limit: limit * c), min_size=1, max_size=12)
        count = len(breaks) + 1 if field not in ("g21", "g31") else 1
        pieces = draw(st.lists(polynomial, min_size=count, max_size=count))
        growth[field] = pieces if count > 1 else pieces[0]
    if draw(st.booleans()):
        scene = {
            "ribbon": ribbon,
            "growth": {"edge": draw(powers(-12, -0.31)), "chiral": draw(powers(-12, -1))},
        }
    else:
        scene = {"ribbon": ribbon, "growth": {"profile": {"d33": [0.0]} | growth}}
    scene["material"] = draw(
        st.one_of(
            st.just({"kind": "isotropic"}),
            st.builds(lambda nu: {"kind": "isotropic", "nu": nu}, st.floats(-0.99, 0.5)),
            st.builds(lambda Y: {"kind": "mooney-rivlin", "c1": Y, "c2": Y / 2}, powers(-50, 50)),
            st.builds(
                lambda a, b, c, g: {
                    "kind": "orthotropic",
                    "Q33": a,
                    "Q22": b,
                    "Q23": c * math.sqrt(a * b),
                    "G": g,
                },
                powers(-3, 3),
                powers(-3, 3),
                st.floats(-0.99, 0.99),
                powers(-3, 3),
            ),
        )
    )
    return document(scene)


@st.composite
def garbled(draw):
    """The text of a valid scene with bytes deleted, inserted, repeated or cut off."""
    scene = draw(st.sampled_from(SCENES + VARYING))
    marks = st.sampled_from([b"[", b"]", b"{", b"\n", b"=", b'"', b"."])
    text = document({key: value for key, value in scene.items() if key != "output"})
    for _ in range(draw(st.integers(1, 4))):
        i, j = sorted(draw(st.tuples(st.integers(0, len(text)), st.integers(0, len(text)))))
        middle = draw(st.one_of(st.binary(max_size=4), marks))
        action = draw(st.sampled_from(["insert", "delete", "repeat", "cut"]))
        if action == "insert":
            text = text[:i] + middle + text[i:]
        elif action == "delete":
            text = text[:i] + text[min(j, i + 8) :]
        elif action == "repeat":
            text = text[:j] + text[i:]
        else:
            text = text[:i]
    return text


@st.composite
def nested(draw):
    """Brackets, tables and dotted keys, up to thousands deep."""
    depth = draw(st.sampled_from([1, 50, 90, 200, 400, 900, 3000]))
    opening, closing = draw(st.sampled_from([("[", "]"), ("{a=", "}"), ("[{a=", "}]"), ("[[", "]]")]))
    closed = draw(st.sampled_from([0, depth // 2, depth]))
    value = draw(
        st.sampled_from(
            [
                "a = " + opening * depth + "1" + closing * closed,
                "growth = " + opening * depth + "1" + closing * closed,
                "ribbon.length = " + opening * depth + "1" + closing * closed,
                "growth" + ".edge" * depth + " = 1",
                "growth.csv" + ".x" * depth + " = 1",
                "growth.profile" + ".x" * depth + " = 1",
                "[ribbon" + ".length" * depth + "]",
                "[[growth.profile" + ".gamma33" * depth + "]]",
            ]
        )
    )
    return value.encode()


def is_loaded():
    """Whether the scene, which is sound, is for the boundary-value solver."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return read("scene.toml").scene.loaded


def check(content):
    """Run a scene: 0, or 2 and one line, or 1 where nothing is stable or a loaded ribbon is not solved."""
    Path("scene.toml").write_bytes(content)
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
        status = main(["run", "scene.toml"])
    lines = [line for line in err.getvalue().splitlines() if not line.startswith("ribbonrs: warning: ")]
    written = {path.name for path in Path().iterdir()} - {"scene.toml"}
    for name in written:
        Path(name).unlink()
    assert (out.getvalue() == "") == (status != 0)
    assert status == 0 or not written
    if status == 0:
        assert lines == []
        assert "nan" not in out.getvalue()
    elif status == 1 and is_loaded():
        assert "; try " in lines[0]
    elif status == 1:
        assert b"quadratic" in content
        assert "equilibria is stable" in lines[0]
    else:
        assert status == 2
        assert lines[0].startswith("ribbonrs: ")
        assert ": expected " in lines[0]
        assert len(lines[0]) < 500
    assert len(lines) == (status != 0)
    return status


@pytest.mark.parametrize("scene", SCENES, ids=["helix", "profile", "quadratic", "saddle", "pieces"])
def test_whole_scenes_run(scene):
    assert check(document(scene)) == 0


@pytest.mark.parametrize("scene", LOADED, ids=["cantilever", "slide", "ring", "arch"])
def test_whole_loaded_scenes_run(scene):
    assert check(document(scene)) == 0


@settings(max_examples=300)
@given(mutated(LOADED))
def test_mutated_loaded_scenes(content):
    check(content)


@settings(max_examples=200)
@given(extreme(LOADED))
def test_extreme_loads(content):
    check(content)


@settings(max_examples=1000)
@given(mutated())
def test_mutated_scenes(content):
    check(content)


@settings(max_examples=600)
@given(extreme())
def test_extreme_numbers(content):
    check(content)


@settings(max_examples=250)
@given(sound())
def test_sound_scenes_run(content):
    assert check(content) == 0


@settings(max_examples=500)
@given(garbled())
def test_garbled_text(content):
    check(content)


@settings(max_examples=150)
@given(nested())
def test_deep_nesting(content):
    assert check(content) == 2


@settings(max_examples=500)
@given(st.one_of(st.binary(), st.text().map(lambda text: text.encode(errors="surrogatepass"))))
def test_random_bytes(content):
    assert check(content) == 2
