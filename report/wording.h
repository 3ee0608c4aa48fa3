#pragma once

#include <string>
#include <vector>

namespace planbench {

/// "1 problem", "2 problems"
std::string Count(int count, const char* noun);

/// "A, B and 3 more"
std::string Named(const std::vector<std::string>& names);

/// "A, B and C", or as Named
std::string Enumerated(std::vector<std::string> names);

}  // namespace planbench
