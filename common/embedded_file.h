#pragma once

#include <string_view>

namespace planbench {

/// A file as it was when the program was built (planbench_embed in cmake/PlanbenchTargets.cmake).
struct EmbeddedFile {
  std::string_view name;  ///< Without folder.
  std::string_view text;
};

}  // namespace planbench
