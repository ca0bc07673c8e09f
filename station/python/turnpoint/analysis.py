"""The fits of Turnpoint's report, for arrays of any experiment.

    from turnpoint import analysis
    fit = analysis.speed_accuracy(times_s, correct, condition, deadline_s=0.8)
    print(fit.conditions[0].boundary, fit.differences)

Every function calls what the report calls, so that the same answers give the same numbers. Times are in seconds. Drifts and
boundaries are scaled for noise with a standard deviation of s = 0.1 after 1 s. An estimate has `value`, `low` and `high`, the
ends of its 95 % interval; what the answers do not determine is None, and `statements` say why. Arrays that do not fit
each other, or numbers outside their range, raise ValueError."""
import numpy as np

from . import _analysis
from ._analysis import (Cell, Condition, Curve, CurveDifference, Detection, Difference, Diffusion, Estimate, Lag, Psychometric, Ratings, Scale,
                        SpeedAccuracy)

__all__ = ["Cell", "Condition", "Curve", "CurveDifference", "Detection", "Difference", "Diffusion", "Estimate", "Lag", "NotDetermined",
           "Psychometric", "Ratings", "Scale", "SpeedAccuracy", "area", "compare_curves", "detection", "diffusion", "first_passage",
           "holm", "psychometric", "ratings", "response_signal", "scale", "speed_accuracy"]


class NotDetermined(ValueError):
    """The answers do not determine the model; the message says why."""


def diffusion(times_s, correct, *, difficulty=None, deadline_s=None, earliest_s=0.0, start="half-way", contaminants=True,
              drift_varies=False, nondecision_varies=False, method="posterior", confidence=0.95, seed=1) -> Diffusion:
    """Fits a diffusion between two boundaries (Ratcliff 1978, Psychol. Rev. 85:59-108) to the trials of one condition.

    times_s: response times, s. A trial without an answer in time has NaN or a time above its deadline; it counts as
        censored there.
    correct: whether the answer reached the upper boundary: the right answer, or one of two answers.
    difficulty: a number or a name for each trial; each one has a drift of its own, in the sorted order of the numbers or
        names. Boundary and time outside the decision are shared.
    deadline_s: one number, or one per trial (NaN: none).
    earliest_s: answers before this time were not accepted, and count as censored there.
    start: "half-way" between the boundaries, or "fitted".
    contaminants: with a mixture of trials that were no decision; half of them guess, and their times are uniform.
    drift_varies, nondecision_varies: drifts vary normally, times outside the decision uniformly, between trials.
    method: "posterior" as in the report, which gives medians and central intervals, with the priors of
        station/analysis/diffusion.hpp; or "likelihood", which gives the maximum of the likelihood, the best of five
        starts, and intervals from its curvature.

    Raises NotDetermined with fewer than 10 answers, or if they limit boundary and drift at no side."""
    _one_of("start", start, ("half-way", "fitted"))
    _one_of("method", method, ("posterior", "likelihood"))
    times_s, deadlines_s, earliest_s = _times(times_s, deadline_s, earliest_s)
    correct = _flags("correct", correct, times_s, where=~np.isnan(times_s))
    numbers, names = _numbered("difficulty", difficulty, times_s)
    fit, statements = _analysis.diffusion(times_s, correct, numbers, deadlines_s, earliest_s, len(names), contaminants,
                                          start == "fitted", drift_varies, nondecision_varies, method == "likelihood",
                                          _share("confidence", confidence), seed)
    if fit is None:
        raise NotDetermined(" ".join(statements))
    return fit


def speed_accuracy(times_s, correct, condition, *, difficulty=None, deadline_s=None, earliest_s=0.0, order=(), mad=None,
                   confidence=0.95, seed=1) -> SpeedAccuracy:
    """Speed, accuracy and the diffusion's parameters by condition, and their differences, as in the report of a session.

    times_s, correct, difficulty, deadline_s, earliest_s: as in diffusion(); `difficulty` must be numbers.
    condition: a name for each trial.
    order: names of conditions, in the order in which they are compared; others follow as they first occur.
    mad: excludes times further from the median than this multiple of 1.4826 median absolute deviations. It acts on medians
        and scores (LISAS, inverse efficiency, accuracy), never on the diffusion."""
    times_s, deadlines_s, earliest_s = _times(times_s, deadline_s, earliest_s)
    correct = _flags("correct", correct, times_s, where=~np.isnan(times_s))
    difficulty = np.zeros(len(times_s)) if difficulty is None else _numbers("difficulty", difficulty, times_s)
    if np.isnan(difficulty).any():
        raise ValueError("difficulty: NaN; every trial needs a number")
    return _analysis.speed_accuracy(times_s, correct, _texts("condition", condition, times_s), difficulty, deadlines_s,
                                    earliest_s, [str(name) for name in order], mad, _share("confidence", confidence),
                                    seed)


def first_passage(times_s, upper, *, drift, boundary, start=0.5, drift_sd=0.0, delay_range_s=0.0,
                  what="density") -> np.ndarray:
    """Natural logarithm of a function of the first passage of a diffusion, for each time.

    times_s: s, from the start of the decision. upper: which boundary, once or for each time.
    what: "density" (1/s) of arriving at this boundary at the time, "distribution": the probability of
        having arrived there by then, "tail": of arriving there later, "survival": of having arrived nowhere.
    drift, boundary, drift_sd: for s = 0.1, drifts per s. delay_range_s: the start is delayed by up to this time, s.

    The relative error is below 1e-8 where the value exceeds 1e-30 and drift_sd is at most 0.2 per s (Navarro & Fuss
    2009; Blurton, Kesselmeier & Gondan 2012; Tuerlinckx 2004)."""
    _one_of("what", what, ("density", "distribution", "tail", "survival"))
    times_s = _column("times_s", times_s)
    if np.isnan(times_s).any():
        raise ValueError("times_s: NaN; every time must be known")
    if not (np.isfinite(drift) and boundary > 0 and 0 < start < 1 and drift_sd >= 0 and delay_range_s >= 0):
        raise ValueError("the boundary must be above 0, the start between 0 and 1, drift_sd and delay_range_s 0 or more")
    upper = np.broadcast_to(upper, times_s.shape) if np.ndim(upper) == 0 else upper
    return _analysis.first_passage(what, times_s, _flags("upper", upper, times_s), drift, boundary, start, drift_sd,
                                   delay_range_s)


def psychometric(level, positive, trials=None, *, function="weibull", scale="linear", guess=0.5, lapse_high=0.06,
                 adaptive_range=None, seed=1) -> Psychometric:
    """Fits a psychometric function guess + (1 - guess - lapse) F(level) (Wichmann & Hill 2001, Percept. Psychophys. 63:1293).

    level, positive: one entry per trial (positive: whether the answer was), or with `trials` one entry per level
        (positive: how many of `trials` were).
    function: "weibull" (on the linear scale its level is in dB), "normal" or "logistic", of the level or of its logarithm
        (scale "linear" or "log10").
    guess: the lower asymptote; "fitted"; or "lapse" if a slip makes either answer wrong, for signed levels.
    lapse_high: highest lapse rate that the fit may take.
    adaptive_range: (lowest, highest) level that a procedure could choose from the answers. The estimates are then posterior
        medians and the intervals credible. Without it: maximum likelihood with intervals from a parametric bootstrap,
        which hold only for levels that were fixed before.

    Raises NotDetermined if the answers determine no threshold."""
    _one_of("function", function, ("weibull", "normal", "logistic"))
    _one_of("scale", scale, ("linear", "log10"))
    level = _column("level", level)
    if trials is None:
        at, where = np.unique(level, return_inverse=True)
        flags = np.array(_flags("positive", positive, level))
        counts, right = np.bincount(where), np.bincount(where, weights=flags).astype(int)
    else:
        at, counts, right = level, _counts("trials", trials, len(level)), _counts("positive", positive, len(level))
    kind = "fixed"
    if isinstance(guess, str):
        _one_of("guess", guess, ("fitted", "lapse"))
        kind, guess = guess, 0.5
    found = _analysis.psychometric(at, counts, right, function, scale == "log10", kind, _share("guess", guess, zero=True),
                                   _share("lapse_high", lapse_high, zero=True), adaptive_range, seed)
    if found.threshold is None:
        raise NotDetermined(" ".join(found.statements))
    return found


def detection(signal, yes, *, level=None, condition=None, order=(), task="presence") -> list[Detection]:
    """Sensitivity d' and criterion by condition and level, with the log-linear correction (Hautus 1995, Behav. Res. Methods
    27:46-51) and the intervals of Gourevitch & Galanter (1967, Psychometrika 32:25-33).

    signal: whether the trial had a signal; for a task of "sides" or of forced choice, whether "yes" would have been right.
    yes: the answer.
    level: a number per trial, whose absolute value is one level. Trials without a signal serve all levels if the task is
        "presence"; with "sides" and "forced_choice" (d' is divided by the square root of 2) each level has its own.

    condition: a name for each trial; order: names of conditions that come first.

    The last entry of each condition is for all levels together."""
    _one_of("task", task, ("presence", "sides", "forced_choice"))
    signal = np.asarray(signal)
    yes = _flags("yes", yes, signal)
    signal = _flags("signal", signal, signal)
    level = np.full(len(signal), np.nan) if level is None else _numbers("level", level, signal)
    return _analysis.detection(signal, yes, level, _texts("condition", condition, signal), [str(name) for name in order],
                               getattr(_analysis.Detecting, task))


def ratings(noise, signal, *, variances="equal") -> Ratings:
    """Fits the normal model of ratings by maximum likelihood (Dorfman & Alf 1969, J. Math. Psychol. 6:487-496).

    noise, signal: numbers of trials without and with a signal, from the surest "no" to the surest "yes".
    variances: "equal" or "unequal". Raises NotDetermined if the ratings do not determine the model."""
    _one_of("variances", variances, ("equal", "unequal"))
    found = _analysis.ratings(*_rated(noise, signal), variances == "unequal")
    if found is None:
        raise NotDetermined("These ratings do not determine the model: both kinds of trial are needed, they must overlap, "
                            "and unequal variances need three ratings or more that occur.")
    return found


def area(noise, signal) -> Estimate:
    """Area under straight lines through the points of the receiver operating characteristic, with the interval of method 5 of
    Newcombe (2006, Stat. Med. 25:559-573). noise, signal: as in ratings()."""
    found = _analysis.area(*_rated(noise, signal))
    if found is None:
        raise NotDetermined("The curve needs trials with and without a signal.")
    return found


def response_signal(times_s, lag_s, signal, yes, *, condition=None, order=(), task="presence") -> list[Curve]:
    """Fits d'(t) = asymptote (1 - exp(-rate (t - intercept))) to answers at response signals (Wickelgren 1977, Acta Psychol.
    41:67-85), one curve per condition. The priors are those of station/analysis/response_signal.hpp.

    times_s, lag_s: time of the answer and of the response signal, s, from the same zero.
    signal, yes, condition, order, task: as in detection(). Fewer than three lags give a statement and no curve."""
    _one_of("task", task, ("presence", "sides", "forced_choice"))
    times_s = _column("times_s", times_s)
    lag_s = _numbers("lag_s", lag_s, times_s)
    if np.isnan(times_s).any() or np.isnan(lag_s).any():
        raise ValueError("times_s, lag_s: NaN; leave out trials without an answer")
    return _analysis.response_signal(times_s, lag_s, _flags("signal", signal, times_s), _flags("yes", yes, times_s),
                                     _texts("condition", condition, times_s), [str(name) for name in order],
                                     getattr(_analysis.Detecting, task))


def compare_curves(curves) -> list[CurveDifference]:
    """Compares the curves of response_signal(), each with each: differences with intervals (MOVER; Donner & Zou 2002), and the
    p values of nested models, in which two conditions share one parameter and everything else is free (chi squared, one
    degree of freedom).

    curves: what response_signal() returned for several conditions."""
    return _analysis.compare_curves(list(curves))


def scale(stimuli, second, *, condition=None, order=(), model=None, sessions=499) -> list[Scale]:
    """Scales stimuli by comparisons, one scale per condition.

    stimuli: a row per trial with the values of two, three or four stimuli in order of presentation.
    second: whether the answer was the second stimulus of a pair; for three, that the last two differ more than the first two;
    for four, that the second pair differs more than the first.
    condition, order: name of the condition of each trial, and their order.
    model: for pairs "bradley-terry" (default; Bradley & Terry 1952, Biometrika 39:324-345) or "thurstone" (case V, in standard
    deviations of what one stimulus is felt as); for three or four "differences" (maximum-likelihood difference scaling, Maloney
    & Yang 2003, J. Vis. 3:573-585; from 0 at the lowest to 1 at the highest). Jeffreys' prior keeps values of stimuli finite
    that were always or never chosen (Kosmidis & Firth 2021, Biometrika 108:71-82). Values that the answers do not determine
    are None, and a statement says why.
    sessions: number of simulated sessions with which the scale is checked; 0 for none, which takes much less time."""
    stimuli = np.asarray(stimuli, dtype=float)
    if stimuli.ndim != 2 or stimuli.shape[1] not in (2, 3, 4) or len(stimuli) == 0:
        raise ValueError("stimuli: a row per trial with two, three or four values is needed")
    if not np.isfinite(stimuli).all():
        raise ValueError("stimuli: NaN or infinite")
    allowed = ("bradley-terry", "thurstone") if stimuli.shape[1] == 2 else ("differences",)
    model = allowed[0] if model is None else model
    _one_of("model", model, allowed)
    first = stimuli[:, 0]
    return _analysis.scale(stimuli.tolist(), _flags("second", second, first), _texts("condition", condition, first),
                           [str(name) for name in order], model, _sessions(sessions))


def holm(p, *, family=None) -> np.ndarray:
    """Corrects p values for the number of tests (Holm 1979, Scand. J. Stat. 6:65-70), as R's p.adjust(p, "holm") does.

    p: p values from 0 to 1; NaN is a test that was not made.
    family: a name for each test; only tests of one family are corrected together. Without it, all are."""
    p = _column("p", p)
    if (p < 0).any() or (p > 1).any():
        raise ValueError("p: values from 0 to 1 are needed, or NaN")
    return _analysis.holm(p, _texts("family", family, p))


def _one_of(name, value, allowed):
    if value not in allowed:
        raise ValueError(f"{name}: {value!r} is not one of " + ", ".join(map(repr, allowed)))


def _sessions(sessions):
    if int(sessions) != sessions or sessions < 0:
        raise ValueError(f"sessions: {sessions} is not a whole number of 0 or more")
    return int(sessions)


def _share(name, value, zero=False):
    if not (0 < value < 1 or zero and value == 0):
        raise ValueError(f"{name}: {value} is not {'0 or more' if zero else 'above 0'} and below 1")
    return float(value)


def _column(name, values):
    values = np.asarray(values, dtype=float)
    if values.ndim != 1 or len(values) == 0:
        raise ValueError(f"{name}: an array of one dimension with one entry or more is needed")
    if np.isinf(values).any():
        raise ValueError(f"{name}: has an infinite entry")
    return values


def _numbers(name, values, like):
    values = np.asarray(values, dtype=float)
    if values.ndim == 0:
        values = np.full(len(like), float(values))
    values = _column(name, values)
    if len(values) != len(like):
        raise ValueError(f"{name}: {len(values)} entries, but there are {len(like)} trials")
    return values


def _counts(name, values, length):
    values = np.asarray(values)
    if values.shape != (length,) or not np.array_equal(values, values.astype(int)):
        raise ValueError(f"{name}: {length} whole numbers are needed")
    return values.astype(int)


def _rated(noise, signal):
    noise, signal = np.asarray(noise), np.asarray(signal)
    return _counts("noise", noise, noise.size), _counts("signal", signal, noise.size)


def _flags(name, values, like, where=None):
    """Entries that are true or false, as 0/1 or booleans; those outside `where` may be missing."""
    values = np.asarray(values)
    if values.shape != (len(like),):
        raise ValueError(f"{name}: {values.size} entries, but there are {len(like)} trials")
    needed = np.ones(len(like), dtype=bool) if where is None else where
    true = values == 1
    for i in np.flatnonzero(needed & ~true & ~(values == 0)):
        raise ValueError(f"{name}: entry {i} is {values[i]!r}, neither true nor false")
    return np.asarray(needed & true, dtype=bool)


def _texts(name, values, like):
    if values is None:
        return [""] * len(like)
    values = [str(value) for value in np.asarray(values)]
    if len(values) != len(like):
        raise ValueError(f"{name}: {len(values)} entries, but there are {len(like)} trials")
    return values


def _numbered(name, values, like):
    if values is None:
        return np.zeros(len(like), dtype=np.uint64), [None]
    values = np.asarray(values)
    if values.shape != (len(like),):
        raise ValueError(f"{name}: {values.size} entries, but there are {len(like)} trials")
    if values.dtype.kind == "f" and np.isnan(values).any():
        raise ValueError(f"{name}: NaN; every trial needs one")
    names, numbers = np.unique(values, return_inverse=True)
    return numbers.astype(np.uint64), list(names)


def _times(times_s, deadline_s, earliest_s):
    times_s = _column("times_s", times_s)
    deadlines_s = np.full(len(times_s), np.nan) if deadline_s is None else _numbers("deadline_s", deadline_s, times_s)
    earliest_s = _numbers("earliest_s", earliest_s, times_s)
    for i in np.flatnonzero(~(times_s > 0) & ~(np.isnan(times_s) & (deadlines_s > 0))):
        raise ValueError(f"times_s: entry {i} is {times_s[i]}; a time must be above 0, or NaN if the trial has a deadline")
    if (deadlines_s <= earliest_s).any() or (earliest_s < 0).any() or np.isnan(earliest_s).any():
        raise ValueError("earliest_s must be 0 or more, and below the deadline")
    return times_s, deadlines_s, earliest_s
