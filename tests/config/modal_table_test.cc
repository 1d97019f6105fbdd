// [structure] kind = "modes": what is read from a file, the content of a resolved scene, and what is refused by name.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/require.h"
#include "config/assumed_spread.h"
#include "config/scene.h"
#include "model/built_beam.h"
#include "model/pull_in.h"
#include "model/structure/tabulated_modes.h"
#include "model/switch.h"
#include "tests/config/small_scene.h"
#include "tests/exchange/mode_samples.h"
#include "tests/support/temporary_folder.h"

namespace softland {
namespace {

using testing::HasSubstr;

constexpr std::string_view modes_scene = R"([structure]
kind = "modes"
file = "modes.csv"
thickness = "2 um"
[gap]
electrode = "3.5 um"
contact = "2 um"
[electrode.main]
span = ["24 %", "tip"]
[contact]
model = "linear"
pad_length = "5 um"
stiffness = "100 N/m"
[waveform.main]
family = "step"
level = "30 V"
)";

/// Three modes over 100 um, 10 um wide.
std::string modes_csv(const std::string& width = "1e-05", const std::string& offset = "0") {
  std::string text = "x_m,width_m,rest_offset_m,mode_1,mode_2,mode_3\nfrequency_Hz,,,25000.25,156000,440000\n";
  for (int k = 0; k <= 10; ++k) {
    const double u = k / 10.0;
    text += fmt::format("{},{},{},{},{},{}\n", 1e-4 * u, k == 7 ? width : "1e-05", k == 7 ? offset : "0",
                        1e6 * u * u * (3 - u) / 3, 1e6 * u * u * (4.8 * u - 3.8), 1e6 * u * u * (1 + u * (13.7 * u - 13.9)));
  }
  return text;
}

class ModalScene : public testing::Test {
 protected:
  void SetUp() override { write("modes.csv", modes_csv()); }
  void write(const std::string& name, const std::string& text) const { static_cast<void>(here_.write(name, text)); }
  Scene scene(const std::string& text, const std::vector<std::string>& options = {}) const {
    write("x.toml", text);
    SceneFile file = SceneFile::load((here_.path() / "x.toml").string());
    for (const std::string& option : options) file.set(option);
    return read_scene(file);
  }
  std::string refusal(const std::string& text, const std::vector<std::string>& options = {}) const {
    try {
      (void)scene(text, options);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  }
  test::TemporaryFolder here_;
};

TEST_F(ModalScene, TakesLengthWidthAndModesFromItsFile) {
  const Structure s = scene(std::string(modes_scene)).device.structure;
  const auto* const modal = s.find<ModalStructure>();
  ASSERT_NE(modal, nullptr);
  EXPECT_EQ(s.length, 1e-4);
  EXPECT_EQ(s.width, 1e-5);
  EXPECT_EQ(s.thickness, 2e-6);
  EXPECT_EQ(s.modes, 3);
  EXPECT_EQ(modal->frequency_factor, 1);
  ASSERT_NE(modal->table, nullptr);
  EXPECT_EQ(modal->table->frequencies().front(), 25000.25);
  const Scene with_two = scene(std::string(modes_scene), {"structure.modes=2"});
  EXPECT_EQ(with_two.device.structure.modes, 2);
  EXPECT_EQ(with_two.device.electrodes[0].pads(1e-4)[0].end, 1e-4);
}

TEST_F(ModalScene, TellsWhatItTookFromTheFileOfAnotherProgram) {
  write("beam.frd", test::sample_frd());
  const std::string text =
      edited(edited(modes_scene, "modes.csv", "beam.frd"), "thickness =", "axis = \"x\"\ndirection = \"-z\"\nthickness =");
  const Scene taken = scene(text);
  EXPECT_EQ(taken.device.structure.modes, 2);
  EXPECT_NEAR(taken.device.structure.width, test::sample_width, 1e-11);
  EXPECT_THAT(taken.warnings,
              testing::Contains(testing::AllOf(HasSubstr("structure.file = \"beam.frd\": CalculiX .frd: 36 nodes at 6 places"),
                                               HasSubstr("left out: mode 4 at 300 kHz, torsional"))));
  EXPECT_THAT(refusal(edited(text, "axis = \"x\"\n", "")), HasSubstr("x.toml:3: structure.file = \"beam.frd\": "))
      << "and the key";
  EXPECT_THAT(refusal(edited(text, "axis = \"x\"\n", "")), HasSubstr("structure.axis is needed"));
  EXPECT_THAT(refusal(text, {"structure.length_unit=V"}),
              HasSubstr("--set structure.length_unit=V: must be the unit of a length"));
  EXPECT_THAT(
      refusal(text, {"structure.mass=1 ng"}),
      HasSubstr("structure.mass: must be omitted, because the modes of the file are mass-normalised, by the generalised mass"));
}

// A result contains the table itself, so that it can be read anywhere, bit for bit.
TEST_F(ModalScene, ResolvedHoldsItsTable) {
  const Scene first = scene(std::string(modes_scene));
  const SceneFile held = resolved(first, {});
  EXPECT_THAT(held.text(), testing::Not(HasSubstr("modes.csv")));
  const Scene again = read_scene(SceneFile::parse(held.text(), "elsewhere.toml"));
  EXPECT_TRUE(*part_of<ModalStructure>(again.device.structure).table == *part_of<ModalStructure>(first.device.structure).table);
  EXPECT_EQ(again.device.structure.width, first.device.structure.width);
  EXPECT_EQ(again.device.structure.length, first.device.structure.length);
  EXPECT_EQ(resolved(again, {}).text(), held.text());
  EXPECT_THAT(canonical(first.file, "x").text(), testing::Not(HasSubstr("modes.csv")));
}

TEST_F(ModalScene, VariesByTheFactorOfItsFrequenciesAndTheGaps) {
  SceneFile file = scene(std::string(modes_scene)).file;
  EXPECT_TRUE(assume_spread(file));
  const Scene spread = read_scene(file);
  ASSERT_EQ(spread.spread.variables.size(), 2U);
  EXPECT_THAT(file.text(), HasSubstr("3.5 %"));
  const std::string varied =
      std::string(modes_scene) + "[spread]\n\"structure.{}\" = {{ distribution = \"normal\", cov = \"2 %\" }}\n";
  EXPECT_EQ(refusal(fmt::format(fmt::runtime(varied), "frequency_factor")), "accepted");
  EXPECT_THAT(
      refusal(fmt::format(fmt::runtime(varied), "thickness")),
      HasSubstr("structure.thickness cannot vary: the modes of a file do not follow it; vary structure.frequency_factor"));
}

TEST_F(ModalScene, RefusesByNameWhatItCannotDo) {
  const std::string text(modes_scene);
  EXPECT_THAT(refusal(text + "[piezo]\nspan = [\"5 um\", \"50 um\"]\nthickness = \"1 um\"\nyoungs_modulus = \"61 GPa\"\n"
                             "density "
                             "= \"7750 kg/m^3\"\nd31 = \"-171 pm/V\"\n"),
              HasSubstr("a layer changes the modes, which a file cannot follow"));
  EXPECT_THAT(refusal(text + "[surface]\nelastic_modulus = \"1 N/m\"\n"), HasSubstr("skins change the modes"));
  EXPECT_THAT(refusal(edited(text, "thickness =", "density = \"19300 kg/m^3\"\nthickness =")),
              HasSubstr("x.toml:4: structure.density = \"19300 kg/m^3\": belongs to kind = \"cantilever\" or "
                        "\"clamped-clamped\", not to \"modes\""));
  EXPECT_THAT(refusal(edited(text, "thickness = \"2 um\"\n", "")),
              HasSubstr("needs structure.thickness beside the modes of a file"));
  EXPECT_THAT(refusal(text, {"structure.modes=4"}), HasSubstr("must not exceed 3, the modes of the file"));
  EXPECT_THAT(refusal(text, {"structure.modes=auto"}), HasSubstr("structure.modes"));
  EXPECT_THAT(refusal(text, {"structure.width=11 um"}), HasSubstr("must equal the width in the file, 10 um, or be omitted"));
  EXPECT_THAT(refusal(text, {"structure.mass=1 ng"}),
              HasSubstr("structure.mass: must be omitted, because the table is in m, Hz and 1/sqrt(kg)"));
  EXPECT_THAT(refusal(text, {"electrode.main.span=[\"0 um\", \"101 um\"]"}),
              HasSubstr("must end on the beam: the 100 um of the modes' table"));
  EXPECT_THAT(refusal(edited(text, "file = \"modes.csv\"", "")), HasSubstr("missing key 'file' or 'positions'"));
  EXPECT_THAT(refusal(edited(text, "modes.csv", "none.csv")), HasSubstr("x.toml:3: structure.file = \"none.csv\""));
  write("modes.csv", modes_csv("2e-05"));
  EXPECT_THAT(refusal(text, {"structure.width=10 um"}),
              HasSubstr("the width in the file varies from 10 um to 20 um along the axis"));
}

// Row 7 of 10 is 20 um wide; the width is linear between the rows.
TEST_F(ModalScene, HasTheWidthsOfItsTable) {
  write("modes.csv", modes_csv("2e-05"));
  const Scene first = scene(std::string(modes_scene));
  for (const Scene& one : {first, read_scene(resolved(first, {})), read_scene(canonical(first.file, "again"))}) {
    const Structure& s = one.device.structure;
    EXPECT_TRUE(s.is_built());
    EXPECT_DOUBLE_EQ(width_at(s, 30e-6), 10e-6);
    EXPECT_NEAR(width_at(s, 65e-6), 15e-6, 1e-15);
    EXPECT_NEAR(width_at(s, 70e-6), 20e-6, 1e-15);
  }
  // The field pulls more strongly on the wide place.
  const double wide = static_pull_in(Switch(first.device), 0).voltage;
  write("modes.csv", modes_csv());
  EXPECT_LT(wide, 0.98 * static_pull_in(Switch(scene(std::string(modes_scene)).device), 0).voltage);
}

// The face of row 7 of 10 is 100 nm closer to the electrode.
TEST_F(ModalScene, TakesTheRestShapeOfItsFile) {
  write("modes.csv", modes_csv("1e-05", "1e-7"));
  const Scene bent = scene(std::string(modes_scene));
  EXPECT_DOUBLE_EQ(bent.device.rest_offset(70e-6), -1e-7);
  EXPECT_NEAR(bent.device.rest_offset(65e-6), -5e-8, 1e-20);
  EXPECT_EQ(bent.device.rest_offset(60e-6), 0);
  EXPECT_EQ(bent.device.rest_offset(100e-6), 0);
  const std::string held = resolved(bent, {}).text();
  EXPECT_THAT(held, HasSubstr("rest_offsets"));
  EXPECT_EQ(scene(held).device.rest_offset(68e-6), bent.device.rest_offset(68e-6));
}

TEST_F(ModalScene, MayBeClampedAtItsFarEnd) {
  std::string csv = "x_m,width_m,rest_offset_m,mode_1\nfrequency_Hz,,,25000\n", bent = csv;
  for (int k = 0; k <= 20; ++k) {
    const double u = k / 20.0;
    csv += fmt::format("{},1e-05,0,{}\n", 1e-4 * u, 1.6e7 * u * u * (1 - u) * (1 - u));
    bent += fmt::format("{},1e-05,{},{}\n", 1e-4 * u, k == 7 ? 1e-8 : 0, 1.6e7 * u * u * (1 - u) * (1 - u));
  }
  write("bridge.csv", csv), write("bent.csv", bent);
  const std::string bridge = edited(modes_scene, "modes.csv", "bridge.csv"),
                    clamped = edited(bridge, "thickness =", "far_anchor = \"clamped\"\nthickness ="),
                    stretched = edited(clamped, "thickness =", "axial_stiffness = \"12 kN/m\"\nthickness =");
  EXPECT_THAT(refusal(bridge), HasSubstr("x.toml:1: [structure]: the far end does not move in any mode: set far_anchor = "
                                         "\"clamped\""));
  EXPECT_THAT(refusal(edited(clamped, "bridge.csv", "modes.csv")),
              HasSubstr("x.toml:4: structure.far_anchor = \"clamped\": requires a far end that does not move"));
  EXPECT_THAT(refusal(edited(edited(stretched, "\"clamped\"", "\"free\""), "bridge.csv", "modes.csv")),
              HasSubstr("x.toml:5: structure.axial_stiffness = \"12 kN/m\": needs far_anchor = \"clamped\""));
  EXPECT_THAT(refusal(edited(stretched, "bridge.csv", "bent.csv")),
              HasSubstr("structure.axial_stiffness = \"12 kN/m\": cannot stand beside rest offsets"));
  EXPECT_THAT(refusal(edited(clamped, "\"clamped\"", "\"hinged\"")), HasSubstr("x.toml:4: structure.far_anchor"));
  const Scene linear = scene(clamped), cubic = scene(stretched);
  EXPECT_THAT(linear.warnings, testing::Contains(HasSubstr("is simulated where structure.axial_stiffness")));
  EXPECT_THAT(cubic.warnings, testing::Not(testing::Contains(HasSubstr("axial_stiffness"))));
  EXPECT_DOUBLE_EQ(linear.device.contact_position(), 50e-6);
  EXPECT_FALSE(Switch(linear.device).stretching());
  ASSERT_TRUE(Switch(cubic.device).stretching());
  EXPECT_EQ(Switch(cubic.device).stretching()->stiffness, 6e3);
  // A result is read back unchanged.
  const SceneFile held = resolved(cubic, {});
  const Scene again = read_scene(SceneFile::parse(held.text(), "elsewhere.toml"));
  EXPECT_TRUE(*part_of<ModalStructure>(again.device.structure).table == *part_of<ModalStructure>(cubic.device.structure).table);
  EXPECT_EQ(part_of<ModalStructure>(again.device.structure).axial_stiffness, 12e3);
  const Scene free = scene(std::string(modes_scene));
  EXPECT_FALSE(*part_of<ModalStructure>(free.device.structure).table == *part_of<ModalStructure>(again.device.structure).table);
}

TEST_F(ModalScene, RefusesListsThatAreNoTable) {
  const auto held = [&](const std::string& lists) {
    return edited(modes_scene, "file = \"modes.csv\"", lists + "width = \"10 um\"");
  };
  const std::string right =
      "positions = [\"0 m\", \"50 um\", \"100 um\"]\nfrequencies = [\"25 kHz\"]\nshapes = [[0, 3e5, 1e6]]\n";
  EXPECT_EQ(refusal(held(right)), "accepted");
  EXPECT_EQ(refusal(held(right + "rest_offsets = [\"0 m\", \"10 nm\", \"30 nm\"]\n")), "accepted");
  EXPECT_THAT(refusal(held(right + "rest_offsets = [\"0 m\"]\n")), HasSubstr("must hold a number per position"));
  EXPECT_THAT(refusal(held(edited(right, "3e5, ", ""))), HasSubstr("must hold 1 lists of 3 numbers"));
  EXPECT_THAT(refusal(held(edited(right, "\"50 um\"", "\"150 um\""))),
              HasSubstr("at least three positions that increase from 0"));
  EXPECT_THAT(refusal(held(edited(right, "[[0,", "[[1,"))), HasSubstr("a shape must be finite and 0 at the clamp"));
  EXPECT_THAT(refusal(held(right + "axis = \"x\"\n")), HasSubstr("this scene holds its modes itself"));
  EXPECT_THAT(refusal(held(right + "file = \"modes.csv\"\n")), HasSubstr("must not be given together with structure.positions"));
}

}  // namespace
}  // namespace softland
