#!/usr/bin/env python3
"""Computes cut-offs and waves of clamped strips by other methods than the library's.

    python3 make_section.py > section.csv
    python3 make_section.py table > ../../../physics/elastic_table.inc

The second command makes the library's table of cut-offs (physics/elastic_section.hpp), in about five minutes.

Needs python3-numpy, python3-scipy and scikit-fem. The half-width is 1, G = rho = 1, and t is the thickness. There are
three kinds of rows:
  cut,nu,t,omega
      The first symmetric bending cut-off, omega, in plane strain, with the sides held over the whole thickness. The
      elements are Lagrange elements of degree 5 on a mesh that is finer near the corners. Elements of degree 4 give
      an omega that differs by less than 5e-6.
  wave,nu,t,omega,Re,Im,...
      The two smallest k_x^2 of three-dimensional waves along the strip, by semi-analytical finite elements.
  mindlin,nu,kappa,t,omega,Re,Im,...
      The same in Mindlin's theory with shear factor kappa, by Chebyshev collocation across the strip.
"""
import sys

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla
import skfem as fe
from skfem.helpers import grad


def mesh(t, ny=6, nz=3, layers=7):
    # Towards the corner between clamp and free face, each layer of the mesh is thinner than the
    # last by the factor g. t = h/W, and z is in [0, t/2].
    g = 0.3
    y = np.unique(np.r_[np.linspace(0, 1 - min(0.5, t), ny + 1), 1 - min(0.5, t) * g ** np.arange(layers), 1])
    z = np.unique(np.r_[np.linspace(0, t / 4, nz), t / 2 - t / 4 * g ** np.arange(layers), t / 2])
    return fe.MeshQuad.init_tensor(y, z)

def matrices(t, p, **kw):
    m = mesh(t, **kw)
    b = fe.Basis(m, fe.ElementQuadP(p), intorder=2 * p + 2)
    M = fe.BilinearForm(lambda u, v, w: u * v).assemble(b)
    d = {}
    for i in range(2):
        for j in range(2):
            d[i, j] = fe.BilinearForm(lambda u, v, w: grad(v)[i] * grad(u)[j]).assemble(b)
        d[i] = fe.BilinearForm(lambda u, v, w: v * grad(u)[i]).assemble(b)
    return m, b, M, d

def free(m, b, which):
    fixed = [b.get_dofs(lambda x: np.isclose(x[0], 1)).all()]
    if which in ("x", "y"): fixed.append(b.get_dofs(lambda x: np.isclose(x[1], 0)).all())  # this component is odd in z
    if which == "y": fixed.append(b.get_dofs(lambda x: np.isclose(x[0], 0)).all())         # this component is odd in y, too
    return np.setdiff1d(np.arange(b.N), np.concatenate(fixed))

def plane(t, nu, p=5, **kw):
    """Returns the matrices of the cross-section with mu = rho = 1: stiffness K and mass M of (u_y, u_z), then those
    of u_x and the coupling C."""
    m, b, M, d = matrices(t, p, **kw)
    lam = 2 * nu / (1 - 2 * nu)
    Fx, Fy, Fz = (free(m, b, c) for c in "xyz")
    cut = lambda A, r, c: A.tocsr()[r][:, c]
    K = sp.bmat([[cut((lam + 2) * d[0, 0] + d[1, 1], Fy, Fy), cut(lam * d[0, 1] + d[1, 0], Fy, Fz)],
                 [cut(lam * d[1, 0] + d[0, 1], Fz, Fy), cut((lam + 2) * d[1, 1] + d[0, 0], Fz, Fz)]]).tocsc()
    MM = sp.block_diag([cut(M, Fy, Fy), cut(M, Fz, Fz)]).tocsc()
    MA = cut(M, Fx, Fx).tocsc(); KA = cut(d[0, 0] + d[1, 1], Fx, Fx).tocsc()
    # C is the matrix of the integral of lam A div(b, c) - grad A . (b, c), where the displacements are u_x = i k A, u_y
    # = b and u_z = c.
    C = sp.bmat([[cut(lam * d[0] - d[0].T, Fx, Fy), cut(lam * d[1] - d[1].T, Fx, Fz)]]).tocsc()
    return K, MM, MA, KA, C, lam

def cut_off(t, nu, p=5, **kw):
    K, M, *_ = plane(t, nu, p, **kw)
    return np.sqrt(sla.eigsh(K, k=1, M=M, sigma=0, return_eigenvectors=False)[0])

def wavenumbers2(t, nu, omega, n=4, p=4, sigma=0.3, **kw):
    """Returns the n smallest k_x^2 W^2 at omega W / c_s. With u_x = i k A, the semi-analytical finite elements give
    an eigenvalue problem that is linear in k_x^2."""
    K, M, MA, KA, C, lam = plane(t, nu, p, **kw)
    o2 = omega ** 2
    P0 = sp.bmat([[KA - o2 * MA, C], [None, K - o2 * M]]).tocsc()
    P1 = sp.bmat([[(lam + 2) * MA, None], [C.T, M]]).tocsc()
    lu = sla.splu((P0 + sigma * P1).tocsc())
    op = sla.LinearOperator(P0.shape, matvec=lambda x: lu.solve(P1 @ x), dtype=float)
    v = sigma - 1 / sla.eigs(op, k=n, return_eigenvectors=False)
    return v[np.argsort(abs(v))]


def mindlin_waves2(t, nu, kappa, omega, n=36):
    """Returns the k of waves exp(-i k x) by Mindlin's theory, smallest first. The unknowns are w, a = beta_x / i and
    beta_y on [-1, 1]. The eigenvalue problem is quadratic in k and is made linear by doubling the unknowns."""
    y = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.r_[2, np.ones(n - 1), 2] * (-1) ** np.arange(n + 1)
    dy = y[:, None] - y[None, :]
    d = np.outer(c, 1 / c) / (dy + np.eye(n + 1))
    d -= np.diag(d.sum(axis=1))
    d2 = d @ d
    inner = slice(1, n)
    i, z = np.eye(n - 1), np.zeros((n - 1, n - 1))
    d, d2 = d[inner, inner], d2[inner, inner]
    dd, s, j = t**3 / (6 * (1 - nu)), kappa * t, t**3 / 12
    half = dd / 2
    o2 = omega**2
    # The matrices a0, a1 and a2 belong to k^0, k^1 and k^2. Their rows are the equations of w,
    # beta_x and beta_y. They are real because beta_x is written as i a.
    a0 = np.block([[s * d2 + t * o2 * i, z, s * d],
                   [z, half * (1 - nu) * d2 - s * i + j * o2 * i, z],
                   [-s * d, z, dd * d2 - s * i + j * o2 * i]])
    a1 = np.block([[z, s * i, z], [s * i, z, -half * (1 + nu) * d], [z, half * (1 + nu) * d, z]])
    a2 = -la.block_diag(s * i, dd * i, half * (1 - nu) * i)
    zero, one = np.zeros_like(a0), np.eye(len(a0))
    k = la.eig(np.block([[zero, one], [a0, a1]]), np.block([[one, zero], [zero, -a2]]), right=False)
    k = k[np.isfinite(k)]
    return k[np.argsort(abs(k))]


def symmetric(values):
    """The k come in pairs +-k. Returns up to six different k^2, in the order of `values`."""
    squares = []
    for k in values:
        if not any(abs(k * k - other) < 1e-6 * abs(other) for other in squares):
            squares.append(k * k)
        if len(squares) == 6:
            break
    return squares


def thin(t, nu):
    """The cut-off of a thin strip (Kirchhoff)."""
    return 2.3650203724313520**2 * t / np.sqrt(6 * (1 - nu))


def table(terms=18, ratios=12):
    """Returns the coefficients a[j, i] of cut_off / thin = sum of a[j, i] T_j(t - 1) T_i(nu / 0.245 - 1). Chebyshev points
    in both directions, except for the smallest t: there the ratio is 1 at t = 0, because a mesh that is fine enough for the
    corners of so thin a strip leaves too few digits."""
    t = 1 + np.cos(np.pi * (np.arange(terms) + 0.5) / terms)
    nu = 0.245 * (1 + np.cos(np.pi * (np.arange(ratios) + 0.5) / ratios))
    t[-1] = 0
    ratio = np.array([[cut_off(at, n) / thin(at, n) if at > 0 else 1 for n in nu] for at in t])
    by_t = np.polynomial.chebyshev.chebvander(t - 1, terms - 1)
    by_nu = np.polynomial.chebyshev.chebvander(nu / 0.245 - 1, ratios - 1)
    return la.solve(by_t, la.solve(by_nu, ratio.T).T)


def row(*cells):
    print(",".join(c if isinstance(c, str) else f"{c:.12g}" for c in cells), flush=True)


if __name__ == "__main__" and sys.argv[1:] == ["table"]:
    print("// Made by tests/physics/oracles/make_section.py table. A row for each degree in h/W, a column for each in Poisson's ratio.")
    for line in table():
        print("{" + ", ".join(f"{value:.9f}" for value in line) + "},")
elif __name__ == "__main__":
    for nu in (0.0, 0.2, 0.33, 0.4, 0.45):
        for t in (0.05, 0.1, 0.2, 0.3, 0.4, 0.6):
            row("cut", nu, t, cut_off(t, nu, layers=8))
    for nu, t in ((0.33, 0.1), (0.33, 0.25), (0.2, 0.4)):
        at = cut_off(t, nu)
        for part in (1.4, 1.1, 0.9, 0.8, 0.5):
            waves = wavenumbers2(t, nu, part * at)[:2]
            waves = sorted(waves, key=lambda v: (-v.real, -v.imag))
            row("wave", nu, t, part * at, *[x for v in waves for x in (v.real, v.imag)])
    for nu, kappa, t in ((0.33, 5 / 6, 0.1), (0.33, 0.9, 0.25), (0.2, 0.87, 0.4)):
        at = thin(t, nu)
        for part in (1.3, 1.0, 0.9, 0.7, 0.5):
            waves = sorted(symmetric(mindlin_waves2(t, nu, kappa, part * at))[:2], key=lambda v: (-v.real, -v.imag))
            row("mindlin", nu, kappa, t, part * at, *[x for v in waves for x in (v.real, v.imag)])
