#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace planbench {

/// Folder of data that is used in tests and measurements but not part of the repository: published
/// problem sets, the manufacturer's robot description. $PLANBENCH_SHARED, or `shared` beside the
/// checkout.
inline std::filesystem::path SharedData(const std::string& below = "") {
  const char* folder = std::getenv("PLANBENCH_SHARED");
  const std::filesystem::path root =
      folder != nullptr ? folder : std::filesystem::path(PLANBENCH_SOURCE_DIR) / ".." / "shared";
  return root / below;
}

}  // namespace planbench

/// Skips the running test unless that part of the shared data is present.
#define PLANBENCH_NEED_SHARED_DATA(below)                                                    \
  do {                                                                                       \
    if (!std::filesystem::exists(::planbench::SharedData(below))) {                          \
      GTEST_SKIP() << "needs " << ::planbench::SharedData(below)                             \
                   << ", which is not here; set PLANBENCH_SHARED to the folder that has it"; \
    }                                                                                        \
  } while (false)
