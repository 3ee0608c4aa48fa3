#include "planner_ara/guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace planbench {
namespace {

constexpr std::size_t kSlots = 1 << 14;  // a power of two

// What each arm under way beyond the first adds: 0.1 is too little where both are in narrow places,
// more is worse where one has to make way for the other.
constexpr double kEachUnderWay = 0.2;

// Soon felt, and more and more where the search has been hundreds of times.
double Crowd(double visits) { return std::log2(1 + visits) + visits / 5; }

}  // namespace

Guide::Guide(const Lattice* lattice, const std::vector<std::vector<double>>* goal_terms,
             const std::vector<Lattice::Coordinate>* goal_cells, Arms arms, double unit,
             double crowding, std::vector<int> place_cells)
    : lattice_(lattice),
      goal_terms_(goal_terms),
      goal_cells_(goal_cells),
      arms_(std::move(arms)),
      unit_(unit),
      crowding_(crowding),
      place_cells_(std::move(place_cells)),
      parts_(arms_.num == 1 ? 1 : static_cast<std::size_t>(arms_.num) + 1),
      visits_(crowding > 0 ? kSlots : 0) {}

void Guide::ByTip(std::unique_ptr<TipDistance> distance, double weight) {
  tip_distance_ = std::move(distance);
  tip_weight_ = weight;
}

void Guide::MeasureBy(const std::vector<std::vector<double>>* terms) {
  goal_terms_ = terms;
  has_own_terms_ = true;
  std::fill(visits_.begin(), visits_.end(), std::uint16_t{0});
}

// Sets, of each part, how far it is from the goal and whether it is at one of the ends.
void Guide::Locate(std::span<const Lattice::Coordinate> point) {
  for (Part& part : parts_) {
    part.squared = 0;
    part.has_left = false;
    part.has_arrived = true;
  }
  for (std::size_t j = 0; j < point.size(); ++j) {
    Part& part = PartOf(j);
    part.squared += (*goal_terms_)[j][point[j]];
    part.has_left = part.has_left || point[j] != lattice_->anchor()[j];
    part.has_arrived = part.has_arrived && point[j] == (*goal_cells_)[j];
  }
}

void Guide::SelectSource(std::span<const Lattice::Coordinate> source, std::span<const double> q) {
  for (Part& part : parts_) part.detour = 0;
  if (!q.empty()) {
    const std::span<const double> distances = (*tip_distance_)(q);
    for (std::size_t t = 0; t < distances.size(); ++t) {
      parts_[static_cast<std::size_t>(arms_.of_tip[t])].detour +=
          unit_ * tip_weight_ * distances[t];
    }
  }
  if (visits_.empty()) return;
  if (parts_.size() > 1) Locate(source);
  const double crowd = 1 + crowding_ * Crowd(CountVisit(source));
  for (Part& part : parts_) part.crowd = part.under_way() ? crowd : 1;
}

float Guide::operator()(std::span<const Lattice::Coordinate> target, double heuristic) {
  if (parts_.size() == 1) {
    if (has_own_terms_) {
      double squared = 0;
      for (std::size_t j = 0; j < target.size(); ++j) squared += (*goal_terms_)[j][target[j]];
      heuristic = unit_ * std::sqrt(squared);
    }
    return static_cast<float>(parts_[0].crowd * (heuristic + parts_[0].detour));
  }
  Locate(target);
  double guide = 0;
  int num_under_way = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    guide += part.crowd * (unit_ * std::sqrt(part.squared) + part.detour);
    if (i + 1 < parts_.size() && part.under_way()) ++num_under_way;
  }
  return static_cast<float>(guide * (1 + kEachUnderWay * std::max(0, num_under_way - 1)));
}

// Counts an expansion in the place of a source that has been located; returns the number of those
// before. Places of different hashes may share a count: it only guides.
double Guide::CountVisit(std::span<const Lattice::Coordinate> source) {
  std::uint64_t hash = 0;
  if (parts_.size() > 1) {
    for (const Part& part : parts_) hash = 2 * hash + (part.under_way() ? 1 : 0);
    hash <<= 32;
  }
  for (std::size_t j = 0; j < source.size(); ++j) {
    if (place_cells_[j] == 0 || !PartOf(j).under_way()) continue;
    hash = (hash ^ static_cast<std::uint64_t>(source[j] / place_cells_[j])) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
  }
  std::uint16_t& visits = visits_[hash & (kSlots - 1)];
  return visits < std::numeric_limits<std::uint16_t>::max() ? visits++ : visits;
}

}  // namespace planbench
