#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/error.h"

namespace planbench {

/// Expects `action` to throw an InputError of one line whose message contains every one of `parts`.
template <typename Action>
void ExpectInputError(Action action, const std::vector<std::string>& parts) {
  try {
    action();
    ADD_FAILURE() << "nothing was thrown; expected an InputError";
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const std::string& part : parts) EXPECT_THAT(message, testing::HasSubstr(part));
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace planbench
