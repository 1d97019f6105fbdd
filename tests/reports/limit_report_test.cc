// What the user sees of a limit: of a plate, which takes a second.
#include "reports/limit_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace softland {
namespace {

using testing::HasSubstr;
using testing::Not;

const Limit& of_a_plate() {
  static const Limit found = limit(SceneFile::parse(R"(
title = "A plate"
[structure]
kind = "plate"
area = "1e-8 m^2"
mass = "2.4e-9 kg"
stiffness = "42 N/m"
[gap]
electrode = "3.8 um"
contact = "2.6 um"
[electrode.main]
fringing = "none"
[contact]
model = "linear"
stiffness = "1e5 N/m"
[waveform.main]
family = "step"
level = "100 V"
[driver.main]
min_voltage = "0 V"
max_voltage = "120 V"
[simulate]
duration = "300 us"
)",
                                                    "plate.toml"),
                                   {.curves = false});
  return found;
}

TEST(LimitReport, SaysForWhichModelALeastTimeIsABound) {
  const nlohmann::json of_plate = limit_json(of_a_plate(), {});
  EXPECT_EQ(of_plate.at("modes"), 1);
  EXPECT_THAT(limit_text(of_a_plate()), Not(HasSubstr("mode,")));
  Limit of_beam = of_a_plate();
  of_beam.given.scene.device.structure.kind = StructureKind::cantilever;
  EXPECT_THAT(limit_text(of_beam), HasSubstr("in this model of 1 mode,"));
  EXPECT_THAT(limit_svg(of_beam), HasSubstr("with 1 mode<"));
}

}  // namespace
}  // namespace softland
