"""What the core gives for a trace, made of states that are solved one by one."""

import warnings

import numpy as np
import ribbonrs as rb
from ribbonrs.course import Held
from ribbonrs.parameter import parameter_of


class FakeBranch:
    """Points of a branch: `state(value)` is the equilibrium there."""

    def __init__(
        self, values, state, ended=("span", "span"), reason="", origin=None, mirrored=False, index=None
    ):
        self.state, self.parameter = state, np.array(values, dtype=float)
        self.ended, self.reason, self.origin, self.mirrored = ended, reason, origin, mirrored
        self.states = [state(value) for value in values]
        self.held = isinstance(self.states[0].course, Held)
        length = self.states[0].scene.ribbon.length_ratio if self.held else 1.0
        self.energy = np.array([length * s.energy for s in self.states])
        self.load_potential = np.array([length * s.load_potential for s in self.states])
        self.section_index = np.array([s.section_index for s in self.states])
        known = [np.nan if s.index is None else s.index for s in self.states]
        self.index = np.array(known if index is None else index, dtype=float)
        self.strains = np.array([s.strains.mean(axis=0) for s in self.states])
        self.position = np.array([s.position[-1] for s in self.states])
        wrenches = [(s.reactions.start, s.reactions.end) for s in self.states]
        self.reactions = np.array(
            [np.concatenate([v for w in pair for v in (w.force, w.moment)]) for pair in wrenches]
        )

    def solution(self, i):
        return self.states[i].course.solution if self.held else None

    def between(self, i, fraction):
        return self.at_value(i, (1.0 - fraction) * self.parameter[i] + fraction * self.parameter[i + 1])

    def at_value(self, i, value):
        state = self.state(value)
        return value, state.strains.mean(axis=0), state.course.solution if self.held else None


class FakeTrace:
    """Branches and special points."""

    def __init__(self, branches, special_points):
        self.branches, self.special_points, self.work = branches, special_points, None


LEAF = rb.Ribbon(10.0, 1.0, 0.1)
EDGE = rb.Scene(LEAF, rb.growth.edge(0.06))
BENDS, TWISTS = 0.04546738, 0.05


def shape_of(phase):
    """The equilibrium of a leaf of this edge growth; where there is no such phase yet it is flat."""

    def state(xi):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of large growth, and at branch points
            states = rb.natural_shapes(LEAF, rb.growth.edge(xi))
        return next((s for s in states if s.phase == phase), states[-1])

    return state


def edge_trace():
    """Flat, bent and twisted shapes as the edges of a leaf grow."""
    flat = FakeBranch([0.0, 0.03, BENDS, 0.047, TWISTS, 0.065, 0.08], shape_of("flat"))
    ended, from_bend = ("branch point", "span"), [0.0456, 0.0465, 0.049, 0.055, 0.066, 0.08]
    bent = FakeBranch([BENDS, *from_bend], shape_of("bent"), ended, origin=0, mirrored=True)
    from_twist = [0.0502, 0.051, 0.054, 0.062, 0.08]
    twisted = FakeBranch([TWISTS, *from_twist], shape_of("twisted"), ended, origin=1, mirrored=True)
    special = [("branch point", 0, 2, BENDS, 1), ("branch point", 0, 4, TWISTS, 1)]
    return FakeTrace([flat, bent, twisted], special)


CLAMPED = rb.Scene(LEAF, end=rb.Sliding(), loads=[rb.PointLoad(5.0, force=(1e-5, 0.0, 0.0))])


def pressed(force):
    """A strip between a clamp and a slider, pushed along and a little aside."""
    return rb.solve(parameter_of(CLAMPED, "end.force").scene(float(force)))


def pressed_trace(ended=("span", "failed"), reason="the Newton iteration diverged"):
    """A strip that bends the more the more it is pressed: an imperfect column."""
    forces = [0.0, -1e-4, -2e-4, -2.6e-4, -3.0e-4]
    return FakeTrace([FakeBranch(forces, pressed, ended, reason)], [("value", 0, 2, -2e-4, 1)])
