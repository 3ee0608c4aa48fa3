#include "geometry/meshes_in_use.h"

#include <utility>

namespace planbench {

SharedMesh MeshesInUse::Get(const std::string& name, const std::function<TriangleMesh()>& read) {
  const std::scoped_lock lock(mutex_);
  if (auto found = meshes_[name].lock()) return SharedMesh(std::move(found));
  SharedMesh mesh = read();
  meshes_[name] = mesh.weak();
  return mesh;
}

}  // namespace planbench
