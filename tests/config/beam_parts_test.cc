// Scenes with beams of sections, layers and anchors: how they are read, which keys may vary, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/assumed_spread.h"
#include "config/edited_scene.h"
#include "config/plan.h"
#include "config/scene.h"
#include "config/spread.h"
#include "model/beam.h"
#include "model/built_beam.h"
#include "tests/config/message.h"
#include "tests/config/small_scene.h"

namespace softland {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// Expected messages cite the line numbers.
constexpr std::string_view built_scene = R"([structure]
kind = "cantilever"
sections = [
  { length = "60 um", width = "10 um", thickness = "1 um" },
  { length = "190 um", width = ["40 um", "20 um"], holes = { pitch = "10 um", size = "4 um" } },
]
layers = [
  { face = "far", span = ["0 um", "tip"], thickness = "0.2 um", youngs_modulus = "70 GPa", density = "2200 kg/m^3", stress = "1 MPa" },
]
anchor = { rotation = "1e-7 N m/rad" }
thickness = "2 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
[gap]
electrode = "3.5 um"
contact = "2 um"
[electrode.main]
span = ["40 um", "240 um"]
[contact]
model = "linear"
pad_length = "5 um"
stiffness = "100 N/m"
[waveform.main]
family = "step"
level = "5 V"
)";

Scene read_built(const std::string& text, const std::vector<std::string>& options = {}) {
  SceneFile file = SceneFile::parse(text, "x.toml");
  for (const std::string& option : options) file.set(option);
  return read_scene(file);
}
Scene built(const std::string& from = "", const std::string& to = "") {
  return read_built(from.empty() ? std::string(built_scene) : edited(built_scene, from, to));
}
std::string refusal(const std::string& from, const std::string& to) { return message(edited(built_scene, from, to)); }
const Beam& beam(const Scene& scene) { return part_of<Beam>(scene.device.structure); }

TEST(BeamParts, AreReadWithTheNumbersOfTheStructureWhereTheyHaveNone) {
  const Scene scene = built();
  EXPECT_DOUBLE_EQ(scene.device.structure.length, 250e-6);
  const std::vector<LocalSection> sections = local_sections(scene.device.structure);
  ASSERT_EQ(sections.size(), 2u);
  EXPECT_EQ(sections[0].thickness, 1e-6);
  EXPECT_EQ(sections[1].thickness, 2e-6);
  EXPECT_EQ(sections[0].end_width, 10e-6);
  EXPECT_EQ(sections[1].width, 40e-6);
  EXPECT_EQ(sections[1].end_width, 20e-6);
  EXPECT_EQ(sections[1].holes.size, 4e-6);
  EXPECT_FALSE(sections[0].holes.exist());
  ASSERT_EQ(beam(scene).layers.size(), 1u);
  EXPECT_EQ(beam(scene).layers[0].face, Side::far);
  EXPECT_EQ(beam(scene).layers[0].end.on(250e-6), 250e-6);
  EXPECT_EQ(beam(scene).layers[0].stress, 1e6);
  ASSERT_TRUE(beam(scene).anchor);
  EXPECT_EQ(beam(scene).anchor->rotation, 1e-7);
  EXPECT_EQ(beam(scene).anchor->translation, Anchor::rigid) << "what is not given is rigid";
}

TEST(BeamParts, SayHowTheFarEndIsHeld) {
  const auto far_end = [](const std::string& kind, const std::string& anchor) {
    const std::string text = edited(edited(small_scene, "cantilever", kind), "width", anchor + "\nwidth");
    return read_built(
               edited(edited(edited(text,
                                    "[piezo]\nspan = [\"5 um\", \"240 um\"]\nthickness = \"1 um\"\nyoungs_modulus = \"61 "
                                    "GPa\"\ndensity = \"7750 kg/m^3\"\nd31 = \"-171 pm/V\"\n",
                                    ""),
                             "[waveform.piezo]\nfamily = \"pulse\"\nlevels = [\"0.2 V\", \"0.6 V\", \"0 V\"]\ntimes = [\"20 "
                             "us\", \"41 us\"]\nedge = \"5 us\"\n",
                             ""),
                      "[driver.piezo]\nmin_voltage = \"-1 V\"\nmax_voltage = \"1 V\"\n", ""))
        .device.structure;
  };
  EXPECT_TRUE(far_end("cantilever", "").far_hold().is_free());
  EXPECT_TRUE(far_end("clamped-clamped", "").far_hold().is_clamp());
  EXPECT_TRUE(far_end("clamped-clamped", "far_anchor = \"free\"").far_hold().is_free());
  EXPECT_FALSE(far_end("clamped-clamped", "far_anchor = \"free\"").has_far_clamp());
  EXPECT_TRUE(far_end("cantilever", "far_anchor = \"clamped\"").has_far_clamp());
  EXPECT_EQ(far_end("cantilever", "far_anchor = { translation = \"3 N/m\" }").far_hold().translation, 3);
}

TEST(BeamParts, MayBeSetOneByOne) {
  const auto with = [](const std::string& option) { return read_built(std::string(built_scene), {option}); };
  EXPECT_EQ(beam(with("structure.sections[2].width[2]=30 um")).sections[1].end_width, 30e-6);
  EXPECT_EQ(beam(with("structure.sections[1].width=12 um")).sections[0].width, 12e-6);
  EXPECT_EQ(beam(with("structure.sections[2].holes.size=5 um")).sections[1].holes.size, 5e-6);
  EXPECT_EQ(beam(with("structure.layers[1].stress=-3 MPa")).layers[0].stress, -3e6);
  EXPECT_EQ(beam(with("structure.anchor.translation=5 N/m")).anchor->translation, 5);
  EXPECT_DOUBLE_EQ(with("structure.sections[1].length=70 um").device.structure.length, 260e-6);
}

TEST(BeamParts, MayVary) {
  const std::string spread =
      "[spread]\n"
      "\"structure.sections[2].width[1]\" = { distribution = \"normal\", cov = \"2 %\" }\n"
      "\"structure.sections[1].length\" = { distribution = \"normal\", cov = \"2 %\" }\n"
      "\"structure.layers[1].stress\" = { distribution = \"normal\", standard_deviation = \"1 MPa\" }\n"
      "\"structure.anchor.rotation\" = { distribution = \"lognormal\", cov = \"20 %\" }\n"
      "\"structure.sections[2].holes.size\" = { distribution = \"normal\", cov = \"2 %\" }\n";
  Scene scene = read_built(std::string(built_scene) + spread);
  for (const SpreadVariable& v : scene.spread.variables) {
    const VariedKey& key = v.keys.front();
    if (key.path == "structure.sections[1].length") {
      EXPECT_EQ(key.member, nullptr) << "the length of the beam follows it";
      EXPECT_EQ(key.nominal, 60e-6);
      continue;
    }
    ASSERT_NE(key.member, nullptr) << key.name();
    EXPECT_EQ(key.member(scene), key.nominal) << key.name();
    key.member(scene) *= 1.5;
  }
  EXPECT_DOUBLE_EQ(beam(scene).sections[1].width, 60e-6);
  EXPECT_DOUBLE_EQ(beam(scene).layers[0].stress, 1.5e6);
  EXPECT_DOUBLE_EQ(beam(scene).anchor->rotation, 1.5e-7);
  EXPECT_DOUBLE_EQ(beam(scene).sections[1].holes.size, 6e-6);
  const auto refused = [](const std::string& key) {
    return message(std::string(built_scene) + "[spread]\n\"" + key + "\" = { distribution = \"normal\", cov = \"2 %\" }\n");
  };
  EXPECT_THAT(refused("structure.sections[3].width"), HasSubstr("x.toml:27: [spread.\"structure.sections[3].width\"]: "));
  EXPECT_THAT(refused("structure.sections[2].width"), HasSubstr("is not a key of this scene that holds one number"));
  EXPECT_THAT(refused("structure.sections[1].width[1]"), HasSubstr("is not a key of this scene that holds one number"));
}

TEST(BeamParts, VaryByTheUsualSpreadTogether) {
  SceneFile file = SceneFile::parse(std::string(built_scene), "x.toml");
  ASSERT_TRUE(assume_spread(file));
  const Scene scene = read_scene(file);
  std::vector<std::string> keys;
  for (const SpreadVariable& v : scene.spread.variables) {
    for (const VariedKey& key : v.keys) keys.push_back(key.name());
  }
  EXPECT_THAT(keys, ElementsAre("gap.contact", "gap.electrode", "structure.thickness", "structure.sections[1].thickness",
                                "structure.youngs_modulus"));
}

TEST(BeamParts, ArePlanned) {
  PlanRequest request{.scene = SceneFile::parse(std::string(built_scene), "x.toml"),
                      .place = [](std::string_view key, std::size_t) { return std::string(key); }};
  request.vary = {"structure.sections[2].width[1]=30 um:50 um:3", "structure.layers[1].thickness=0.1 um,0.3 um"};
  EXPECT_EQ(Plan(request).points(), 6u);
  request.vary = {"structure.sections[2].width=30 um:50 um:3"};
  EXPECT_THROW(Plan{request}, InvalidInput);
}

TEST(BeamParts, AreTheSameInWholeSentencesAndInSiUnits) {
  const Scene scene = built();
  const Scene again = read_scene(canonical(scene.file, "again")), resolved_one = read_scene(resolved(scene, {}));
  for (const Scene* other : {&again, &resolved_one}) {
    const std::vector<BeamSection> first = beam_sections(scene.device), second = beam_sections(other->device);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].rigidity, second[i].rigidity);
      EXPECT_EQ(first[i].mass_per_length, second[i].mass_per_length);
      EXPECT_EQ(first[i].curvature, second[i].curvature);
    }
    EXPECT_EQ(beam(*other).anchor->rotation, 1e-7);
  }
}

TEST(BeamParts, AreEditedWhereTheyStand) {
  const std::string text = edited_scene(
      built_scene, "x.toml",
      {{.path = "structure.sections[2].width", .element = 1, .value = {.value = 41e-6, .dimension = dimension::length}}});
  EXPECT_THAT(text, HasSubstr("width = [\"41 um\", \"20 um\"]"));
}

TEST(BeamParts, ThatCannotBeAreRefusedWithTheirPlace) {
  EXPECT_EQ(message(std::string(built_scene)), "");
  EXPECT_EQ(refusal("width = \"10 um\"", "width = \"0 um\""),
            "x.toml:4: structure.sections[1].width = \"0 um\": must be in [1 pm, 1 m]");
  EXPECT_EQ(refusal("[\"40 um\", \"20 um\"]", "[\"40 um\", \"0 um\"]"),
            "x.toml:5: structure.sections[2].width = [\"40 um\", \"0 um\"]: value 2: must be in [1 pm, 1 m]");
  EXPECT_THAT(
      refusal("[\"40 um\", \"20 um\"]", "[\"40 um\", \"20 um\", \"3 um\"]"),
      HasSubstr("x.toml:5: structure.sections[2].width = [\"40 um\", \"20 um\", \"3 um\"]: must be one width, or a list"));
  EXPECT_THAT(refusal("width = \"10 um\", ", ""), HasSubstr("x.toml:4: structure.sections[1]"));
  EXPECT_THAT(refusal("width = \"10 um\", ", ""), HasSubstr("needs width, which [structure] does not give either"));
  EXPECT_THAT(refusal("length = \"60 um\", ", ""), HasSubstr("x.toml:4: [structure.sections[1]]: missing key 'length'"));
  EXPECT_THAT(refusal("width = \"10 um\"", "widht = \"10 um\""),
              HasSubstr("x.toml:4: structure.sections[1].widht = \"10 um\": unknown key (did you mean 'width'?)"));
  EXPECT_THAT(refusal("thickness = \"2 um\"", "thickness = \"2 um\"\nlength = \"250 um\""),
              AllOf(HasSubstr("x.toml:3: structure.sections = [{ length"),
                    HasSubstr("must not be given together with structure.length = \"250 um\": give one of them")));
  EXPECT_THAT(refusal("[\"0 um\", \"tip\"]", "[\"0 um\", \"251 um\"]"),
              HasSubstr("x.toml:8: structure.layers[1].span = [\"0 um\", \"251 um\"]: from 0 m to 251 um: "
                        "must increase and lie "
                        "on the beam, from 0 m to 250 um"));
  EXPECT_THAT(refusal("face = \"far\"", "face = \"both\""), HasSubstr("structure.layers[1].face = \"both\": unknown value"));
  EXPECT_THAT(refusal("size = \"4 um\"", "size = \"10 um\""),
              HasSubstr("x.toml:5: structure.sections[2].holes.size = \"10 um\": must be less than "
                        "structure.sections[2].holes.pitch = \"10 um\""));
  EXPECT_THAT(
      refusal("pitch = \"10 um\"", "pitch = \"21 um\""),
      HasSubstr("x.toml:5: structure.sections[2].holes = { pitch = \"21 um\", size = \"4 um\" }: the pitch must not exceed"));
  EXPECT_THAT(refusal("{ rotation = \"1e-7 N m/rad\" }", "{}"),
              HasSubstr("[structure.anchor]: needs rotation, translation or both"));
  EXPECT_THAT(refusal("{ rotation = \"1e-7 N m/rad\" }", "\"free\""),
              HasSubstr("x.toml:10: structure.anchor = \"free\": expected"));
  EXPECT_THAT(refusal("{ rotation = \"1e-7 N m/rad\" }", "{ rotation = \"0 N m/rad\" }"),
              HasSubstr("x.toml:10: structure.anchor = { rotation = \"0 N m/rad\" }: nothing holds the beam"));
  EXPECT_THAT(refusal("anchor = { rotation", "far_anchor = { rotation"), HasSubstr("x.toml:7: structure.layers = "));
  EXPECT_THAT(refusal("sections = [", "sections = []\nfurther = ["), StartsWith("x.toml:4: structure.further = "));
  EXPECT_THAT(message(edited(small_scene, "length = \"250 um\"", "sections = []")),
              HasSubstr("x.toml:4: structure.sections = []: expected a list such as [{ length"));
  EXPECT_THAT(message(std::string(built_scene) + "[surface]\nelastic_modulus = \"1 N/m\"\n"), HasSubstr("sections and layers"));
  EXPECT_THAT(message(std::string(built_scene) + "[gas]\nmodel = \"reynolds\"\n"),
              HasSubstr("gas.model = reynolds: not over holes"));
}

TEST(BeamParts, NameTheirLengthWhereSomethingLiesBeyondIt) {
  EXPECT_THAT(refusal("\"240 um\"", "\"251 um\""),
              HasSubstr("electrode.main.span = [\"40 um\", \"251 um\"]: must end on the beam: its sections are 250 um long"));
  EXPECT_THAT(refusal("pad_length", "at = \"260 um\"\npad_length"),
              HasSubstr("contact.at = \"260 um\": must lie on the beam: its sections are 250 um long"));
  EXPECT_EQ(message(std::string(built_scene), {"structure.length=250 um"}),
            "--set structure.length=250 um: [structure]: missing key 'width' (a length such as \"20 um\"); "
            "structure.length replaced structure.sections");
}

TEST(BeamParts, NeedNoThicknessOfTheStructureWhereAllHaveTheirOwn) {
  const std::string own = edited(edited(built_scene, "thickness = \"2 um\"\n", ""), "length = \"190 um\"",
                                 "length = \"190 um\", thickness = \"2 um\"");
  for (const char* law : {"meijs-fokkema", "bao-2001"}) {
    const std::string fringing = std::string("electrode.main.fringing=") + law;
    EXPECT_EQ(message(own, {fringing}), "") << law;
  }
  const std::string gas = "[gas]\nmodel = \"guo-alexeenko\"\n",
                    solid = edited(own, ", holes = { pitch = \"10 um\", size = \"4 um\" }", "");
  EXPECT_EQ(message(solid + gas), "");
}

TEST(BeamParts, AreToldOfWhereTheyKeepANumberThatVaries) {
  const auto warnings = [](const std::string& entry) {
    return read_built(std::string(built_scene) + "[spread]\n" + entry + " distribution = \"normal\", cov = \"2 %\" }\n").warnings;
  };
  EXPECT_THAT(
      warnings("\"structure.thickness\" = {"),
      Contains("x.toml:27: structure.sections[1].thickness does not vary with structure.thickness: name all of them in keys "
               "of one entry of [spread]"));
  const auto is_told = Contains(HasSubstr("not vary with"));
  EXPECT_THAT(warnings("\"structure.youngs_modulus\" = {"), Not(is_told));
  EXPECT_THAT(warnings("both = { keys = [\"structure.thickness\", \"structure.sections[1].thickness\"],"), Not(is_told));
}

// Expected messages cite the line numbers.
constexpr std::string_view bent_scene = R"([structure]
kind = "cantilever"
length = "250 um"
width = "20 um"
rest_shape = { positions = ["0 um", "100 um", "tip"], heights = ["0 nm", "30 nm", "-200 nm"] }
thickness = "2 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
[gap]
electrode = "3.5 um"
contact = "2 um"
[electrode.main]
span = ["40 um", "240 um"]
[contact]
model = "linear"
pad_length = "5 um"
stiffness = "100 N/m"
[waveform.main]
family = "step"
level = "5 V"
)";
std::string bent_refusal(const std::string& from, const std::string& to) { return message(edited(bent_scene, from, to)); }

TEST(RestShapeOfAScene, IsATableOfHeightsAlongTheBeam) {
  const Device d = read_built(std::string(bent_scene)).device;
  EXPECT_EQ(d.rest_offset(0), 0);
  EXPECT_DOUBLE_EQ(d.rest_offset(50e-6), 15e-9);
  EXPECT_DOUBLE_EQ(d.rest_offset(100e-6), 30e-9);
  EXPECT_DOUBLE_EQ(d.rest_offset(175e-6), -85e-9);
  EXPECT_DOUBLE_EQ(d.contact_gap(), 2e-6 + d.rest_offset(247.5e-6));
  const Scene scene = read_built(std::string(bent_scene));
  for (const Scene& again : {read_scene(canonical(scene.file, "again")), read_scene(resolved(scene, {}))})
    EXPECT_EQ(again.device.rest_offset(175e-6), d.rest_offset(175e-6));
}

TEST(RestShapeOfAScene, MayBeSetAndMayVary) {
  const auto with = [](const std::string& option) { return read_built(std::string(bent_scene), {option}).device; };
  EXPECT_DOUBLE_EQ(with("structure.rest_shape.heights[2]=50 nm").rest_offset(100e-6), 50e-9);
  EXPECT_DOUBLE_EQ(with("structure.stress_gradient=0.1 MPa/um").rest_offset(100e-6), 0.1e12 / 78e9 * 1e-8 / 2)
      << "it takes the place of the table";
  const std::string spread =
      "[spread]\n"
      "\"structure.rest_shape.heights[2]\" = { distribution = \"normal\", standard_deviation = \"5 nm\" }\n"
      "\"structure.rest_shape.heights[3]\" = { distribution = \"normal\", cov = \"10 %\" }\n";
  Scene scene = read_built(std::string(bent_scene) + spread);
  for (const SpreadVariable& v : scene.spread.variables) {
    ASSERT_NE(v.keys.front().member, nullptr);
    v.keys.front().member(scene) *= 2;
  }
  EXPECT_DOUBLE_EQ(scene.device.rest_offset(100e-6), 60e-9);
  EXPECT_DOUBLE_EQ(scene.device.rest_offset(250e-6), -400e-9);
  const std::string together =
      "[spread]\nbow = { keys = [\"structure.rest_shape.heights[2]\", \"structure.rest_shape.heights[3]\"], distribution = "
      "\"normal\", cov = \"10 %\" }\n";
  EXPECT_EQ(read_built(std::string(bent_scene) + together).spread.variables.front().keys.size(), 2u);
  PlanRequest request{.scene = SceneFile::parse(std::string(bent_scene), "x.toml"),
                      .place = [](std::string_view key, std::size_t) { return std::string(key); }};
  request.vary = {"structure.rest_shape.heights[3]=-100 nm:100 nm:3"};
  EXPECT_EQ(Plan(request).points(), 3u);
}

TEST(RestShapeOfAScene, ThatCannotBeIsRefusedWithItsPlace) {
  EXPECT_EQ(message(std::string(bent_scene)), "");
  const std::string table = "x.toml:5: structure.rest_shape.";
  EXPECT_THAT(
      bent_refusal("\"-200 nm\"]", "\"-200 nm\", \"0 nm\"]"),
      AllOf(StartsWith(table + "heights = ["), HasSubstr("one height for each position, but there are 4 for 3 positions")));
  EXPECT_THAT(bent_refusal("\"0 um\", \"100 um\"", "\"1 um\", \"100 um\""),
              AllOf(StartsWith(table + "positions = ["), HasSubstr("rise from 0 m")));
  EXPECT_THAT(bent_refusal("\"100 um\", \"tip\"", "\"250 um\", \"tip\""),
              AllOf(StartsWith(table + "positions = ["), HasSubstr("rise from 0 m")));
  EXPECT_THAT(bent_refusal("\"tip\"", "\"240 um\""),
              AllOf(StartsWith(table + "positions = ["), HasSubstr("must end at the tip, and the beam is 250 um long")));
  EXPECT_EQ(bent_refusal("\"tip\"", "\"100 %\""), "");
  EXPECT_THAT(bent_refusal("\"30 nm\"", "\"30 V\""),
              AllOf(StartsWith(table + "heights = ["), HasSubstr("value 2: expected a length [m], got a voltage [V]")));
  EXPECT_THAT(bent_refusal(", heights = [\"0 nm\", \"30 nm\", \"-200 nm\"]", ""),
              HasSubstr("x.toml:5: [structure.rest_shape]: missing key 'heights'"));
  EXPECT_THAT(bent_refusal("thickness", "stress_gradient = \"0 Pa/m\"\nthickness"),
              AllOf(StartsWith("x.toml:5: structure.rest_shape = {"),
                    HasSubstr("must not be given together with structure.stress_gradient")));
  EXPECT_THAT(
      bent_refusal("thickness",
                   "layers = [{ face = \"far\", span = [\"0 um\", \"tip\"], thickness = \"0.1 um\", youngs_modulus = \"70 "
                   "GPa\", density = \"2200 kg/m^3\", stress = \"1 MPa\" }]\nthickness"),
      AllOf(StartsWith("x.toml:5: structure.rest_shape = {"), HasSubstr("cannot stand beside layers[1].stress")));
  EXPECT_THAT(bent_refusal("\"cantilever\"", "\"clamped-clamped\""),
              AllOf(StartsWith("x.toml:5: structure.rest_shape = {"), HasSubstr("needs stretching = false")));
  EXPECT_EQ(bent_refusal("\"cantilever\"", "\"clamped-clamped\"\nstretching = false"), "");
  EXPECT_THAT(bent_refusal("\"-200 nm\"", "\"-2.1 um\""), HasSubstr("it would be closed at rest"));
  EXPECT_THAT(bent_refusal("\"30 nm\"", "\"-3.49 um\""), HasSubstr("it would touch the electrode at rest"));
  EXPECT_THAT(message("[structure]\nkind = \"plate\"\nrest_shape = { positions = [], heights = [] }\n"),
              HasSubstr("belongs to kind = \"cantilever\" or \"clamped-clamped\", not to \"plate\""));
}

}  // namespace
}  // namespace softland
