#!/usr/bin/env python3
"""Computes fields of uniform strips in closed form, with 40 digits (needs python3-mpmath).

    python3 make_strip.py > strip.csv

The half-width is 30 mm (brass) or 14 mm (aluminium), the far end is held, and k is complex with loss, k (1 - i/2Q).
  membrane   sum over odd n of b_n sin(q_n (L - x)) / sin(q_n L), q_n^2 = k^2 - (n pi/2W)^2; b_1 = 1 for the drive
             `cosine`, b_n = (-1)^((n-1)/2) 4/(n pi) for `piston`; c = 800 m/s
  supported  a simply supported plate: the same sum, with k of the bare plate, D k^4 = rho h omega^2
  taut       a simply supported plate under tension, D k^4 + N k^2 = rho h omega^2
  clamped    model mode of a clamped plate under tension, f(x) phi(y/W) with the shape phi of the cut-off at this frequency:
             M0 f'''' - (2 M1 + t M0) f'' + (M2 + t M1 - (k^4 + t k^2) M0) f = 0, f(0) = 1, f'(0) = f(L) = f'(L) = 0,
             Mi the integral of the squared i-th derivative of phi, t = N/D
Columns: kind, drive, length in m, thickness in m, tension in Pa, Q (0: lossless), number n of the mode that is near resonance
(0: none), relative distance from that resonance, the frequency in Hz, then Re v and Im v on the centre line at x = L i / 10.37,
i = 1, ..., 9.
"""
from mpmath import mp, mpf, mpc, mpmathify, pi, sqrt, sin, cos, cosh, tan, tanh, exp, findroot, quad, matrix, lu_solve, det

mp.dps = 40
C, E, RHO, NU = mpf(800), mpf("69e9"), mpf(2700), mpf("0.33")


class Strip:
    def __init__(self, kind, drive, length, thickness, tension):
        self.kind, self.drive = kind, drive
        self.length, self.h, self.tension = (mpf(float(t)) for t in (length, thickness, tension))
        self.w = mpf(float(0.03 if kind == "membrane" else 0.014))
        self.t = 0 if kind == "membrane" else 12 * (1 - NU**2) * self.tension / (E * self.h**2)

    def wavenumber(self, f, q):
        omega = 2 * pi * f
        if self.kind == "membrane":
            k = omega / C
        else:
            k4 = 12 * (1 - NU**2) * RHO * omega**2 / (E * self.h**2)
            k = sqrt(-self.t / 2 + sqrt(self.t**2 / 4 + k4))
        return k if q == 0 else k * mpc(1, -mpf(1) / (2 * q))

    def along(self, n, k):
        return sqrt(mpmathify(k**2 - (n * pi / (2 * self.w)) ** 2))

    def cut_off_shape(self, f):
        k = self.wavenumber(f, 0)
        ratio = sqrt(1 + self.t / k**2)
        b = findroot(lambda b: tan(b) + ratio * tanh(ratio * b), mpf("2.2") if self.t else mpf("2.365"))
        g = ratio * b
        unit = 1 / cos(b) - 1 / cosh(g)
        phi = (lambda y: (cos(b * y) / cos(b) - cosh(g * y) / cosh(g)) / unit,
               lambda y: (-b * sin(b * y) / cos(b) - g * mp.sinh(g * y) / cosh(g)) / unit,
               lambda y: (-b**2 * cos(b * y) / cos(b) - g**2 * cosh(g * y) / cosh(g)) / unit)
        return [quad(lambda y, p=p: p(y) ** 2, [0, 0.5, 1]) / self.w ** (2 * i) for i, p in enumerate(phi)]

    def clamped(self, f, q):
        """Returns the four solutions as a function of x, and the matrix of the conditions at both ends."""
        k = self.wavenumber(f, q)
        m0, m1, m2 = self.cut_off_shape(f)
        b, c = (2 * m1 + self.t * m0) / m0, (m2 + self.t * m1) / m0 - (k**4 + self.t * k**2)
        root = sqrt(mpmathify(b**2 / 4 - c))
        e = [s * sqrt(mpmathify(b / 2 + r)) for r in (root, -root) for s in (1, -1)]
        start = [self.length if mp.re(x) > 0 else 0 for x in e]  # the end at which the exponential is one
        at = lambda x: [exp(one * (x - s)) for one, s in zip(e, start)]
        times = lambda values: [x * y for x, y in zip(e, values)]
        return at, matrix([at(0), times(at(0)), at(self.length), times(at(self.length))])

    def response(self, f, n):
        """Is zero at a resonance of mode n."""
        if self.kind != "clamped":
            return mp.re(sin(self.along(n, self.wavenumber(f, 0)) * self.length))
        return mp.im(det(self.clamped(f, 0)[1]))

    def resonance(self, n, near):
        step, f = near / 400, near
        while self.response(f, n) * self.response(f + step, n) > 0:
            f += step
        unit = abs(self.response(f, n))
        return findroot(lambda t: self.response(t, n) / unit, (f, f + step), solver="anderson", tol=mpf("1e-55"), maxsteps=100)

    def field(self, f, q):
        # irregular points, so that they do not coincide with nodes that several functions have in common
        points = [self.length * mpf(float(i / 10.37)) for i in range(1, 10)]
        if self.kind == "clamped":
            at, conditions = self.clamped(f, q)
            c = lu_solve(conditions, matrix([1, 0, 0, 0]))
            return [mp.fsum(a * b for a, b in zip(c, at(x))) for x in points]
        k, total = self.wavenumber(f, q), [mpf(0)] * 9
        for n in range(1, 2 if self.drive == "cosine" else 400, 2):
            b = 1 if self.drive == "cosine" else (-1) ** ((n - 1) // 2) * 4 / (n * pi)
            p = self.along(n, k)
            total = [t + b * sin(p * (self.length - x)) / sin(p * self.length) for t, x in zip(total, points)]
        return total


def row(strip, q, n, distance, near):
    near = mpf(float(near))
    f = mpf(float(strip.resonance(n, near) * (1 + mpf(distance)) if n else near))
    cells = [strip.kind, strip.drive] + [repr(float(x)) for x in (strip.length, strip.h, strip.tension, q)]
    cells += [str(n), distance, repr(float(f))]
    for v in strip.field(f, q):
        cells += [mp.nstr(mp.re(v), 17), mp.nstr(mp.im(v), 17)]
    print(",".join(cells), flush=True)


if __name__ == "__main__":
    distances = ("1e-3", "1e-6", "-1e-9", "1e-12")
    for kind, thickness, tension in (("membrane", 0.05e-3, 640e6), ("supported", 2e-3, 0), ("taut", 0.5e-3, 50e6)):
        for drive in ("cosine", "piston"):
            strip = Strip(kind, drive, 0.25, thickness, tension)
            second = {"membrane": 24e3, "supported": 65e3, "taut": 18e3}[kind]  # 20 % above the third mode's cut-off
            for q in (60, 1e9):
                row(strip, q, 0, "0", second)
            for distance in distances:
                row(strip, 0, 1, distance, second)
                if drive == "piston":
                    row(strip, 0, 3, distance, second)
    for thickness, tension in ((2e-3, 0), (0.5e-3, 50e6), (0.2e-3, 200e6)):
        strip = Strip("clamped", "cosine", 0.1, thickness, tension)
        near = 1.3 * (26e3 if tension == 0 else 13e3)
        row(strip, 60, 0, "0", near)
        for distance in distances:
            row(strip, 0, 1, distance, near)
