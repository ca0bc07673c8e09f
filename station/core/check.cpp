#include "station/core/check.hpp"

namespace turnpoint::core {

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::passed:
      return "passed";
    case Verdict::failed:
      return "failed";
    case Verdict::not_possible:
      return "not possible";
  }
  return "";
}

}  // namespace turnpoint::core
