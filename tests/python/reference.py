"""Section-law references in mpmath, with at least 50 correct digits, written independently of the Rust code.

Printed closed forms: `twist` is Liu, Li & Liu, eqs. (57)-(58), with a chirality; `saddle` is their eq. (49)
with (50) repaired ("published") or with the thickness gradient kept in the edge condition ("consistent").
They cancel badly for small K2, so they are evaluated with as many digits as that costs.

General law: `General` solves the cross-section exactly. With lambda = K2^2/D the deflection obeys

    U'''' + lambda U = (K2 P - D f'')/D,   U'' + f = U''' + f' = 0 at x = +-1/2,

so U is a polynomial plus the exponentials exp(+-(1 +- i) q x), 4 q^4 = lambda, and the relaxed energy follows
from the work of the data on U: the minimum of a quadratic J is J(0) + J'(0)[U]/2.

Every function takes the doubles the tested code gets and converts them exactly. Derivatives are in the order
eps, K1, K2, K3.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

from mpmath import mp, mpf

DIGITS = 60
ISOTROPIC = (Fraction(4, 3), Fraction(4, 3), Fraction(2, 3), Fraction(1, 3))  # Q33, Q22, Q23, G for nu = 1/2
Poly = list[Any]  # coefficients, lowest power of x first


class Value(NamedTuple):
    """Energy, gradient (4) and Hessian (4 x 4) as mpf."""

    energy: Any
    gradient: list[Any]
    hessian: list[list[Any]]


def exact(value: Any) -> Any:
    """The number itself as an mpf, without rounding it through a decimal string."""
    if isinstance(value, Fraction):
        return mpf(value.numerator) / value.denominator
    return mpf(value)


def jet(f: Callable[[Any], Any], x: Any, step: Any) -> tuple[Any, Any, Any]:
    """f, f', f'' by central differences; of n digits a step of 10^(-n/4) leaves n/2 in f''."""
    low, mid, high = f(x - step), f(x), f(x + step)
    return mid, (high - low) / (2 * step), (high - 2 * mid + low) / step**2


# ------------------------------------------------------------------------------------- printed closed forms


def _ratio(eta: Any, K2: Any) -> Any:
    z = mp.sqrt(3 * abs(K2) / (2 * eta))
    return (mp.cos(z) - mp.cosh(z)) / (mp.sin(z) + mp.sinh(z))


@cache
def _v(eta: float, K2: float, power: Fraction) -> tuple[Any, Any, Any]:
    """eta^(5/2) |K2|^-power ratio / (18 sqrt 6) and its K2-derivatives: power 5/2 in (58), 1/2 in (50)."""
    with mp.workdps(_digits(eta, K2)):
        h, p, step = exact(eta), exact(power), exact(K2) * mpf(10) ** -(mp.dps // 4)

        def v(k: Any) -> Any:
            return h ** mpf("2.5") * abs(k) ** -p * _ratio(h, k) / (18 * mp.sqrt(6))

        return jet(v, exact(K2), step)


def _digits(eta: float, K2: float) -> int:
    """Digits that leave 60 after the cancellations in the printed forms, which cost (K2/eta)^-4 at most."""
    return 150 + int(-8 * min(mp.log10(abs(exact(K2)) / exact(eta)), 0)) if K2 else 150


def twist(eta: float, xi: float, strain: Sequence[float], chiral: float = 0.0) -> Value:
    """Liu, Li & Liu, eqs. (57)-(58), (K3 - d/2)^2 for K3^2 in torsion; (59) at K2 = 0, exact there."""
    with mp.workdps(_digits(eta, strain[2])):
        h, g, d = exact(eta), exact(xi), exact(chiral)
        e, K1, K2, K3 = map(exact, strain)
        torsion = h**2 / 18 * ((K3 - d / 2) ** 2 - K3**2)
        if K2 == 0:
            return _second_order(h, g, (e, K1, K2, K3), torsion, h**2 / 9 * (-d / 2))
        s = e + K3**2 / 24
        T = K2**2 + K3**2
        A = h**2 / 18
        bracket = (g - 6 * e) / 9 + 64 * h**2 * g / (9 * K2**2) - K3**2 / 36
        bracket -= 8 * h**2 * (K2**2 + 2 * K3**2) / (9 * K2**2)
        Q = K2**2 + 2 * K3**2 - 16 * g
        v, v1, v2 = _v(eta, strain[2], Fraction(5, 2))
        energy = s**2 / 2 + K1**2 / 24 + A * T**2 / K2**2 + bracket * g / 2 + v * Q**2 + torsion
        b2 = -128 * h**2 * g / (9 * K2**3) + 32 * h**2 * K3**2 / (9 * K2**3)
        b3 = -32 * h**2 * K3 / (9 * K2**2) - K3 / 18
        gradient = [
            s - g / 3,
            K1 / 12,
            A * (4 * T / K2 - 2 * T**2 / K2**3) + b2 * g / 2 + v1 * Q**2 + 4 * v * Q * K2,
            s * K3 / 12 + A * 4 * T * K3 / K2**2 + b3 * g / 2 + 8 * v * Q * K3 - h**2 * d / 18,
        ]
        b22 = 128 * h**2 * g / (3 * K2**4) - 32 * h**2 * K3**2 / (3 * K2**4)
        b23 = 64 * h**2 * K3 / (9 * K2**3)
        b33 = -32 * h**2 / (9 * K2**2) - mpf(1) / 18
        H22 = A * (8 - 4 * T / K2**2 - 8 * T / K2**2 + 6 * T**2 / K2**4) + b22 * g / 2
        H22 += v2 * Q**2 + 8 * v1 * Q * K2 + v * (8 * K2**2 + 4 * Q)
        H23 = A * (8 * K3 / K2 - 8 * T * K3 / K2**3) + b23 * g / 2 + 8 * v1 * Q * K3 + 16 * v * K2 * K3
        H33 = s / 12 + K3**2 / 144 + A * (4 * T + 8 * K3**2) / K2**2 + b33 * g / 2 + v * (32 * K3**2 + 8 * Q)
        return Value(energy, gradient, _hessian(K3 / 12, H22, H23, H33))


def twist_second_order(eta: float, xi: float, strain: Sequence[float], chiral: float = 0.0) -> Value:
    """Liu, Li & Liu, eq. (59), with the same chirality."""
    with mp.workdps(150):
        h, g, d = exact(eta), exact(xi), exact(chiral)
        K3 = exact(strain[3])
        torsion = h**2 / 18 * ((K3 - d / 2) ** 2 - K3**2)
        return _second_order(h, g, tuple(map(exact, strain)), torsion, h**2 / 9 * (-d / 2))


def _second_order(h: Any, g: Any, strain: Sequence[Any], torsion: Any, dtorsion: Any) -> Value:
    e, K1, K2, K3 = strain
    c2 = (K3**2 + 60 * h**2 - 8 * g) / 1440 - (K3**2 - 8 * g) ** 2 / (80640 * h**2)
    c2_3 = K3 / 720 - (K3**2 - 8 * g) * K3 / (20160 * h**2)
    c2_33 = mpf(1) / 720 - (3 * K3**2 - 8 * g) / (20160 * h**2)
    energy = (e + K3**2 / 24) ** 2 / 2 + K1**2 / 24 + K3**4 / 1440 + K3**2 / 360 * (20 * h**2 - 9 * g)
    energy += -e * g / 3 + g**2 / 10 + K2**2 * c2 + torsion
    gradient = [
        e + K3**2 / 24 - g / 3,
        K1 / 12,
        2 * K2 * c2,
        (e + K3**2 / 24) * K3 / 12 + K3**3 / 360 + K3 / 180 * (20 * h**2 - 9 * g) + K2**2 * c2_3 + dtorsion,
    ]
    H33 = (e + K3**2 / 24) / 12 + K3**2 / 144 + K3**2 / 120 + (20 * h**2 - 9 * g) / 180 + K2**2 * c2_33
    return Value(energy, gradient, _hessian(K3 / 12, 2 * c2, 2 * K2 * c2_3, H33))


def _hessian(He3: Any, H22: Any, H23: Any, H33: Any) -> list[list[Any]]:
    one, zero = mpf(1), mpf(0)
    return [
        [one, zero, zero, He3],
        [zero, one / 12, zero, zero],
        [zero, zero, H22, H23],
        [He3, zero, H23, H33],
    ]


def saddle(eta: float, xi: float, K2: float, form: str) -> tuple[Any, Any, Any]:
    """Soft part of eq. (49), (eta^2/18)(K2 + xi)^2 + V(K2), with its first two K2-derivatives.

    V = eta^(5/2)/(18 sqrt 6) |K2|^(-1/2) F (cos z - cosh z)/(sin z + sinh z), F = K2 (K2 + 2 xi) in the
    published form (the printed square root takes only |K2|), F = (K2 + xi)^2 in the consistent one.
    """
    with mp.workdps(_digits(eta, K2)):
        h, g, k = exact(eta), exact(xi), exact(K2)
        plain = h**2 / 18 * (k + g) ** 2, h**2 / 9 * (k + g), h**2 / 9
        F = (k * (k + 2 * g), 2 * (k + g)) if form == "published" else ((k + g) ** 2, 2 * (k + g))
        if k == 0:  # |K2|^(-1/2) ratio -> -(1/4) sqrt(6/eta) (1 - K2^2/(80 eta^2))
            c, c2 = -(h**2) / 72, h**2 / 72 * 2 * mpf(9) / (4 * 180 * h**2)
            return plain[0] + c * F[0], plain[1] + c * F[1], plain[2] + c * 2 + c2 * F[0]
        v, v1, v2 = _v(eta, K2, Fraction(1, 2))
        return (
            plain[0] + v * F[0],
            plain[1] + v1 * F[0] + v * F[1],
            plain[2] + v2 * F[0] + 2 * v1 * F[1] + 2 * v,
        )


# ---------------------------------------------------------------------------------------------- polynomials


def add(*polys: Poly) -> Poly:
    """Sum of polynomials."""
    n = max(map(len, polys))
    return [sum((p[i] for p in polys if i < len(p)), mpf(0)) for i in range(n)]


def scaled(factor: Any, p: Poly) -> Poly:
    """factor * p."""
    return [factor * c for c in p]


def times(p: Poly, q: Poly) -> Poly:
    """Product of two polynomials."""
    out = [mpf(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        if a:
            for j, b in enumerate(q):
                out[i + j] += a * b
    return out


def derivative(p: Poly, order: int = 1) -> Poly:
    """Derivative of the given order."""
    for _ in range(order):
        p = [i * c for i, c in enumerate(p)][1:] or [mpf(0)]
    return p


def primitive(p: Poly) -> Poly:
    """Primitive that vanishes at 0."""
    return [mpf(0)] + [c / (i + 1) for i, c in enumerate(p)]


def at(p: Poly, x: Any) -> Any:
    """Value at x."""
    total = mpf(0)
    for c in reversed(p):
        total = total * x + c
    return total


def mean(p: Poly) -> Any:
    """Integral over [-1/2, 1/2]."""
    return sum((2 * c / (i + 1) / mpf(2) ** (i + 1) for i, c in enumerate(p) if i % 2 == 0), mpf(0))


def soft(p: Poly) -> Poly:
    """p less its components on 1 and x."""
    return add(p, [-mean(p), -12 * mean([mpf(0), *p])])


def parity(p: Poly, odd: int) -> Poly:
    """The even (0) or odd (1) part."""
    return [c if i % 2 == odd else mpf(0) for i, c in enumerate(p)]


# ------------------------------------------------------------------------------------------ the general law


class Load(NamedTuple):
    """A membrane strain P(x), orthogonal to 1 and x, and a transverse curvature f(x)."""

    P: Poly
    f: Poly


class Deflection:
    """U for one load at one K2: a polynomial and, by parity, Re(c (exp(r(x-1/2)) +- exp(-r(x+1/2))))."""

    def __init__(self, load: Load, K2: Any, D: Any) -> None:
        self.load, self.K2, self.D = load, K2, D
        self.waves: list[tuple[int, Any]] = []
        if K2 == 0:
            self.poly = soft(scaled(-1, primitive(primitive(load.f))))
            return
        lam = K2**2 / D
        self.r = mp.mpc(1, 1) * mp.sqrt(mp.sqrt(lam) / 2)
        term = add(scaled(K2 / D, load.P), scaled(-1, derivative(load.f, 2)))
        self.poly = [mpf(0)]
        while any(term):
            self.poly = add(self.poly, scaled(1 / lam, term))
            term = scaled(-1 / lam, derivative(term, 4))
        half = mpf(1) / 2
        for odd in (0, 1):
            f, p = parity(load.f, odd), parity(self.poly, odd)
            b2 = -at(derivative(p, 2), half) - at(f, half)
            b3 = -at(derivative(p, 3), half) - at(derivative(f), half)
            a2, a3 = self._wave(half, odd, 2), self._wave(half, odd, 3)
            det = a2.imag * a3.real - a2.real * a3.imag  # Re(c a2) = b2, Re(c a3) = b3
            self.waves.append(
                (odd, mp.mpc((a2.imag * b3 - a3.imag * b2) / det, (a2.real * b3 - a3.real * b2) / det))
            )

    def _wave(self, x: Any, odd: int, order: int) -> Any:
        sign = (-1) ** (odd + order)
        return self.r**order * (mp.exp(self.r * (x - mpf(1) / 2)) + sign * mp.exp(-self.r * (x + mpf(1) / 2)))

    def __call__(self, x: Any, order: int = 0) -> Any:
        """U or a derivative of it."""
        return at(derivative(self.poly, order), x) + sum(
            (c * self._wave(x, o, order)).real for o, c in self.waves
        )

    def moment(self, p: Poly, order: int) -> Any:
        """Integral of p(x) times U (order 0) or U'' (order 2)."""
        total = mean(times(p, derivative(self.poly, order)))
        for odd, c in self.waves:
            q, power, integral = parity(p, odd), self.r, mp.mpc(0)
            while any(q):
                integral += (at(q, mpf(1) / 2) - at(q, -mpf(1) / 2) * mp.exp(-self.r)) / power
                q, power = scaled(-1, derivative(q)), power * self.r
            total += 2 * (c * self.r**order * integral).real
        return total


def energy_matrix(loads: Sequence[Load], K2: Any, D: Any) -> list[list[Any]]:
    """A with y A y = min over U of 1/2 int (sum y_i P_i - K2 U)^2 + (D/2) int (U'' + sum y_i f_i)^2."""
    U = [Deflection(load, K2, D) for load in loads]

    def entry(i: int, j: int) -> Any:
        a, b = loads[i], loads[j]
        fixed = mean(times(a.P, b.P)) + D * mean(times(a.f, b.f))
        return (fixed - K2 * U[j].moment(a.P, 0) + D * U[j].moment(a.f, 2)) / 2

    n = len(loads)
    upper = {(i, j): entry(i, j) for i in range(n) for j in range(i, n)}
    return [[upper[min(i, j), max(i, j)] for j in range(n)] for i in range(n)]


FIELDS = ("gamma33", "d33", "d22", "d23", "g21", "g31", "gamma22", "gamma23")


class General:
    """The exact relaxed law for polynomial fields {name: coefficients} and stiffness (Q33, Q22, Q23, G)."""

    def __init__(
        self, eta: float, fields: Mapping[str, Sequence[float]], stiffness: Sequence[Any] = ISOTROPIC
    ) -> None:
        self.eta, self.stiffness = eta, tuple(stiffness)
        self.fields = {name: tuple(fields.get(name, ())) for name in FIELDS}
        self._forms: dict[float, list[list[tuple[Any, Any, Any]]]] = {}

    def _field(self, name: str) -> Poly:
        return [exact(c) for c in self.fields[name]] or [mpf(0)]

    def _constants(self) -> tuple[Any, Any, Any, Any]:
        """nu, D, and the factors of 1/2 b33^2 and 1/2 b23^2."""
        Q33, Q22, Q23, G = map(exact, self.stiffness)
        E33 = Q33 - Q23**2 / Q22
        h2 = exact(self.eta) ** 2
        return Q23 / Q22, h2 * Q22 / (12 * E33), h2 / 12, h2 * G / (3 * E33)

    def loads(self) -> list[Load]:
        """Loads of weight K3^2, K2 and 1."""
        nu = self._constants()[0]
        zero = [mpf(0)]
        f = add(
            scaled(-1, derivative(self._field("g21"))), self._field("d22"), scaled(nu, self._field("d33"))
        )
        twist_load = Load(soft([mpf(0), mpf(0), mpf(1) / 2]), zero)
        return [twist_load, Load(zero, [nu]), Load(soft(scaled(-1, self._field("gamma33"))), f)]

    def digits(self, K2: float) -> int:
        """Digits that leave 60 once the polynomial, of size lambda^-3, has cancelled against the waves."""
        small = mp.log10(abs(exact(K2)) / exact(self.eta)) if K2 else mpf(-30)
        return 160 + int(-16 * min(small, 0))

    def forms(self, K2: float) -> list[list[tuple[Any, Any, Any]]]:
        """Entries of `energy_matrix` with two K2-derivatives; kept, as grids share K2."""
        if K2 not in self._forms:
            with mp.workdps(self.digits(K2)):
                loads, D, k, step = (
                    self.loads(),
                    self._constants()[1],
                    exact(K2),
                    exact(self.eta) * mpf(10) ** -30,
                )
                low, mid, high = (energy_matrix(loads, k + s * step, D) for s in (-1, 0, 1))
                self._forms[K2] = [
                    [
                        (b, (c - a) / (2 * step), (c - 2 * b + a) / step**2)
                        for a, b, c in zip(*rows, strict=True)
                    ]
                    for rows in zip(low, mid, high, strict=True)
                ]
        return self._forms[K2]

    def __call__(self, strain: Sequence[float]) -> Value:
        """Energy, gradient and Hessian at a strain (eps, K1, K2, K3)."""
        A = self.forms(strain[2])
        with mp.workdps(DIGITS + 60):
            e, K1, K2, K3 = map(exact, strain)
            _, _, cb, ct = self._constants()
            gamma, d33 = self._field("gamma33"), self._field("d33")
            stretch = e + K3**2 / 24 - mean(gamma)
            bend = K1 - 12 * mean([mpf(0), *gamma])
            b23 = scaled(mpf(1) / 2, add(derivative(self._field("g31")), scaled(-1, self._field("d23"))))
            y, dy = (K3**2, K2, mpf(1)), (2 * K3, mpf(0), mpf(0))  # dy by K3; dy by K2 is the unit vector 1

            def form(order: int, a: Sequence[Any], b: Sequence[Any]) -> Any:
                return sum(a[i] * A[i][j][order] * b[j] for i in range(3) for j in range(3))

            unit, ddy = (mpf(0), mpf(1), mpf(0)), (mpf(2), mpf(0), mpf(0))
            energy = stretch**2 / 2 + bend**2 / 24 + form(0, y, y)
            energy += cb / 2 * (K2**2 + 2 * K2 * mean(d33) + mean(times(d33, d33)))
            energy += ct / 2 * (K3**2 + 2 * K3 * mean(b23) + mean(times(b23, b23)))
            gradient = [
                stretch,
                bend / 12,
                cb * (K2 + mean(d33)) + form(1, y, y) + 2 * form(0, unit, y),
                stretch * K3 / 12 + ct * (K3 + mean(b23)) + 2 * form(0, dy, y),
            ]
            H22 = cb + form(2, y, y) + 4 * form(1, unit, y) + 2 * form(0, unit, unit)
            H23 = 2 * form(1, dy, y) + 2 * form(0, dy, unit)
            H33 = stretch / 12 + K3**2 / 144 + ct + 2 * form(0, ddy, y) + 2 * form(0, dy, dy)
            return Value(energy, gradient, _hessian(K3 / 12, H22, H23, H33))

    def deflection(self, strain: Sequence[float], x: Sequence[float], order: int = 0) -> list[Any]:
        """U or a derivative of it at the points x."""
        with mp.workdps(self.digits(strain[2])):
            K2, K3 = exact(strain[2]), exact(strain[3])
            y = (K3**2, K2, mpf(1))
            loads = self.loads()
            parts = (
                [scaled(w, p) for w, p in zip(y, part, strict=True)] for part in zip(*loads, strict=True)
            )
            total = Load(*(add(*part) for part in parts))
            U = Deflection(total, K2, self._constants()[1])
            return [U(exact(t), order) for t in x]
