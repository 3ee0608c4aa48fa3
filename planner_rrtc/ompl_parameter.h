#pragma once

#include <ompl/base/GenericParam.h>

#include <string>

namespace planbench {

/// Why `value` is none of a parameter of OMPL's, in words that go behind its name; empty if it may
/// be one. Numbers are finite, whole where OMPL suggests such, not negative where it suggests none
/// that are, and shares (bias, fraction, probability, what it suggests up to 1) from 0 to 1. OMPL
/// itself takes what its conversions make of a text.
std::string WhyRefused(const ompl::base::GenericParam& parameter, const std::string& value);

}  // namespace planbench
