#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "common/enum_names.h"

namespace planbench {

/// --version: name, version and commit.
void AddVersionFlag(CLI::App* app);

/// For a flag that takes an enum's value by its name. (CLI::CheckedTransformer takes its number,
/// too, and tells the numbers.)
template <typename Enum>
CLI::Validator OneOf() {
  return CLI::Validator(
      [](std::string& text) {
        const std::optional<Enum> value = ParseEnum<Enum>(text);
        if (!value) return fmt::format("{} is not {}", text, EnumChoices<Enum>());
        text = std::to_string(static_cast<int>(*value));
        return std::string();
      },
      fmt::format("{{{}}}", fmt::join(EnumNames<Enum>::kNames, ",")));
}

/// For a flag that takes a whole number of 64 bits: CLI11 wraps those below 0, and takes the
/// largest for what is larger.
CLI::Validator AnySeed();

/// For a flag that takes a finite number greater than zero, at most `most`. (CLI::PositiveNumber
/// lets NaN pass, and tells its range to 309 digits.)
CLI::Validator Positive(double most = std::numeric_limits<double>::max());

/// For a flag that takes a number from `least` to `most`, `least` greater than zero.
CLI::Validator Within(double least, double most);

/// Parses the flags and calls `work`, which returns the exit code. Flags that CLI11 refuses, text
/// that is no UTF-8, and InputError end with 2, any other exception with 1, each after one line on
/// stderr that begins with the app's name; so ends, with 1 instead of 0, what lost something of its
/// standard output. --help tells the exit codes.
int RunCommand(CLI::App* app, int argc, char** argv, const std::function<int()>& work);

}  // namespace planbench
