#pragma once

#include <ompl/base/GenericParam.h>

#include <string>

namespace planbench {

/// Why `value` is none of a parameter of OMPL's, in words that go behind its name; empty if it may
/// be one. Numbers are finite, at most a million, not negative where OMPL suggests none that are,
/// and shares (bias, fraction, probability, what it suggests up to 1) from 0 to 1; where it
/// suggests whole numbers they are such, from 1 (or where it begins, if that is less); degrees of
/// trees begin where it does, and end at 1000, batches of samples at 100,000. OMPL itself takes
/// what its conversions make of a text.
std::string WhyRefused(const ompl::base::GenericParam& parameter, const std::string& value);

}  // namespace planbench
