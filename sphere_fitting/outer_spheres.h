#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/ball.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// How closely spheres are to enclose links: one of the two is given.
struct FitGoal {
  std::optional<int> spheres;          ///< So many on all links together.
  std::optional<double> protrusion_m;  ///< No point of a sphere further than that from its link.
  std::map<std::size_t, double>
      protrusion_of_m;     ///< Of links, by index, that have one of their own.
  int most_a_link = 1000;  ///< However far that protrudes.
  int samples = 3000;      ///< About so many points stand for a link's surface.
};

/// The balls of a link, in its frame, and how long it took to fit them.
struct OuterSet {
  std::vector<Ball> balls;
  double seconds = 0;
};

/// Is told how far the work has come, and with what: a piece for each sphere of the goal, if it
/// says how many, and then one for each link. They are not alike: one link may take a hundred times
/// as long as another, and a few links together as long as all spheres before them.
using FitProgress = std::function<void(int done, const std::string& text)>;

/// For each link, which must not be empty, balls in its frame that provably contain it
/// (CoverProof): its own spheres, then those fitted to the rest. Throws InputError if the goal
/// leaves a shape without a sphere.
///
/// A ball at a centre at depth d of a body protrudes by its radius less d, no more. So the fit is a
/// problem of k centres with the cost |p - c| - d(c) for a point p of the body at the centre c: the
/// point of the highest cost gets a centre of its own near it, points go to the centre of the least
/// cost, each centre moves to where the highest cost of its points is least, and again. Where the
/// proof then finds bare points, they join those that are fitted to, and at last radii grow until
/// it holds.
std::vector<OuterSet> FitOuterSpheres(const std::vector<LinkBody>& links, const FitGoal& goal,
                                      const FitProgress& progress = nullptr);

/// How far the balls reach beyond a link, m: no point of a ball is further from it.
double GreatestProtrusion(const LinkBody& link, const std::vector<Ball>& balls);

}  // namespace planbench
