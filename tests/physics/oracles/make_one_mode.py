#!/usr/bin/env python3
"""Computes exact solutions of the one-mode equations with 40 digits (needs python3-mpmath).

    python3 make_one_mode.py > one_mode.csv

Linear tapers:      seed  sqrt(s) J_mu(k s), mu^2 = (pi/2d)^2 + 1/4
                    mode  J_mu(k s),         mu^2 = (pi/2d)^2 + pi^2/6
                    (combined with Y where the surface ends before its apex)
Exponential tapers: seed  K_(i nu)(z),       nu = k l,             z = (pi l / 2 W0) exp(x/l)
                    mode  W^-1/2 K_(i nu)(z), nu^2 = k^2 l^2 - (pi^2/6 - 1/4)
with k = (omega/c)(1 - i/2Q), c = 800 m/s. The displacement is one at x = 0. Columns: taper, model, slope (or decay
length in m), half-width W0 in m, length in m, frequency in Hz, Q (0: lossless), then for each of six points x/L,
ln|v|, arg v.
"""
import sys
from mpmath import mp, mpf, mpc, pi, sqrt, besselj, bessely, besselk, log, exp, arg

mp.dps = 40
C = mpf(800)
QUALITIES = (5, 30, 1000, 1000000, 0)


def wavenumber(f, q):
    k = 2 * pi * f / C
    return k if q == 0 else k * mpc(1, -mpf(1) / (2 * q))


def linear(model, d, w0, length, k):
    m2 = (pi / (2 * d)) ** 2
    mu = sqrt(m2 + (mpf(1) / 4 if model == "seed" else pi**2 / 6))
    apex = w0 / d
    end = apex - length
    if end > apex * mpf("1e-12"):
        y_end, j_end = bessely(mu, k * end), besselj(mu, k * end)

    def v(x):
        s = apex - x
        if end > apex * mpf("1e-12"):
            g = besselj(mu, k * s) * y_end - bessely(mu, k * s) * j_end
        else:
            g = besselj(mu, k * s)
        return sqrt(s) * g if model == "seed" else g

    return v


def exponential(model, l, w0, k):
    nu2 = (k * l) ** 2 - (0 if model == "seed" else pi**2 / 6 - mpf(1) / 4)
    nu = sqrt(mpc(nu2))

    def v(x):
        g = besselk(mpc(0, 1) * nu, pi * l / (2 * w0) * exp(x / l))
        return g if model == "seed" else g * exp(x / (2 * l))

    return v


def row(taper, model, slope, w0, length, f, q, x0):
    # The C++ test reads these values as doubles, so round them to doubles before computing.
    slope, w0, length, f = (mpf(float(value)) for value in (slope, w0, length, f))
    k = wavenumber(f, q)
    v = linear(model, slope, w0, length, k) if taper == "linear" else exponential(model, slope, w0, k)
    fractions = [x0 * mpf("0.31"), x0 * mpf("0.83"), x0]
    fractions += [x0 + (length - x0) * t for t in (mpf("0.2"), mpf("0.6"), mpf("0.97"))]
    if taper == "exponential":  # stay away from the clamped end, which this solution leaves out
        fractions[5] = x0 + (length - x0) * mpf("0.75")
    unit = v(mpf(0))
    cells = [taper, model] + [repr(float(value)) for value in (slope, w0, length, f, q)]
    for x in fractions:
        t = float(x / length)
        value = v(mpf(t) * length) / unit
        cells += [repr(t), mp.nstr(log(abs(value)), 17), mp.nstr(arg(value), 17)]
    print(",".join(cells))
    sys.stdout.flush()


def main():
    # For each slope, the half-widths of the drive edge, divided by the cut-off half-width.
    tapers = {
        "0.001": ("1.05", "1.3", "2.5"), "0.003": ("1.1", "2"), "0.01": ("1.1", "1.8", "5"),
        "0.02": ("1.2", "3"), "0.05": ("1.15", "2", "6"), "0.1": ("1.2", "2", "3.5", "8"),
        "0.2": ("1.3", "4", "10"), "0.5": ("1.5", "5", "12"),
    }
    frequencies = ("5e3", "2.24e4", "9e4")
    for d in tapers:
        for ratio in tapers[d]:
            for f in frequencies if d != "0.001" else frequencies[:1]:
                for q in QUALITIES:
                    for model in ("seed", "mode"):
                        wc = C / (4 * mpf(f))
                        w0 = mpf(ratio) * wc
                        apex = w0 / mpf(d)
                        row("linear", model, mpf(d), w0, apex, f, q, (w0 - wc) / mpf(d))
    for d, ratio, end in (("0.1", "2", "0.9"), ("0.1", "3", "0.55"), ("0.05", "2", "0.52"), ("0.2", "3", "0.3")):
        # `end` is the length of the surface divided by the distance of the apex. Below 1 - 1/ratio,
        # the surface ends before the turning point, where the mode still oscillates.
        for q in QUALITIES:
            for model in ("seed", "mode"):
                wc = C / (4 * mpf("22400"))
                w0 = mpf(ratio) * wc
                length = w0 / mpf(d) * mpf(end)
                row("linear", model, mpf(d), w0, length, "22400", q, min((w0 - wc) / mpf(d), length * mpf("0.9")))
    for l, ratio in (("0.05", "2"), ("0.1", "1.5"), ("0.1", "3"), ("0.3", "2")):
        for q in QUALITIES:
            for model in ("seed", "mode"):
                wc = C / (4 * mpf("22400"))
                w0 = mpf(ratio) * wc
                x0 = mpf(l) * log(mpf(ratio))
                row("exponential", model, mpf(l), w0, x0 + mpf(l) * mpf("2.2"), "22400", q, x0)
    at_the_edges()


def at_the_edges():
    """The turning point is exactly at the drive edge or at the clamped end, or within 1e-9 of the length."""
    for q in QUALITIES:
        for d, ratio in (("0.03", "1.6"), ("0.2", "3")):
            for model in ("seed", "mode"):
                wc = C / (4 * mpf("22400"))
                # the drive edge is as wide as the cut-off, or a little wider or narrower
                for w0 in (wc, wc * (1 + mpf("1e-9")), wc * (1 - mpf("1e-9"))):
                    length = mpf("0.7") * w0 / mpf(d)
                    row("linear", model, mpf(d), w0, length, "22400", q, length / 5)
                # the clamped end is as wide as the cut-off
                for end in (mpf(1), 1 + mpf("1e-9"), 1 - mpf("1e-9")):
                    length = mpf(ratio) * wc / mpf(d) - end * wc / mpf(d)
                    row("linear", model, mpf(d), mpf(ratio) * wc, length, "22400", q, length * mpf("0.6"))


if __name__ == "__main__":
    main()
