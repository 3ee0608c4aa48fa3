#pragma once

#include <string>

namespace planbench {

/// "0.1.0".
std::string Version();
/// The commit this was built from, "-dirty" appended if the tree had changes; "unknown" outside a
/// checkout.
std::string Commit();

}  // namespace planbench
