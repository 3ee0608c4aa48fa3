#include "messaging/wire.h"

#include <fmt/format.h>

#include <set>

namespace planbench::wire {

std::string Field::Path() const {
  if (parent_ == nullptr) return "";
  std::string path = parent_->Path();
  if (!path.empty()) path += '.';
  path += name_;
  if (index_ >= 0) path += fmt::format("[{}]", index_);
  return path;
}

void Field::Fail(const std::string& what) const {
  const std::string path = Path();
  throw MessageError(path.empty() ? fmt::format("{}: {}", *channel_, what)
                                  : fmt::format("{}: {}: {}", *channel_, path, what),
                     *request_id_);
}

double Finite(double value, const Field& at) {
  if (!std::isfinite(value)) at.Fail(fmt::format("{} is not a finite number", value));
  return value;
}

double NonNegative(double value, const Field& at) {
  if (Finite(value, at) < 0) at.Fail(fmt::format("{} is negative", value));
  return value;
}

double Positive(double value, const Field& at) {
  if (Finite(value, at) <= 0) at.Fail(fmt::format("{} is not greater than 0", value));
  return value;
}

double Fraction(double value, const Field& at) {
  if (!(value >= 0 && value <= 1)) at.Fail(fmt::format("{} is not in [0, 1]", value));
  return value;
}

std::int64_t AtLeast(std::int64_t minimum, std::int64_t value, const Field& at) {
  if (value < minimum) at.Fail(fmt::format("{} is less than {}", value, minimum));
  return value;
}

bool Bool(std::int8_t value, const Field& at) {
  if (value != 0 && value != 1) at.Fail(fmt::format("{} is no boolean", static_cast<int>(value)));
  return value == 1;
}

const std::string& NotEmpty(const std::string& text, const Field& at) {
  if (text.empty()) at.Fail("is empty");
  return text;
}

CollisionModel Model(const std::string& name, const Field& at) {
  const auto model = ParseEnum<CollisionModel>(name);
  if (!model) at.Fail(fmt::format("no collision model '{}'", name));
  return *model;
}

EdgeCheck Method(const std::string& name, const Field& at) {
  const auto method = ParseEnum<EdgeCheck>(name);
  if (!method) at.Fail(fmt::format("no way to check edges '{}'", name));
  return *method;
}

const std::vector<std::string>& Names(const std::vector<std::string>& names, const Field& parent,
                                      const char* name) {
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    NotEmpty(names[i], parent(name, i));
    if (!seen.insert(names[i]).second) {
      parent(name, i).Fail(fmt::format("'{}' occurs twice", names[i]));
    }
  }
  return names;
}

std::int32_t Count(std::size_t size) {
  if (size > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::logic_error("a list is too long for a message");
  }
  return static_cast<std::int32_t>(size);
}

void RequireSameSize(std::size_t a, std::size_t b, const char* what) {
  if (a != b) throw std::logic_error(fmt::format("{}: sizes differ ({} and {})", what, a, b));
}

std::vector<lcmt_key_value> ToWire(const std::map<std::string, std::string>& values) {
  std::vector<lcmt_key_value> wire;
  wire.reserve(values.size());
  for (const auto& [key, value] : values) {
    wire.emplace_back();
    wire.back().key = key;
    wire.back().value = value;
  }
  return wire;
}

std::map<std::string, std::string> FromWire(const std::vector<lcmt_key_value>& values,
                                            const Field& parent, const char* name) {
  std::map<std::string, std::string> result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Field at = parent(name, i);
    NotEmpty(values[i].key, at("key"));
    if (!result.emplace(values[i].key, values[i].value).second) {
      at("key").Fail(fmt::format("'{}' occurs twice", values[i].key));
    }
  }
  return result;
}

lcmt_joint_state ToWire(const JointState& state) {
  RequireSameSize(state.names.size(), state.positions.size(), "names and positions of joints");
  lcmt_joint_state wire;
  wire.num_joints = Count(state.names.size());
  wire.joint_name = state.names;
  wire.position = state.positions;
  return wire;
}

JointState FromWire(const lcmt_joint_state& state, const Field& at) {
  Names(state.joint_name, at, "joint_name");
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    Finite(state.position[i], at("position", i));
  }
  return {state.joint_name, state.position};
}

std::vector<lcmt_joint_goal> ToWire(const std::vector<JointGoal>& goal) {
  std::vector<lcmt_joint_goal> wire(goal.size());
  for (std::size_t i = 0; i < goal.size(); ++i) {
    wire[i].joint_name = goal[i].joint;
    wire[i].position = goal[i].position;
    wire[i].tolerance_above = goal[i].tolerance_above;
    wire[i].tolerance_below = goal[i].tolerance_below;
  }
  return wire;
}

std::vector<JointGoal> FromWire(const std::vector<lcmt_joint_goal>& goal, const Field& parent,
                                const char* name) {
  std::vector<JointGoal> result;
  result.reserve(goal.size());
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < goal.size(); ++i) {
    const Field at = parent(name, i);
    const lcmt_joint_goal& wire = goal[i];
    NotEmpty(wire.joint_name, at("joint_name"));
    if (!seen.insert(wire.joint_name).second) {
      at("joint_name").Fail(fmt::format("'{}' occurs twice", wire.joint_name));
    }
    result.push_back({wire.joint_name, Finite(wire.position, at("position")),
                      NonNegative(wire.tolerance_above, at("tolerance_above")),
                      NonNegative(wire.tolerance_below, at("tolerance_below"))});
  }
  return result;
}

lcmt_path ToWire(const std::vector<std::string>& joint_names, const Path& path) {
  lcmt_path wire{};
  if (path.empty()) return wire;
  for (const Configuration& waypoint : path) {
    RequireSameSize(joint_names.size(), waypoint.size(), "joint names and a waypoint");
  }
  wire.num_joints = Count(joint_names.size());
  wire.num_waypoints = Count(path.size());
  wire.joint_name = joint_names;
  wire.position = path;
  return wire;
}

NamedPath FromWire(const lcmt_path& path, const Field& at) {
  if (path.num_waypoints == 0) return {};
  if (path.num_joints == 0) at("num_joints").Fail("waypoints without joints");
  Names(path.joint_name, at, "joint_name");
  for (std::size_t i = 0; i < path.position.size(); ++i) {
    for (std::size_t j = 0; j < path.position[i].size(); ++j) {
      const double position = path.position[i][j];
      if (!std::isfinite(position)) {
        at("position", i)
            .Fail(fmt::format("{} of {} is not a finite number", position, path.joint_name[j]));
      }
    }
  }
  return {path.joint_name, path.position};
}

}  // namespace planbench::wire
