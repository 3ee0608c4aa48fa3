#pragma once

namespace planbench {

/// Exit codes of every program.
inline constexpr int kExitOk = 0;
inline constexpr int kExitFailed = 1;    ///< Ran, but something failed.
inline constexpr int kExitBadInput = 2;  ///< Bad use or bad input.

}  // namespace planbench
