#include "physics/edge_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/edge_feature.hpp"
#include "physics/gate.hpp"
#include "physics/root.hpp"
#include "physics/statement.hpp"

namespace turnpoint::physics {
namespace {

using Piece = EdgeTable::Piece;
constexpr std::size_t most_terms = EdgeTable::degree + 1;

// Returns how often a range of frequencies may be halved. The number is lower where one position takes long
// to compute: for friction edges, and on a taper with many points, where the solution needs a step for every
// point. On smoothed sides, which still wiggle, the ratio does not follow a polynomial closely in any case.
int deepest(const Surface& surface, const MapOptions& options) {
  const auto* table = std::get_if<TabulatedTaper>(&surface.taper);
  if (table != nullptr && !table->slopes.empty()) return 5;
  if (table != nullptr && table->points.size() > 200) return 3;
  return options.edge.kind == Edge::Kind::friction ? 5 : 9;
}

// Returns the error below which the table is not refined further. Finite elements and fingertip integrals are
// no more accurate than this, so a finer table would only reproduce their numerical errors. And the curvature
// of a tabulated taper jumps at every point, so no number of pieces could follow the edge exactly.
double tolerance_m(const Surface& surface, const MapOptions& options) {
  if (options.edge.kind == Edge::Kind::friction) return 2e-6;
  const Dispersion dispersion(surface);
  if (dispersion.theory != PlateTheory::kirchhoff) return 2e-6;
  if (dispersion.clamped_bending()) return 3e-7;
  return std::holds_alternative<TabulatedTaper>(surface.taper) ? 1e-8 : 1e-11;
}

double clenshaw(const Piece& piece, double ln_f) noexcept {
  const double t = (2 * ln_f - piece.low - piece.high) / (piece.high - piece.low);
  double b1 = 0, b2 = 0;
  for (std::size_t k = most_terms - 1; k > 0; --k) {
    const double b0 = 2 * t * b1 - b2 + piece.coefficient[k];
    b2 = b1;
    b1 = b0;
  }
  return t * b1 - b2 + piece.coefficient[0];
}

class Builder {
 public:
  Builder(const Surface& surface, const MapOptions& options, Model model)
      : surface_(surface), options_(options), model_(model), taper_(surface), dispersion_(surface) {
    // A thick plate's solution takes a hundred times as long as a thin plate's, and its table needs fewer
    // digits.
    if (thick()) terms_ = 7;
  }

  std::optional<double> position(double f) const {
    try {
      const auto wave = model_ == Model::edge || model_ == Model::modes ? Wave::exact : Wave::as_modelled;
      return solve_edge_m(surface_, options_, f, model_, wave);
    } catch (const std::domain_error&) {  // the model does not apply at this frequency
      return std::nullopt;
    }
  }
  std::optional<double> ratio(double f) const {
    const auto x = position(f);
    if (!x) return std::nullopt;
    return taper_.half_width_m(*x) / dispersion_.cut_off_half_width_m(f);
  }

  // Returns frequencies whose turning points are spread over the surface, or over the requested band.
  std::vector<double> survey() const {
    std::vector<double> f;
    const int count = options_.band ? 12 : 48;
    for (int i = 0; i <= count; ++i) {
      const double w = taper_.half_width_m(surface_.length_m * i / count);
      if (w > 1e-6 * taper_.half_width_m(0)) f.push_back(dispersion_.cut_off_frequency_Hz(w));
    }
    std::erase_if(f, [high = highest_frequency_Hz(surface_)](double one) { return one > high; });
    if (!options_.band) return f;
    const double low =
        std::max(options_.band->low_Hz, dispersion_.cut_off_frequency_Hz(taper_.half_width_m(0)));
    const double high = std::min(options_.band->high_Hz, highest_frequency_Hz(surface_));
    if (!(low < high)) return {};
    std::erase_if(f, [low, high](double one) { return one <= low || one >= high; });
    f.insert(f.begin(), low);
    f.push_back(high);
    return f;
  }

  // Finds the frequency at which the edge stops existing, between `with` (the edge exists) and `without` (it
  // does not).
  double limit(double with, double without) const {
    // On plates and tabulated tapers a solution takes long, so a rough limit is enough. The limit is safe,
    // because the edge exists at the frequency that is returned.
    const bool dear = dispersion_.clamped_bending() || std::holds_alternative<TabulatedTaper>(surface_.taper);
    const double enough = thick() ? 1e-4 : dear ? 1e-9 : 1e-14;
    return bisect(
               {with, without}, [this](double f) { return ratio(f).has_value(); },
               [enough](const Bracket& b) { return b.width() <= enough * b.above; }, 60)
        .above;
  }

  void fill(EdgeTable& table, double low, double high, int depth) const {
    Piece piece{low, high, {}};
    std::array<double, most_terms> value{};
    const bool complete = sample(piece, value);
    double worst = std::numeric_limits<double>::infinity();
    if (complete) worst = miss(piece);
    if (worst > tolerance_m(surface_, options_) && depth < deepest(surface_, options_)) {
      // Near the lowest frequency the edge is close to the drive edge, where its position is least smooth;
      // make the piece there shorter.
      const double middle =
          low + (thick() && piece.low == std::log(table.low_Hz) ? 0.25 : 0.5) * (high - low);
      fill(table, low, middle, depth + 1);
      fill(table, middle, high, depth + 1);
      return;
    }
    if (!complete) return;
    table.pieces.push_back(piece);
    table.error_m = std::max(table.error_m, worst);
  }

 private:
  bool thick() const { return dispersion_.theory != PlateTheory::kirchhoff; }

  bool sample(Piece& piece, std::array<double, most_terms>& value) const {
    const auto n = static_cast<double>(terms_);
    for (std::size_t j = 0; j < terms_; ++j) {
      const double t = std::cos(std::numbers::pi * (static_cast<double>(j) + 0.5) / n);
      const auto r = ratio(std::exp(0.5 * (piece.low + piece.high + t * (piece.high - piece.low))));
      if (!r) return false;
      value[j] = *r;
    }
    for (std::size_t k = 0; k < terms_; ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < terms_; ++j) {
        sum += value[j] *
               std::cos(std::numbers::pi * static_cast<double>(k) * (static_cast<double>(j) + 0.5) / n);
      }
      piece.coefficient[k] = sum * (k == 0 ? 1 : 2) / n;
    }
    return true;
  }

  // Largest error (m) of a piece of the table, at points between its nodes.
  double miss(const Piece& piece) const {
    double worst = 0;
    for (const double t : {-0.98, -0.55, 0.06, 0.6, 0.985}) {
      const double ln_f = 0.5 * (piece.low + piece.high + t * (piece.high - piece.low));
      const double f = std::exp(ln_f);
      const auto x = position(f);
      const auto w = taper_.position_continued_m(clenshaw(piece, ln_f) * dispersion_.cut_off_half_width_m(f));
      if (!x || !w) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, std::abs(*x - *w));
      // stop here: with this error, the piece will be halved in any case
      if (worst > 100 * tolerance_m(surface_, options_)) return worst;
    }
    return worst;
  }

  const Surface& surface_;
  const MapOptions& options_;
  Model model_;
  Taper taper_;
  Dispersion dispersion_;
  std::size_t terms_ = most_terms;  // number of terms of the series for one piece of the table
};

// True if each edge has the same k s (wavenumber times distance from the apex) at all frequencies, with any
// loss. This is so on a linear taper that runs to its apex.
bool scale_free(const Surface& surface, const MapOptions& options) {
  if (options.edge.kind == Edge::Kind::turning) return true;
  if (options.edge.kind == Edge::Kind::friction) return false;
  const auto apex = Taper(surface).apex_m();
  const Dispersion dispersion(surface);
  // the thickness of a thick plate is a fixed length, so its features do not scale with the wavelength
  const bool thin = dispersion.theory == PlateTheory::kirchhoff;
  const bool scales = thin && (!dispersion.clamped_bending() || dispersion.tension_N_per_m == 0);
  return apex && *apex <= surface.length_m * (1 + 1e-9) && scales;
}

}  // namespace

Refused no_such_edge(const Edge& edge) {
  return Refused(make_statement("no-such-edge", "edge %1 does not exist on this surface", {format(edge)}));
}

std::optional<double> EdgeTable::ratio(double f) const noexcept {
  if (closed) return constant;
  const double ln_f = std::log(f);
  auto piece =
      std::partition_point(pieces.begin(), pieces.end(), [ln_f](const Piece& p) { return p.high < ln_f; });
  // Rounding of the logarithm may put a frequency at the end of the range just outside it.
  if (piece == pieces.end()) piece = pieces.end() - 1;
  const double slack = 1e-12 * std::abs(ln_f);
  if (ln_f < piece->low - slack || ln_f > piece->high + slack) return std::nullopt;
  return clenshaw(*piece, ln_f);
}

EdgeTable edge_limits(const Surface& surface, const MapOptions& options, Model model) {
  const Builder builder(surface, options, model);
  const Taper taper(surface);
  const Dispersion dispersion(surface);
  EdgeTable table;
  const double end = taper.half_width_m(surface.length_m);
  const bool apex = end <= 1e-9 * taper.half_width_m(0);
  if (scale_free(surface, options)) {
    // far from the drive edge, where every edge exists
    const double far_Hz = std::min(dispersion.cut_off_frequency_Hz(taper.half_width_m(0) * 0.02),
                                   0.999 * highest_frequency_Hz(surface));
    const auto constant =
        options.edge.kind == Edge::Kind::turning ? std::optional(1.0) : builder.ratio(far_Hz);
    if (!constant) throw no_such_edge(options.edge);
    table.constant = *constant;
    table.low_Hz = dispersion.cut_off_frequency_Hz(taper.half_width_m(0) / *constant);
    table.high_Hz = apex ? std::numeric_limits<double>::infinity() : dispersion.cut_off_frequency_Hz(end);
    return table;
  }
  table.closed = false;
  const std::vector<double> survey = builder.survey();
  const auto exists = [&](double f) { return builder.ratio(f).has_value(); };
  const auto lowest = std::find_if(survey.begin(), survey.end(), exists);
  const auto highest = std::find_if(survey.rbegin(), survey.rend(), exists);
  if (lowest == survey.end()) throw no_such_edge(options.edge);
  table.low_Hz = lowest == survey.begin() ? *lowest : builder.limit(*lowest, *(lowest - 1));
  table.high_Hz = highest == survey.rbegin() ? *highest : builder.limit(*highest, *(highest - 1));
  return table;
}

EdgeTable make_edge_table(const Surface& surface, const MapOptions& options, Model model) {
  EdgeTable table = edge_limits(surface, options, model);
  if (table.closed) return table;
  Builder(surface, options, model).fill(table, std::log(table.low_Hz), std::log(table.high_Hz), 0);
  if (table.pieces.empty()) {
    throw Refused(make_statement("edge-not-tabulated", "edge %1 could not be tabulated on this surface",
                                 {format(options.edge)}));
  }
  return table;
}

}  // namespace turnpoint::physics
