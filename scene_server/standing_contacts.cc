#include "scene_server/standing_contacts.h"

#include <algorithm>
#include <optional>
#include <random>
#include <set>

#include "common/random.h"

namespace planbench {
namespace {

using LinkPairs = std::set<std::pair<std::string, std::string>>;

// Draws of which all contacts are listed: what touches in one and not in another does not stand.
constexpr int kListedDraws = 5;

std::vector<double> Draw(const JointSpace& space, std::mt19937_64* random) {
  std::vector<double> q;
  for (const JointSpace::Joint& joint : space.joints()) {
    q.push_back(joint.lower + UniformFraction(random) * (joint.upper - joint.lower));
  }
  return q;
}

// Every pair of links in contact at q: the checker tells one at a time.
LinkPairs ContactsAt(CollisionChecker* checker, Scene scene, std::span<const double> base_positions,
                     std::span<const double> q) {
  LinkPairs pairs;
  while (true) {
    checker->SetScene(scene, base_positions);
    const std::optional<Contact> contact = checker->FindContact(q);
    if (!contact) return pairs;
    pairs.insert(std::minmax(contact->body_a, contact->body_b));
    scene.allowed_collisions.SetEntry(contact->body_a, contact->body_b, true);
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> FindStandingContacts(
    CollisionChecker* checker, const AllowedCollisionMatrix& allowed,
    std::span<const double> base_positions) {
  Scene scene;
  scene.world_frame = checker->robot().model.links().front().name;
  scene.allowed_collisions = allowed;
  checker->SetScene(scene, base_positions);
  std::mt19937_64 random(1);
  std::vector<std::vector<double>> draws;
  for (int i = 0; i < kStandingDraws; ++i) {
    draws.push_back(Draw(checker->space(), &random));
    if (checker->IsFree(draws.back())) return {};
  }
  LinkPairs standing = ContactsAt(checker, scene, base_positions, draws.front());
  for (int i = 1; i < kListedDraws; ++i) {
    const LinkPairs others =
        ContactsAt(checker, scene, base_positions, draws[static_cast<std::size_t>(i)]);
    std::erase_if(standing, [&](const auto& pair) { return !others.contains(pair); });
  }
  return {standing.begin(), standing.end()};
}

}  // namespace planbench
