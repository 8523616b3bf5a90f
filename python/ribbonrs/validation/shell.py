"""The strains (15)-(19) of the shell and their parts (27), at points of the ribbon.

Random values of the sizes that the paper assumes, as in `kinematics`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .kinematics import COMPONENTS, Point, exact, order_row, orders, weak
from .row import PAPER, Row, farthest

__all__ = ["rows"]

NAMES = ("22", "23", "33")


@dataclass(frozen=True)
class Shell:
    """Mid-surface fields at a point; a letter and digits are a field's derivatives by X2 and X3.

    u1: u1, u1,2, u1,3, u1,22, u1,23, u1,33; u2, u3: the field, its derivatives by X2 and by X3; g21, g31 the
    same; k: kappa1, kappa2, kappa3, kappa3'; g: g11, g12, g13, g22, g23, g32, g33; zeta: its derivatives by
    X1, X2 and X3.
    """

    X: Array
    eps: float
    k: Array
    u1: Array
    u2: Array
    u3: Array
    g21: Array
    g31: Array
    g: Array
    zeta: Array

    @classmethod
    def random(cls, eta: float, seed: int) -> Shell:
        """The same random numbers for every eta, times their powers of it."""
        rng = np.random.default_rng(seed)

        def draw(*powers: int) -> Array:
            return rng.uniform(0.3, 1.0, len(powers)) * eta ** np.array(powers)

        return cls(
            X=draw(1, 0, 0),
            eps=float(draw(2)[0]),
            k=draw(2, 1, 1, 1),
            u1=draw(1, 1, 1, 1, 1, 1),
            u2=draw(2, 2, 2),
            u3=draw(2, 2, 2),
            g21=draw(1, 1, 1),
            g31=draw(1, 1, 1),
            g=draw(2, 3, 3, 2, 2, 2, 2),
            zeta=draw(2, 3, 3),
        )

    @property
    def point(self) -> Point:
        """The point with the displacements (15), for which sections do not shear through the thickness."""
        X1, X2, _ = self.X
        k1, k2, k3, k33 = self.k
        u1, u12, u13, u122, u123, u133 = self.u1
        turned2, turned3 = u12 - self.g21[0], u13 - k3 * X2 - self.g31[0]
        across2 = np.array([turned2, u122 - self.g21[1], u123 - self.g21[2]])
        across3 = np.array([turned3, u123 - k3 - self.g31[1], u133 - k33 * X2 - self.g31[2]])
        U2, U22, U23 = self.u2 - X1 * across2
        U3, U32, U33 = self.u3 - X1 * across3
        zeta1, zeta2, zeta3 = self.zeta
        g11, g12, g13, g22, g23, g32, g33 = self.g
        return Point(
            X=self.X[:2],
            U=np.array([u1 + X1 * zeta1, U2, U3]),
            U_1=np.array([zeta1, -turned2, -turned3]),
            U_2=np.array([u12 + zeta2, U22, U32]),
            U_3=np.array([u13 + zeta3, U23, U33]),
            zeta=np.array([X1 * zeta1, zeta2, zeta3]),
            eps=np.array([self.eps]),
            K=np.array([k1, k2, k3]),
            g=np.array([[g11, g12, g13], [self.g21[0], g22, g23], [self.g31[0], g32, g33]]),
        )

    @property
    def strains(self) -> Array:
        """e22, e23, e33 of (19)."""
        X1, X2, _ = self.X
        k1, k2, k3, k33 = self.k
        u1, u12, u13, u122, u123, u133 = self.u1
        *_, g22, g23, g32, g33 = self.g
        e22 = self.u2[1] + u12**2 / 2.0 - g22 - X1 * (u122 - self.g21[1])
        e23 = (self.u3[1] + self.u2[2] + u12 * u13 + k3 * (u1 - X2 * u12) - g32 - g23) / 2.0
        e23 -= X1 * (u123 - k3 - self.g31[1] / 2.0 - self.g21[2] / 2.0)
        e33 = self.eps + k1 * X2 - k2 * u1 + self.u3[2] + (u13 - k3 * X2) ** 2 / 2.0 - g33
        e33 -= X1 * (k2 + u133 - k33 * X2 - self.g31[2])
        return np.array([e22, e23, e33])

    def parts(self, last: float) -> tuple[float, float]:
        """The sums of the parts of e23 and e33 in (27), the last term of e33^(1) being `last` g31,3."""
        X1, X2, _ = self.X
        k1, k2, k3, k33 = self.k
        u1, u12, u13, _, u123, u133 = self.u1
        *_, g23, g32, g33 = self.g
        e23 = (self.u3[1] + k3 * u1 - k3 * X2 * u12 - g32 - g23) / 2.0 + X1 * (k3 + self.g31[1] / 2.0)
        e23 += (self.u2[2] + u12 * u13 + X1 * self.g21[2] - 2.0 * X1 * u123) / 2.0
        e33 = self.eps + k1 * X2 - k2 * u1 + k3**2 * X2**2 / 2.0 - k2 * X1 - g33
        e33 += self.u3[2] - k3 * X2 * u13 + k33 * X2 * X1 + last * self.g31[2]
        e33 += u13**2 / 2.0 - X1 * u133
        return float(e23), float(e33)


def rows() -> Iterator[Row]:
    """Yield the identities and the orders of what is left out."""
    shells = [Shell.random(1.0, seed) for seed in range(20)]
    E = np.array([weak(s.point) for s in shells])
    yield Row("E12 = E13 = 0", f"{PAPER}, (18)", *farthest(0.0, E[:, 0, 1:]), 5e-16)
    e = np.array([s.strains for s in shells])
    for k, name in enumerate(NAMES):
        i, j = COMPONENTS[name]
        yield Row(f"e{name} from (14), (15)", f"{PAPER}, (19)", *farthest(e[:, k], E[:, i, j]), 5e-15)

    for name, order in zip(NAMES, orders(_left_out), strict=True):
        yield order_row(f"order of what e{name} leaves out", "(19)", 3.0, float(order))

    source = f"{PAPER}, (27)"
    sums = np.array([(*s.parts(s.X[2]), *s.parts(s.X[0])) for s in shells])
    yield Row("e23 as the sum of its parts", source, *farthest(sums[:, 0], e[:, 1]), 5e-15)
    published, computed, mended = farthest(sums[:, 1], e[:, 2], sums[:, 3])
    wrong = "The last term of e33^(1) is X1 g31,3, not X3 g31,3."
    yield Row(
        "e33 as the sum of its parts", source, published, computed, 5e-15, wrong=wrong, corrected=mended
    )


def _left_out(eta: float, seed: int) -> Array:
    s = Shell.random(eta, seed)
    E = exact(s.point)
    return np.array([E[COMPONENTS[name]] for name in NAMES]) - s.strains
