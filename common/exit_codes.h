#pragma once

namespace planbench {

/// Exit codes of every program. Of one that signal N ended, shells tell 128 + N.
inline constexpr int kExitOk = 0;
inline constexpr int kExitFailed = 1;    ///< Ran, but something failed.
inline constexpr int kExitBadInput = 2;  ///< Bad use or bad input.

}  // namespace planbench
