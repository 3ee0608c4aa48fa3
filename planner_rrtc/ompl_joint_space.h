#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "robot_model/joint_space.h"

namespace ompl::base {
class State;
class StateSampler;
class StateSpace;
}  // namespace ompl::base

namespace planbench {

/// A JointSpace as a state space of OMPL: n doubles in one block, distances L2 with continuous
/// joints the short way round, motions straight. Flat, because a compound of OMPL's own spaces
/// spends more time in virtual calls than a collision checker needs for a configuration. Positions
/// of continuous joints must be kept in
/// [-pi, pi]. `joints` must outlive the space.
std::shared_ptr<ompl::base::StateSpace> MakeOmplJointSpace(const JointSpace& joints);

/// The n positions of a state of such a space.
std::span<double> OmplPositions(ompl::base::State* state, std::size_t n);
std::span<const double> OmplPositions(const ompl::base::State* state, std::size_t n);

/// Uniform sampler over the joints' limits, and [-pi, pi) for continuous joints, that depends on
/// `seed` only and not on OMPL's process-wide seed. Adds the number of its uniform samples to
/// *num_samples.
std::shared_ptr<ompl::base::StateSampler> MakeOmplSampler(const ompl::base::StateSpace* space,
                                                          const JointSpace& joints,
                                                          std::uint64_t seed,
                                                          std::int64_t* num_samples);

/// A seed of OMPL's generator, which takes 32 bits; different for seeds that differ anywhere in
/// their 64 bits (but for chance), never 0.
std::uint32_t OmplSeed(std::uint64_t seed);

}  // namespace planbench
