#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/embedded_file.h"

namespace planbench {

/// What pages are made of: report/web/.
const std::vector<EmbeddedFile>& WebFiles();
/// Vega's modules as Debian's libjs-vega has them.
const std::vector<EmbeddedFile>& VegaFiles();
/// three.js and its orbit controls, of Debian's libjs-three.
const std::vector<EmbeddedFile>& ThreeFiles();

/// One of WebFiles.
std::string_view WebFile(std::string_view name);
/// Vega's modules as one script, which modules.js joins: Debian has them in CommonJS's form.
std::string VegaModules();

}  // namespace planbench
