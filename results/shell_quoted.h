#pragma once

#include <string>

namespace planbench {

/// `text` as one word of a shell, quoted if it must be.
std::string ShellQuoted(const std::string& text);

}  // namespace planbench
