#!/usr/bin/env python3
"""Computes two-dimensional fields of curved tapers, by Chebyshev collocation of the strong form (needs python3-numpy).

    python3 make_collocation.py > collocation.csv

This method is independent of the library's. The Laplacian acts on grid values in the coordinates (x, y/W(x)); applied
twice, it is the plate's operator. At the boundary points, boundary conditions replace the equation. Columns: kind,
W0, decay length and length in m, frequency in Hz, Q; then Re v and Im v on the centre line at x = 0, L/20, ..., L,
with v(0, 0) = 1. The last column is the largest difference from the solution on a coarser grid. The membrane has c^2
= 5.12e9/8110; the plate is clamped aluminium, 2 mm thick, with E = 69 GPa, nu = 0.33, rho = 2700.
"""
import numpy as np


def chebyshev(n):
    """Returns Chebyshev points on [-1, 1] and their differentiation matrix (Trefethen, Spectral Methods in MATLAB,
    program cheb)."""
    t = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.r_[2, np.ones(n - 1), 2] * (-1) ** np.arange(n + 1)
    dt = t[:, None] - t[None, :]
    d = np.outer(c, 1 / c) / (dt + np.eye(n + 1))
    return t, d - np.diag(d.sum(axis=1))


def interpolate(t, values, at):
    w = (-1.0) ** np.arange(len(t))
    w[0] *= 0.5
    w[-1] *= 0.5
    out = []
    for a in at:
        gap = a - t
        if np.min(np.abs(gap)) < 1e-14:
            out.append(values[np.argmin(np.abs(gap))])
        else:
            out.append(np.sum(w * values / gap) / np.sum(w / gap))
    return np.array(out)


def solve(kind, w0, l, length, f, q, nx, ny):
    tx, dx = chebyshev(nx)
    eta, de = chebyshev(ny)
    x, dx = 0.5 * length * (1 + tx), dx * 2 / length
    w = w0 * np.exp(-x / l)
    ix, ie = np.eye(nx + 1), np.eye(ny + 1)
    # The derivative v_x at constant y is d/dx - eta W'/W d/deta, with W'/W = -1/l. It is applied twice.
    first = np.kron(dx, ie) + np.kron(ix, np.diag(eta) @ de) / l
    lap = first @ first + np.kron(np.diag(1 / w**2), de @ de)
    on = lambda i, j: i * (ny + 1) + j
    if kind == "membrane":
        k = 2 * np.pi * f / np.sqrt(5.12e9 / 8110) * (1 - 0.5j / q)
        a = lap + k**2 * np.eye(lap.shape[0])
    else:
        stiffness, mass = 69e9 * 0.002**3 / (12 * (1 - 0.33**2)), 2700 * 0.002
        k = (mass * (2 * np.pi * f) ** 2 / stiffness) ** 0.25 * (1 - 0.5j / q)
        a = (lap @ lap - k**4 * np.eye(lap.shape[0])).astype(complex)
    a = a.astype(complex)
    b = np.zeros(lap.shape[0], complex)
    clamped = kind == "plate"
    root = 2.3650203724313520
    shape = (lambda e: np.cos(np.pi / 2 * e)) if not clamped else (
        lambda e: (np.cos(root * e) / np.cos(root) - np.cosh(root * e) / np.cosh(root))
        / (1 / np.cos(root) - 1 / np.cosh(root)))
    for i in range(nx + 1):
        for j in range(ny + 1):
            row = on(i, j)
            # the points run from the far end to the drive edge, so index 0 is x = length
            side, end, drive = j in (0, ny), i == 0, i == nx
            if side or end or drive:
                a[row] = 0
                a[row, row] = 1
                b[row] = shape(eta[j]) if drive and not side else 0
            elif clamped and j in (1, ny - 1):
                a[row] = 0
                edge = 0 if j == 1 else ny
                a[row, i * (ny + 1):(i + 1) * (ny + 1)] = de[edge]
            elif clamped and i in (1, nx - 1):
                a[row] = 0
                a[row] = first[on(0 if i == 1 else nx, j)]  # no slope at constant y
    scale = np.max(np.abs(a), axis=1)
    v = np.linalg.solve(a / scale[:, None], b / scale)
    middle = v.reshape(nx + 1, ny + 1)[:, ny // 2]
    return interpolate(x, middle, length * np.arange(21) / 20)


if __name__ == "__main__":
    for kind, w0, l, length, f, q, nx, ny in (
        ("membrane", 0.03, 0.12, 0.15, 15000.0, 60.0, 56, 20),
        ("membrane", 0.03, 0.06, 0.10, 18000.0, 200.0, 56, 20),
        ("plate", 0.014, 0.2, 0.12, 25000.0, 60.0, 56, 18),
        ("plate", 0.014, 0.1, 0.08, 28000.0, 30.0, 48, 18),
    ):
        coarse = solve(kind, w0, l, length, f, q, nx - 8, ny - 4)
        fine = solve(kind, w0, l, length, f, q, nx, ny)
        cells = [kind] + [repr(value) for value in (w0, l, length, f, q)]
        for value in fine:
            cells += ["%.10e" % value.real, "%.10e" % value.imag]
        print(",".join(cells + ["%.1e" % (np.max(np.abs(fine - coarse)) / np.max(np.abs(fine)))]))
