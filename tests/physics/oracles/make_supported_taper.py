#!/usr/bin/env python3
"""Simply supported aluminium plates with curved sides, solved by Chebyshev collocation (writes supported_taper.csv).

The library solves such a plate as a membrane, (lap + k^2) v = 0 with v = 0 on the sides. On a curved side, zero bending
moment means lap v = (1 - nu) kappa dv/dn instead of lap v = 0, with kappa the curvature of the side and n its normal.
Here, two functions are solved for on the quarter x in [0, L], y/W in [0, 1]: v, and u = lap v, with D lap u - N u =
(D k^4 + N k^2) v. On the sides v = 0 and u = (1 - nu) kappa dv/dn; at the drive edge v = cos(pi y / 2W) and u = -k^2 v, as
in the library; at the far end v = u = 0. The sides are W0 exp(-x / l).

Columns: decay length (m), frequency (Hz), thickness (m), tension (Pa), loss 1/2Q of the wavenumber, nu; then |v| on the
centre line at 0, L/30, ..., L, the position of the last maximum and where |v| is half of it (m).

With nu = 1 the condition is that of the library, and both agree to 1e-6: run `make_supported_taper.py check`.
"""
import sys

import numpy as np

E, RHO, NU, W0, L = 69e9, 2700, 0.33, 0.014, 0.3


def chebyshev(n):
    t = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.where((np.arange(n + 1) == 0) | (np.arange(n + 1) == n), 2, 1) * (-1.0) ** np.arange(n + 1)
    d = np.outer(c, 1 / c) / (t[:, None] - t[None, :] + np.eye(n + 1))
    return t, d - np.diag(d.sum(axis=1))


def solve(decay, f, h, tension, loss, nu, nx=120, ny=10):
    t, d = chebyshev(nx)
    x, dx = 0.5 * L * (1 - t), -2 / L * d
    t, d = chebyshev(2 * ny + 1)  # even functions of eta: keep the upper half
    half = ny + 1
    even = lambda m: m[:half, :half] + m[:half, : half - 1 : -1]
    eta, d1, d2 = t[:half], even(d), even(d @ d)
    stiff, line = E * h**3 / (12 * (1 - NU**2)), tension * h
    mass = RHO * h * (2 * np.pi * f) ** 2
    k = np.sqrt(2 * mass / (line + np.sqrt(line**2 + 4 * stiff * mass))) * (1 - 1j * loss)
    w = W0 * np.exp(-x / decay)
    w1, w2 = -w / decay, w / decay**2
    n, m = nx + 1, half
    # lap = d2/dx2 - 2 r eta d2/dx deta + (2 r^2 - W''/W) eta d/deta + (r^2 eta^2 + 1/W^2) d2/deta2, r = W'/W
    r = w1 / w
    one_x, one_y, y = np.eye(n), np.eye(m), np.diag(eta)
    lap = (np.kron(dx @ dx, one_y) - 2 * np.kron(np.diag(r) @ dx, y @ d1) + np.kron(np.diag(2 * r**2 - w2 / w), y @ d1)
           + np.kron(np.diag(r**2), y @ y @ d2) + np.kron(np.diag(1 / w**2), d2))
    size = n * m
    a = np.zeros((2 * size, 2 * size), complex)
    b = np.zeros(2 * size, complex)
    a[:size, :size], a[:size, size:] = lap, -np.eye(size)
    a[size:, :size] = -(stiff * k**4 + line * k**2) / stiff * np.eye(size)
    a[size:, size:] = lap - line / stiff * np.eye(size)
    kappa = -w2 / (1 + w1**2) ** 1.5  # positive where the plate is convex, as on a disc
    for i in range(n):
        for j in range(m):
            row, edge = i * m + j, i in (0, n - 1)
            if not edge and j > 0:
                continue
            a[row], a[size + row] = 0, 0
            a[row, row], a[size + row, size + row] = 1, 1
            if i == 0:
                b[row] = np.cos(np.pi / 2 * eta[j])
                b[size + row] = -(k**2) * b[row]
            elif j == 0 and not edge:  # dv/dn = dv/deta sqrt(1 + W'^2) / W; the normal points outward
                a[size + row, i * m : i * m + m] -= (1 - nu) * kappa[i] * np.sqrt(1 + w1[i] ** 2) / w[i] * d1[0]
    centre = np.linalg.solve(a, b)[:size].reshape(n, m) @ centre_weights(eta)
    return x, centre


def centre_weights(eta):
    """The value at eta = 0 of the even polynomial through the points."""
    s = eta**2
    return np.array([np.prod([s[j] / (s[j] - s[i]) for j in range(len(s)) if j != i]) for i in range(len(s))])


def at(x, v, where):
    c = np.where((np.arange(len(x)) == 0) | (np.arange(len(x)) == len(x) - 1), 0.5, 1) * (-1.0) ** np.arange(len(x))
    out = []
    for one in np.atleast_1d(where):
        gap = one - x
        out.append(v[np.argmin(abs(gap))] if min(abs(gap)) < 1e-14 else (c / gap) @ v / (c / gap).sum())
    return np.array(out)


def features(x, v):
    grid = np.linspace(0, L, 6001)
    size = abs(at(x, v, grid))
    last = max(i for i in range(1, 6000) if size[i] > size[i - 1] and size[i] >= size[i + 1] and size[i] > 0.01)
    low, high = grid[last - 1], grid[last + 1]
    for _ in range(60):
        p, q = low + (high - low) / 3, high - (high - low) / 3
        low, high = (p, high) if abs(at(x, v, p))[0] < abs(at(x, v, q))[0] else (low, q)
    peak, most = low, abs(at(x, v, low))[0]
    half = max(i for i in range(6001) if size[i] > 0.5 * most)
    low, high = grid[half], grid[half + 1]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if abs(at(x, v, middle))[0] > 0.5 * most else (low, middle)
    return peak, low


if __name__ == "__main__":
    nu = 1 if "check" in sys.argv else NU
    for decay in (0.15, 0.25, 0.5):
        for f, h, tension, loss in ((30e3, 2e-3, 0, 1 / 120), (24e3, 2e-3, 0, 1 / 120), (30e3, 1e-3, 2e7, 1 / 60),
                                    (40e3, 3e-3, 0, 1 / 400)):
            x, v = solve(decay, f, h, tension, loss, nu)
            if "fine" in sys.argv:
                x, v = solve(decay, f, h, tension, loss, nu, 140, 12)
            values = abs(at(x, v, np.linspace(0, L, 31)))
            print(",".join(f"{one:.10g}" for one in (decay, f, h, tension, loss, nu, *values, *features(x, v))), flush=True)
