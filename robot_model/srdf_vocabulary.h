#pragma once

#include <string>
#include <vector>

namespace tinyxml2 {
class XMLElement;
}

namespace planbench {

/// What an SRDF's <robot> holds, at any depth, that the format does not have, and that would
/// otherwise be passed over in silence: elements and attributes, one line each with file and line.
/// What an unknown element holds is not looked at, nor are attributes of other namespaces.
std::vector<std::string> UnknownParts(const tinyxml2::XMLElement& robot, const std::string& origin);

}  // namespace planbench
