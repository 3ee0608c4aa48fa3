#include "sphere_fitting/outer_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "common/error.h"
#include "common/stopwatch.h"
#include "sphere_fitting/center_fit.h"
#include "sphere_fitting/cover_proof.h"

namespace planbench {
namespace {

using Fits = std::vector<std::unique_ptr<CenterFit>>;

constexpr int kImproveRounds = 20;
constexpr int kTrimRounds = 3;
constexpr double kAim = 0.97;            // What the proof adds is left room for.
constexpr int kProofRounds = 8;          // Of fitting to bare points.
constexpr double kBareResolution = 0.5;  // Of how far bare points are apart.

// Adds the time that it lives to that of a set.
class Timer {
 public:
  explicit Timer(OuterSet* set) : set_(set) {}
  ~Timer() { set_->seconds += clock_.seconds(); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  OuterSet* set_;
  Stopwatch clock_;
};

int Count(const std::vector<LinkBody>& links, const Fits& fits) {
  int count = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    count += static_cast<int>(links[i].spheres().size());
    if (fits[i] != nullptr) count += fits[i]->size();
  }
  return count;
}

std::vector<Ball> Proven(const LinkBody& link, CenterFit* fit) {
  const CoverProof proof(link);
  double apart_m = fit->spacing_m() / 2;
  for (int round = 0; round < kProofRounds; ++round) {
    const double resolution = std::max(proof.resolution(), kBareResolution * apart_m);
    const auto bare = proof.FindBarePoints(fit->Balls(), resolution, apart_m);
    if (bare.empty()) break;
    fit->AddSamples(bare);
    fit->Improve(0);
    apart_m = std::max(apart_m / 2, fit->spacing_m() / 8);
  }
  std::vector<Ball> balls = fit->Balls();
  proof.Close(&balls);
  return balls;
}

// Centres go one by one to the link whose spheres protrude most.
void Distribute(const std::vector<LinkBody>& links, int spheres, const FitProgress& progress,
                Fits* fits, std::vector<OuterSet>* sets) {
  int count = Count(links, *fits);
  if (count > spheres) {
    throw InputError(
        fmt::format("{} spheres are too few: these links need {} at least", spheres, count));
  }
  for (; count < spheres; ++count) {
    std::optional<std::size_t> worst;
    for (std::size_t i = 0; i < fits->size(); ++i) {
      if ((*fits)[i] == nullptr) continue;
      if (!worst || (*fits)[i]->Worst() > (*fits)[*worst]->Worst()) worst = i;
    }
    if (!worst) return;
    const Timer timer(&(*sets)[*worst]);
    (*fits)[*worst]->Grow();
    progress(count, "spheres placed");
  }
}

std::vector<Ball> FitTo(double protrusion_m, int most, const LinkBody& link,
                        std::unique_ptr<CenterFit>* fit) {
  while ((*fit)->Worst() > kAim * protrusion_m && (*fit)->size() < most) (*fit)->Grow();
  std::vector<Ball> balls;
  for (int rounds = kImproveRounds;; rounds = 1) {
    (*fit)->Improve(rounds);
    balls = Proven(link, fit->get());
    const double reached = GreatestProtrusion(link, balls);
    if (reached <= protrusion_m) break;
    const int size = (*fit)->size();
    if (size >= most) return balls;
    // Along edges, where most are needed, spheres protrude by a share of how far they are apart.
    const double lacking = size * (reached / protrusion_m - 1);
    const int wanted = std::min(most, size + std::max(1, static_cast<int>(lacking)));
    while ((*fit)->size() < wanted) (*fit)->Grow();
  }
  // Growing one by one takes more than are needed: as many go again as can be done without.
  for (int fewer = (*fit)->size() / 4; fewer > 0;) {
    auto trial = std::make_unique<CenterFit>(**fit);
    trial->Shrink(fewer);
    trial->Improve(kTrimRounds);
    std::vector<Ball> trial_balls;
    if (trial->Worst() <= protrusion_m) trial_balls = Proven(link, trial.get());
    if (trial_balls.empty() || GreatestProtrusion(link, trial_balls) > protrusion_m) {
      fewer /= 2;
      continue;
    }
    *fit = std::move(trial);
    balls = std::move(trial_balls);
    fewer = std::min(fewer, (*fit)->size() / 4);
  }
  return balls;
}

}  // namespace

double GreatestProtrusion(const LinkBody& link, const std::vector<Ball>& balls) {
  double greatest = 0;
  for (const Ball& ball : balls) {
    greatest = std::max(greatest, ball.radius - link.Depth(ball.center));
  }
  return greatest;
}

std::vector<OuterSet> FitOuterSpheres(const std::vector<LinkBody>& links, const FitGoal& goal,
                                      const FitProgress& progress) {
  const FitProgress say = progress ? progress : [](int, const std::string&) {};
  std::vector<OuterSet> sets(links.size());
  Fits fits;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Timer timer(&sets[i]);
    fits.push_back(links[i].has_solids() ? std::make_unique<CenterFit>(links[i], goal.samples)
                                         : nullptr);
  }
  if (goal.spheres) Distribute(links, *goal.spheres, say, &fits, &sets);
  for (std::size_t i = 0; i < links.size(); ++i) {
    say(goal.spheres.value_or(0) + static_cast<int>(i), "links proven");
    const Timer timer(&sets[i]);
    sets[i].balls = links[i].spheres();
    if (fits[i] == nullptr) continue;
    if (goal.spheres) fits[i]->Improve(kImproveRounds);
    const auto own = goal.protrusion_of_m.find(i);
    const std::vector<Ball> fitted =
        goal.spheres
            ? Proven(links[i], fits[i].get())
            : FitTo(own == goal.protrusion_of_m.end() ? goal.protrusion_m.value() : own->second,
                    goal.most_a_link, links[i], &fits[i]);
    sets[i].balls.insert(sets[i].balls.end(), fitted.begin(), fitted.end());
  }
  say(goal.spheres.value_or(0) + static_cast<int>(links.size()), "links proven");
  return sets;
}

}  // namespace planbench
