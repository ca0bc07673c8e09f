"""Waves on tapered friction displays. SI units; positions from the drive edge; peak amplitudes."""
from typing import Any, Literal, overload

import numpy as np
import numpy.typing as npt

Edges = Literal["supported", "clamped"]
Bending = Literal["auto", "on", "off"]
DriveShape = Literal["cosine", "piston"]
PlateTheory = Literal["kirchhoff", "mindlin", "elastic"]
Model = Literal["edge", "mode", "modes"]
Normalise = Literal["drive", "peak", "none"]

class Unreachable(ValueError):
    """A target that this surface cannot present, or a model that does not apply to it."""

class LinearTaper:
    """Half-width W(x) = half_width_m - slope x. The sides meet at the apex."""
    half_width_m: float  # half-width at the drive edge, m
    slope: float  # fall of the half-width per length, no unit
    def __init__(self, *, half_width_m: float = ..., slope: float = ...) -> None: ...

class ExponentialTaper:
    """Half-width W(x) = half_width_m exp(-x / decay_length_m)."""
    decay_length_m: float  # m
    half_width_m: float  # half-width at the drive edge, m
    def __init__(self, *, decay_length_m: float = ..., half_width_m: float = ...) -> None: ...

class TabulatedTaper:
    """Measured half-widths, joined by monotone cubics. The first point is at x = 0, the last at or beyond the surface's
        length; half-widths fall strictly."""
    def __init__(self, x_m: npt.ArrayLike, half_width_m: npt.ArrayLike) -> None: ...

class ParameterSd:
    """Standard deviations of a surface's parameters; 0 means that a parameter is exact."""
    clamp_line_m: float
    decay_length_m: float
    density_kg_m3: float
    half_width_m: float
    modulus_Pa: float
    quality_factor: float
    slope: float
    temperature_K: float
    tension_Pa: float
    thickness_m: float
    def __init__(self, *, clamp_line_m: float = ..., decay_length_m: float = ..., density_kg_m3: float = ...,
        half_width_m: float = ..., modulus_Pa: float = ..., quality_factor: float = ..., slope: float = ..., temperature_K:
        float = ..., tension_Pa: float = ..., thickness_m: float = ...) -> None: ...

class Surface:
    """The tapered surface: material, taper, tension, loss and supports. SI units."""
    bending: Bending  # "auto", "on" or "off"
    density_kg_m3: float  # density, kg/m3
    drive: DriveShape  # motion across the drive edge: "cosine" or "piston"
    edges: Edges  # how the sides are held: "supported" or "clamped"
    expansion_per_K: float  # relative change of every length, 1/K
    length_m: float  # from the drive edge to the clamped end, m
    modulus_Pa: float | None  # Young's modulus, Pa; needed where bending is modelled
    modulus_per_K: float  # relative change of Young's modulus, 1/K
    poisson: float  # Poisson's ratio
    quality_factor: float  # Q; infinity means no loss
    sd: ParameterSd  # standard deviations of the parameters
    taper: LinearTaper | ExponentialTaper | TabulatedTaper  # reading returns a copy
    tension_Pa: float  # tension as a stress, Pa; 0 means a plate
    theory: PlateTheory  # "kirchhoff", "mindlin" or "elastic"
    thickness_m: float  # thickness, m
    yield_strength_Pa: float | None  # Pa
    def __init__(self, *, bending: Bending = ..., density_kg_m3: float = ..., drive: DriveShape = ..., edges:
        Edges = ..., expansion_per_K: float = ..., length_m: float = ..., modulus_Pa: float | None = ..., modulus_per_K:
        float = ..., poisson: float = ..., quality_factor: float = ..., sd: ParameterSd = ..., taper:
        LinearTaper | ExponentialTaper | TabulatedTaper = ..., tension_Pa: float = ..., theory: PlateTheory = ...,
        thickness_m: float = ..., yield_strength_Pa: float | None = ...) -> None: ...

class Tone:
    """A tone: the drive edge moves by amplitude_m cos(2 pi frequency_Hz t + phase_rad)."""
    amplitude_m: float  # peak displacement of the drive edge's centre, m
    frequency_Hz: float  # Hz
    phase_rad: float  # rad
    def __init__(self, *, amplitude_m: float = ..., frequency_Hz: float = ..., phase_rad: float = ...) -> None: ...

class Warning:
    """A warning: a stable code for programs and a sentence for people."""
    @property
    def code(self) -> str: ...
    @property
    def text(self) -> str: ...

class ToneInfo:
    """What a model predicts for one tone. A position is None if it does not exist."""
    @property
    def conditioning(self) -> float: ...  # factor by which the division by v(0) amplifies rounding errors
    @property
    def frequency_Hz(self) -> float: ...
    @property
    def gain(self) -> float: ...  # |v| at the last maximum divided by |v(0)|
    @property
    def last_peak_m(self) -> float | None: ...  # outermost maximum of |v|, m
    @property
    def nearest_resonance_Hz(self) -> float | None: ...  # set only by tone_info()
    @property
    def no_peak_reason(self) -> str: ...
    @property
    def turning_point_m(self) -> float | None: ...  # where the local cut-off equals the frequency, m

class ToneField:
    """The field of one tone at the points x_m of the call."""
    @property
    def info(self) -> ToneInfo: ...
    @property
    def ln_amplitude(self) -> npt.NDArray[np.float64]: ...  # ln|v|, correct also where v underflows
    @property
    def v(self) -> npt.NDArray[np.complex128]: ...  # complex displacement; the time factor is exp(+i omega t)

class Field:
    """The fields of all tones, and their sum."""
    @property
    def amplitude(self) -> npt.NDArray[np.float64]: ...  # root of the summed squares of |v| over tones
    @property
    def ln_amplitude(self) -> npt.NDArray[np.float64]: ...
    @property
    def model(self) -> Model: ...
    @property
    def normalise(self) -> Normalise: ...
    @property
    def tones(self) -> list[ToneField]: ...

class FieldNotes:
    """How far a field can be trusted."""
    @property
    def error_bound(self) -> float: ...  # error of |v|, relative to its largest value
    @property
    def validity(self) -> str: ...
    @property
    def warnings(self) -> list[Warning]: ...

class RungEstimate:
    """The error bounds of a model, estimated before it is evaluated."""
    @property
    def amplitude_bound(self) -> float: ...
    @property
    def boundary_bound_m(self) -> float: ...
    @property
    def cost_s(self) -> float: ...
    @property
    def level_bound_dB(self) -> float: ...
    @property
    def model(self) -> Model: ...
    @property
    def reason(self) -> str: ...
    @property
    def usable(self) -> bool: ...

class PlanChoice:
    """The cheapest model within the tolerance."""
    @property
    def bound(self) -> RungEstimate: ...
    @property
    def considered(self) -> list[RungEstimate]: ...
    @property
    def inside(self) -> bool: ...
    @property
    def model(self) -> Model: ...
    @property
    def reason(self) -> str: ...

class Finger:
    """A fingertip as a mechanical impedance that presses evenly on a disc."""
    beside_m: float  # distance of the disc's centre from the centre line, m
    contact_radius_m: float  # m
    impedance_Ns_per_m: complex  # force divided by velocity, N s/m, complex
    def __init__(self, *, beside_m: float = ..., contact_radius_m: float = ..., impedance_Ns_per_m:
        complex = ...) -> None: ...

class FrictionMap:
    """Vibration amplitude to friction, relative to the surface at rest."""
    @overload
    def __init__(self) -> None: ...
    @overload
    def __init__(self, displacement_m: npt.ArrayLike, relative_friction: npt.ArrayLike) -> None: ...
    def displacement_m(self, relative_friction: float) -> float | None: ...
    def relative_friction(self, displacement_m: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    @property
    def illustrative(self) -> bool: ...
    @property
    def lowest_friction(self) -> float: ...

class ToneBand:
    """The frequencies that may be used."""
    high_Hz: float
    low_Hz: float
    spacing_Hz: float  # smallest difference between two tones, Hz
    def __init__(self, *, high_Hz: float = ..., low_Hz: float = ..., spacing_Hz: float = ...) -> None: ...

class ZoneRequest:
    """A zone of uniform friction."""
    band: ToneBand
    boundary_m: float
    edge: str
    fingertip_m: float
    from_m: float
    friction: float  # mean relative friction
    tones: int  # largest number of tones
    def __init__(self, *, band: ToneBand = ..., boundary_m: float = ..., edge: str = ..., fingertip_m: float = ...,
        from_m: float = ..., friction: float = ..., tones: int = ...) -> None: ...

class ZoneDesign:
    """Tones that produce a zone."""
    @property
    def boundary_m(self) -> float: ...
    @property
    def crest_factor(self) -> float: ...
    @property
    def friction(self) -> float: ...
    @property
    def node_fill(self) -> float: ...
    @property
    def peak_displacement_m(self) -> float: ...
    @property
    def reason(self) -> str: ...
    @property
    def residual(self) -> float: ...
    @property
    def tones(self) -> list[Tone]: ...
    @property
    def warnings(self) -> list[Warning]: ...

class ProfileDesign:
    """Tones that come closest to a profile of amplitude."""
    @property
    def reachable(self) -> bool: ...
    @property
    def residual(self) -> float: ...
    @property
    def tones(self) -> list[Tone]: ...
    @property
    def verdict(self) -> str: ...

class FrictionContext:
    """What a friction edge needs in addition to the surface."""
    friction: FrictionMap
    displacement_m: float  # peak amplitude at the last maximum, m
    fingertip_m: float  # m
    def __init__(self, *, friction: FrictionMap = ..., displacement_m: float = ..., fingertip_m:
        float = ...) -> None: ...

class MapAnswer:
    """The result of a look-up, with error bound, uncertainty, reason and warnings."""
    @property
    def boundary_m(self) -> float | None: ...
    @property
    def edge(self) -> str: ...
    @property
    def error_bound_m(self) -> float: ...  # error of the model, m
    @property
    def frequency_Hz(self) -> float | None: ...
    @property
    def m_per_Hz(self) -> float: ...
    @property
    def model(self) -> Model: ...
    @property
    def reason(self) -> str: ...
    @property
    def shear_shift_m(self) -> float | None: ...
    @property
    def uncertainty_m(self) -> float: ...  # standard deviation that the surface's parameters cause, m
    @property
    def warnings(self) -> list[Warning]: ...

class Contribution:
    """What one uncertain parameter contributes to the uncertainty of a boundary."""
    @property
    def left_m(self) -> float: ...  # the boundary's standard deviation if this parameter were known exactly, m
    @property
    def moved_m(self) -> float: ...  # how far one standard deviation moves the boundary, m
    @property
    def parameter(self) -> str: ...
    @property
    def sd(self) -> float: ...  # standard deviation of the parameter, SI units

class BoundaryBudget:
    """How uncertain a boundary is, and which parameters cause this."""
    @property
    def contributions(self) -> list[Contribution]: ...
    @property
    def total_m(self) -> float: ...  # one standard deviation, m

class MeasuredBoundary:
    """The measured position of an edge at one frequency."""
    boundary_m: float
    frequency_Hz: float
    sd_m: float  # precision of the measurement, m
    def __init__(self, *, boundary_m: float = ..., frequency_Hz: float = ..., sd_m: float = ...) -> None: ...

class FittedParameter:
    """One parameter of a fit."""
    @property
    def change(self) -> float: ...  # estimate minus the value in the surface, SI units
    @property
    def parameter(self) -> str: ...
    @property
    def prior_sd(self) -> float: ...
    @property
    def sd(self) -> float: ...

class BoundaryFit:
    """Parameters estimated from measured boundaries."""
    def applied_to(self, surface: Surface) -> Surface: ...
    @property
    def deviations(self) -> list[float]: ...
    @property
    def left_out(self) -> bool: ...
    @property
    def outliers(self) -> list[bool]: ...
    @property
    def parameters(self) -> list[FittedParameter]: ...
    @property
    def residuals_m(self) -> list[float]: ...  # measured minus fitted, m

class BoundaryMap:
    """The map between boundary and frequency for one surface and one edge."""
    def __init__(self, surface: Surface, edge: str = 'turning', *, model: Model | None = None, tolerance_m:
        float | None = None, friction: FrictionContext | None = None, band_Hz: tuple[float,
        float] | None = None) -> None: ...
    def at_boundary(self, boundary_m: float) -> MapAnswer: ...
    def at_frequency(self, frequency_Hz: float) -> MapAnswer: ...
    @overload
    def boundary_m(self, frequency_Hz: float) -> float | None: ...  # None or NaN where there is none
    @overload
    def boundary_m(self, frequency_Hz: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    @overload
    def frequency_Hz(self, boundary_m: float) -> float | None: ...
    @overload
    def frequency_Hz(self, boundary_m: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    @property
    def model(self) -> Model: ...

def aluminium_plate() -> Surface:
    """A clamped aluminium plate, 2 mm thick."""

def amplitude_profile(surface: Surface, tones: list[Tone], x_m: npt.ArrayLike, model:
    Model = 'mode') -> npt.NDArray[np.float64]:
    """Amplitude in m at each point: the root of the sum of |v|^2 over the tones."""

def assign_phases(tones: list[Tone]) -> list[Tone]:
    """The tones with phases that give a low crest factor."""

def boundary_budget(surface: Surface, frequency_Hz: float, boundary_m: float) -> BoundaryBudget:
    """What each uncertain parameter contributes to the uncertainty of a boundary, largest first."""

def choose_model(surface: Surface, tones: list[Tone], *, points: int = 0, edge: str = 'turning', normalise:
    Normalise = 'peak', boundary_m: float | None = None, amplitude: float | None = None, level_dB:
    float | None = None) -> PlanChoice:
    """Chooses the cheapest model whose error bounds are within the tolerances: the error of the boundary (m), of |v|
    relative to its largest value, and of the level at the last maximum (dB). None tolerates any error."""

def crest_factor(tones: list[Tone]) -> float:
    """Peak of the summed waveform divided by its root mean square."""

def describe(surface: Surface, tones: list[Tone], field: Field) -> FieldNotes:
    """Error bound, validity and warnings of a field."""

def design_profile(surface: Surface, x_m: npt.ArrayLike, amplitude_m: npt.ArrayLike, band:
    ToneBand = ...) -> ProfileDesign:
    """Finds tones that come closest to amplitudes in m at the positions x_m."""

def design_zone(surface: Surface, friction: FrictionMap, request: ZoneRequest) -> ZoneDesign:
    """Finds tones that give a zone of uniform friction."""

def drive_amplitude_m(surface: Surface, frequency_Hz: float, displacement_m: float, model: Model = 'mode') -> float:
    """The amplitude at the drive edge that gives this displacement at the last maximum, m."""

def evaluate(surface: Surface, tones: list[Tone], x_m: npt.ArrayLike, model: Model = 'mode', normalise:
    Normalise = 'drive') -> Field:
    """The centre-line displacement at the points x_m, in any order. See Field."""

def finger_load(surface: Surface, frequency_Hz: float, x_m: npt.ArrayLike, finger: Finger) -> dict[str,
    npt.NDArray[Any]]:
    """Means over the disc under the finger, as arrays: unloaded, loaded (v(0) = 1), mobility_m_per_Ns, and share,
    the fraction of the amplitude that remains under the finger."""

def fingertip_average(x_m: npt.ArrayLike, values: npt.ArrayLike, fingertip_m: float) -> npt.NDArray[np.float64]:
    """Averages samples over a fingertip centred at each x; the x must ascend."""

def fit_boundaries(surface: Surface, measured: list[MeasuredBoundary], edge: str = 'turning') -> BoundaryFit:
    """Fits the surface's uncertain parameters to measured boundaries."""

def half_width_m(surface: Surface, x_m: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Half-widths W(x) in m."""

def loudest_sound_dB(surface: Surface, tone: Tone, distance_m: float, model: Model = 'mode') -> float:
    """The highest sound level at this distance from the centre line, dB re 20 uPa rms."""

def seed_brass() -> Surface:
    """The brass membrane of the 1998 paper."""

def shear_shift_m(surface: Surface, frequency_Hz: float) -> float | None:
    """Distance by which the next better plate theory would move the turning point, m."""

def solve_frequency_Hz(surface: Surface, boundary_m: float, edge: str = 'turning', *, model: Model | None = None,
    friction: FrictionContext | None = None) -> float | None:
    """The frequency that puts the edge at boundary_m, without a map; None if the search fails."""

def surface_warnings(surface: Surface) -> list[Warning]:
    """Warnings about the surface itself, such as a tension above the yield strength."""

def tone_info(surface: Surface, frequency_Hz: float, model: Model = 'mode') -> ToneInfo:
    """Positions and gain for one frequency, without a profile."""

def validate(surface: Surface) -> None:
    """Raises ValueError if a quantity is outside its physical range."""
