#include "physics/model.hpp"

#include <stdexcept>
#include <string>

namespace turnpoint::physics {

std::string_view name(Model model) {
  constexpr std::array<std::string_view, 3> names{"edge", "mode", "modes"};
  return names[static_cast<std::size_t>(model)];
}

Model parse_model(std::string_view text) {
  std::string allowed;
  for (const Model model : all_models) {
    if (name(model) == text) return model;
    allowed += (allowed.empty() ? "" : ", ") + std::string(name(model));
  }
  throw std::invalid_argument("model \"" + std::string(text) + "\" is not known; allowed: " + allowed);
}

}  // namespace turnpoint::physics
