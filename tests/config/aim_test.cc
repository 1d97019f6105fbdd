// Tests the aim of a search, read from text.
#include "config/aim.h"

#include <gtest/gtest.h>

#include <string>

#include "base/require.h"

namespace softland {
namespace {

std::string message(const char* text) {
  try {
    static_cast<void>(parse_aim(text));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Aim, IsATargetOrAWeightedSum) {
  for (const TargetRow& row : targets) {
    const Aim aim = parse_aim(row.name);
    EXPECT_FALSE(aim.is_sum());
    EXPECT_TRUE(aim.is_about(row.value));
    EXPECT_EQ(aim.has_own_cost(), row.has_own_cost);
    EXPECT_EQ(aim.text(), row.name);
  }
  const Aim sum = parse_aim("0.7 bounce + 0.3 energy");
  ASSERT_EQ(sum.parts().size(), 2U);
  EXPECT_EQ(sum.parts()[0].target, Target::bounce);
  EXPECT_EQ(sum.parts()[0].weight, 0.7);
  EXPECT_EQ(sum.parts()[1].weight, 0.3);
  EXPECT_TRUE(sum.has_own_cost());
  EXPECT_EQ(sum.text(), "0.7 bounce + 0.3 energy");
  EXPECT_EQ(parse_aim("settling+2 drive").text(), "1 settling + 2 drive");
  EXPECT_EQ(parse_aim("  2   force  ").text(), "force") << "one target has no use for a weight";
}

TEST(Aim, RefusesWhatIsNone) {
  const std::string rule = "must be " + listed(targets) + ", or a weighted sum such as \"0.7 bounce + 0.3 energy\"";
  EXPECT_EQ(message("softness"), rule);
  EXPECT_EQ(message(""), rule);
  EXPECT_EQ(message("0.7 bounce + 0.3 softness"), rule);
  EXPECT_EQ(message("0.7 bounce + "), rule);
  EXPECT_EQ(message("much bounce + energy"), "'much bounce' must be a weight and a target, such as 0.7 bounce");
  EXPECT_EQ(message("bounce + 2 bounce"), "bounce appears twice in a sum of targets; name each target once");
  EXPECT_EQ(message("-1 bounce + 2 energy"), "the weight of bounce is -1; it must be finite and > 0");
}

}  // namespace
}  // namespace softland
