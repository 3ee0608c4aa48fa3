#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace planbench {

/// Remarks, with file and line, on what URDF text says of links, joints and bodies and is passed
/// over: elements and attributes of names that are nearly known ones (others are other tools' own),
/// axes of planar joints; and on angles of origins that are probably degrees. `origin` names the
/// text.
std::vector<std::string> RemarkUnheeded(std::string_view urdf_text, const std::string& origin);

}  // namespace planbench
