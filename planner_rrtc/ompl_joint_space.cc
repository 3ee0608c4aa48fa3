#include "planner_rrtc/ompl_joint_space.h"

#include <ompl/base/StateSampler.h>
#include <ompl/base/StateSpace.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>
#include <ostream>
#include <vector>

namespace planbench {
namespace {

namespace ob = ompl::base;
constexpr double kPi = std::numbers::pi;

/// Header of a block that goes on with the positions.
class alignas(double) JointSpaceState final : public ob::State {
 public:
  ~JointSpaceState() override = default;
  double* positions() { return reinterpret_cast<double*>(this + 1); }
  const double* positions() const { return reinterpret_cast<const double*>(this + 1); }
};

double* Positions(ob::State* state) { return static_cast<JointSpaceState*>(state)->positions(); }
const double* Positions(const ob::State* state) {
  return static_cast<const JointSpaceState*>(state)->positions();
}

class JointSpaceSampler final : public ob::StateSampler {
 public:
  JointSpaceSampler(const ob::StateSpace* space, const JointSpace& joints)
      : ob::StateSampler(space), joints_(joints) {}
  JointSpaceSampler(const ob::StateSpace* space, const JointSpace& joints, std::uint64_t seed,
                    std::int64_t* num_samples)
      : ob::StateSampler(space), joints_(joints), num_samples_(num_samples) {
    rng_.setLocalSeed(OmplSeed(seed));
  }

  void sampleUniform(ob::State* state) override {
    if (num_samples_ != nullptr) ++*num_samples_;
    double* q = Positions(state);
    for (int j = 0; j < joints_.size(); ++j) {
      q[j] = rng_.uniformReal(joints_.joint(j).lower, joints_.joint(j).upper);
    }
  }

  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    double* q = Positions(state);
    const double* center = Positions(near);
    for (int j = 0; j < joints_.size(); ++j) {
      q[j] = rng_.uniformReal(center[j] - distance, center[j] + distance);
    }
    space_->enforceBounds(state);
  }

  void sampleGaussian(ob::State* state, const ob::State* mean, double std_dev) override {
    double* q = Positions(state);
    const double* center = Positions(mean);
    for (int j = 0; j < joints_.size(); ++j) q[j] = rng_.gaussian(center[j], std_dev);
    space_->enforceBounds(state);
  }

 private:
  const JointSpace& joints_;
  std::int64_t* num_samples_ = nullptr;
};

class OmplJointSpace final : public ob::StateSpace {
 public:
  explicit OmplJointSpace(const JointSpace& joints)
      : joints_(joints), n_(static_cast<std::size_t>(joints.size())) {
    setName("JointSpace");
    type_ = ob::STATE_SPACE_TYPE_COUNT + 1;  // a type of its own, none of OMPL's
    for (const JointSpace::Joint& joint : joints.joints()) {
      period_.push_back(joint.continuous ? 2 * kPi : std::numeric_limits<double>::infinity());
    }
  }

  unsigned int getDimension() const override { return static_cast<unsigned int>(n_); }

  double getMaximumExtent() const override {
    double sum = 0;
    for (const JointSpace::Joint& joint : joints_.joints()) {
      const double extent = joint.continuous ? kPi : joint.upper - joint.lower;
      sum += extent * extent;
    }
    return std::sqrt(sum);
  }

  double getMeasure() const override {
    double measure = 1;
    for (const JointSpace::Joint& joint : joints_.joints()) measure *= joint.upper - joint.lower;
    return measure;
  }

  void enforceBounds(ob::State* state) const override {
    double* q = Positions(state);
    for (int j = 0; j < joints_.size(); ++j) {
      const JointSpace::Joint& joint = joints_.joint(j);
      q[j] = joint.continuous ? WrapAngle(q[j]) : std::clamp(q[j], joint.lower, joint.upper);
    }
  }

  bool satisfiesBounds(const ob::State* state) const override {
    return joints_.WithinLimits({Positions(state), n_});
  }

  void copyState(ob::State* destination, const ob::State* source) const override {
    std::copy_n(Positions(source), n_, Positions(destination));
  }

  unsigned int getSerializationLength() const override {
    return static_cast<unsigned int>(n_ * sizeof(double));
  }
  void serialize(void* serialization, const ob::State* state) const override {
    std::copy_n(Positions(state), n_, static_cast<double*>(serialization));
  }
  void deserialize(ob::State* state, const void* serialization) const override {
    std::copy_n(static_cast<const double*>(serialization), n_, Positions(state));
  }

  double distance(const ob::State* state1, const ob::State* state2) const override {
    const double* a = Positions(state1);
    const double* b = Positions(state2);
    double sum = 0;
    for (std::size_t k = 0; k < n_; ++k) {
      const double direct = std::abs(a[k] - b[k]);
      const double shorter = std::min(direct, std::abs(period_[k] - direct));
      sum += shorter * shorter;
    }
    return std::sqrt(sum);
  }

  bool equalStates(const ob::State* state1, const ob::State* state2) const override {
    return std::equal(Positions(state1), Positions(state1) + n_, Positions(state2));
  }

  void interpolate(const ob::State* from, const ob::State* to, double t,
                   ob::State* state) const override {
    joints_.Interpolate({Positions(from), n_}, {Positions(to), n_}, t, {Positions(state), n_});
  }

  ob::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<JointSpaceSampler>(this, joints_);
  }

  ob::State* allocState() const override {
    void* block = ::operator new(sizeof(JointSpaceState) + n_ * sizeof(double));
    auto* state = new (block) JointSpaceState;
    std::fill_n(new (state->positions()) double[n_], n_, 0.0);
    return state;
  }

  void freeState(ob::State* state) const override {
    auto* joint_space_state = static_cast<JointSpaceState*>(state);
    joint_space_state->~JointSpaceState();
    ::operator delete(joint_space_state);
  }

  double* getValueAddressAtIndex(ob::State* state, unsigned int index) const override {
    return index < n_ ? Positions(state) + index : nullptr;
  }

  void printState(const ob::State* state, std::ostream& out) const override {
    for (const double position : OmplPositions(state, n_)) out << position << ' ';
    out << '\n';
  }

 private:
  const JointSpace& joints_;
  std::size_t n_;
  std::vector<double> period_;
};

}  // namespace

std::shared_ptr<ob::StateSpace> MakeOmplJointSpace(const JointSpace& joints) {
  return std::make_shared<OmplJointSpace>(joints);
}

std::span<double> OmplPositions(ob::State* state, std::size_t n) { return {Positions(state), n}; }

std::span<const double> OmplPositions(const ob::State* state, std::size_t n) {
  return {Positions(state), n};
}

std::shared_ptr<ob::StateSampler> MakeOmplSampler(const ob::StateSpace* space,
                                                  const JointSpace& joints, std::uint64_t seed,
                                                  std::int64_t* num_samples) {
  return std::make_shared<JointSpaceSampler>(space, joints, seed, num_samples);
}

std::uint32_t OmplSeed(std::uint64_t seed) {
  // The finalizer of SplitMix64 (Steele, Lea and Flood, 2014) spreads all bits over the upper half.
  seed += 0x9e3779b97f4a7c15u;
  seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9u;
  seed = (seed ^ (seed >> 27)) * 0x94d049bb133111ebu;
  const auto folded = static_cast<std::uint32_t>(seed >> 32);
  return folded == 0 ? 1 : folded;
}

}  // namespace planbench
