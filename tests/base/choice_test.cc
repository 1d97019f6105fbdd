#include "base/choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace softland {
namespace {

using testing::ElementsAre;

enum class Metal { gold, nickel, tin };

struct MetalRow {
  Metal value;
  std::string_view name;
  Words keys;
};

constexpr auto metals = std::to_array<MetalRow>({{Metal::gold, "gold", {"hardness"}},
                                                 {Metal::nickel, "nickel", Words{"hardness"} + Words{"magnetisation"}},
                                                 {Metal::tin, "tin", {}}});
constexpr auto forgotten = std::to_array<Named<Metal>>({{Metal::gold, "gold"}, {Metal::nickel, "nickel"}});
constexpr auto disordered = std::to_array<Named<Metal>>({{Metal::nickel, "nickel"}, {Metal::gold, "gold"}, {Metal::tin, "tin"}});
constexpr auto twice = std::to_array<Named<Metal>>({{Metal::gold, "gold"}, {Metal::nickel, "gold"}, {Metal::tin, "tin"}});
constexpr auto nameless = std::to_array<Named<Metal>>({{Metal::gold, "gold"}, {Metal::nickel, ""}, {Metal::tin, "tin"}});
constexpr auto beyond = std::to_array<Named<Metal>>(
    {{Metal::gold, "gold"}, {Metal::nickel, "nickel"}, {Metal::tin, "tin"}, {static_cast<Metal>(3), "lead"}});

TEST(Choice, TablesAreCompleteOrDoNotCompile) {
  static_assert(is_complete<metals>());
  static_assert(!is_complete<forgotten>());
  static_assert(!is_complete<disordered>());
  static_assert(!is_complete<twice>());
  static_assert(!is_complete<nameless>());
  static_assert(!is_complete<beyond>());
}

TEST(Choice, IsFoundByValueAndByName) {
  EXPECT_EQ(name_of(metals, Metal::nickel), "nickel");
  EXPECT_EQ(&row_of(metals, Metal::tin), &metals[2]);
  EXPECT_EQ(find_named(metals, "tin"), &metals[2]);
  EXPECT_EQ(find_named(metals, "lead"), nullptr);
  EXPECT_THAT(names_of(metals), ElementsAre("gold", "nickel", "tin"));
}

TEST(Choice, KnowsWhichRowsListAKey) {
  EXPECT_THAT(with_key(metals, "hardness"), ElementsAre("gold", "nickel"));
  EXPECT_THAT(with_key(metals, "magnetisation"), ElementsAre("nickel"));
  EXPECT_THAT(with_key(metals, "colour"), ElementsAre());
}

}  // namespace
}  // namespace softland
