#include "report/shown_scene.h"

#include "report/coarse_meshes.h"

namespace planbench {

const Scene& ShownScene::scene() const {
  CoarsenOnce();
  return scene_;
}

const std::vector<std::string>& ShownScene::remarks() const {
  CoarsenOnce();
  return remarks_;
}

void ShownScene::CoarsenOnce() const {
  if (is_coarsened_) return;
  std::vector<std::vector<PlacedShape>*> bodies;
  for (SceneObject& object : scene_.objects) bodies.push_back(&object.shapes);
  for (AttachedObject& attached : scene_.attached) bodies.push_back(&attached.object.shapes);
  Coarsen("scene", kMostTrianglesShown, bodies, &remarks_);
  is_coarsened_ = true;
}

}  // namespace planbench
