#!/usr/bin/env python3
"""Computes two-dimensional fields of membranes whose straight edge is driven, by finite elements.

    python3 make_drive.py > drive.csv

Needs python3-numpy, python3-scipy and scikit-fem. The membrane has c = 800 m/s; its half is meshed with triangles of degree 4,
which are refined ten times towards the corner of the drive edge, where the displacement of a piston jumps from one to zero
at the held side. Columns: drive, W0 and length in m, slope, frequency in Hz, Q (0:
lossless), then Re v and Im v on the centre line at x = 0.05 L, 0.1 L, ..., 0.95 L, with v = 1 at the centre of the
drive edge. The last column is the largest difference from a coarser mesh, relative to the largest |v|.
"""
import numpy as np
import scipy.sparse.linalg as sla
import skfem as fe
from skfem.helpers import dot, grad


@fe.BilinearForm
def stiffness(u, v, _):
    return dot(grad(u), grad(v))


@fe.BilinearForm
def mass(u, v, _):
    return u * v


def solve(drive, w0, length, slope, f, q, size):
    nx, ny = int(np.ceil(length / size)), int(np.ceil(w0 / size))
    m = fe.MeshTri.init_tensor(np.linspace(0, length, nx + 1), np.linspace(0, 1, ny + 1))
    for _ in range(10):
        at_corner = np.flatnonzero((m.p[0] == 0) & (m.p[1] == 1))
        m = m.refined(np.flatnonzero(np.isin(m.t, at_corner).any(axis=0)))
    edge, side, end = (lambda x: x[0] == 0), (lambda x: x[1] == 1), (lambda x: x[0] == length)
    m = m.with_boundaries(dict(edge=edge, side=side, end=end))
    p = m.p.copy()
    p[1] *= w0 - slope * p[0]
    m = fe.MeshTri(p, m.t).with_boundaries(m.boundaries)
    basis = fe.Basis(m, fe.ElementTriP4())
    k = 2 * np.pi * f / 800 * (1 - (0.5j / q if q else 0))
    a = (stiffness.assemble(basis) - k**2 * mass.assemble(basis)).tocsc()
    u = np.zeros(a.shape[0], complex)
    on_edge = basis.get_dofs("edge").all()
    u[on_edge] = 1 if drive == "piston" else np.cos(np.pi / 2 * basis.doflocs[1][on_edge] / w0)
    held = np.concatenate([basis.get_dofs("side").all(), basis.get_dofs("end").all()])
    u[held] = 0
    held = np.union1d(held, on_edge)
    free = np.setdiff1d(np.arange(len(u)), held)
    u[free] = sla.spsolve(a[free][:, free], -a[free][:, held] @ u[held])
    x = length * np.arange(1, 20) / 20
    return basis.probes(np.array([x, 1e-12 + 0 * x])) @ u


if __name__ == "__main__":
    for w0, length, slope, f, q in (
        (0.03, 0.27, 0.1, 24000.0, 60.0),
        (0.03, 0.27, 0.1, 24000.0, 0.0),
        (0.03, 0.16666666666666666, 0.1, 15000.0, 60.0),  # the turning point is the far end
        (0.03, 0.27, 0.1, 6666.666666666667, 60.0),  # the turning point is the drive edge
        (0.04, 0.11, 0.3, 16000.0, 30.0),
    ):
        for drive in ("cosine", "piston"):
            coarse, fine = (solve(drive, w0, length, slope, f, q, size) for size in (6e-3, 4e-3))
            cells = [drive] + [repr(float(x)) for x in (w0, length, slope, f, q)]
            for v in fine:
                cells += ["%.9e" % v.real, "%.9e" % v.imag]
            print(",".join(cells + ["%.1e" % (np.max(np.abs(fine - coarse)) / np.max(np.abs(fine)))]), flush=True)
