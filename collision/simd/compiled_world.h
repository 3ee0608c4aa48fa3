#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "collision/pair_rules.h"
#include "collision/simd/compiled_robot.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "collision/simd/mesh_tree.h"
#include "scene/scene.h"

namespace planbench {

/// A scene's objects as the kernels take them: solids that the robot can reach, in single
/// precision, enlarged by what that rounds.
class CompiledWorld {
 public:
  /// Up to this many solids every tree has its own list of those within its reach; beyond, a
  /// hierarchy finds them.
  static constexpr std::size_t kMaxListed = 24;

  /// Distances beyond this are not told, m: solids that far out of reach are left out.
  static constexpr double kMaxDistance = 0.5;

  /// Takes the objects of a scene, as far as they are near `reach`, which the robot and what is
  /// attached to it never leave. Throws InputError, naming the object, for a shape that is none.
  /// Solids too large for single precision become doubtful boxes; so do cones, where the robot has
  /// triangles. Of meshes that the objects set before had, too, the trees are kept.
  void SetObjects(const Scene& scene, const CompiledRobot& robot, Ball reach);

  /// Those that have a solid, by their places in the scene, ascending.
  const std::vector<int>& objects() const { return objects_; }

  /// Lists what a link's, a body's or an attached object's tree is to be tested against.
  /// `checked[i]`: whether objects()[i] counts.
  void AddTree(const CompiledTree& tree, const std::vector<unsigned char>& checked);

  /// By object, of so many: whether one of its solids is doubtful.
  std::vector<unsigned char> DoubtfulObjects(std::size_t num_objects) const;

  kernels::SphereWorld kernel;

 private:
  /// What a solid of the kernel's was made of.
  struct Source {
    int object;              ///< Index in objects().
    Eigen::Vector3d center;  ///< Bounding box in W: any orientation.
    Eigen::Matrix3d R_WS;
    Eigen::Vector3d half_size;
  };

  void AddShape(const Shape& shape, const Pose& X_WS, int object, const Ball& reach);
  /// Returns its index in the kernel's world.
  int AddMesh(const SharedMesh& mesh, const Pose& X_WS);
  void AddHalfSpace(const Pose& X_WS, int object, const Ball& reach);
  void AddSolid(kernels::Solid solid, const Source& source);
  void BuildHierarchy();
  void BuildNode(int first, int last);

  std::vector<Source> sources_;  ///< By solid.
  std::vector<int> objects_;
  bool cones_are_doubtful_ = false;
  using MeshTrees = std::unordered_map<std::string, std::shared_ptr<const MeshTree>>;
  MeshTrees meshes_;  ///< By their ids.
  MeshTrees meshes_before_;
};

}  // namespace planbench
