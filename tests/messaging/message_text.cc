#include "tests/messaging/message_text.h"

#include <fmt/format.h>

#include <type_traits>
#include <variant>

#include "scene/pose.h"

namespace planbench {
namespace {

// Structs are taken apart by structured bindings, so that a new field does not compile until it is
// compared too.
class Writer {
 public:
  std::string text;

  template <typename... Values>
  void All(const Values&... values) {
    (Add(values), ...);
  }

  void Add(const std::string& value) { text += '"' + value + "\"\n"; }
  void Add(double value) { text += fmt::format("{}\n", value); }
  template <typename Value>
  requires std::is_integral_v<Value>
  void Add(Value value) { text += fmt::format("{}\n", value); }
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void Add(Enum value) { text += fmt::format("{}\n", static_cast<int>(value)); }
  template <typename Value>
  void Add(const std::vector<Value>& values) {
    text += fmt::format("[{}]\n", values.size());
    for (const Value& value : values) Add(value);
  }
  template <typename Key, typename Value>
  void Add(const std::map<Key, Value>& values) {
    text += fmt::format("{{{}}}\n", values.size());
    for (const auto& [key, value] : values) All(key, value);
  }
  template <typename First, typename Second>
  void Add(const std::pair<First, Second>& pair) {
    All(pair.first, pair.second);
  }
  template <typename Value>
  void Add(const std::optional<Value>& value) {
    text += value ? "some\n" : "none\n";
    if (value) Add(*value);
  }

  void Add(const Eigen::Vector3d& v) { All(v.x(), v.y(), v.z()); }
  void Add(const Eigen::Isometry3d& pose) {
    const Eigen::Quaterniond q = OrientationOf(pose);
    Add(Eigen::Vector3d(pose.translation()));
    All(q.w(), q.x(), q.y(), q.z());
  }
  void Add(const Box& shape) { Add(shape.size); }
  void Add(const Sphere& shape) { Add(shape.radius); }
  void Add(const Cylinder& shape) { All(shape.radius, shape.length); }
  void Add(const Cone& shape) { All(shape.radius, shape.length); }
  void Add(const Capsule& shape) { All(shape.radius, shape.length); }
  void Add(const HalfSpace&) {}
  void Add(const Mesh& shape) {
    Add(shape.triangles.vertices);
    for (const auto& [a, b, c] : shape.triangles.triangles) All(a, b, c);
  }
  void Add(const PlacedShape& placed) {
    const auto& [shape, pose] = placed;
    Add(ShapeTypeName(shape));
    std::visit([this](const auto& any) { Add(any); }, shape);
    Add(pose);
  }
  void Add(const SceneObject& object) {
    const auto& [a, b, c] = object;
    All(a, b, c);
  }
  void Add(const AttachedObject& object) {
    const auto& [a, b, c] = object;
    All(a, b, c);
  }
  void Add(const FrameTransform& frame) {
    const auto& [a, b] = frame;
    All(a, b);
  }
  void Add(const AllowedCollisionMatrix& matrix) {
    All(matrix.entries(), matrix.default_entries());
  }
  void Add(const Scene& scene) {
    const auto& [a, b, c, d, e, f, g] = scene;
    All(a, b, c, d, e, f, g);
  }
  void Add(const JointState& state) {
    const auto& [a, b] = state;
    All(a, b);
  }
  void Add(const JointGoal& goal) {
    const auto& [a, b, c, d] = goal;
    All(a, b, c, d);
  }
  void Add(const Contact& contact) {
    const auto& [a, b, c] = contact;
    All(a, b, c);
  }
  void Add(const PathVerdict& verdict) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k] = verdict;
    All(a, b, c, d, e, f, g, h, i, j, k);
  }
  void Add(const PlanProgress& progress) {
    const auto& [a, b, c, d] = progress;
    All(a, b, c, d);
  }
  void Add(const PhaseTimes& times) {
    const auto& [a, b, c, d, e] = times;
    All(a, b, c, d, e);
  }
  void Add(const PlanResult& result) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l] = result;
    All(a, b, c, d, e, f, g, h, i, j, k, l);
  }
  void Add(const ProblemSetSummary& set) {
    const auto& [a, b] = set;
    All(a, b);
  }
  void Add(const EdgeQuery& edge) {
    const auto& [a, b] = edge;
    All(a, b);
  }
  void Add(const CollisionVerdict& verdict) {
    const auto& [a, b, c, d, e, f, g, h, i] = verdict;
    All(a, b, c, d, e, f, g, h, i);
  }

  void Add(const DiscoverMessage& message) {
    const auto& [a] = message;
    All(a);
  }
  void Add(const NodeStatusMessage& message) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = message;
    All(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r);
  }
  void Add(const ProblemSetsMessage& message) {
    const auto& [a, b, c, d, e, f, g] = message;
    All(a, b, c, d, e, f, g);
  }
  void Add(const ProblemRequestMessage& message) {
    const auto& [a, b, c] = message;
    All(a, b, c);
  }
  void Add(const ProblemMessage& message) {
    const auto& [a, b, c, d, e, f, g, h, i, j] = message;
    All(a, b, c, d, e, f, g, h, i, j);
  }
  void Add(const SceneRequestMessage& message) {
    const auto& [a, b] = message;
    All(a, b);
  }
  void Add(const SceneMessage& message) {
    const auto& [a, b, c, d, e] = message;
    All(a, b, c, d, e);
  }
  void Add(const PlanRequest& message) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = message;
    All(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
  }
  void Add(const PlanAckMessage& message) {
    const auto& [a, b, c, d] = message;
    All(a, b, c, d);
  }
  void Add(const PlanProgressMessage& message) {
    const auto& [a, b, c] = message;
    All(a, b, c);
  }
  void Add(const PlanResultMessage& message) {
    const auto& [a, b, c, d, e] = message;
    All(a, b, c, d, e);
  }
  void Add(const PlanCancelMessage& message) {
    const auto& [a] = message;
    All(a);
  }
  void Add(const AckMessage& message) {
    const auto& [a, b, c, d] = message;
    All(a, b, c, d);
  }
  void Add(const CollisionRequestMessage& message) {
    const auto& [a, b, c, d, e, f, g, h, i] = message;
    All(a, b, c, d, e, f, g, h, i);
  }
  void Add(const CollisionReplyMessage& message) {
    const auto& [a, b, c, d, e, f] = message;
    All(a, b, c, d, e, f);
  }
  void Add(const PathCheckRequestMessage& message) {
    const auto& [a, b, c, d, e, f, g, h, i, j] = message;
    All(a, b, c, d, e, f, g, h, i, j);
  }
  void Add(const PathCheckReplyMessage& message) {
    const auto& [a, b, c, d, e, f, g] = message;
    All(a, b, c, d, e, f, g);
  }
  void Add(const SessionMessage& message) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = message;
    All(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
  }
  void Add(const RunRecordMessage& message) {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q] = message;
    All(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q);
  }
};

}  // namespace

template <typename Message>
std::string TextOf(const Message& message) {
  Writer writer;
  writer.Add(message);
  return writer.text;
}

template std::string TextOf(const DiscoverMessage&);
template std::string TextOf(const NodeStatusMessage&);
template std::string TextOf(const ProblemSetsMessage&);
template std::string TextOf(const ProblemRequestMessage&);
template std::string TextOf(const ProblemMessage&);
template std::string TextOf(const SceneRequestMessage&);
template std::string TextOf(const SceneMessage&);
template std::string TextOf(const PlanRequest&);
template std::string TextOf(const PlanAckMessage&);
template std::string TextOf(const PlanProgressMessage&);
template std::string TextOf(const PlanResultMessage&);
template std::string TextOf(const PlanCancelMessage&);
template std::string TextOf(const AckMessage&);
template std::string TextOf(const CollisionRequestMessage&);
template std::string TextOf(const CollisionReplyMessage&);
template std::string TextOf(const PathCheckRequestMessage&);
template std::string TextOf(const PathCheckReplyMessage&);
template std::string TextOf(const SessionMessage&);
template std::string TextOf(const RunRecordMessage&);

}  // namespace planbench
