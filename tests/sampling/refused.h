// Checks that a refusal names the parameter, its value and the rule.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/require.h"

namespace softland::test {

/// Expects `action` to throw InvalidParameter about this parameter, with a message that contains all of `parts`.
template <typename Action>
void expect_parameter_refused(Action action, const std::string& parameter, const std::vector<std::string>& parts) {
  try {
    action();
    ADD_FAILURE() << "accepted; expected a message with " << testing::PrintToString(parts);
  } catch (const InvalidParameter& error) {
    EXPECT_EQ(error.parameter(), parameter) << error.what();
    for (const std::string& part : parts) EXPECT_THAT(error.what(), testing::HasSubstr(part));
  }
}

}  // namespace softland::test
