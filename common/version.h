#pragma once

#include <string>

namespace planbench {

/// "0.2.0", say.
std::string Version();
/// The commit this was built from, "-dirty" appended if the tree had changes; "unknown" outside a
/// checkout.
std::string Commit();

}  // namespace planbench
