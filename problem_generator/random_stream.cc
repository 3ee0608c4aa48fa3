#include "problem_generator/random_stream.h"

#include "common/content_hash.h"
#include "common/random.h"

namespace planbench {
namespace {

std::uint64_t StreamSeed(const std::string& set, std::uint64_t seed, int problem, int attempt) {
  ContentHash hash;
  hash.Add(set);
  hash.Add(static_cast<std::int64_t>(seed));
  hash.Add(problem);
  hash.Add(attempt);
  return std::stoull(hash.HexDigest().substr(0, 16), nullptr, 16);
}

}  // namespace

RandomStream::RandomStream(const std::string& set, std::uint64_t seed, int problem, int attempt)
    : engine_(StreamSeed(set, seed, problem, attempt)) {}

double RandomStream::Draw(const Range& range) {
  // Also drawn where the range is a single value: widening one range then leaves the others' draws
  // as they were.
  const double fraction = UniformFraction(&engine_);
  return range.low + fraction * (range.high - range.low);
}

Eigen::Vector3d RandomStream::Draw(const Range3& ranges) {
  const double x = Draw(ranges[0]);
  const double y = Draw(ranges[1]);
  const double z = Draw(ranges[2]);
  return {x, y, z};
}

bool RandomStream::Chance(double probability) { return UniformFraction(&engine_) < probability; }

std::size_t RandomStream::Index(std::size_t size) {
  return static_cast<std::size_t>(UniformFraction(&engine_) * static_cast<double>(size));
}

std::size_t RandomStream::Weighted(const std::vector<double>& weights) {
  double total = 0;
  for (const double weight : weights) total += weight;
  double left = UniformFraction(&engine_) * total;
  for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
    left -= weights[i];
    if (left < 0) return i;
  }
  return weights.size() - 1;
}

}  // namespace planbench
