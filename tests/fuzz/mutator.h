#pragma once

#include <random>
#include <vector>

#include "tests/fuzz/fuzz_target.h"

namespace planbench {

/// An input made of one of the seeds by a few changes: bits and bytes, pieces left out, doubled, or
/// taken from another seed, numbers replaced by extreme ones, words and marks of the text formats
/// put in. Equal states of `random` give equal inputs.
Bytes Mutated(const std::vector<Bytes>& seeds, std::mt19937_64* random);

}  // namespace planbench
