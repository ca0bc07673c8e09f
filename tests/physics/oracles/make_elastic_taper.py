#!/usr/bin/env python3
"""Computes where a tapered plate stops moving, by three-dimensional elastic finite elements of the whole plate.

    python3 make_elastic_taper.py > elastic_taper.csv

Needs python3-numpy, python3-scipy and scikit-fem; takes five minutes of one core and 5 GB. The plate is that of the
simulated rig: 3 mm aluminium, half-width 15.1 mm, slope 0.03, length 0.3 m, Q = 60 (an imaginary part of omega^2). The
elements are hexahedra with quadratic displacements. The mesh covers a quarter of the plate, 0 < y < W(x) and
0 < z < h/2. This is exact: the deflection is even in y and in z, the other displacements are odd in z, and u_y is odd
in y. The sides and the far end are held over the whole thickness; the faces are free. The drive edge moves in the
shape of the first cut-off at its own width, by plane-strain elements of the same mesh, without motion along x.

Columns: frequency (Hz), then the positions of the edges peak, p50 and p10 on the centre line (m) from the fine mesh,
then the same from the coarse mesh, which has less than half as many elements. The stress is singular where the clamp
meets a free face, and that is most of what is left: by plane-strain elements on the same y and z, the coarse mesh puts
a boundary at 30 kHz 0.12 mm too far in, the fine one 0.04 mm. So the fine mesh is about half the difference between
the two away from the limit.
"""
import sys
import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
import skfem as fe
from scipy.optimize import brentq
from skfem.helpers import ddot, dot, eye, sym_grad, trace

E, NU, RHO, H, W0, SLOPE, L, Q = 69e9, 0.33, 2700, 3e-3, 15.1e-3, 0.03, 0.3, 60
MU, LAME = E / 2 / (1 + NU), E * NU / (1 + NU) / (1 - 2 * NU)


MESHES = dict(fine=(72, 8, 0.5, 3), coarse=(60, 6, 0, 2))  # elements along x and across, middle in z, layers


def grids(nx, ny, middle, layers):
    g = 0.3 ** np.arange(layers + 1)  # each layer towards the corner between clamp and free face is thinner
    y = np.r_[np.linspace(0, 0.8, ny + 1)[:-1], 1 - 0.2 * g, 1]
    z = H / 2 * np.r_[0, 1 - (1 - middle) * g, 1]
    return np.linspace(0, L, nx + 1), np.unique(y), np.unique(z)


def stiffness(u, v, w):
    d = 2 * MU * sym_grad(u)
    return ddot(d + LAME * eye(trace(sym_grad(u)), d.shape[0]), sym_grad(v))


def mass(u, v, w):
    return RHO * dot(u, v)


def where(basis, component, near):
    """Returns the unknowns of one displacement at nodes for which near(positions) is true."""
    dofs = basis.get_dofs(elements=True).all(component)
    return dofs[near(basis.doflocs[:, dofs])]


def drive(y, z):
    """Returns (positions, u_y) and (positions, u_z) of the first cut-off at the drive edge, with u_z(0, 0) = 1."""
    basis = fe.Basis(fe.MeshQuad.init_tensor(y * W0, z), fe.ElementVector(fe.ElementQuad2()), intorder=5)
    k, m = (fe.BilinearForm(form).assemble(basis) for form in (stiffness, mass))
    held = np.r_[where(basis, "u^1", lambda p: np.isclose(p[0], W0) | np.isclose(p[0], 0) | np.isclose(p[1], 0)),
                 where(basis, "u^2", lambda p: np.isclose(p[0], W0))]
    free = np.setdiff1d(np.arange(basis.N), held)
    u = np.zeros(basis.N)
    u[free] = sla.eigsh(k[free][:, free], k=1, M=m[free][:, free], sigma=0)[1][:, 0]
    parts = [where(basis, name, lambda p: p[0] >= 0) for name in ("u^1", "u^2")]
    centre = where(basis, "u^2", lambda p: np.isclose(p[0], 0) & np.isclose(p[1], 0))
    return [(basis.doflocs[:, d], u[d] / u[centre]) for d in parts]


def plate(mesh):
    x, y, z = grids(*MESHES[mesh])
    mesh = fe.MeshHex.init_tensor(x, y, z)
    p = mesh.p.copy()
    p[1] *= W0 - SLOPE * p[0]
    basis = fe.Basis(fe.MeshHex(p, mesh.t), fe.ElementVector(fe.ElementHex2()), intorder=5)
    k, m = (fe.BilinearForm(form).assemble(basis) for form in (stiffness, mass))
    at = basis.doflocs
    side = lambda p: np.isclose(p[1], W0 - SLOPE * p[0], atol=1e-9)
    ends = lambda p: np.isclose(p[0], L, atol=1e-9) | np.isclose(p[0], 0, atol=1e-9) | side(p)
    held = np.unique(np.r_[where(basis, "u^1", lambda p: ends(p) | np.isclose(p[2], 0)),
                           where(basis, "u^2", lambda p: ends(p) | np.isclose(p[2], 0) | np.isclose(p[1], 0)),
                           where(basis, "u^3", ends)])
    u = np.zeros(basis.N)
    for name, (places, values) in zip(("u^2", "u^3"), drive(y, z)):
        dofs = where(basis, name, lambda p: np.isclose(p[0], 0, atol=1e-9))
        order = lambda q: np.lexsort((np.round(q[1], 9), np.round(q[0], 9)))
        to, source = dofs[order(at[1:, dofs])], order(places)
        assert np.allclose(at[1:, to], places[:, source], atol=1e-9)
        u[to] = values[source]
    centre = where(basis, "u^3", lambda p: np.isclose(p[1], 0) & np.isclose(p[2], 0))
    centre = centre[np.argsort(at[0, centre])]
    return k, m, held, u, centre, at[0, centre]


def edges(problem, f):
    k, m, held, u, centre, x = problem
    lossy = (1 - 0.5j / Q) ** 4
    a = (k - (2 * np.pi * f) ** 2 * lossy * m).tocsc()
    free = np.setdiff1d(np.arange(k.shape[0]), held)
    lu = sla.splu(a[free][:, free], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options=dict(SymmetricMode=True))
    v = u.astype(complex)
    v[free] = lu.solve(-(a[free][:, held] @ u[held]))
    v = v[centre]
    # The displacement is a quadratic in each element, given by the values at its two ends and its middle.
    def value(s):
        e = min(int(s / (x[2] - x[0])), len(x) // 2 - 1)
        t = (s - x[2 * e]) / (x[2 * e + 2] - x[2 * e])
        return abs(v[2 * e] * (1 - t) * (1 - 2 * t) + v[2 * e + 1] * 4 * t * (1 - t) + v[2 * e + 2] * t * (2 * t - 1))
    fine = np.linspace(0, L * 0.99, 4000)
    a = np.array([value(s) for s in fine])
    last = max(i for i in range(1, len(a) - 1) if a[i] > a[i - 1] and a[i] >= a[i + 1] and a[i] > 0.02 * a.max())
    # Fit a parabola through the nodes around the maximum. (The values inside an element would not do, because
    # they have kinks at its ends.)
    i = int(np.argmin(abs(x - fine[last])))
    c = np.polyfit(x[i - 3:i + 4] - fine[last], abs(v[i - 3:i + 4]), 4)
    peak = brentq(np.poly1d(np.polyder(c)), -2e-3, 2e-3) + fine[last]
    top = np.polyval(c, peak - fine[last])
    found = [peak]
    for level in (0.5, 0.1):
        i = max(i for i in range(last, len(a) - 1) if a[i] >= level * top > a[i + 1])
        found.append(brentq(lambda s: value(s) - level * top, fine[i], fine[i + 1], xtol=1e-10))
    return found


if __name__ == "__main__":
    problems = [plate(mesh) for mesh in sys.argv[1:] or MESHES]
    for f in (22.4e3, 30e3, 45e3):
        print(",".join(f"{c:.9g}" for c in [f, *(e for problem in problems for e in edges(problem, f))]), flush=True)
