#!/usr/bin/env python3
"""Computes two-dimensional fields of curved clamped plates, also under tension, by Chebyshev collocation (python3-numpy).

    python3 make_curved_plate.py > curved_plate.csv

The method is that of make_collocation.py, for D lap^2 v - N lap v = (D k^4 + N k^2) v and for a half-width that falls as
W = W1 + (W0 - W1) (1 + cos(pi x / L)) / 2. Columns: W0, W1, length in m, thickness in m, tension in Pa, frequency in Hz, Q
(0: lossless); then Re v and Im v on the centre line at x = 0, L/20, ..., L, with v(0, 0) = 1. The last column is the largest
difference from the solution on a coarser grid. E = 69 GPa, nu = 0.33, rho = 2700.
"""
import numpy as np
from make_collocation import chebyshev, interpolate

E, NU, RHO = 69e9, 0.33, 2700


def cut_off(w0, t):
    """Returns k W and k2 W of a clamped strip of half-width w0 at its cut-off: b tan b + g tanh g = 0."""
    low, high = np.pi / 2 + 1e-9, np.pi - 1e-9
    g = lambda b: np.sqrt(b * b + t * w0**2)
    for _ in range(200):
        b = 0.5 * (low + high)
        low, high = (b, high) if b * np.sin(b) + g(b) * np.tanh(g(b)) * np.cos(b) > 0 else (low, b)
    return b, g(b)


def plate_cut_off_Hz(w, h):
    return (cut_off(w, 0)[0] / w) ** 2 * np.sqrt(E * h**2 / (12 * (1 - NU**2) * RHO)) / (2 * np.pi)


def solve(w0, w1, length, h, tension, f, q, nx, ny):
    tx, dx = chebyshev(nx)
    eta, de = chebyshev(ny)
    x, dx = 0.5 * length * (1 + tx), dx * 2 / length
    w = w1 + (w0 - w1) * (1 + np.cos(np.pi * x / length)) / 2
    slope = -(w0 - w1) * np.pi / (2 * length) * np.sin(np.pi * x / length)
    first = np.kron(dx, np.eye(ny + 1)) - np.kron(np.diag(slope / w), np.diag(eta) @ de)
    lap = first @ first + np.kron(np.diag(1 / w**2), de @ de)
    t = 12 * (1 - NU**2) * tension / (E * h**2)
    k2 = -t / 2 + np.sqrt(t**2 / 4 + 12 * (1 - NU**2) * RHO * (2 * np.pi * f) ** 2 / (E * h**2))
    k2 = k2 * (1 - (0.5j / q if q else 0)) ** 2
    a = (lap @ lap - t * lap - (k2**2 + t * k2) * np.eye(lap.shape[0])).astype(complex)
    b = np.zeros(lap.shape[0], complex)
    r, g = cut_off(w0, t)
    shape = lambda e: ((np.cos(r * e) / np.cos(r) - np.cosh(g * e) / np.cosh(g)) / (1 / np.cos(r) - 1 / np.cosh(g)))
    for i in range(nx + 1):
        for j in range(ny + 1):
            row, side = i * (ny + 1) + j, j in (0, ny)
            # the points run from the far end to the drive edge, so index 0 is x = length
            if side or i in (0, nx):
                a[row] = 0
                a[row, row] = 1
                b[row] = shape(eta[j]) if i == nx and not side else 0
            elif j in (1, ny - 1):
                a[row] = 0
                a[row, i * (ny + 1):(i + 1) * (ny + 1)] = de[0 if j == 1 else ny]
            elif i in (1, nx - 1):
                a[row] = first[(0 if i == 1 else nx) * (ny + 1) + j]  # no slope at constant y
    scale = np.max(np.abs(a), axis=1)
    v = np.linalg.solve(a / scale[:, None], b / scale)
    return interpolate(x, v.reshape(nx + 1, ny + 1)[:, ny // 2], length * np.arange(21) / 20)


if __name__ == "__main__":
    for w0, w1, length, h, tension, f, q, nx, ny in (
        (0.014, 0.007, 0.12, 2e-3, 0.0, 28000.0, 60.0, 56, 18),
        (0.014, 0.007, 0.12, 2e-3, 0.0, 28000.0, 0.0, 56, 18),
        (0.014, 0.007, 0.12, 2e-3, 0.0, plate_cut_off_Hz(0.014, 2e-3), 60.0, 56, 18),  # the turning point is the drive edge
        (0.014, 0.0095, 0.12, 2e-3, 0.0, plate_cut_off_Hz(0.0095, 2e-3), 60.0, 56, 18),  # the turning point is the clamped end
        (0.014, 0.007, 0.12, 1e-3, 50e6, 16000.0, 60.0, 56, 18),
        (0.014, 0.007, 0.12, 0.5e-3, 100e6, 13000.0, 60.0, 56, 22),
        (0.014, 0.007, 0.12, 0.5e-3, 100e6, 13000.0, 0.0, 56, 22),
    ):
        coarse = solve(w0, w1, length, h, tension, f, q, nx - 8, ny - 4)
        fine = solve(w0, w1, length, h, tension, f, q, nx, ny)
        cells = [repr(float(value)) for value in (w0, w1, length, h, tension, f, q)]
        for value in fine:
            cells += ["%.10e" % value.real, "%.10e" % value.imag]
        print(",".join(cells + ["%.1e" % (np.max(np.abs(fine - coarse)) / np.max(np.abs(fine)))]), flush=True)
