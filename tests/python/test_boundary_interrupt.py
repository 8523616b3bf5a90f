"""Ctrl-C is answered while the core solves."""

import signal
import time

import pytest
import ribbonrs as rb


def interrupt(*_):
    raise KeyboardInterrupt


def test_a_long_solve_is_interrupted():
    # a soft helix that is pulled: the solver tries all it knows, for a second or so
    leaf = rb.Ribbon(10.0, 1.0, 0.1)
    growth = rb.growth.edge(0.06) + rb.growth.chiral(0.04)
    scene = rb.Scene(leaf, growth, end=rb.Free(force=(0.0, 0.0, 1e-3)))
    start = time.perf_counter()
    with pytest.raises(rb.ConvergenceError):
        rb.solve(scene)
    whole = time.perf_counter() - start
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1 * whole)
        start = time.perf_counter()
        with pytest.raises(KeyboardInterrupt):
            rb.solve(scene)
        assert time.perf_counter() - start < 0.7 * whole
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
