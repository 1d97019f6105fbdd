#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <vector>

#include "optimizers/problem.h"

namespace softland {

/// A suite whose cases run once for each optimizer.
class EveryOptimizer : public testing::TestWithParam<std::string> {};

inline std::vector<std::string> every_name() { return {optimizer_names().begin(), optimizer_names().end()}; }

inline std::string case_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  }
  return name;
}

inline void expect_same(const Evaluation& a, const Evaluation& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.x, b.x);
}

/// Expects all members to be equal bit for bit.
inline void expect_same(const OptimizerResult& a, const OptimizerResult& b) {
  EXPECT_EQ(a.termination, b.termination);
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(a.x, b.x);
  if (!a.x.empty()) {
    EXPECT_EQ(a.value, b.value);
  }
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.first_exception, b.first_exception);
  ASSERT_EQ(a.improvements.size(), b.improvements.size());
  for (std::size_t k = 0; k < a.improvements.size(); ++k) expect_same(a.improvements[k], b.improvements[k]);
}

}  // namespace softland
