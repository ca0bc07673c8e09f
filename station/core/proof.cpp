#include "station/core/proof.hpp"

#include <iterator>

namespace turnpoint::core {

namespace {

constexpr const char* kProofs[] = {"unproven", "ok", "flagged", "refused", "stopped", "lost"};

struct Words {
  const char *name, *description;
};
constexpr Words kCauses[] = {
    {"", "nothing is wrong"},
    {"gap", "captured samples were lost during the stimulus"},
    {"clipped", "the captured signal reached full scale"},
    {"dead", "the surface does not move"},
    {"frequency", "the surface moves at another frequency than planned"},
    {"half", "the surface moves half as much as planned, as if one of two transducers were missing"},
    {"late", "the surface did not begin to move when planned"},
    {"offset", "the surface did not come to rest as planned"},
    {"phase", "the phase of the vibration differs from the calibration"},
    {"level", "the surface moves more or less than planned"},
    {"residual", "the surface also moves in a way that was not planned (noise or distortion)"},
    {"noisy", "the surface moves although it should be silent"},
};

static_assert(std::size(kProofs) == proofs.size() && std::size(kCauses) == proof_causes.size());

}  // namespace

const char* name(Proof proof) { return kProofs[static_cast<int>(proof)]; }
const char* name(ProofCause cause) { return kCauses[static_cast<int>(cause)].name; }
const char* describe(ProofCause cause) { return kCauses[static_cast<int>(cause)].description; }

}  // namespace turnpoint::core
