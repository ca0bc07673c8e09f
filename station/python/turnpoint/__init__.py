"""Turnpoint in Python: the data of the station as pandas frames, the fits of its report, and its physics library.

    import turnpoint
    study = turnpoint.read("lab.sqlite", protocol="boundary-constant")
    study.trials.groupby("level").correct.mean()

    from turnpoint import analysis
    analysis.speed_accuracy(times_s, correct, condition).differences

    from turnpoint import physics
    plate = physics.aluminium_plate()
    physics.BoundaryMap(plate, "p50").frequency_Hz(0.150)
"""
from ._read import Study, read, read_signals
from ._store import StoreError

__all__ = ["Study", "StoreError", "read", "read_signals"]
