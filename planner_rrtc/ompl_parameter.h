#pragma once

#include <ompl/base/GenericParam.h>

#include <string>

namespace planbench {

/// Why `value` is none of a parameter of OMPL's, in words that go behind its name; empty if it may
/// be one. Known are the range or the choices that OMPL suggests for it and, where it suggests
/// none, that ranges are not negative and shares (bias, fraction, probability) from 0 to 1. Numbers
/// are finite. OMPL itself takes what its conversions make of a text.
std::string WhyRefused(const ompl::base::GenericParam& parameter, const std::string& value);

}  // namespace planbench
