#include "scene/scene.h"

#include <map>
#include <utility>

#include "scene/pose.h"

namespace planbench {
namespace {

std::pair<std::string, std::string> Ordered(std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  return {std::move(a), std::move(b)};
}

}  // namespace

void AllowedCollisionMatrix::SetEntry(std::string a, std::string b, bool allowed) {
  // Most come in the map's order: from a map, over the bus.
  entries_.insert_or_assign(entries_.end(), Ordered(std::move(a), std::move(b)), allowed);
}

void AllowedCollisionMatrix::SetDefaultEntry(const std::string& name, bool allowed) {
  default_entries_[name] = allowed;
}

bool AllowedCollisionMatrix::AllowedByDefault(const std::string& a, const std::string& b) const {
  const auto default_a = default_entries_.find(a);
  const auto default_b = default_entries_.find(b);
  const bool has_a = default_a != default_entries_.end();
  const bool has_b = default_b != default_entries_.end();
  if (has_a && has_b) return default_a->second && default_b->second;
  if (has_a) return default_a->second;
  if (has_b) return default_b->second;
  return false;
}

std::optional<bool> AllowedCollisionMatrix::Entry(const std::string& a,
                                                  const std::string& b) const {
  const auto entry = entries_.find(Ordered(a, b));
  return entry == entries_.end() ? std::nullopt : std::optional(entry->second);
}

bool AllowedCollisionMatrix::Allowed(const std::string& a, const std::string& b) const {
  const std::optional<bool> entry = Entry(a, b);
  return entry ? *entry : AllowedByDefault(a, b);
}

Scene InFrame(const Scene& scene, const std::string& frame, const Eigen::Isometry3d& X_NW) {
  Scene moved = scene;
  moved.world_frame = frame;
  for (SceneObject& object : moved.objects) object.X_WO = CanonicalPose(X_NW * object.X_WO);
  for (FrameTransform& fixed : moved.fixed_frames) {
    fixed.X_WF = CanonicalPose(X_NW * fixed.X_WF);
  }
  return moved;
}

bool AllowedCollisionMatrix::Tells(const Entries::value_type& entry) const {
  const auto& [pair, allowed] = entry;
  return pair.first != pair.second && !(allowed && AllowedByDefault(pair.first, pair.second));
}

AllowedCollisionMatrix AllowedCollisionMatrix::Simplified() const {
  AllowedCollisionMatrix simplified = *this;
  std::erase_if(simplified.entries_, [this](const auto& entry) { return !Tells(entry); });
  return simplified;
}

}  // namespace planbench
