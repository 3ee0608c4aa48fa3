#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace planbench {

/// A scene as 3D views draw it: when it is asked for first, its meshes are made coarser if they
/// have more than kMostTrianglesShown. Not thread-safe.
class ShownScene {
 public:
  ShownScene(Scene scene)  // NOLINT(google-explicit-constructor): it is the same scene
      : scene_(std::move(scene)) {}

  const Scene& scene() const;
  /// What Coarsen says of that.
  const std::vector<std::string>& remarks() const;

 private:
  void CoarsenOnce() const;

  mutable Scene scene_;
  mutable bool is_coarsened_ = false;
  mutable std::vector<std::string> remarks_;
};

}  // namespace planbench
