#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "geometry/shapes.h"

namespace planbench {

/// Meshes by what they were read from, for as long as somebody has them: many objects, of one scene
/// or several, are often of one mesh. Thread-safe.
class MeshesInUse {
 public:
  /// The mesh that `read` made for this name, if a copy of it is left; else what it makes now.
  /// Throws what `read` throws.
  SharedMesh Get(const std::string& name, const std::function<TriangleMesh()>& read);

  /// How many names are remembered: those of meshes that were in use when the last one was read.
  std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, SharedMesh::Weak> meshes_;
};

}  // namespace planbench
