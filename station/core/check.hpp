#pragma once
#include <array>

namespace turnpoint::core {

/// The result of one check of the self-test.
enum class Verdict {
  passed,
  failed,
  not_possible,  ///< the rig has no part that this check could measure, or nobody was there to press a button
};

inline constexpr std::array verdicts{Verdict::passed, Verdict::failed, Verdict::not_possible};

/// Fingers that a session may be run with.
inline constexpr std::array fingers{"left-thumb",  "left-index",  "left-middle", "left-ring",
                                    "left-little", "right-thumb", "right-index", "right-middle",
                                    "right-ring",  "right-little"};

/// Returns the word used in databases and exports: "passed", "failed", "not possible".
const char* name(Verdict verdict);

}  // namespace turnpoint::core
