#pragma once

#include <vector>

#include "common/embedded_file.h"

namespace planbench {

/// viewer/web/.
const std::vector<EmbeddedFile>& ViewerFiles();

}  // namespace planbench
