// Checks that a message about bad input contains the parameter, its value and the rule.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/require.h"

namespace softland::test {

/// Expects `action` to throw InvalidInput with a message that contains all of `parts`.
template <typename Action>
void expect_invalid(Action action, const std::vector<std::string>& parts) {
  try {
    action();
    ADD_FAILURE() << "accepted; expected a message with " << testing::PrintToString(parts);
  } catch (const InvalidInput& error) {
    for (const std::string& part : parts) EXPECT_THAT(error.what(), testing::HasSubstr(part));
  }
}

}  // namespace softland::test
