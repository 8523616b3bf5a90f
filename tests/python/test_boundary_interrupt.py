"""Ctrl-C is answered while the core works."""

import signal
import time
from contextlib import contextmanager

import pytest
import ribbonrs as rb

STRIP = rb.Scene(
    rb.Ribbon(10.0, 1.0, 0.1), rb.growth.edge(0.02), end=rb.Clamped((0.0, 0.0, 9.9), twist_turns=0.5)
)
ARCH = rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), None, end=rb.Clamped((0.0, 0.0, 9.8)))


class OutOfTimeError(Exception):
    """What a handler raises that is not Ctrl-C."""


@contextmanager
def raising(exception, seconds):
    """A signal after some seconds, whose handler raises."""

    def handler(*_):
        raise exception

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, seconds)
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def soft_helix():
    # pulled: its sections go over to other phases, one after the other, a long way
    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04)
    rb.solve(rb.Scene(rb.Ribbon(10.0, 1.0, 0.1), growth, end=rb.Free(force=(0.0, 0.0, 1e-3))))


def traced():
    rb.trace(STRIP, "end.position[2]", (9.0, 10.0), depth=2)


def located():
    rb.trace(
        rb.Scene(ARCH.ribbon, rb.growth.edge(0.01), end=ARCH.end), "end.twist_turns", (0.0, 2.0), depth=0
    )


def deflated():
    rb.find_states(ARCH, most=20)


@pytest.mark.filterwarnings("ignore:the shape jumps")
@pytest.mark.parametrize("work", [soft_helix, traced, located, deflated])
@pytest.mark.parametrize("exception", [KeyboardInterrupt, OutOfTimeError])
def test_what_a_handler_raises_ends_the_work(work, exception):
    start = time.perf_counter()
    work()
    whole = time.perf_counter() - start
    assert whole > 0.02  # else there is nothing to interrupt
    start = time.perf_counter()
    with raising(exception, 0.2 * whole), pytest.raises(exception):
        work()
    assert time.perf_counter() - start < 0.8 * whole


def test_the_next_solve_is_not_interrupted():
    with raising(KeyboardInterrupt, 0.01), pytest.raises(KeyboardInterrupt):
        deflated()
    assert rb.solve(ARCH).report.residual < 1e-9
