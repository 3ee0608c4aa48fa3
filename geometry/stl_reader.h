#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace planbench {

/// The triangles of an STL file, binary or ASCII, in the file's unit and order. What the header
/// calls itself does not count, since many binary files begin with "solid": a file of the size that
/// its number of triangles asks for is binary, text that begins with "solid" is ASCII. Throws
/// InputError naming `file` and the line, or the bytes it has and needs, for files that are cut
/// off.
std::vector<std::array<Eigen::Vector3d, 3>> ReadStl(std::string_view data, const std::string& file);

}  // namespace planbench
