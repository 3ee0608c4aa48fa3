#include "planner_ara/motion_primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <string_view>

#include "common/error.h"

namespace planbench {
namespace {

constexpr std::string_view kHeader = "Motion_Primitives(degrees):";
constexpr int kMaxMultiple = 32767;  // half the cells a lattice axis can have

// Integers of one line; `first_word` to be skipped has been removed.
std::vector<int> Integers(std::string_view line, const std::string& where) {
  std::vector<int> values;
  std::istringstream words{std::string(line)};
  std::string word;
  while (words >> word) {
    int value = 0;
    const char* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || rest != end) {
      throw InputError(where + ": expected an integer, found '" + word + "'");
    }
    values.push_back(value);
  }
  return values;
}

bool MovesNothing(const std::vector<int>& row) {
  return std::all_of(row.begin(), row.end(), [](int cells) { return cells == 0; });
}

// The factor of the one of two units that is named.
double Unit(const YamlNode& node, std::string_view a, double factor_a, std::string_view b,
            double factor_b) {
  const std::string name = node.String();
  if (name == a) return factor_a;
  if (name == b) return factor_b;
  node.Fail(fmt::format("expected {} or {}, found '{}'", a, b, name));
}

std::vector<int> Row(const std::string& line, const std::string& where, int columns) {
  std::vector<int> row = Integers(line, where);
  if (static_cast<int>(row.size()) != columns) {
    throw InputError(fmt::format("{}: expected {} numbers, found {}", where, columns, row.size()));
  }
  if (MovesNothing(row)) {
    throw InputError(where + ": a motion primitive of zeros moves nothing");
  }
  for (const int value : row) {
    if (value < -kMaxMultiple || value > kMaxMultiple) {
      throw InputError(fmt::format("{}: {} is beyond +-{}", where, value, kMaxMultiple));
    }
  }
  return row;
}

}  // namespace

MotionPrimitives ParseMotionPrimitives(const std::string& text, const std::string& origin,
                                       int num_joints) {
  std::istringstream lines(text);
  std::string line;
  int number = 0;
  const auto where = [&] { return fmt::format("{}:{}", origin, number); };
  const auto next_line = [&] {  // the next line that is not blank
    while (std::getline(lines, line)) {
      ++number;
      if (line.find_first_not_of(" \t\r") != std::string::npos) return true;
    }
    return false;
  };

  if (!next_line() || line.compare(line.find_first_not_of(" \t"), kHeader.size(), kHeader) != 0) {
    throw InputError(fmt::format("{}:{}: expected '{} ROWS COLUMNS NUM_SHORT'", origin,
                                 std::max(number, 1), kHeader));
  }
  const std::size_t header_end = line.find(':') + 1;
  const std::vector<int> counts = Integers(std::string_view(line).substr(header_end), where());
  if (counts.size() != 3) {
    throw InputError(fmt::format("{}: expected three numbers, ROWS COLUMNS NUM_SHORT, found {}",
                                 where(), counts.size()));
  }
  const int rows = counts[0];
  const int columns = counts[1];
  const int num_short = counts[2];
  if (rows < 1 || rows > static_cast<int>(kMostPrimitives)) {
    throw InputError(
        fmt::format("{}: {} rows; 1 to {} are possible", where(), rows, kMostPrimitives));
  }
  if (num_short < 0 || num_short > rows) {
    throw InputError(fmt::format("{}: {} short primitives of {}", where(), num_short, rows));
  }
  if (columns != num_joints) {
    throw InputError(fmt::format("{}: {} columns, but the planning group has {} joints", where(),
                                 columns, num_joints));
  }

  MotionPrimitives primitives;
  for (int row = 0; row < rows; ++row) {
    if (!next_line()) {
      throw InputError(
          fmt::format("{}:{}: {} rows announced, {} found", origin, number, rows, row));
    }
    auto& moves = row < rows - num_short ? primitives.long_moves : primitives.short_moves;
    moves.push_back(Row(line, where(), columns));
  }
  if (next_line()) {
    throw InputError(fmt::format("{}: text after the {} rows announced", where(), rows));
  }
  return primitives;
}

MotionPrimitives ReadMotionPrimitives(const YamlNode& node, const JointSpace& space,
                                      std::span<const double> discretization) {
  node.AllowOnly({"angle_unit", "length_unit", "long", "short"});
  const double angle = Unit(node.At("angle_unit"), "deg", std::numbers::pi / 180, "rad", 1);
  const double length = Unit(node.At("length_unit"), "m", 1, "mm", 1e-3);
  MotionPrimitives primitives;
  const auto read_list = [&](const std::string& key, std::vector<std::vector<int>>* moves) {
    const std::optional<YamlNode> list = node.Find(key);
    if (!list) return;
    for (const YamlNode& move : list->Elements()) {
      std::vector<int>& row = moves->emplace_back(static_cast<std::size_t>(space.size()), 0);
      for (const std::string& name : move.Keys()) {
        const YamlNode value = move.At(name);
        const int j = space.Find(name);
        if (j < 0) value.Fail("the planning group has no joint of that name");
        const double unit = space.joint(j).prismatic ? length : angle;
        const auto k = static_cast<std::size_t>(j);
        const double cells = value.Double() * unit / discretization[k];
        if (!(std::abs(cells) <= kMaxMultiple))
          value.Fail("is beyond what a lattice axis can have");
        if (std::abs(cells - std::round(cells)) > 0.01) {
          value.Fail(
              fmt::format("is {:.4g} cells of the discretisation, not a whole number", cells));
        }
        row[k] = static_cast<int>(std::lround(cells));
      }
      if (MovesNothing(row)) move.Fail("moves nothing");
      if (primitives.size() > kMostPrimitives) {
        move.Fail(fmt::format("is one move too many: {} are possible, long and short ones together",
                              kMostPrimitives));
      }
    }
  };
  read_list("long", &primitives.long_moves);
  read_list("short", &primitives.short_moves);
  if (primitives.long_moves.empty() && primitives.short_moves.empty()) {
    node.Fail("has no motion primitive, neither long nor short");
  }
  return primitives;
}

MotionPrimitives PrimitivesOfFile(const NamedFile& file, const JointSpace& space,
                                  std::span<const double> discretization) {
  const std::string extension = file.path.extension().string();
  if (extension == ".yaml" || extension == ".yml") {
    const YamlNode node = YamlNode::Parse(file.text, file.path.string());
    return ReadMotionPrimitives(node, space, discretization);
  }
  return ParseMotionPrimitives(file.text, file.path.string(), space.size());
}

}  // namespace planbench
