// Compares messages about bad input word for word.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/require.h"

namespace softland::test {

/// Expects `action` to throw InvalidInput with this message.
template <typename Action>
void expect_refused(Action action, const std::string& message) {
  try {
    action();
    ADD_FAILURE() << "accepted; expected: " << message;
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.what(), message);
  }
}

}  // namespace softland::test
