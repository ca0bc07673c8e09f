#pragma once
// The tapered surface: material, taper, tension, loss and supports. SI units, plain data.
//
//        y ^   clamped or simply supported sides, v = 0 at |y| = W(x)
//          |\___________
//  drive   |            \________       W(x): half-width, falling with x
//  x = 0   |                      |  x = length_m: clamped end
//          |             ________/
//          |/-----------
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace turnpoint::physics {

// How the two sloping sides are held: simply supported (v = 0, no moment) or clamped (v = 0, no slope). For a
// membrane without bending stiffness there is no difference.
enum class Edges { supported, clamped };

// Whether bending stiffness is modelled. `automatic` models it on every surface without tension. On a surface
// with tension, it does so only if bending changes a cut-off frequency by more than about half a percent
// somewhere in the first 90 % of the length (see bending_modelled).
enum class Bending { automatic, on, off };

// The theory that describes bending of a clamped plate. For a 2 mm aluminium plate at 22 to 45 kHz,
// Kirchhoff's cut-off half-width is 3 to 6 % larger than that of the elastic cross-section. Mindlin's agrees
// with the elastic one within 0.2 % (h/W to 0.4, Poisson's ratio 0 to 0.4).
enum class PlateTheory {
  kirchhoff,  // thin plate: D lap^2 v = rho h omega^2 v, plus a term for tension
  // includes shear and rotary inertia; the shear factor depends on Poisson's ratio (mindlin_plate.hpp)
  mindlin,
  elastic  // three-dimensional elasticity of the cross-section (elastic_section.hpp)
};

// Converts a theory to its name, "kirchhoff", "mindlin" or "elastic", and back. `parse_plate_theory` throws
// std::invalid_argument with a list of the names.
std::string_view name(PlateTheory theory);
PlateTheory parse_plate_theory(std::string_view text);

// W(x) = half_width_m - slope x. The sides meet at the apex, x = half_width_m / slope.
struct LinearTaper {
  double half_width_m;
  double slope;
};

// W(x) = half_width_m exp(-x / decay_length_m).
struct ExponentialTaper {
  double half_width_m;
  double decay_length_m;
};

struct TaperPoint {
  double x_m;
  double half_width_m;
};

// Measured half-widths, joined by monotone cubics with continuous slope (Fritsch & Carlson 1980). The first
// point must be at x = 0, the last at or beyond the surface's length; half-widths must fall strictly.
struct TabulatedTaper {
  std::vector<TaperPoint> points;
  // dW/dx at the points, if smooth_sides() has made the table; empty for a measured one, whose slopes follow
  // from its points
  std::vector<double> slopes = {};
};

using TaperForm = std::variant<LinearTaper, ExponentialTaper, TabulatedTaper>;

// Parameters that determine the position of a boundary and are not known exactly. The clamp line is where the
// sides are really held: a fraction of the thickness behind the edge of the clamp. The parameter is its
// distance from that edge, which is added to W(x) everywhere. An exponential taper has no clamp line, because
// its formula has no term for one.
enum class Parameter {
  density,
  tension,
  thickness,
  modulus,
  half_width,
  slope,
  decay_length,
  clamp_line,
  temperature,
  quality_factor
};

// Standard deviations of the surface's parameters; zero means that a parameter is known exactly. They give
// the uncertainty of a boundary and of a level, which are reported separately from the error of a model.
struct ParameterSd {
  double density_kg_m3 = 0;
  double tension_Pa = 0;
  double thickness_m = 0;
  double modulus_Pa = 0;
  double half_width_m = 0;
  double slope = 0;           // for a linear taper
  double decay_length_m = 0;  // for an exponential taper
  double clamp_line_m = 0;
  // how far the temperature may deviate from the one at which the other values hold
  double temperature_K = 0;
  double quality_factor = 0;  // changes levels; no boundary moves noticeably with it
};

// The correlation between the errors of two parameters that were determined by the same fit.
struct Correlation {
  Parameter first, second;
  double coefficient = 0;
};

// How the displacement of the drive edge (x = 0) varies with y. It is 1 at the centre line.
enum class DriveShape {
  cosine,  // cos(pi y / 2W), the shape of the first transverse mode, which the 1998 paper assumes
  piston   // 1 everywhere: a stiff bar, which also excites the higher transverse modes
};

struct Surface {
  double density_kg_m3 = 0;
  double tension_Pa = 0;  // tension as a stress; 0 means a plate
  double thickness_m = 0;
  double length_m = 0;  // distance from the drive edge to the clamped end
  // The quality factor that a resonance curve shows: a resonance's frequency over its width at half of its
  // power. Infinity means no loss. The wavenumber becomes k (1 - i/2Q) on a membrane and k (1 - i/4Q) in
  // bending, where k^2 is proportional to the frequency (see Dispersion::loss).
  double quality_factor = 0;
  TaperForm taper = LinearTaper{0, 0};
  Edges edges = Edges::supported;
  Bending bending = Bending::automatic;
  DriveShape drive = DriveShape::cosine;
  std::optional<double> modulus_Pa;  // Young's modulus; required when bending is modelled
  double poisson = 0.33;
  // mindlin and elastic: only for clamped plates without tension
  PlateTheory theory = PlateTheory::kirchhoff;
  std::optional<double> yield_strength_Pa;
  // relative change per kelvin of every length (expansion) and of Young's modulus; 0 ignores temperature
  double expansion_per_K = 0;
  double modulus_per_K = 0;
  ParameterSd sd;
  std::vector<Correlation> correlations;  // empty if all values were measured separately
};

struct Material {
  std::string_view name;
  double density_kg_m3;
  double modulus_Pa;
  double poisson;
  // yield strength of a strong commercial temper (handbook value, accurate to about 10 %)
  double yield_strength_Pa;
};

// Returns the material with this name; empty if it is unknown.
std::optional<Material> find_material(std::string_view name);

// Throws std::invalid_argument if a quantity is outside its physical range. The message names the first such
// quantity and its allowed range.
void validate(const Surface& surface);

// Returns the half-width (m) at x in [0, length_m]. For many points, make a Taper (taper.hpp).
double half_width_m(const Surface& surface, double x_m);

// Bending stiffness D = E h^3 / (12 (1 - nu^2)), which is empty without a modulus; line tension N = T h; and
// wave speed c = sqrt(T / rho).
std::optional<double> bending_stiffness_N_m(const Surface& surface);
double line_tension_N_per_m(const Surface& surface);
double wave_speed_m_s(const Surface& surface);

// Whether the equations for this surface include bending, according to its `bending` setting. validate()
// rejects a plate without a modulus or with bending off.
bool bending_modelled(const Surface& surface);

// Reference surfaces for tests and examples: the 1998 paper's brass membrane (30 mm half-width, slope 0.1,
// 5.12 GPa; no loss), and an aluminium plate (clamped, 14 mm, slope 0.03, 2 mm thick, Q = 30).
Surface seed_brass();
Surface aluminium_plate();

}  // namespace turnpoint::physics
