#include "station/terms/check.hpp"

namespace turnpoint::terms {

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

}  // namespace turnpoint::terms
