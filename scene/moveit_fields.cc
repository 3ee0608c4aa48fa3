#include "scene/moveit_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/text.h"
#include "scene/frame_tree.h"
#include "scene/pose.h"

namespace planbench {
namespace {

// How far from 1 the length of a quaternion that was rounded to a few digits may be, and of one
// that was meant to be a rotation at all.
constexpr double kRounding = 1e-3;
constexpr double kFarthest = 0.05;

// The fields of a vector and of a quaternion, a letter each.
constexpr std::string_view kVector = "xyz";
constexpr std::string_view kQuaternion = "xyzw";

// The numbers of a list of so many, or of a map: what a message leaves out is 0.
std::vector<double> Components(const YamlNode& node, std::string_view fields) {
  if (!node.IsMap()) return node.Doubles(static_cast<int>(fields.size()));
  std::vector<double> numbers;
  for (const char field : fields) numbers.push_back(node.DoubleOr(std::string(1, field), 0));
  return numbers;
}

Eigen::Isometry3d ReadPoseOf(const YamlNode& node, const char* position, const char* orientation) {
  const std::optional<YamlNode> p = node.Find(position);
  const std::optional<YamlNode> q = node.Find(orientation);
  return CanonicalPose(
      PoseFromPositionOrientation(p ? ReadVector3(*p) : Eigen::Vector3d(0, 0, 0),
                                  q ? ReadQuaternion(*q)
                                    : Normalised(Eigen::Quaterniond(0, 0, 0, 0), node,
                                                 fmt::format("the {}, left out, ", orientation))));
}

}  // namespace

std::string ReadName(const YamlNode& node) {
  const std::string name = node.String();
  if (name.empty()) node.Fail("must not be empty");
  if (const auto fault = FindNameFault(name)) node.Fail("the name '" + name + "' " + *fault);
  if (Printable(name) != name) {
    node.Fail(
        fmt::format("the name '{}' has {} bytes, which is too long; at most {}, and {} without "
                    "a space",
                    Printable(name), name.size(), kLongestText, kLongestWord));
  }
  return name;
}

Eigen::Vector3d ReadVector3(const YamlNode& node) {
  const std::vector<double> xyz = Components(node, kVector);
  const Eigen::Vector3d vector(xyz[0], xyz[1], xyz[2]);
  RequireNear(vector, node);
  return vector;
}

void RequireNear(const Eigen::Vector3d& position, const YamlNode& node) {
  if (position.cwiseAbs().maxCoeff() > kFarthestAway) {
    node.Fail(fmt::format("is beyond {} m", kFarthestAway));
  }
}

Eigen::Quaterniond ReadQuaternion(const YamlNode& node) {
  const std::vector<double> xyzw = Components(node, kQuaternion);
  return Normalised(Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]), node);
}

Eigen::Quaterniond Normalised(const Eigen::Quaterniond& q, const YamlNode& node,
                              const std::string& subject) {
  const double length = q.coeffs().stableNorm();
  if (q.vec().isZero(0)) {
    if (q.w() == 0) node.Warn(subject + "is all zero; taken as no rotation");
    if (q.w() != 0 && std::abs(std::abs(q.w()) - 1) > kRounding) {
      node.Warn(fmt::format("{}has length {:g}; taken as no rotation", subject, length));
    }
    return Eigen::Quaterniond::Identity();
  }
  const double off = std::abs(length - 1);
  if (!(off <= kFarthest)) {
    node.Fail(fmt::format("{}is no unit quaternion (length {:g})", subject, length));
  }
  if (off > kRounding) node.Warn(fmt::format("{}has length {:g}; normalised", subject, length));
  return q.normalized();
}

Eigen::Isometry3d ReadPose(const YamlNode& node) {
  return ReadPoseOf(node, "position", "orientation");
}

Eigen::Isometry3d ReadTransform(const YamlNode& node) {
  return ReadPoseOf(node, "translation", "rotation");
}

bool IsUnsetPose(const YamlNode& pose) {
  const auto is_zero = [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return number == 0; });
  };
  const std::optional<YamlNode> position = pose.Find("position");
  const std::optional<YamlNode> orientation = pose.Find("orientation");
  return (!position || is_zero(Components(*position, kVector))) &&
         (!orientation || is_zero(Components(*orientation, kQuaternion)));
}

std::string ReadFrame(const YamlNode& message) {
  const std::optional<YamlNode> header = message.Find("header");
  return header ? WithoutSlash(header->StringOr("frame_id", "")) : "";
}

YamlNode FrameNode(const YamlNode& message) {
  const std::optional<YamlNode> header = message.Find("header");
  const std::optional<YamlNode> frame = header ? header->Find("frame_id") : std::nullopt;
  return frame ? *frame : message;
}

std::vector<YamlNode> OptionalElements(const YamlNode& message, const std::string& key) {
  const std::optional<YamlNode> sequence = message.Find(key);
  return sequence ? sequence->Elements() : std::vector<YamlNode>();
}

void RefuseElements(const YamlNode& message, const std::string& key, const std::string& why) {
  const std::vector<YamlNode> elements = OptionalElements(message, key);
  if (!elements.empty()) elements.front().Fail(why);
}

bool ReadFlag(const YamlNode& node) {
  if (node.IsScalar() && (node.String() == "0" || node.String() == "1")) {
    return node.String() == "1";
  }
  return node.Bool();
}

}  // namespace planbench
