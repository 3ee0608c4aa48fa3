#pragma once

#include <vector>

#include "common/embedded_file.h"

namespace planbench {

/// All files of lcmtypes/, so that a session folder explains its own event log wherever this
/// program is installed.
const std::vector<EmbeddedFile>& LcmTypeFiles();

}  // namespace planbench
