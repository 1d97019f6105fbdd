// Scenes with several contacts: how they are read, and what is refused.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/scene.h"
#include "tests/config/message.h"
#include "tests/config/small_scene.h"

namespace softland {
namespace {

const std::string one_contact = "[contact]\nmodel = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"\n";

std::string section(const std::string& name, const std::string& keys) {
  return "[contact." + name + "]\nmodel = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"\n" + keys + "\n";
}

/// Returns the small scene with these sections in place of its contact.
std::string with(const std::string& contacts, const std::string& more = "") {
  return edited(edited(small_scene, "contact = \"2 um\"\n", ""), one_contact, contacts) + more;
}

const std::string left = section("left", "gap = \"2 um\""), right = section("right", "gap = \"2.1 um\"\ncount = 2"),
                  inner = section("inner", "gap = \"1.2 um\"\nat = \"70 %\""),
                  stop = section("a_stop", "gap = \"0.5 um\"\nat = \"200 um\"\nside = \"far\"");

TEST(Contacts, HaveAPlaceAGapAndASide) {
  const Device d = read_scene(SceneFile::parse(with(inner + stop + right + left), "x.toml")).device;
  ASSERT_EQ(d.contacts.size(), 4u);
  // The outermost contact is first. Of two contacts at one place the nearer one is first. Back stops are last.
  const std::vector<std::string> names{"left", "right", "inner", "a_stop"};
  const std::vector<double> places{247.5e-6, 247.5e-6, 175e-6, 200e-6}, gaps{2e-6, 2.1e-6, 1.2e-6, 0.5e-6};
  for (std::size_t c = 0; c < names.size(); ++c) {
    EXPECT_EQ(d.contacts[c].name, names[c]);
    EXPECT_DOUBLE_EQ(d.contact_position(c), places[c]) << names[c];
    EXPECT_DOUBLE_EQ(d.contact_gap(c), gaps[c]) << names[c];
    EXPECT_EQ(d.contacts[c].side, c == 3 ? Side::far : Side::near);
    EXPECT_EQ(d.contacts[c].connects, c != 3);
    EXPECT_EQ(d.contacts[c].count, c == 1 ? 2 : 1);
  }
  EXPECT_EQ(d.connection, Connection::all);
}

TEST(Contacts, ThatMakeTheConnectionAreNamed) {
  const auto read = [](const std::string& closed) {
    return read_scene(SceneFile::parse(with(left + inner + stop, "[metrics]\nclosed = " + closed), "x.toml")).device;
  };
  EXPECT_EQ(read("\"any\"").connection, Connection::any);
  const Device d = read("[\"inner\"]");
  EXPECT_EQ(d.contacts[0].name, "inner") << "what makes the connection comes first";
  EXPECT_EQ(d.gap.contact, 1.2e-6);
  EXPECT_TRUE(d.contacts[0].connects);
  EXPECT_FALSE(d.contacts[1].connects);
}

TEST(Contacts, MayDifferFromDeviceToDevice) {
  const Scene scene = read_scene(SceneFile::parse(
      with(left + inner,
           "[spread]\n\"contact.left.gap\" = { distribution = \"normal\", cov = \"2 %\" }\n\"contact.inner.gap\" = { "
           "distribution = \"normal\", cov = \"2 %\" }\n\"contact.inner.at\" = { distribution = \"normal\", cov = "
           "\"1 %\" }\n"),
      "x.toml"));
  Scene changed = scene;
  ASSERT_EQ(scene.spread.variables.size(), 3u);
  for (const auto& variable : scene.spread.variables) variable.keys.front().member(changed) *= 1.5;
  EXPECT_DOUBLE_EQ(changed.device.contact_gap(0), 3e-6);
  EXPECT_DOUBLE_EQ(changed.device.contact_gap(1), 1.8e-6);
  EXPECT_DOUBLE_EQ(changed.device.contact_position(1), 1.05 * 250e-6);
}

TEST(Contacts, AreWrittenAsTheyWereRead) {
  const SceneFile file = SceneFile::parse(with(left + inner + stop, "[metrics]\nclosed = [\"left\"]\n"), "x.toml");
  const std::string text = file.text();
  const SceneFile again = SceneFile::parse(text, "x.toml");
  EXPECT_EQ(again.text(), text);
  EXPECT_EQ(read_scene(again).device.contacts.size(), 3u);
  EXPECT_EQ(read_scene(again).device.contacts[1].name, "inner");
}

TEST(Contacts, RefuseWhatContradictsItself) {
  EXPECT_EQ(softland::message(with(left + inner + stop)), "");
  EXPECT_EQ(
      softland::message(edited(small_scene, one_contact, one_contact + inner)),
      "x.toml:18: contact.model = \"linear\": [contact] must not be combined with [contact.NAME]: use one of the two forms");
  EXPECT_EQ(softland::message(edited(small_scene, one_contact, left + inner)),
            "x.toml:11: gap.contact = \"2 um\": belongs to a single [contact]: every [contact.NAME] has its own gap");
  EXPECT_EQ(softland::message(edited(small_scene, "contact = \"2 um\"\n", "")),
            "x.toml:9: [gap]: missing key 'contact' (a length such as \"2 um\")");
  EXPECT_EQ(softland::message(with(left + section("right", "gap = \"2 um\""))),
            "x.toml:21: [contact.right]: stands at the place of contact.left, with the same gap: "
            "one contact with count = 2 says "
            "the same");
  EXPECT_EQ(softland::message(with(left + section("right", "count = 2"))),
            "x.toml:21: [contact.right]: missing key 'gap' (a length such as \"2 um\")");
  EXPECT_EQ(softland::message(with(left + section("right", "gap = \"2.1 um\"\ncount = 2.5"))),
            "x.toml:26: contact.right.count = 2.5: must be a whole number");
  EXPECT_EQ(softland::message(with(left + section("right", "gap = \"1 um\"\nat = \"251 um\""))),
            "x.toml:26: contact.right.at = \"251 um\": must lie on the beam: structure.length = \"250 um\"");
  EXPECT_EQ(softland::message(with(left + section("right", "gap = \"3.5 um\""))),
            "x.toml:25: contact.right.gap = \"3.5 um\": must be less than 0.99 times gap.electrode = \"3.5 um\"");
  EXPECT_EQ(softland::message(with(section("stop", "gap = \"1 um\"\nside = \"far\""))),
            "x.toml:16: [contact.stop]: a back stop closes nothing: a contact of side = \"near\" is missing");
  EXPECT_EQ(softland::message(edited(small_scene, one_contact, one_contact + "gap = \"1 um\"\n")),
            "x.toml:21: contact.gap = \"1 um\": belongs to [contact.NAME]; "
            "the contact plane of a single [contact] is at gap.contact");
  EXPECT_EQ(softland::message(with(left + inner, "[metrics]\nclosed = [\"outer\"]\n")),
            "x.toml:47: metrics.closed = [\"outer\"]: unknown contact [contact.outer] (known: inner, left)");
  EXPECT_EQ(softland::message(with(left + stop, "[metrics]\nclosed = [\"a_stop\"]\n")),
            "x.toml:48: metrics.closed = [\"a_stop\"]: [contact.a_stop] is a back stop: it makes no connection");
  EXPECT_EQ(softland::message(std::string(small_scene) + "[metrics]\nclosed = \"all\"\n"),
            "x.toml:41: metrics.closed = \"all\": needs several contacts [contact.NAME], "
            "of which it names those that make the connection");
}

}  // namespace
}  // namespace softland
