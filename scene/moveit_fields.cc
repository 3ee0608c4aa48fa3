#include "scene/moveit_fields.h"

#include <fmt/format.h>

#include <cmath>

#include "common/text.h"
#include "scene/frame_tree.h"
#include "scene/pose.h"

namespace planbench {
namespace {

// How far from 1 the length of a quaternion that was rounded to a few digits may be, and of one
// that was meant to be a rotation at all.
constexpr double kRounding = 1e-3;
constexpr double kFarthest = 0.05;

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
  const std::vector<double> xyz =
      node.IsMap()
          ? std::vector{node.At("x").Double(), node.At("y").Double(), node.At("z").Double()}
          : node.Doubles(3);
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
  Eigen::Quaterniond q;
  if (node.IsMap()) {
    q = Eigen::Quaterniond(node.At("w").Double(), node.At("x").Double(), node.At("y").Double(),
                           node.At("z").Double());
  } else {
    const std::vector<double> xyzw = node.Doubles(4);
    q = Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  }
  return Normalised(q, node);
}

Eigen::Quaterniond Normalised(const Eigen::Quaterniond& q, const YamlNode& node,
                              const std::string& subject) {
  const std::string length = std::to_string(q.norm());
  if (q.vec().isZero(0)) {
    if (q.w() == 0) node.Warn(subject + "is all zero; taken as no rotation");
    if (q.w() != 0 && std::abs(std::abs(q.w()) - 1) > kRounding) {
      node.Warn(subject + "has length " + length + "; taken as no rotation");
    }
    return Eigen::Quaterniond::Identity();
  }
  const double off = std::abs(q.norm() - 1);
  if (!(off <= kFarthest)) node.Fail(subject + "is no unit quaternion (length " + length + ")");
  if (off > kRounding) node.Warn(subject + "has length " + length + "; normalised");
  return q.normalized();
}

Eigen::Isometry3d ReadPose(const YamlNode& node) {
  const Eigen::Vector3d position = ReadVector3(node.At("position"));
  return CanonicalPose(
      PoseFromPositionOrientation(position, ReadQuaternion(node.At("orientation"))));
}

bool IsUnsetPose(const YamlNode& pose) {
  for (const char* part : {"position", "orientation"}) {
    const YamlNode node = pose.At(part);
    if (node.IsMap()) {
      for (const std::string& key : node.Keys()) {
        if (node.At(key).Double() != 0) return false;
      }
    } else {
      for (const double value : node.Doubles()) {
        if (value != 0) return false;
      }
    }
  }
  return true;
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
