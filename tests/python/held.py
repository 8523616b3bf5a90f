"""Held and loaded ribbons in tests: scenes, components in the fixed basis, rotations."""

import numpy as np
import ribbonrs as rb
from scipy.spatial.transform import Rotation

AXES = np.eye(3)
SOFT = rb.LinearLaw(EI1=1.0, EI2=1.0, GJ=1.0, inextensible=True)
"""A rod whose forces are in units of EI."""


def strip(length):
    """A ribbon of unit width, 1/10 as thick."""
    return rb.Ribbon(float(length), 1.0, 0.1)


def rod(length=1.0, law=SOFT, **scene):
    """The scene of a classical rod."""
    return rb.Scene(strip(length), law=law, **scene)


def in_space(sections, name):
    """Force or moment, (n, 3), in the fixed basis."""
    return np.einsum("ni,nij->nj", getattr(sections, name), sections.directors)


def turn(vector):
    """The rotation matrix of a rotation vector; columns are the turned E_i."""
    return Rotation.from_rotvec(vector).as_matrix()


def quaternion(matrix):
    """The unit quaternion, scalar first, of a rotation matrix."""
    return tuple(np.roll(Rotation.from_matrix(matrix).as_quat(), 1))


def matrices(sections):
    """Rotation matrices (n, 3, 3), columns the directors."""
    return np.swapaxes(sections.directors, 1, 2)


def largest(difference):
    """The largest of absolute values."""
    return float(np.max(np.abs(difference)))
