// [electrode.NAME] dielectric: how it is read, what is refused, and where its keys may vary.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/require.h"
#include "config/scene.h"

namespace softland {
namespace {

using testing::HasSubstr;

const std::string plate = R"(
[structure]
kind = "plate"
mass = "0.1 ug"
stiffness = "10 N/m"
area = "10000 um^2"
[gap]
electrode = "4 um"
contact = "4 um"
[electrode.main]
fringing = "none"
dielectric = { thickness = "0.2 um", permittivity = 7.6, roughness = "5 nm" }
[contact]
model = "rigid"
restitution = 0.3
[waveform.main]
family = "step"
level = "1.2 Vsp"
[spread]
"electrode.main.dielectric.thickness" = { distribution = "normal", cov = "5 %" }
)";

std::string edited_plate(const std::string& old, const std::string& replacement) {
  std::string text = plate;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), replacement);
}

std::string refusal_of(const std::string& text) {
  try {
    (void)read_scene(SceneFile::parse(text, "x.toml"));
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "nothing is refused";
}

TEST(DielectricKeys, AreReadAndMayVary) {
  SceneFile file = SceneFile::parse(plate, "x.toml");
  const Scene scene = read_scene(file);
  ASSERT_TRUE(scene.device.electrodes[0].dielectric);
  const Dielectric& d = *scene.device.electrodes[0].dielectric;
  EXPECT_DOUBLE_EQ(d.thickness, 0.2e-6);
  EXPECT_DOUBLE_EQ(d.permittivity, 7.6);
  EXPECT_DOUBLE_EQ(d.roughness, 5e-9);
  EXPECT_EQ(d.charge, 0);
  EXPECT_TRUE(scene.device.closes_on_dielectric());
  ASSERT_EQ(scene.spread.variables.size(), 1U);
  file.set("electrode.main.dielectric.thickness=\"0.3 um\"");
  EXPECT_DOUBLE_EQ(read_scene(file).device.electrodes[0].dielectric->thickness, 0.3e-6);
  const Scene again = read_scene(SceneFile::parse(file.text(), "again.toml"));
  EXPECT_DOUBLE_EQ(again.device.electrodes[0].dielectric->thickness, 0.3e-6);
}

TEST(DielectricKeys, ChargeIsPerAreaAndMayVary) {
  const std::string charged = edited_plate(R"(roughness = "5 nm")", R"(charge = "-0.4 mC/m^2")");
  SceneFile file = SceneFile::parse(charged, "x.toml");
  file.set(R"(spread."electrode.main.dielectric.charge"={distribution="normal",standard_deviation="0.1 mC/m^2"})");
  const Scene scene = read_scene(file);
  EXPECT_DOUBLE_EQ(scene.device.electrodes[0].dielectric->charge, -0.4e-3);
  EXPECT_TRUE(scene.device.is_charged());
  EXPECT_FALSE(read_scene(SceneFile::parse(plate, "x.toml")).device.is_charged());
  ASSERT_EQ(scene.spread.variables.size(), 2U);
  file.set("electrode.main.dielectric.charge=\"200 uC/m^2\"");
  EXPECT_DOUBLE_EQ(read_scene(SceneFile::parse(file.text(), "again.toml")).device.electrodes[0].dielectric->charge, 0.2e-3);
  const auto refused = [&](const std::string& value) {
    return refusal_of(edited_plate(R"(roughness = "5 nm")", "charge = " + value));
  };
  EXPECT_THAT(refused("\"1 mC\""), HasSubstr("x.toml:12: electrode.main.dielectric.charge = \"1 mC\": expected "));
  EXPECT_THAT(refused("1e-3"), HasSubstr("x.toml:12: electrode.main.dielectric.charge = 0.001: no unit (expected "));
  EXPECT_THAT(refused("\"2 MC/m^2\""), HasSubstr("x.toml:12: electrode.main.dielectric.charge = \"2 MC/m^2\": must be "));
}

TEST(DielectricKeys, AreRefusedByFileLineAndKey) {
  EXPECT_THAT(refusal_of(edited_plate("thickness = \"0.2 um\", ", "")),
              HasSubstr("x.toml:12: [electrode.main.dielectric]: missing key 'thickness'"));
  EXPECT_THAT(refusal_of(edited_plate("7.6", "0.6")),
              HasSubstr("x.toml:12: electrode.main.dielectric.permittivity = 0.6: must be"));
  EXPECT_THAT(refusal_of(edited_plate("\"5 nm\"", "\"-5 nm\"")),
              HasSubstr("x.toml:12: electrode.main.dielectric.roughness = \"-5 nm\": must be in [0 m, 1 m]"));
  EXPECT_THAT(refusal_of(edited_plate("thickness =", "thick =")),
              HasSubstr("electrode.main.dielectric.thick = \"0.2 um\": unknown key"));
  EXPECT_THAT(refusal_of(edited_plate("permittivity =", "eps_r =")),
              HasSubstr("electrode.main.dielectric.eps_r = 7.6: unknown key; 'permittivity' is the relative permittivity"));
  EXPECT_THAT(refusal_of(edited_plate("{ thickness = \"0.2 um\", permittivity = 7.6, roughness = \"5 nm\" }", "\"0.2 um\"")),
              HasSubstr("electrode.main.dielectric = \"0.2 um\": expected keys in braces"));
  EXPECT_THAT(refusal_of(edited_plate("fringing = \"none\"", "fringing = \"none\"\nside = \"both\"\ngap = \"4 um\"")),
              HasSubstr("belongs to an electrode on the near side alone"));
  EXPECT_THAT(refusal_of(edited_plate("[contact]", "[dispersion]\nmodel = \"casimir\"\n[contact]")),
              HasSubstr("x.toml:9: gap.contact = \"4 um\": a plate that lands on a dielectric must not have a dispersion "
                        "force: "
                        "remove [dispersion]"));
  EXPECT_THAT(refusal_of(edited_plate("dielectric =", "# dielectric =")),
              HasSubstr("x.toml:9: gap.contact = \"4 um\": must be less than"));
}

const std::string capacitive = R"(
[structure]
kind = "clamped-clamped"
length = "280 um"
width = "120 um"
thickness = "0.5 um"
youngs_modulus = "70 GPa"
density = "2700 kg/m^3"
[gap]
electrode = "3 um"
[electrode.main]
span = ["90 um", "190 um"]
fringing = "none"
dielectric = { thickness = "0.2 um", permittivity = 7, landing = { model = "linear", stiffness = "1e17 Pa/m", from = "30 nm" } }
[waveform.main]
family = "step"
level = "1.2 Vsp"
[spread]
"electrode.main.dielectric.landing.stiffness" = { distribution = "normal", cov = "5 %" }
)";

std::string edited_bridge(const std::string& old, const std::string& replacement) {
  std::string text = capacitive;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), replacement);
}

const std::string linear_bed = R"(model = "linear", stiffness = "1e17 Pa/m", from = "30 nm")";

TEST(LandingKeys, MakeTheFaceTheContact) {
  SceneFile file = SceneFile::parse(capacitive, "x.toml");
  const Device linear = read_scene(file).device;
  ASSERT_TRUE(linear.closes_along_face());
  EXPECT_DOUBLE_EQ(linear.gap.contact, 2.97e-6);
  EXPECT_DOUBLE_EQ(linear.contact_position(), 140e-6);
  EXPECT_DOUBLE_EQ(linear.landing()->stiffness, 1e17);
  file.set("electrode.main.dielectric.landing.from=\"0.05 um\"");
  EXPECT_DOUBLE_EQ(read_scene(SceneFile::parse(file.text(), "again.toml")).device.gap.contact, 2.95e-6);
  std::string text = edited_bridge(linear_bed, R"(model = "wall")");
  text.resize(text.find("[spread]"));
  const Device wall = read_scene(SceneFile::parse(text, "x.toml")).device;
  EXPECT_TRUE(wall.landing()->is_wall());
  EXPECT_DOUBLE_EQ(wall.gap.contact, 3e-6);
}

// Returns the bridge over asperities, with the keys that [contact] has for them.
std::string rough_bridge(const std::string& numbers) {
  std::string text = edited_bridge(linear_bed, "model = \"asperity-uniform\", " + numbers);
  return text.replace(text.find("landing.stiffness"), std::string("landing.stiffness").size(), "landing.asperity_radius");
}

TEST(LandingKeys, DescribeAsperities) {
  const std::string numbers =
      R"(asperity_radius = "90 nm", asperity_density = "1e12 1/m^2", asperity_height = "40 nm", effective_modulus = "50 GPa")";
  const Scene scene = read_scene(SceneFile::parse(rough_bridge(numbers), "x.toml"));
  EXPECT_EQ(scene.spread.variables.size(), 1U);
  EXPECT_DOUBLE_EQ(scene.device.gap.contact, 2.96e-6) << "the highest of them";
  const Landing& landing = *scene.device.landing();
  EXPECT_FALSE(landing.is_wall());
  ASSERT_TRUE(landing.asperities);
  EXPECT_DOUBLE_EQ(landing.asperities->summits.radius, 90e-9);
  EXPECT_DOUBLE_EQ(landing.asperities->summits.density, 1e12);
  EXPECT_DOUBLE_EQ(landing.asperities->summits.effective_modulus, 50e9);
  EXPECT_DOUBLE_EQ(landing.asperities->height, 40e-9);

  const auto refused = [&](const std::string& old, const std::string& replacement) {
    std::string other = numbers;
    return refusal_of(rough_bridge(other.replace(other.find(old), old.size(), replacement)));
  };
  EXPECT_THAT(refused(R"(, asperity_height = "40 nm")", ""),
              HasSubstr("x.toml:14: [electrode.main.dielectric.landing]: missing key 'asperity_height' (a length such as "));
  EXPECT_THAT(refused("90 nm", "-90 nm"),
              HasSubstr("x.toml:14: electrode.main.dielectric.landing.asperity_radius = \"-90 nm\": must be "));
  EXPECT_THAT(refused("40 nm", "3 um"), HasSubstr("x.toml:14: electrode.main.dielectric"));
  EXPECT_THAT(refused("40 nm", "3 um"), HasSubstr("'asperity_height' must be less than gap.electrode"));
  EXPECT_THAT(refused("asperity_radius", R"(damping = "1 s/m", asperity_radius)"),
              HasSubstr("landing.damping = \"1 s/m\": unknown key; the face of a dielectric dissipates no energy"));
  EXPECT_THAT(refused("asperity_radius", R"(pad_length = "1 um", asperity_radius)"),
              HasSubstr("landing.pad_length = \"1 um\": unknown key; the pad is the whole face above the electrode"));
  EXPECT_THAT(refused("asperity_radius", R"(from = "1 nm", asperity_radius)"),
              HasSubstr("landing.from = \"1 nm\": belongs to model = \"linear\""));
  EXPECT_THAT(refusal_of(edited_bridge("stiffness = \"1e17 Pa/m\"", "asperity_height = \"40 nm\", stiffness = \"1e17 Pa/m\"")),
              HasSubstr("landing.asperity_height = \"40 nm\": belongs to model = \"asperity-uniform\""));
}

// Returns the bridge with dimples of 0.8 um at several places.
std::string with_stops(const std::vector<std::string>& names, const std::string& more = "") {
  std::string text;
  double at = 60;
  for (const std::string& name : names) {
    text += fmt::format(
        "[contact.{}]\nmodel = \"linear\"\nstiffness = \"1000 N/m\"\npad_length = \"2 um\"\n"
        "at = \"{} um\"\ngap = \"2.2 um\"\n{}",
        name, at, more);
    at += 160;
  }
  return text;
}

TEST(LandingKeys, StandBesideContacts) {
  const auto device_with = [](const std::string& sections) {
    return read_scene(SceneFile::parse(edited_bridge("[waveform.main]", sections + "[waveform.main]"), "x.toml")).device;
  };
  const auto names = [](const Device& device) {
    std::vector<std::string> all;
    for (const Contact& contact : device.contacts) all.push_back(contact.name + (contact.connects ? " connects" : ""));
    return all;
  };
  const Device dimples = device_with(with_stops({"left", "right"}));
  EXPECT_THAT(names(dimples), ElementsAre("right connects", "left connects", "dielectric"));
  EXPECT_DOUBLE_EQ(dimples.gap.contact, 2.2e-6);
  EXPECT_DOUBLE_EQ(dimples.contacts[2].gap, 2.97e-6);
  EXPECT_THAT(names(device_with(with_stops({"left"}) + "[metrics]\nclosed = [\"dielectric\"]\n")),
              ElementsAre("dielectric connects", "left"));
  const Device stop = device_with(with_stops({"behind"}, "side = \"far\"\n"));
  EXPECT_THAT(names(stop), ElementsAre("dielectric connects", "behind"));
  EXPECT_DOUBLE_EQ(stop.gap.contact, 2.97e-6);
  EXPECT_DOUBLE_EQ(stop.contacts[1].gap, 2.2e-6);
}

TEST(LandingKeys, AreRefusedByFileLineAndKey) {
  EXPECT_THAT(refusal_of(edited_bridge("model = \"linear\"", "model = \"wall\"")),
              HasSubstr("x.toml:14: electrode.main.dielectric.landing.from = \"30 nm\": belongs to model = \"linear\""));
  EXPECT_THAT(refusal_of(edited_bridge("model = \"linear\"", "model = \"soft\"")),
              HasSubstr("x.toml:14: electrode.main.dielectric.landing.model = \"soft\": unknown value (known: wall, linear, "
                        "asperity-uniform)"));
  EXPECT_THAT(refusal_of(edited_bridge("stiffness = \"1e17 Pa/m\", ", "")),
              HasSubstr("x.toml:14: [electrode.main.dielectric.landing]: missing key 'stiffness'"));
  EXPECT_THAT(refusal_of(edited_bridge("\"30 nm\"", "\"4 um\"")), HasSubstr("x.toml:14: electrode.main.dielectric"));
  EXPECT_THAT(refusal_of(edited_bridge("electrode = \"3 um\"", "electrode = \"3 um\"\ncontact = \"2 um\"")),
              HasSubstr("x.toml:11: gap.contact = \"2 um\": must be omitted or 2.97 um, where the landing begins"));
  EXPECT_THAT(refusal_of(edited_bridge("[waveform.main]",
                                       "[contact]\nmodel = \"linear\"\nstiffness = \"1 N/m\"\n"
                                       "pad_length = \"1 um\"\n[waveform.main]")),
              HasSubstr("[contact]: must have a name, as in [contact.tip], and a 'gap', "
                        "because the face of a dielectric is a contact as well"));
  EXPECT_THAT(refusal_of(edited_bridge("[waveform.main]", with_stops({"dielectric"}) + "[waveform.main]")),
              HasSubstr("x.toml:14: electrode.main.dielectric = "));
  EXPECT_THAT(refusal_of(edited_bridge("[waveform.main]",
                                       with_stops({"left", "right"}) + "[metrics]\nclosed = [\"dielctric\"]\n[waveform.main]")),
              HasSubstr("unknown contact [contact.dielctric] (did you mean 'dielectric'?)"));
  EXPECT_THAT(refusal_of(edited_bridge("[waveform.main]", "[dispersion]\nmodel = \"casimir\"\n[waveform.main]")),
              HasSubstr("must not have a landing together with [dispersion]: remove one of them"));
  EXPECT_THAT(refusal_of(edited_bridge("[waveform.main]",
                                       "[electrode.other]\nspan = [\"200 um\", \"250 um\"]\nfringing = "
                                       "\"none\"\n[waveform.main]")),
              HasSubstr("where a dielectric has a landing, every near electrode has the same one"));
}

}  // namespace
}  // namespace softland
