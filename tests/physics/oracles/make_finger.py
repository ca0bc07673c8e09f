#!/usr/bin/env python3
"""Computes how surfaces move under a finger, by two-dimensional finite elements.

    python3 make_finger.py > finger.csv

Needs python3-numpy, python3-scipy and scikit-fem. The finger is a uniform pressure over a disc of 4 mm radius, and its
velocity is the mean velocity of the surface over the disc. The mesh covers half of the strip; a disc beside the centre
line is the sum of an even and an odd load. There are three surfaces, all with Q = 60 (an imaginary part of the stiffness):
  brass      the 1998 paper's membrane (quadrilaterals of degree 4)
  kirchhoff  the plate of aluminium_plate() as a thin plate (Argyris triangles)
  mindlin    the same plate with shear and rotary inertia (degree 4, as in make_mindlin_taper.py)

Columns: surface; frequency (Hz); x and y of the disc's centre (m); unloaded motion (real, imaginary), which is the mean
over the disc if the centre of the drive edge moves by 1; mobility (real, imaginary), which is the mean velocity per force
in m/(N s). A finger of impedance Z leaves 1 / (1 + Z mobility) of the unloaded motion. For each frequency, one direct
solution with the finger as part of the matrix confirms this. With a mesh 1.5 times finer, the relative change of all
values is below 1e-3.
"""
import sys
import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
import skfem as fe
from skfem.helpers import ddot, dd, grad
from scipy.optimize import brentq
from make_mindlin_taper import D, E, H, J, L, M, NU, RHO, S, SLOPE, W0, cut_off_shape

Q, RADIUS, FINE = 60, 4e-3, float(sys.argv[1]) if len(sys.argv) > 1 else 1
BRASS = dict(rho=8110, tension=5.12e9, h=0.05e-3, w0=0.03, slope=0.1, length=0.299)


def graded(nx, ny, length, w0, slope, quads):
    x = np.linspace(0, length, nx + 1)
    x = np.unique(np.r_[x, length / nx * np.array([0.02, 0.1, 0.3, 0.6])])
    y = 1 - (1 - np.linspace(0, 1, ny + 1)) ** 1.3
    m = (fe.MeshQuad if quads else fe.MeshTri).init_tensor(x, y)
    near = lambda i, v: (lambda p: np.isclose(p[i], v))
    m = m.with_boundaries(dict(drive=near(0, 0), end=near(0, length), side=near(1, 1), centre=near(1, 0)))
    p = m.p.copy()
    p[1] *= w0 - slope * p[0]
    return m, type(m)(p, m.t)


def disc(x, y, half_width):
    """Returns points and weights for a mean over the part of the disc on the strip, and the sign of an odd field there."""
    r, wr = np.polynomial.legendre.leggauss(12)
    r, wr = (r + 1) / 2, wr / 2
    a = 2 * np.pi * (np.arange(48) + 0.5) / 48
    rr, aa = np.meshgrid(r, a)
    weight = np.broadcast_to(2 * r * wr, rr.shape) / 48
    px, py = x + RADIUS * rr * np.cos(aa), y + RADIUS * rr * np.sin(aa)
    inside = np.abs(py) < half_width(px)
    return px[inside], np.abs(py[inside]), weight[inside], np.sign(py[inside])


class Strip:
    """Holds stiffness and mass of half the strip, the held unknowns for each parity, and the drive edge's motion."""
    def mean(self, x, y, odd):
        px, py, w, sign = disc(x, y, self.half_width)
        row = self.basis.probes(np.array([px, py + 1e-13])).T @ (w * (sign if odd else 1))
        return np.r_[np.zeros(self.first), row, np.zeros(self.k.shape[0] - self.first - row.size)]

    def at(self, f, places):
        o, answer = 2 * np.pi * f, []
        a = (2 * self.stiff * self.k - 2 * o * o * self.m).tocsc()
        u, free, lu = self.u.astype(complex), {}, {}
        for odd in (False, True):
            free[odd] = np.setdiff1d(np.arange(a.shape[0]), self.held(odd))
            lu[odd] = sla.splu(a[free[odd]][:, free[odd]].tocsc())
        rest = self.held(False)
        u[free[False]] = lu[False].solve(-a[free[False]][:, rest] @ u[rest])
        for n, (x, y) in enumerate(places):
            mobility = 0
            for odd in (False, True):
                l = self.mean(x, y, odd)[free[odd]]
                mobility += 1j * o * (l @ lu[odd].solve(l.astype(complex)))
            l = self.mean(x, y, False)
            answer.append((x, y, l @ u, mobility))
            if n == 0:  # check with the finger as part of the matrix
                z, i = 40 + 20j, free[False]
                s = sp.csc_matrix(l[i]).T
                loaded = sla.spsolve((a[i][:, i] + 1j * o * z * (s @ s.T)).tocsc(), -a[i][:, rest] @ u[rest])
                assert y == 0 and abs((l[i] @ loaded) / (l @ u) * (1 + z * mobility) - 1) < 1e-4
        return answer


class Brass(Strip):
    first = 0

    def __init__(self):
        b = BRASS
        named, m = graded(int(75 * FINE), int(8 * FINE), b["length"], b["w0"], b["slope"], True)
        self.basis = fe.Basis(m, fe.ElementQuadP(4), intorder=10)
        self.half_width = lambda x: b["w0"] - b["slope"] * x
        self.k = b["tension"] * b["h"] * fe.BilinearForm(lambda u, v, w: fe.helpers.dot(grad(u), grad(v))).assemble(self.basis)
        self.m = b["rho"] * b["h"] * fe.BilinearForm(lambda u, v, w: u * v).assemble(self.basis)
        self.stiff = 1 / (1 - 0.5j / Q) ** 2
        self.dofs = {n: self.basis.get_dofs(facets=f).all() for n, f in named.boundaries.items()}
        edge = fe.FacetBasis(m, fe.ElementQuadP(4), facets=named.boundaries["drive"], intorder=12)
        at = self.dofs["drive"]
        gram = fe.BilinearForm(lambda u, v, w: u * v).assemble(edge).toarray()[np.ix_(at, at)]
        load = fe.LinearForm(lambda v, w: v * np.cos(np.pi / 2 / b["w0"] * w.x[1])).assemble(edge)[at]
        self.u = np.zeros(self.basis.N)
        self.u[at] = np.linalg.solve(gram, load)

    def held(self, odd):
        names = ["drive", "side", "end"] + ["centre"] * odd
        return np.unique(np.concatenate([self.dofs[n] for n in names]))


class Mindlin(Strip):
    def __init__(self):
        from make_mindlin_taper import system
        self.basis, self.k, self.m, self.dofs, drive = system(int(60 * FINE), int(7 * FINE))
        n = self.first = 0
        n = self.basis.N
        self.half_width = lambda x: W0 - SLOPE * x
        self.stiff = 1 / (1 - 0.5j / Q) ** 4
        self.u = np.zeros(3 * n)
        self.u[self.dofs["drive"]], self.u[2 * n + self.dofs["drive"]] = drive

    def held(self, odd):
        n = self.basis.N
        all = [self.dofs[name] + i * n for name in ("drive", "end", "side") for i in range(3)]
        return np.unique(np.concatenate(all + [self.dofs["centre"] + i * n for i in ((0, 1) if odd else (2,))]))


class Kirchhoff(Strip):
    first = 0

    def __init__(self):
        named, m = graded(int(90 * FINE), int(8 * FINE), L, W0, SLOPE, False)
        self.basis = fe.Basis(m, fe.ElementTriArgyris(), intorder=8)
        self.half_width = lambda x: W0 - SLOPE * x
        law = lambda u, v, w: (1 - NU) * ddot(dd(u), dd(v)) + NU * (dd(u)[0, 0] + dd(u)[1, 1]) * (dd(v)[0, 0] + dd(v)[1, 1])
        k = D * fe.BilinearForm(law).assemble(self.basis)
        mm = M * fe.BilinearForm(lambda u, v, w: u * v).assemble(self.basis)
        self.stiff = 1 / (1 - 0.5j / Q) ** 4
        nodal, facet = self.basis.nodal_dofs, self.basis.facet_dofs  # u, u_x, u_y, u_xx, u_xy, u_yy; normal slope
        ends = {n: np.unique(m.facets[:, f]) for n, f in named.boundaries.items()}
        # along a side the second derivatives are in the side's own directions: tangent, mixed, normal
        t = np.array([1, -SLOPE]) / np.hypot(1, SLOPE)
        n = np.array([-t[1], t[0]])
        pair = lambda a, b: [a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1]]
        turn = np.linalg.inv(np.array([pair(t, t), pair(t, n), pair(n, n)]))
        change = sp.eye(self.basis.N).tolil()
        for v in ends["side"]:
            for a in range(3):
                for b in range(3):
                    change[nodal[3 + a, v], nodal[3 + b, v]] = turn[a, b]
        self.change = change.tocsr()
        self.k, self.m = (self.change.T @ k @ self.change).tocsc(), (self.change.T @ mm @ self.change).tocsc()
        rows = dict(drive=(0, 1, 2, 4, 5), end=(0, 1, 2, 4, 5), side=(0, 1, 2, 3, 4))
        self.fixed = [nodal[r, ends[n]] for n in rows for r in rows[n]] + [facet[0, named.boundaries[n]] for n in rows]
        self.parity = {False: [nodal[r, ends["centre"]] for r in (2, 4)] + [facet[0, named.boundaries["centre"]]],
                       True: [nodal[r, ends["centre"]] for r in (0, 1, 3, 5)]}
        beta = brentq(lambda b: np.tan(b) + np.tanh(b), 1.6, 3.1)
        c = beta / W0
        unit = 1 / np.cos(beta) - 1 / np.cosh(beta)
        y = m.p[1, ends["drive"]]
        self.u = np.zeros(self.basis.N)
        self.u[nodal[0, ends["drive"]]] = (np.cos(c * y) / np.cos(beta) - np.cosh(c * y) / np.cosh(beta)) / unit
        self.u[nodal[2, ends["drive"]]] = -c * (np.sin(c * y) / np.cos(beta) + np.sinh(c * y) / np.cosh(beta)) / unit
        bend = -c * c * (np.cos(c * y) / np.cos(beta) + np.cosh(c * y) / np.cosh(beta)) / unit
        corner = np.intersect1d(ends["drive"], ends["side"])
        self.u[nodal[5, ends["drive"]]] = np.where(np.isin(ends["drive"], corner), 0, bend)

    def mean(self, x, y, odd):
        return self.change.T @ super().mean(x, y, odd)

    def held(self, odd):
        return np.unique(np.concatenate(self.fixed + self.parity[odd]))


# positions in m along the centre line, from the middle of the smooth zone to the point with 10 % of the amplitude
PLACES = dict(brass={19.6e3: (.05, .12, .165, .185, .205), 30e3: (.1, .18, .225, .235)},
              plate={22.4e3: (.05, .08, .095, .115), 30e3: (.05, .1, .135, .15, .165), 40e3: (.05, .12, .165, .19, .205)})

if __name__ == "__main__":
    for name, kind in (("brass", Brass), ("kirchhoff", Kirchhoff), ("mindlin", Mindlin)):
        strip = kind()
        for f, xs in PLACES["brass" if name == "brass" else "plate"].items():
            places = [(x, 0) for x in xs] + [(xs[i], y) for i, y in ((1, 1.5e-3), (2, 3e-3))]
            for x, y, unloaded, mobility in strip.at(f, places):
                figures = [f, x, y, unloaded.real, unloaded.imag, mobility.real, mobility.imag]
                print(name + "," + ",".join(f"{c:.8g}" for c in figures), flush=True)
