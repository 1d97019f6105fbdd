#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "reports/check_report.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using testing::HasSubstr;
using namespace literals;

int drawn(const std::string& text, std::string_view what) {
  int found = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

constexpr std::string_view beam = "fill=\"#c9a227\"", layer = "fill=\"#7a5cc4\"", electrode = " fill=\"#2b6cb0\"",
                           hole = "fill=\"#fff\"/";

TEST(BeamDrawing, ShowsEveryPartFromAboveAndFromTheSide) {
  Device d = test::gold_cantilever();
  const std::string plain = beam_drawing("plain <beam>", d);
  EXPECT_THAT(plain, HasSubstr("plain &lt;beam&gt;"));
  EXPECT_THAT(plain, HasSubstr("(prefers-color-scheme:dark){[fill=\"#fff\"]{fill:#131416}"));
  EXPECT_EQ(drawn(plain, beam), 2) << "from above and from the side";
  EXPECT_EQ(drawn(plain, electrode), 2) << "an outline from above, a body from the side";
  Beam& parts = part_of<Beam>(d.structure);
  parts.sections = {{.length = 50_um, .width = 10_um}, {.length = 200_um, .holes = {.pitch = 10_um, .size = 4_um}}};
  parts.layers = {{.begin = 0, .end = 100_um, .thickness = 0.2_um, .youngs_modulus = 70_GPa, .density = 2200, .stress = 10e6}};
  const std::string built = beam_drawing("", d);
  EXPECT_EQ(drawn(built, beam), 4);
  EXPECT_EQ(drawn(built, layer), 1);
  EXPECT_EQ(drawn(built, hole) - drawn(plain, hole), 20 * 2) << "200 um by 20 um of holes every 10 um";
  EXPECT_EQ(drawn(built, "nan"), 0);
}

TEST(BeamDrawing, ShowsAndNamesPiezoAnchorsAndContacts) {
  Device d = test::gold_cantilever();
  EXPECT_EQ(drawn(beam_drawing("", d), ">anchor<"), 2) << "from above and from the side";
  EXPECT_EQ(drawn(beam_drawing("", d), ">contact<"), 2);
  EXPECT_EQ(drawn(beam_drawing("", d), ">piezo<"), 0);
  d.piezo = {.begin = 0, .end = 150_um, .thickness = 0.5_um, .youngs_modulus = 60_GPa, .density = 7500, .d31 = -100e-12};
  d.contacts.front().name = "<tip>";
  const std::string built = beam_drawing("", d);
  EXPECT_EQ(drawn(built, ">piezo<"), 2);
  EXPECT_EQ(drawn(built, layer), 3) << "a body from the side, and two names; an outline from above";
  EXPECT_EQ(drawn(built, ">&lt;tip&gt;<"), 2);
}

}  // namespace
}  // namespace softland
