#!/usr/bin/env python3
"""Computes two-dimensional fields of 200 random surfaces by finite elements.

    python3 make_modes.py > modes.csv

Needs python3-numpy, python3-scipy and scikit-fem. There are 160 membranes with linear, exponential and tabulated tapers,
some of the tables with steep steps, and 40 clamped plates with linear tapers, so that both kinds of drive occur on each.
A membrane's half is a rectangle in x and y/W, meshed with triangles of degree 4; a plate's half is meshed with Argyris
triangles. If the drive is a piston, the triangles are refined towards the corner of the drive edge, where the displacement
jumps from one to zero at the held side. A scene is drawn again if two meshes differ by more than 2e-5 (clamped plates
with a piston: 2e-3), which happens near resonances without loss.

Columns: kind (membrane or clamped), drive, taper, frequency in Hz, Q (0: lossless), length in m, number of taper numbers and
these: W0 and slope, W0 and decay length, or x and W of each point. Then |v| on the centre line at x = 0.025 L, 0.075 L, ...,
0.975 L, with |v| = 1 at the centre of the drive edge; the largest |v|; |v| at its last maximum; the outermost x in m at which
it is half of that. The last three columns say how much a coarser mesh changes the values, relative to the largest |v|,
the maximum, relative to itself, and the position, in m. The membrane has c = 800 m/s; the plate is 2 mm of aluminium (E = 69 GPa, nu = 0.33, rho = 2700).
"""
import sys

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
import skfem as fe
from skfem.helpers import dd, ddot

C, F, H, E, NU, RHO = 800.0, 20000.0, 2e-3, 69e9, 0.33, 2700.0
CUT = C / (4 * F)  # cut-off half-width of the membrane


class Taper:
    def __init__(self, kind, numbers):
        self.kind, self.numbers = kind, numbers
        if kind == "table":
            x, w = np.array(numbers[0::2]), np.array(numbers[1::2])
            self.x, h, d = x, np.diff(x), np.diff(w) / np.diff(x)
            a, b = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
            m = np.r_[self.end(h[0], h[1], d[0], d[1]), (a + b) / (a / d[:-1] + b / d[1:]),
                      self.end(h[-1], h[-2], d[-1], d[-2])]
            self.c = (w[:-1], m[:-1], (3 * d - 2 * m[:-1] - m[1:]) / h, (m[:-1] + m[1:] - 2 * d) / h**2)

    @staticmethod
    # returns the slope at an end of the table (Fritsch & Carlson), for a table that only falls
    def end(h0, h1, d0, d1):
        s = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1)
        return d0 / 3 if s >= 0 else max(s, 3 * d0)

    def __call__(self, x):
        """Returns W and W'."""
        if self.kind == "linear":
            return self.numbers[0] - self.numbers[1] * x, -self.numbers[1] + 0 * x
        if self.kind == "exponential":
            w = self.numbers[0] * np.exp(-x / self.numbers[1])
            return w, -w / self.numbers[1]
        i = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, len(self.x) - 2)
        t, (y, m, p, q) = x - self.x[i], [c[i] for c in self.c]
        return y + t * (m + t * (p + t * q)), m + t * (2 * p + 3 * t * q)

    def knots(self, end):
        return [x for x in (self.x[1:-1] if self.kind == "table" else []) if x < end]


def steps(taper, k, end, size):
    """Returns the x of a mesh: `size` radians or a part of the half-width, with table points among them."""
    x, stops = [0.0], taper.knots(end) + [end]
    while x[-1] < end * (1 - 1e-12):
        w, h = taper(x[-1])[0], 0
        h = min(size / k, 0.5 * size * w)
        while taper(min(x[-1] + h, end))[0] < (1 - 0.3 * size) * w:
            h *= 0.8
        stop = next(s for s in stops if s > x[-1] * (1 + 1e-12) + 1e-15)
        room = stop - x[-1]
        x.append(stop if room <= 1.001 * h else x[-1] + room / np.ceil(room / h))
    return np.array(x)


def towards_corner(m, times):
    for _ in range(times):
        corner = np.flatnonzero((m.p[0] == 0) & (m.p[1] == 1))
        m = m.refined(np.flatnonzero(np.isin(m.t, corner).any(axis=0)))
    return m


def domain_end(taper, k, length, cut, rate):
    """Returns where the field has decayed by e^-30 beyond its turning point, or the length."""
    x = np.linspace(0, length * (1 - 1e-6), 40001)
    w = taper(x)[0]
    decay = np.cumsum(np.sqrt(np.maximum(0, (cut / w) ** 2 - 1)) * rate) * (x[1] - x[0])
    return length if decay[-1] < 30 and taper(length)[0] > 1e-4 * taper(0.0)[0] else x[min(np.searchsorted(decay, 30), 39999)]


def membrane(s, size):
    taper, k = s["taper"], 2 * np.pi * F / C
    end = domain_end(taper, k, s["length"], CUT, k)
    w0 = taper(0.0)[0]
    m = fe.MeshTri.init_tensor(steps(taper, k, end, size), np.linspace(0, 1, int(np.ceil(max(3, k * w0) / (1.3 * size))) + 1))
    m = towards_corner(m, 10 if s["drive"] == "piston" else 2)
    basis = fe.Basis(m, fe.ElementTriP4(), intorder=12)
    x = basis.global_coordinates().value
    w, slope = taper(x[0])
    k2 = (k * (1 - (0.5j / s["q"] if s["q"] else 0))) ** 2

    @fe.BilinearForm
    def stiffness(u, v, p):  # the coordinates are x and y = W eta
        ux, vx = (a.grad[0] - p.x[1] * p["slope"] / p["w"] * a.grad[1] for a in (u, v))
        return p["w"] * (ux * vx + u.grad[1] * v.grad[1] / p["w"] ** 2)

    @fe.BilinearForm
    def mass(u, v, p):
        return p["w"] * u * v

    a = stiffness.assemble(basis, w=w, slope=slope) - k2 * mass.assemble(basis, w=w)
    at = lambda which: basis.get_dofs(which).all()
    edge, held = at(lambda p: p[0] == 0), np.union1d(at(lambda p: p[1] == 1), at(lambda p: p[0] == m.p[0].max()))
    u = np.zeros(a.shape[0], complex)
    u[edge] = 1 if s["drive"] == "piston" else np.cos(np.pi / 2 * basis.doflocs[1][edge])
    u[held] = 0
    return centre(basis, a, u, np.union1d(edge, held), end)


def clamped_root():
    """Returns k W of a clamped strip at its cut-off: tan b = -tanh b."""
    low, high = np.pi / 2 + 1e-9, np.pi
    for _ in range(100):
        b = 0.5 * (low + high)
        low, high = (b, high) if np.sin(b) + np.tanh(b) * np.cos(b) > 0 else (low, b)
    return b


ROOT = clamped_root()
STIFF = E * H**3 / (12 * (1 - NU**2))
PLATE_K = ((RHO * H * (2 * np.pi * F) ** 2) / STIFF) ** 0.25


def clamped(s, size):
    taper, k = s["taper"], PLATE_K
    end, w0 = s["length"], taper(0.0)[0]
    m = fe.MeshTri.init_tensor(steps(taper, k, end, 1.2 * size), np.linspace(0, 1, int(np.ceil(max(3, k * w0) / size)) + 1))
    m = towards_corner(m, 9 if s["drive"] == "piston" else 2)
    named = m.with_boundaries(dict(drive=lambda p: p[0] == 0, end=lambda p: p[0] == m.p[0].max(),
                                   side=lambda p: p[1] == 1, centre=lambda p: p[1] == 0))
    p = m.p.copy()
    p[1] *= taper(p[0])[0]
    m = fe.MeshTri(p, m.t)
    basis = fe.Basis(m, fe.ElementTriArgyris(), intorder=9)
    k4 = (k * (1 - (0.5j / s["q"] if s["q"] else 0))) ** 4
    bend = fe.BilinearForm(lambda u, v, w: ddot(dd(u), dd(v))).assemble(basis)
    a = bend - k4 * fe.BilinearForm(lambda u, v, w: u * v).assemble(basis)
    nodal, facet = basis.nodal_dofs, basis.facet_dofs  # u, u_x, u_y, u_xx, u_xy, u_yy; normal slope
    ends = {n: np.unique(m.facets[:, f]) for n, f in named.boundaries.items()}
    u = np.zeros(a.shape[0], complex)
    y = m.p[1][ends["drive"]]
    if s["drive"] == "piston":
        u[nodal[0, ends["drive"]]] = 1
    else:
        b, e = ROOT, y / w0
        unit = 1 / np.cos(b) - 1 / np.cosh(b)
        for row, values in ((0, (np.cos(b * e) / np.cos(b) - np.cosh(b * e) / np.cosh(b)) / unit),
                            (2, b / w0 * (-np.sin(b * e) / np.cos(b) - np.sinh(b * e) / np.cosh(b)) / unit),
                            (5, (b / w0) ** 2 * (-np.cos(b * e) / np.cos(b) - np.cosh(b * e) / np.cosh(b)) / unit)):
            u[nodal[row, ends["drive"]]] = values
    # unit vector along the side
    t = np.array([1, -s["taper"].numbers[1]]) / np.hypot(1, s["taper"].numbers[1])
    # Along a side, u, its slopes and its second derivative along the side vanish. So u_xx and u_xy follow
    # from u_yy there.
    held = [nodal[[0, 1, 2, 4, 5]][:, ends["drive"]].ravel(), facet[0, named.boundaries["drive"]],
            nodal[[0, 1, 2, 4, 5]][:, ends["end"]].ravel(), facet[0, named.boundaries["end"]],
            nodal[[0, 1, 2]][:, ends["side"]].ravel(), facet[0, named.boundaries["side"]],
            nodal[[2, 4]][:, ends["centre"]].ravel(), facet[0, named.boundaries["centre"]]]
    corner = np.intersect1d(ends["side"], np.union1d(ends["drive"], ends["end"]))
    held = np.unique(np.concatenate(held + [nodal[:, corner].ravel()]))
    u[nodal[:, corner]] = 0
    # At the inner vertices of a side, the second derivatives are g (n n^T) with the normal n and the single
    # unknown g = u_yy / n_y^2.
    inner = np.setdiff1d(ends["side"], corner)
    ny2, nx_ny, nx2 = t[0] ** 2, -t[0] * t[1], t[1] ** 2
    q = sp.identity(a.shape[0], format="lil")
    for v in inner:
        q[nodal[3, v], nodal[3, v]] = q[nodal[4, v], nodal[4, v]] = 0
        q[nodal[3, v], nodal[5, v]] = nx2 / ny2
        q[nodal[4, v], nodal[5, v]] = nx_ny / ny2
    q = q.tocsr()
    held = np.union1d(held, nodal[[3, 4]][:, inner].ravel())
    u = q @ u
    return centre(basis, (q.T @ a @ q), u, held, end, q)


def centre(basis, a, u, held, end, join=None):
    free = np.setdiff1d(np.arange(len(u)), held)
    a = a.tocsc()
    u[free] = sla.spsolve(a[free][:, free], -(a[free][:, held] @ u[held]))
    if join is not None:
        u = join @ u

    def values(x):
        x = np.atleast_1d(x)
        v = np.zeros(x.shape)
        inside = x < end
        v[inside] = np.abs(basis.probes(np.array([x[inside], 1e-12 + 0 * x[inside]])) @ u)
        return v
    return values


def figures(values, length, turning):
    x = np.linspace(0, length, 3001)[:-1]
    v = values(x)
    top = np.flatnonzero((v[1:-1] > v[:-2]) & (v[1:-1] >= v[2:]) & (x[1:-1] < turning))[-1] + 1
    h = x[1]
    near = np.linspace(x[top] - h, x[top] + h, 21)
    fit = np.polynomial.Polynomial.fit(near, values(near), 4)
    inside = [r.real for r in fit.deriv().roots() if abs(r.imag) < 1e-9 and abs(r.real - x[top]) <= h]
    peak = fit(inside[0]) if inside else v[top]
    beyond = np.flatnonzero(v >= 0.5 * peak)[-1]
    near = np.linspace(x[beyond], x[beyond] + h, 15)
    fit = np.polynomial.Polynomial.fit(near, np.log(values(near) / (0.5 * peak)), 5)
    edge = next(r.real for r in fit.roots() if abs(r.imag) < 1e-9 and x[beyond] - h / 9 <= r.real <= x[beyond] + 1.1 * h)
    return values(length * (0.025 + 0.05 * np.arange(20))), max(v.max(), 1), peak, edge


def draw(rng, number):
    plate, drive = number >= 160, "piston" if rng.random() < 0.4 else "cosine"
    q = 0.0 if rng.random() < 0.3 else float(np.exp(rng.uniform(np.log(5), np.log(2000))))
    kind = "linear" if plate else ("linear", "exponential", "table", "steps")[number % 4]
    if plate:
        cut, slope, ratio = ROOT / PLATE_K, float(np.exp(rng.uniform(np.log(0.05), np.log(0.3)))), rng.uniform(1.2, 2.5)
        return dict(kind="clamped", drive=drive, q=q, taper=Taper("linear", [ratio * cut, slope]),
                    length=(ratio - rng.uniform(0.3, 0.6)) * cut / slope)
    ratio, slope = rng.uniform(1.15, 10), float(np.exp(rng.uniform(np.log(0.05), np.log(0.5))))
    w0, length = ratio * CUT, ratio * CUT / slope
    if kind == "linear":
        taper, length = Taper(kind, [w0, slope]), length * rng.uniform(0.9, 1)
    elif kind == "exponential":
        taper, length = Taper(kind, [w0, CUT / slope]), CUT / slope * (np.log(ratio) + 1.8)
    elif kind == "table":
        length *= 0.95
        taper = Taper("table", [0.0, w0, length * 0.3, w0 * rng.uniform(0.65, 0.8), length * 0.6, w0 * rng.uniform(0.35, 0.5),
                                length, 0.05 * w0])
    else:
        points, x, w, n = [0.0, w0], 0.0, w0, int(rng.integers(4, 7))
        for i in range(1, n):
            x += length / (n - 1) * rng.uniform(0.6, 1.4)
            left, share = w - 0.05 * w0, rng.uniform(0.4, 0.8) if rng.random() < 0.5 else rng.uniform(0.005, 0.05)
            w -= left if i == n - 1 else left * share
            points += [x, w]
        taper, length = Taper("table", points), x
    return dict(kind="membrane", drive=drive, q=q, taper=taper, length=length)


def row(number):
    rng = np.random.default_rng([20260105, number])
    while True:
        s = draw(rng, number)
        s["taper"].numbers = [float(n) for n in s["taper"].numbers]
        s["length"] = float(s["length"])
        solve = clamped if s["kind"] == "clamped" else membrane
        cut = ROOT / PLATE_K if solve is clamped else CUT
        x = np.linspace(0, s["length"], 10001)
        turning = x[np.count_nonzero(s["taper"](x)[0] > cut)]
        if turning < 0.05 * s["length"]:
            continue  # the edge is too close to the drive edge to be used
        try:
            (a, _, peak_a, edge_a), (b, most, peak, edge) = (figures(solve(s, size), s["length"], turning)
                                                           for size in (0.85, 0.6))
        except (StopIteration, IndexError):
            continue
        off = np.max(np.abs(a - b)) / most
        if off < (2e-3 if solve is clamped and s["drive"] == "piston" else 2e-5):
            break
    cells = [s["kind"], s["drive"], s["taper"].kind, repr(F), repr(s["q"]), repr(s["length"]), str(len(s["taper"].numbers))]
    cells += [repr(n) for n in s["taper"].numbers] + ["%.8e" % v for v in b] + ["%.8e" % most, "%.8e" % peak, "%.8e" % edge]
    return ",".join(cells + ["%.1e" % off, "%.1e" % abs(peak_a / peak - 1), "%.1e" % abs(edge_a - edge)])


if __name__ == "__main__":
    for number in [int(n) for n in sys.argv[1:]] or range(200):
        print(row(number), flush=True)
