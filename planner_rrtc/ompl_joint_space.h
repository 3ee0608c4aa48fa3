#pragma once

#include <ompl/base/StateSpace.h>

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <vector>

#include "planner_rrtc/flat_joints.h"
#include "planner_rrtc/joint_sampler.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// A JointSpace as a state space of OMPL: n doubles in one block, distances by the metric with
/// continuous joints the short way round, motions straight. The extent is that of the joints'
/// ranges in the metric; continuous joints count pi, the furthest they can be apart, in L2, but 2
/// pi in the sum, as in MoveIt. Flat, because a compound of OMPL's own spaces spends more time in
/// virtual calls than a collision checker needs for a configuration. States that are freed are kept
/// for the next one asked for. Positions of continuous joints must be kept in [-pi, pi]. Its
/// default projection, for the planners that need one, is onto the first three joints (all, if
/// there are fewer), those that carry the others. Its samplers are JointSamplers and do not depend
/// on OMPL's process-wide seed.
///
/// Not thread-safe, unlike OMPL's own spaces. `joints` must outlive it.
class OmplJointSpace final : public ompl::base::StateSpace {
 public:
  OmplJointSpace(const JointSpace& joints, Metric metric);
  ~OmplJointSpace() override;

  const JointSpace& joints() const { return joints_; }
  const FlatJoints& flat_joints() const { return flat_; }
  /// The first sampler allocated from here on has this seed, every further one the next. Begins to
  /// count samples.
  void SeedSamplers(SamplerKind kind, std::uint64_t seed);
  /// Configurations drawn by all samplers since they were seeded, from the whole space or near one.
  std::int64_t num_samples() const { return num_samples_; }
  /// Time that planners have spent on nearest neighbours since the samplers were seeded, where
  /// their structure adds it here.
  std::uint64_t* neighbor_ticks() const { return &neighbor_ticks_; }
  /// Positions with continuous joints wrapped.
  void SetPositions(ompl::base::State* state, const std::vector<double>& q) const;

  unsigned int getDimension() const override;
  double getMaximumExtent() const override;
  double getMeasure() const override;
  void enforceBounds(ompl::base::State* state) const override;
  bool satisfiesBounds(const ompl::base::State* state) const override;
  void copyState(ompl::base::State* destination, const ompl::base::State* source) const override;
  unsigned int getSerializationLength() const override;
  void serialize(void* serialization, const ompl::base::State* state) const override;
  void deserialize(ompl::base::State* state, const void* serialization) const override;
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  bool equalStates(const ompl::base::State* a, const ompl::base::State* b) const override;
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  ompl::base::StateSamplerPtr allocDefaultStateSampler() const override;
  ompl::base::State* allocState() const override;
  void freeState(ompl::base::State* state) const override;
  double* getValueAddressAtIndex(ompl::base::State* state, unsigned int index) const override;
  void printState(const ompl::base::State* state, std::ostream& out) const override;
  void registerProjections() override;

 private:
  const JointSpace& joints_;
  FlatJoints flat_;
  mutable std::vector<ompl::base::State*> free_states_;
  SamplerKind sampler_kind_ = SamplerKind::kUniform;
  mutable std::uint64_t next_seed_ = 1;
  mutable std::int64_t num_samples_ = 0;
  mutable std::uint64_t neighbor_ticks_ = 0;
};

/// The space that a state of such a space belongs to.
const OmplJointSpace& OmplSpaceOf(const ompl::base::State* state);
/// The positions of a state of such a space.
double* OmplPositions(ompl::base::State* state);
const double* OmplPositions(const ompl::base::State* state);

}  // namespace planbench
