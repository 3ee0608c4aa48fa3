#include "planner_rrtc/ompl_joint_space.h"

#include <ompl/base/ProjectionEvaluator.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <ostream>
#include <random>

#include "common/numbers.h"
#include "common/random.h"

namespace planbench {
namespace {

namespace ob = ompl::base;

/// Header of a block that goes on with the positions.
class alignas(double) JointSpaceState final : public ob::State {
 public:
  explicit JointSpaceState(const OmplJointSpace* space) : space(space) {}
  ~JointSpaceState() override = default;
  double* positions() { return reinterpret_cast<double*>(this + 1); }
  const double* positions() const { return reinterpret_cast<const double*>(this + 1); }

  const OmplJointSpace* space;
};

void DeleteState(ob::State* state) {
  auto* joint_space_state = static_cast<JointSpaceState*>(state);
  joint_space_state->~JointSpaceState();
  ::operator delete(joint_space_state);
}

class FirstJointsProjection final : public ob::ProjectionEvaluator {
 public:
  FirstJointsProjection(const ob::StateSpace* space, const JointSpace& joints)
      : ob::ProjectionEvaluator(space), joints_(joints) {}

  unsigned int getDimension() const override {
    return static_cast<unsigned int>(std::min(3, joints_.size()));
  }
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
    std::copy_n(OmplPositions(state), getDimension(), projection.data());
  }
  void defaultCellSizes() override {
    constexpr double kCells = 20;  // along a joint, as many as OMPL takes where it estimates
    bounds_.resize(getDimension());
    cellSizes_.clear();
    for (unsigned int j = 0; j < getDimension(); ++j) {
      const JointSpace::Joint& joint = joints_.joint(static_cast<int>(j));
      bounds_.setLow(j, joint.lower);
      bounds_.setHigh(j, joint.upper);
      cellSizes_.push_back((joint.upper - joint.lower) / kCells);
    }
  }

 private:
  const JointSpace& joints_;
};

/// A JointSampler for OMPL. Adds the number of its samples to *num_samples.
class OmplSampler final : public ob::StateSampler {
 public:
  OmplSampler(const ob::StateSpace* space, JointSampler sampler, std::int64_t* num_samples)
      : ob::StateSampler(space), sampler_(std::move(sampler)), num_samples_(num_samples) {}

  void sampleUniform(ob::State* state) override {
    ++*num_samples_;
    sampler_.Sample(OmplPositions(state));
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    ++*num_samples_;
    // Within the limits, as OMPL's own spaces have it. What is drawn beyond them and brought back
    // stands at a limit: half of the joints, where motions are as long as joints can turn.
    const JointSpace& joints = OmplSpaceOf(near).joints();
    for (int j = 0; j < joints.size(); ++j) {
      const JointSpace::Joint& joint = joints.joint(j);
      const double center = OmplPositions(near)[j];
      const double reach = joint.continuous ? std::min(distance, kPi) : distance;
      const double least =
          joint.continuous ? center - reach : std::max(joint.lower, center - reach);
      const double most = joint.continuous ? center + reach : std::min(joint.upper, center + reach);
      const double fraction = UniformFraction(sampler_.generator());
      OmplPositions(state)[j] = least + fraction * (most - least);
    }
    space_->enforceBounds(state);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double std_dev) override {
    ++*num_samples_;
    std::normal_distribution<double> normal(0, std_dev);
    for (unsigned int j = 0; j < space_->getDimension(); ++j) {
      OmplPositions(state)[j] = OmplPositions(mean)[j] + normal(*sampler_.generator());
    }
    space_->enforceBounds(state);
  }

 private:
  JointSampler sampler_;
  std::int64_t* num_samples_;
};

}  // namespace

const OmplJointSpace& OmplSpaceOf(const ob::State* state) {
  return *static_cast<const JointSpaceState*>(state)->space;
}

double* OmplPositions(ob::State* state) {
  return static_cast<JointSpaceState*>(state)->positions();
}

const double* OmplPositions(const ob::State* state) {
  return static_cast<const JointSpaceState*>(state)->positions();
}

OmplJointSpace::OmplJointSpace(const JointSpace& joints, Metric metric)
    : joints_(joints), flat_(joints, metric) {
  setName("JointSpace");
  type_ = ob::STATE_SPACE_TYPE_COUNT + 1;  // a type of its own, none of OMPL's
}

OmplJointSpace::~OmplJointSpace() {
  for (ob::State* state : free_states_) DeleteState(state);
}

void OmplJointSpace::SeedSamplers(SamplerKind kind, std::uint64_t seed) {
  sampler_kind_ = kind;
  next_seed_ = seed;
  num_samples_ = 0;
  neighbor_ticks_ = 0;
}

void OmplJointSpace::SetPositions(ob::State* state, const std::vector<double>& q) const {
  std::copy(q.begin(), q.end(), OmplPositions(state));
  joints_.Wrap({OmplPositions(state), flat_.size()});
}

unsigned int OmplJointSpace::getDimension() const {
  return static_cast<unsigned int>(flat_.size());
}

double OmplJointSpace::getMaximumExtent() const {
  double sum = 0;
  double squares = 0;
  for (const JointSpace::Joint& joint : joints_.joints()) {
    const double extent = joint.upper - joint.lower;  // a turn, of continuous joints
    const double furthest = joint.continuous ? kPi : extent;
    sum += extent;
    squares += furthest * furthest;
  }
  return flat_.metric() == Metric::kSum ? sum : std::sqrt(squares);
}

double OmplJointSpace::getMeasure() const {
  double measure = 1;
  for (const JointSpace::Joint& joint : joints_.joints()) measure *= joint.upper - joint.lower;
  return measure;
}

void OmplJointSpace::enforceBounds(ob::State* state) const {
  double* q = OmplPositions(state);
  for (int j = 0; j < joints_.size(); ++j) {
    const JointSpace::Joint& joint = joints_.joint(j);
    q[j] = joint.continuous ? WrapAngle(q[j]) : std::clamp(q[j], joint.lower, joint.upper);
  }
}

bool OmplJointSpace::satisfiesBounds(const ob::State* state) const {
  return joints_.WithinLimits({OmplPositions(state), flat_.size()});
}

void OmplJointSpace::copyState(ob::State* destination, const ob::State* source) const {
  std::copy_n(OmplPositions(source), flat_.size(), OmplPositions(destination));
}

unsigned int OmplJointSpace::getSerializationLength() const {
  return static_cast<unsigned int>(flat_.size() * sizeof(double));
}

void OmplJointSpace::serialize(void* serialization, const ob::State* state) const {
  std::copy_n(OmplPositions(state), flat_.size(), static_cast<double*>(serialization));
}

void OmplJointSpace::deserialize(ob::State* state, const void* serialization) const {
  std::copy_n(static_cast<const double*>(serialization), flat_.size(), OmplPositions(state));
}

double OmplJointSpace::distance(const ob::State* a, const ob::State* b) const {
  return flat_.Distance(OmplPositions(a), OmplPositions(b));
}

bool OmplJointSpace::equalStates(const ob::State* a, const ob::State* b) const {
  return std::equal(OmplPositions(a), OmplPositions(a) + flat_.size(), OmplPositions(b));
}

void OmplJointSpace::interpolate(const ob::State* from, const ob::State* to, double t,
                                 ob::State* state) const {
  flat_.Interpolate(OmplPositions(from), OmplPositions(to), t, OmplPositions(state));
}

ob::StateSamplerPtr OmplJointSpace::allocDefaultStateSampler() const {
  return std::make_shared<OmplSampler>(this, JointSampler(joints_, sampler_kind_, next_seed_++),
                                       &num_samples_);
}

ob::State* OmplJointSpace::allocState() const {
  if (!free_states_.empty()) {
    ob::State* state = free_states_.back();
    free_states_.pop_back();
    return state;
  }
  void* block = ::operator new(sizeof(JointSpaceState) + flat_.size() * sizeof(double));
  auto* state = new (block) JointSpaceState(this);
  std::fill_n(new (state->positions()) double[flat_.size()], flat_.size(), 0.0);
  return state;
}

void OmplJointSpace::freeState(ob::State* state) const { free_states_.push_back(state); }

double* OmplJointSpace::getValueAddressAtIndex(ob::State* state, unsigned int index) const {
  return index < flat_.size() ? OmplPositions(state) + index : nullptr;
}

void OmplJointSpace::printState(const ob::State* state, std::ostream& out) const {
  for (std::size_t j = 0; j < flat_.size(); ++j) out << OmplPositions(state)[j] << ' ';
  out << '\n';
}

void OmplJointSpace::registerProjections() {
  registerDefaultProjection(std::make_shared<FirstJointsProjection>(this, joints_));
}

}  // namespace planbench
