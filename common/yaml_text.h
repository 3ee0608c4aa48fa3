#pragma once

#include <string>

namespace planbench {

/// `text` as a YAML scalar: plain if YAML cannot take it for anything but a name, else in double
/// quotes.
std::string YamlText(const std::string& text);

/// The shortest text that reads back as the same double; without "-0".
std::string YamlNumber(double value);

}  // namespace planbench
