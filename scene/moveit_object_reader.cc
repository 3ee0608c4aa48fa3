#include "scene/moveit_object_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>
#include <string_view>
#include <utility>

#include "common/file_state.h"
#include "common/numbers.h"
#include "common/text.h"
#include "geometry/meshes_in_use.h"
#include "scene/moveit_fields.h"
#include "scene/moveit_octomap_reader.h"
#include "scene/pose.h"

namespace planbench {
namespace {

// shape_msgs/SolidPrimitive's numbers are the places here, counted from 1.
constexpr const char* kPrimitiveTypes[] = {"box", "sphere", "cylinder", "cone"};

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string ReadPrimitiveType(const YamlNode& node) {
  const std::string type = LowerCase(node.String());
  int number = 1;
  for (const char* known : kPrimitiveTypes) {
    if (type == known || type == std::to_string(number)) return known;
    ++number;
  }
  node.Fail("unknown shape type '" + node.String() +
            "'; known are: box (1), sphere (2), cylinder (3), cone (4)");
}

// A file is read once for all objects that are of it, be they of several scenes.
SharedMesh LoadMeshOnce(const std::filesystem::path& file, const Eigen::Vector3d& scale) {
  static MeshesInUse meshes;
  const std::string name = fmt::format("{} as of {}, scaled by {} {} {}", file.string(),
                                       FileState(file), scale.x(), scale.y(), scale.z());
  return meshes.Get(name, [&] { return LoadMesh(file, scale); });
}

Mesh LoadMeshResource(const YamlNode& uri, const Eigen::Vector3d& scale,
                      const ResourceResolver& resources) {
  Mesh mesh;
  mesh.resource = uri.String();
  mesh.scale = scale;
  mesh.triangles =
      AtField(uri, [&] { return LoadMeshOnce(resources.Resolve(mesh.resource), scale); });
  return mesh;
}

Eigen::Vector3d ReadScale(const YamlNode& mesh) {
  std::optional<Eigen::Vector3d> scale;
  for (const char* key : {"dimensions", "scale"}) {
    const std::optional<YamlNode> node = mesh.Find(key);
    if (!node) continue;
    const Eigen::Vector3d read = ReadVector3(*node);
    if (!(read.array() > 0).all()) node->Fail("scales must be greater than zero");
    if (scale && *scale != read) node->Fail("says another scale than the mesh's dimensions");
    scale = read;
  }
  return scale.value_or(Eigen::Vector3d::Ones());
}

Mesh ReadMesh(const YamlNode& node, const ResourceResolver& resources) {
  if (node.IsScalar()) return LoadMeshResource(node, Eigen::Vector3d::Ones(), resources);
  if (const std::optional<YamlNode> uri = node.Find("resource")) {
    return LoadMeshResource(*uri, ReadScale(node), resources);
  }
  TriangleMesh mesh;
  const Eigen::Vector3d scale = ReadScale(node);
  const YamlNode vertices = node.At("vertices");
  for (const YamlNode& vertex : vertices.Elements()) {
    mesh.vertices.push_back(scale.cwiseProduct(ReadVector3(vertex)));
  }
  const auto num_vertices = static_cast<long long>(mesh.vertices.size());
  const YamlNode triangles = node.At("triangles");
  for (const YamlNode& triangle : triangles.Elements()) {
    const YamlNode indices = triangle.IsMap() ? triangle.At("vertex_indices") : triangle;
    if (indices.Size() != 3) indices.Fail("a triangle has three vertex indices");
    std::array<std::uint32_t, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const YamlNode index = indices.At(i);
      const long long value = index.Int();
      if (value < 0 || value >= num_vertices) {
        index.Fail("there is no vertex " + std::to_string(value) + " among " +
                   std::to_string(num_vertices));
      }
      corners[i] = static_cast<std::uint32_t>(value);
    }
    mesh.triangles.push_back(corners);
  }
  if (mesh.triangles.empty()) triangles.Fail("the mesh has no triangles");
  return {"", Eigen::Vector3d::Ones(), std::move(mesh)};
}

// Pose of the half-space below shape_msgs/Plane's a x + b y + c z + d = 0.
Eigen::Isometry3d ReadPlane(const YamlNode& node) {
  const YamlNode coefficients = node.At("coef");
  const std::vector<double> abcd = coefficients.Doubles(4);
  const Eigen::Vector3d normal(abcd[0], abcd[1], abcd[2]);
  const double length = normal.norm();
  if (!(length > 0) || !std::isfinite(length)) {
    coefficients.Fail("a, b and c must not all be zero: they are the plane's normal");
  }
  return PoseFromPositionOrientation(
      -abcd[3] / (length * length) * normal,
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal));
}

// `plural` as a sequence, or `singular` as one element or a sequence.
std::vector<YamlNode> OneOrMore(const YamlNode& node, const std::string& plural,
                                const std::string& singular) {
  std::vector<YamlNode> elements = OptionalElements(node, plural);
  if (const std::optional<YamlNode> value = node.Find(singular)) {
    if (!elements.empty()) value->Fail("give either '" + singular + "' or '" + plural + "'");
    if (value->IsSequence()) return value->Elements();
    elements.push_back(*value);
  }
  return elements;
}

// Whether it begins with a list of meshes, or of their poses, that is empty and ends there.
bool BeginsWithNoMesh(std::string_view text) {
  for (const std::string_view key : {"meshes:", "mesh_poses:"}) {
    if (!text.starts_with(key)) continue;
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(' ', key.size())));
    if (!text.starts_with("[]")) return false;
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(' ', 2)));
    return text.empty() || std::string_view("\r\n,}").find(text.front()) != std::string_view::npos;
  }
  return false;
}

// How MoveIt tells a pose that is not set. Here it is one: who writes it means it.
bool MoveItPassesOver(const YamlNode& pose) {
  const std::optional<YamlNode> orientation = pose.Find("orientation");
  if (!orientation) return false;
  const double w =
      orientation->IsMap() ? orientation->DoubleOr("w", 0) : orientation->Doubles(4)[3];
  return w == 1 && ReadPose(pose).matrix().isIdentity(0);
}

bool HasPose(const YamlNode& object) {
  const std::optional<YamlNode> pose = object.Find("pose");
  return pose && !IsUnsetPose(*pose);
}

// Poses of `count` shapes, the identity if none is given. Warns where nothing says where they are.
std::vector<Eigen::Isometry3d> ReadShapePoses(const YamlNode& object, std::size_t count,
                                              const std::string& plural,
                                              const std::string& singular) {
  const std::vector<YamlNode> nodes = OneOrMore(object, plural, singular);
  if (nodes.empty()) {
    if (count > 0 && !HasPose(object)) {
      object.Warn("has neither a pose nor " + plural + "; taken at the origin of its frame");
    }
    return std::vector<Eigen::Isometry3d>(count, Eigen::Isometry3d::Identity());
  }
  if (nodes.size() != count) {
    object.Fail("has " + std::to_string(count) + (count == 1 ? " shape" : " shapes") + " but " +
                std::to_string(nodes.size()) + " " + plural);
  }
  std::vector<Eigen::Isometry3d> poses;
  for (const YamlNode& node : nodes) poses.push_back(ReadPose(node));
  return poses;
}

void RequireAddOperation(const YamlNode& object) {
  const std::optional<YamlNode> operation = object.Find("operation");
  if (!operation) return;
  // ROS 2 prints the byte itself.
  const std::optional<int> byte = operation->RawByte();
  const std::string text = byte ? std::to_string(*byte) : LowerCase(operation->String());
  if (text != "0" && text != "add") {
    operation->Fail("only the operation ADD (0) is supported, found '" + text +
                    "'; write what there is once all operations are done");
  }
}

bool HasShapes(const YamlNode& object) {
  for (const char* list : {"primitives", "meshes", "mesh", "planes"}) {
    const std::optional<YamlNode> shapes = object.Find(list);
    if (shapes && (!shapes->IsSequence() || shapes->Size() > 0)) return true;
  }
  return false;
}

bool HasBody(const Robot& robot, int link) {
  const auto has_one = [&](const std::vector<LinkSphere>& spheres) {
    return std::any_of(spheres.begin(), spheres.end(),
                       [&](const LinkSphere& sphere) { return sphere.link == link; });
  };
  return !robot.model.links()[static_cast<std::size_t>(link)].collision.empty() ||
         has_one(robot.spheres) || has_one(robot.enclosing_spheres);
}

// The frames of an object, in the frame that its pose is in.
std::vector<ObjectFrame> ReadFrames(const YamlNode& node, const SceneObject& object) {
  Eigen::Isometry3d X_WF = object.X_WO;
  std::optional<YamlNode> disputed_pose;
  if (object.shapes.size() == 1) {
    const Eigen::Isometry3d& X_OS = object.shapes.front().X_FS;
    if (!HasPose(node)) {
      X_WF = object.X_WO * X_OS;
    } else if (!X_OS.matrix().isIdentity() && MoveItPassesOver(node.At("pose"))) {
      disputed_pose.emplace(node.At("pose"));
    }
  }
  const std::string name = WithoutSlash(object.id);  // As frames are asked for.
  std::vector<ObjectFrame> frames = {{name, X_WF, node.At("id"), disputed_pose}};
  const std::vector<YamlNode> names = OptionalElements(node, "subframe_names");
  const std::vector<YamlNode> poses = OptionalElements(node, "subframe_poses");
  if (names.size() != poses.size()) {
    node.Fail("has " + std::to_string(names.size()) + " subframe_names but " +
              std::to_string(poses.size()) + " subframe_poses");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    frames.push_back(
        {name + "/" + ReadName(names[i]), X_WF * ReadPose(poses[i]), names[i], disputed_pose});
  }
  return frames;
}

AttachedObject* FindAttached(const std::string& id, Scene* scene) {
  const auto found = std::find_if(scene->attached.begin(), scene->attached.end(),
                                  [&](const AttachedObject& a) { return a.object.id == id; });
  return found == scene->attached.end() ? nullptr : &*found;
}

const SceneObject* FindInWorld(const std::string& id, const Scene& scene) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [&](const SceneObject& object) { return object.id == id; });
  return found == scene.objects.end() ? nullptr : &*found;
}

// An attached object that has shapes of its own, in the frame of its link, which is at X_BL.
SceneObject ReadAttachedShapes(const YamlNode& node, const std::string& link,
                               const Eigen::Isometry3d& X_BL, const ResourceResolver& resources,
                               FrameTree* frames) {
  SceneObject object = ReadCollisionObject(node, resources);
  const std::string frame = ReadFrame(node);
  if (frame.empty()) {
    node.Warn("names no frame; taken in the planning frame, and not in that of its link, '" + link +
              "'");
  }
  if (frame != link) {
    const Eigen::Isometry3d X_LB = X_BL.inverse(Eigen::Isometry);
    object.X_WO = CanonicalPose(X_LB * frames->At(frame, FrameNode(node)) * object.X_WO);
  }
  frames->SetObject(object.id, link, ReadFrames(node, object));
  return object;
}

// The object that a message without shapes names by its id, the world's or one that is attached
// already, where it is: in the base frame.
SceneObject FindNamed(const YamlNode& node, const std::string& id, const AttachedObject* known,
                      const FrameTree& frames, const Scene& scene) {
  RequireAddOperation(node);
  if (HasPose(node)) {
    node.At("pose").Warn("does not count: '" + id + "' has no shape here, and stays where it is");
  }
  if (const SceneObject* in_world = FindInWorld(id, scene)) return *in_world;
  if (known == nullptr) {
    node.At("id").Fail("the object '" + id + "' has no shape, and the world has none of that id");
  }
  SceneObject object = known->object;
  object.X_WO = frames.At(known->link, node) * object.X_WO;
  return object;
}

// Why a name is no link.
std::string NoLink(const std::string& name, const Robot& robot) {
  if (std::any_of(robot.groups.begin(), robot.groups.end(),
                  [&](const PlanningGroup& group) { return group.name == name; })) {
    return "'" + name + "' is a planning group, no link";
  }
  std::vector<std::string_view> links;
  for (const Link& link : robot.model.links()) links.push_back(link.name);
  const std::string nearest = NearestName(name, links);
  return fmt::format("the robot '{}' has no link '{}'{}", robot.name, name,
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest));
}

// In file order, each once: in MoveIt they are a set.
std::vector<std::string> ReadTouchLinks(const YamlNode& attached, const Robot& robot) {
  std::vector<std::string> links;
  for (const YamlNode& node : OptionalElements(attached, "touch_links")) {
    const std::string link = LinkNamed(ReadName(node), robot.model);
    if (link.empty()) node.Fail("must not be empty");
    if (robot.model.FindLink(link) < 0) {
      node.Warn(NoLink(link, robot) +
                "; touch links are the robot's, objects may touch by the matrix alone");
    }
    if (std::find(links.begin(), links.end(), link) == links.end()) links.push_back(link);
  }
  return links;
}

AttachedObject ReadAttachedObject(const YamlNode& node, const AttachedObject* known,
                                  const ResourceResolver& resources, const Robot& robot,
                                  const Scene& scene, FrameTree* frames) {
  AttachedObject attached;
  const YamlNode link = node.At("link_name");
  attached.link = LinkNamed(link.String(), robot.model);
  if (robot.model.FindLink(attached.link) < 0) link.Fail(NoLink(attached.link, robot));
  attached.touch_links = ReadTouchLinks(node, robot);
  const YamlNode object = node.At("object");
  const Eigen::Isometry3d X_BL = frames->At(attached.link, link);
  if (HasShapes(object)) {
    attached.object = ReadAttachedShapes(object, attached.link, X_BL, resources, frames);
  } else {
    const std::string id = object.At("id").String();
    attached.object = FindNamed(object, id, known, *frames, scene);
    attached.object.X_WO = CanonicalPose(X_BL.inverse(Eigen::Isometry) * attached.object.X_WO);
    frames->AttachObject(id, attached.link);
    if (known != nullptr && attached.touch_links.empty()) attached.touch_links = known->touch_links;
  }
  for (const PlacedShape& placed : attached.object.shapes) {
    if (std::holds_alternative<HalfSpace>(placed.shape)) {
      object.Find("planes").value_or(object.At("id")).Fail("a plane cannot be attached to a link");
    }
  }
  return attached;
}

// Only the ids say that what has shapes of its own is the same thing.
void WarnThatItLeavesTheWorld(const YamlNode& id, const AttachedObject& attached) {
  id.Warn(fmt::format(
      "the world's object '{}' is left out: one of that id is attached to the link '{}', with "
      "shapes of its own",
      attached.object.id, attached.link));
}

// Attaches objects one after the other.
class Attacher {
 public:
  Attacher(const ResourceResolver& resources, const Robot& robot, FrameTree* frames, Scene* scene)
      : resources_(resources), robot_(robot), frames_(frames), scene_(scene) {}

  void Attach(const YamlNode& node) {
    const YamlNode id_node = node.At("object").At("id");
    const std::string id = ReadObjectId(id_node, robot_);
    if (!ids_.insert(id).second) {
      id_node.Warn("'" + id + "' is attached twice; the last one counts");
    }
    AttachedObject* known = FindAttached(id, scene_);
    AttachedObject attached = ReadAttachedObject(node, known, resources_, robot_, *scene_, frames_);
    const auto is_same = [&](const SceneObject& other) { return other.id == id; };
    const bool left_world = std::erase_if(scene_->objects, is_same) > 0;
    if (left_world && HasShapes(node.At("object"))) WarnThatItLeavesTheWorld(id_node, attached);
    if (known == nullptr) {
      scene_->attached.push_back(std::move(attached));
    } else {
      *known = std::move(attached);
    }
  }

 private:
  const ResourceResolver& resources_;
  const Robot& robot_;
  FrameTree* frames_;
  Scene* scene_;
  std::set<std::string> ids_;
};

// A plane is solid on one side here, and nothing but a surface in MoveIt: who has the robot in it
// means a ceiling, or a wall seen from its other side. `object` is in the base frame.
void WarnOfPlanesAround(const SceneObject& object, const YamlNode& node) {
  constexpr double kDepth = 1e-3;  // m; less is a floor that the robot stands on.
  const std::vector<YamlNode> planes = OptionalElements(node, "planes");
  const std::size_t first = object.shapes.size() - planes.size();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Eigen::Isometry3d X_BF = object.X_WO * object.shapes[first + i].X_FS;
    if (X_BF.inverse(Eigen::Isometry).translation().z() >= -kDepth) continue;
    planes[i].At("coef").Warn(
        "the robot's base is in it: planes are solid on the side that (a, b, c) points away from; "
        "negate all four numbers for a ceiling");
  }
}

// How far the nearest part of an object is from the robot's base, m, to its middle.
double DistanceOf(const SceneObject& object) {
  double least = kInfinity;
  for (const PlacedShape& placed : object.shapes) {
    if (std::holds_alternative<HalfSpace>(placed.shape)) return 0;
    least = std::min(least, (object.X_WO * placed.X_FS.translation()).norm());
  }
  return least;
}

// Tells of objects that are so far away that their unit is wrong sooner than that they are meant to
// be there: nothing else would, as all paths are free of them.
class FarObjects {
 public:
  void Add(const YamlNode& id, const SceneObject& object) {
    constexpr double kOutOfReach = 100;  // m
    const double distance = DistanceOf(object);
    if (distance <= kOutOfReach) return;
    if (num_++ > 0) return;
    first_.emplace(id);
    first_distance_ = distance;
  }

  void Warn() const {
    if (num_ == 0) return;
    first_->Warn(fmt::format(
        "'{}' is {:g} m from the robot's base; are its numbers millimetres? They are metres{}",
        first_->String(), first_distance_,
        num_ == 1 ? "" : fmt::format("; likewise {} more", num_ - 1)));
  }

 private:
  std::optional<YamlNode> first_;
  double first_distance_ = 0;
  int num_ = 0;
};

// Adds the objects of world.collision_objects in the base frame, and their frames. One may be given
// in the frame of one above it.
void AddWorldObjects(const YamlNode& world, const ResourceResolver& resources, const Robot& robot,
                     FrameTree* frames, Scene* scene) {
  std::set<std::string> ids;
  const std::vector<YamlNode> nodes = OptionalElements(world, "collision_objects");
  FarObjects far;
  for (const YamlNode& node : nodes) {
    if (const std::optional<YamlNode> id = node.Find("id")) frames->ExpectObject(id->String());
  }
  for (const YamlNode& node : nodes) {
    const std::string id = ReadObjectId(node.At("id"), robot);
    SceneObject object = ReadCollisionObject(node, resources);
    if (!ids.insert(id).second) node.At("id").Fail("the object '" + id + "' is given twice");
    object.X_WO = CanonicalPose(frames->At(ReadFrame(node), FrameNode(node)) * object.X_WO);
    if (const AttachedObject* attached = FindAttached(id, scene)) {
      WarnThatItLeavesTheWorld(node.At("id"), *attached);
      continue;
    }
    WarnOfPlanesAround(object, node);
    far.Add(node.At("id"), object);
    frames->SetObject(id, "", ReadFrames(node, object));
    scene->objects.push_back(std::move(object));
  }
  far.Warn();
}

}  // namespace

bool MayHaveMesh(std::string_view yaml_text) {
  constexpr auto kNone = std::string_view::npos;
  // In quotes these may stand for letters, or be within a word.
  for (const char* escape : {"\\x", "\\u", "\\U", "\\\n", "\\\r"}) {
    if (yaml_text.find(escape) != kNone) return true;
  }
  for (std::size_t at = yaml_text.find("mesh"); at != kNone; at = yaml_text.find("mesh", at + 1)) {
    if (!BeginsWithNoMesh(yaml_text.substr(at))) return true;
  }
  return false;
}

std::string ReadObjectId(const YamlNode& node, const Robot& robot) {
  const std::string id = ReadName(node);
  if (id == kOctomapId) node.Fail("the name '" + id + "' is that of world.octomap alone");
  const int link = robot.model.FindLink(id);
  if (link >= 0 && HasBody(robot, link)) {
    node.Fail("the object has the name of a link, '" + id +
              "'; what the matrix allows the link it "
              "would allow the object");
  }
  return id;
}

Shape ReadPrimitive(const YamlNode& node) {
  const std::string type = ReadPrimitiveType(node.At("type"));
  const YamlNode dimensions = node.At("dimensions");
  const int count = type == "box" ? 3 : type == "sphere" ? 1 : 2;
  std::vector<YamlNode> elements = dimensions.Elements();
  // Who always writes three leaves those at 0 that the shape does not have.
  while (std::ssize(elements) > count && elements.back().Double() == 0) elements.pop_back();
  if (std::ssize(elements) != count) dimensions.Doubles(count);
  std::vector<double> values;
  for (const YamlNode& dimension : elements) {
    values.push_back(dimension.PositiveDouble());
    if (values.back() > kLargestShape) {
      dimension.Fail(fmt::format("is more than {} m", kLargestShape));
    }
  }
  if (type == "box") return Box{{values[0], values[1], values[2]}};
  if (type == "sphere") return Sphere{values[0]};
  if (type == "cylinder") return Cylinder{.radius = values[1], .length = values[0]};
  return Cone{.radius = values[1], .length = values[0]};
}

SceneObject ReadCollisionObject(const YamlNode& node, const ResourceResolver& resources) {
  SceneObject object;
  object.id = ReadName(node.At("id"));
  RequireAddOperation(node);

  if (HasPose(node)) object.X_WO = ReadPose(node.At("pose"));

  const std::vector<YamlNode> primitives = OptionalElements(node, "primitives");
  const std::vector<YamlNode> meshes = OneOrMore(node, "meshes", "mesh");
  const std::vector<YamlNode> planes = OptionalElements(node, "planes");
  if (primitives.empty() && meshes.empty() && planes.empty()) {
    node.Fail("the object '" + object.id + "' has no shape (primitives, meshes or planes)");
  }
  const auto primitive_poses =
      ReadShapePoses(node, primitives.size(), "primitive_poses", "primitive_pose");
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    object.shapes.push_back({ReadPrimitive(primitives[i]), primitive_poses[i]});
  }
  const auto mesh_poses = ReadShapePoses(node, meshes.size(), "mesh_poses", "mesh_pose");
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    object.shapes.push_back({ReadMesh(meshes[i], resources), mesh_poses[i]});
  }
  const auto plane_poses = ReadShapePoses(node, planes.size(), "plane_poses", "plane_pose");
  for (std::size_t i = 0; i < planes.size(); ++i) {
    object.shapes.push_back({HalfSpace{}, CanonicalPose(plane_poses[i] * ReadPlane(planes[i]))});
  }
  return object;
}

void AddSceneObjects(const YamlNode& planning_scene, const ResourceResolver& resources,
                     const Robot& robot, FrameTree* frames, Scene* scene) {
  const std::optional<YamlNode> state = planning_scene.Find("robot_state");
  const std::optional<YamlNode> world = planning_scene.Find("world");
  Attacher attacher(resources, robot, frames, scene);
  std::vector<YamlNode> after_world;
  std::set<std::string> ids_after_world;
  if (state) {
    for (const YamlNode& node : OptionalElements(*state, "attached_collision_objects")) {
      const YamlNode object = node.At("object");
      const std::string id = object.At("id").String();
      const std::string frame = ReadFrame(object);
      const bool needs_world = !HasShapes(object) || frames->Find(frame) == nullptr;
      if (needs_world || ids_after_world.contains(id)) {
        after_world.push_back(node);
        ids_after_world.insert(id);
        frames->ExpectObject(id);
      } else {
        attacher.Attach(node);
      }
    }
  }
  if (world) {
    AddWorldObjects(*world, resources, robot, frames, scene);
    AddOctomap(*world, *frames, scene);
  }
  for (const YamlNode& node : after_world) attacher.Attach(node);
}

void AddAttachedObjects(const YamlNode& robot_state, const ResourceResolver& resources,
                        const Robot& robot, FrameTree* frames, Scene* scene) {
  Attacher attacher(resources, robot, frames, scene);
  const std::vector<YamlNode> nodes = OptionalElements(robot_state, "attached_collision_objects");
  for (const YamlNode& node : nodes) frames->ExpectObject(node.At("object").At("id").String());
  for (const YamlNode& node : nodes) attacher.Attach(node);
}

void DetachUnnamed(const YamlNode& robot_state, const YamlNode& is_diff, FrameTree* frames,
                   Scene* scene) {
  std::set<std::string> named;
  for (const YamlNode& node : OptionalElements(robot_state, "attached_collision_objects")) {
    named.insert(node.At("object").At("id").String());
  }
  std::erase_if(scene->attached, [&](const AttachedObject& attached) {
    const std::string& id = attached.object.id;
    if (named.contains(id)) return false;
    frames->RemoveObject(id);
    is_diff.Warn("is false, so that '" + id +
                 "', which the scene attaches and this state does not, is left out; true keeps it");
    return true;
  });
}

}  // namespace planbench
