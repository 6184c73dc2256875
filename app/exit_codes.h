// Exit codes of the program: part of its interface (README).
#pragma once

namespace ltcfit::app {

inline constexpr int kExitOk = 0;
inline constexpr int kExitFailure = 1;  ///< I/O or run-time failure
inline constexpr int kExitBadInput =
    2;  ///< bad option, or a file that is missing, damaged or of the wrong kind
inline constexpr int kExitQuality = 3;  ///< a quality gate failed: unusable entries

}  // namespace ltcfit::app
