#pragma once

#include <vector>

#include "common/embedded_file.h"

namespace planbench {

/// What pages are made of: report/web/.
const std::vector<EmbeddedFile>& WebFiles();
/// Vega's modules as Debian's libjs-vega has them.
const std::vector<EmbeddedFile>& VegaFiles();
/// three.js and its orbit controls, of Debian's libjs-three.
const std::vector<EmbeddedFile>& ThreeFiles();

}  // namespace planbench
