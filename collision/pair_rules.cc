#include "collision/pair_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "common/error.h"

namespace planbench {

PairRules::PairRules(const Robot& robot, const Scene& scene) : robot_(&robot), scene_(&scene) {
  for (const AttachedObject& attached : scene.attached) {
    if (LinkOf(attached) < 0) {
      throw InputError(
          fmt::format("scene: object '{}' is attached to link '{}', which robot '{}' "
                      "does not have",
                      attached.object.id, attached.link, robot.name));
    }
    for (const PlacedShape& placed : attached.object.shapes) {
      if (!std::holds_alternative<HalfSpace>(placed.shape)) continue;
      throw InputError(
          fmt::format("scene: object '{}' is attached to link '{}' and has a half-space, "
                      "which cannot move with a link",
                      attached.object.id, attached.link));
    }
  }
}

const std::string& PairRules::LinkName(int link) const {
  return robot_->model.links()[static_cast<std::size_t>(link)].name;
}

int PairRules::LinkOf(const AttachedObject& attached) const {
  return robot_->model.FindLink(attached.link);
}

bool PairRules::ChecksLinks(int link_a, int link_b) const {
  const std::string& a = LinkName(link_a);
  const std::string& b = LinkName(link_b);
  const AllowedCollisionMatrix& matrix = scene_->allowed_collisions;
  const std::optional<bool> allowed = matrix.Entry(a, b);
  if (allowed) return !*allowed && !robot_->NeverChecks(link_a, link_b);
  return !matrix.AllowedByDefault(a, b) && robot_->ChecksLinks(link_a, link_b);
}

bool PairRules::ChecksLinkWithObject(int link, const SceneObject& object) const {
  return !scene_->allowed_collisions.Allowed(LinkName(link), object.id);
}

bool PairRules::ChecksAttachedWithLink(const AttachedObject& attached, int link) const {
  const std::string& name = LinkName(link);
  if (name == attached.link) return false;
  const auto& touch = attached.touch_links;
  if (std::find(touch.begin(), touch.end(), name) != touch.end()) return false;
  return !scene_->allowed_collisions.Allowed(attached.object.id, name);
}

bool PairRules::ChecksAttachedWithObject(const AttachedObject& attached,
                                         const SceneObject& object) const {
  return !scene_->allowed_collisions.Allowed(attached.object.id, object.id);
}

bool PairRules::ChecksAttached(const AttachedObject& a, const AttachedObject& b) const {
  return a.link != b.link && !scene_->allowed_collisions.Allowed(a.object.id, b.object.id);
}

}  // namespace planbench
