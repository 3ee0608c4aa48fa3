#include "geometry/meshes_in_use.h"

#include <utility>

namespace planbench {

SharedMesh MeshesInUse::Get(const std::string& name, const std::function<TriangleMesh()>& read) {
  // Held while reading, so that what two ask for at once is read once.
  const std::scoped_lock lock(mutex_);
  if (const auto known = meshes_.find(name); known != meshes_.end()) {
    if (auto found = known->second.lock()) return SharedMesh(std::move(found));
  }
  SharedMesh mesh = read();
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.expired(); });
  meshes_[name] = mesh.weak();
  return mesh;
}

std::size_t MeshesInUse::size() const {
  const std::scoped_lock lock(mutex_);
  return meshes_.size();
}

}  // namespace planbench
