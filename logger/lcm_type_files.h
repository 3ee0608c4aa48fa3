#pragma once

#include <string_view>
#include <vector>

namespace planbench {

/// A file of lcmtypes/, as it was when this program was built.
struct LcmTypeFile {
  std::string_view name;  ///< "lcmt_ack.lcm"
  std::string_view text;
};

/// All .lcm files, so that a session folder explains its own event log wherever this program is
/// installed.
const std::vector<LcmTypeFile>& LcmTypeFiles();

}  // namespace planbench
