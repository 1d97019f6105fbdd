// Modes from a file of another program, up to a closing.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"
#include "tests/exchange/mode_samples.h"

namespace softland {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::vector<std::string> to_table{"modes", "--from", "beam.frd", "--axis", "x", "--direction", "-z", "--out", "modes.csv"};

TEST(ModesOfAFile, BecomeATableAPictureAndAList) {
  const Workplace here;
  write(here.path() / "beam.frd", test::sample_frd());
  std::vector<std::string> words = to_table;
  words.insert(words.end(), {"--plot", "modes.svg", "--json", "modes.json"});
  const Outcome o = here.run(words);
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("CalculiX .frd: 36 nodes at 6 places over 100 um"));
  EXPECT_THAT(o.out, HasSubstr("left out  torsional"));
  const json j = json::parse(read(here.path() / "modes.json"));
  EXPECT_EQ(j["modes"].size(), 4U);
  EXPECT_EQ(j["modes"][2]["taken_as"], "mode_2");
  EXPECT_TRUE(j["modes"][1]["taken_as"].is_null());
  const std::string picture = read(here.path() / "modes.svg");
  EXPECT_THAT(picture, HasSubstr("left out: in-plane"));
  EXPECT_THAT(picture, HasSubstr("mode_1"));
  // The table is read back bit for bit.
  const std::string table = read(here.path() / "modes.csv");
  EXPECT_THAT(table, testing::StartsWith("x_m,width_m,rest_offset_m,mode_1,mode_2\nfrequency_Hz,,,25000,156000\n0,"));
  EXPECT_EQ(here.run({"modes", "--from", "modes.csv", "--out", "again.csv"}).status, 0);
  EXPECT_EQ(read(here.path() / "again.csv"), table);
}

TEST(ModesOfAFile, AreRefusedWithTheOptionThatDecides) {
  const Workplace here;
  write(here.path() / "beam.frd", test::sample_frd());
  write(here.path() / "line.txt", test::sample_comsol(false));
  const auto refused = [&](const std::vector<std::string>& words) {
    const Outcome o = here.run(words);
    EXPECT_EQ(o.status, 2) << o.out;
    return o.err;
  };
  EXPECT_THAT(refused({"modes"}), HasSubstr("requires a scene, or --from"));
  EXPECT_THAT(refused({"modes", "gold.toml", "--axis", "x"}), HasSubstr("--axis: describes the file of --from"));
  EXPECT_THAT(refused({"modes", "gold.toml", "--from", "beam.frd"}), HasSubstr("replaces a scene"));
  EXPECT_THAT(refused({"modes", "--from", "beam.frd", "--direction", "z"}), HasSubstr("--axis is needed"));
  EXPECT_THAT(refused({"modes", "--from", "line.txt", "--axis", "x", "--direction", "-z"}), HasSubstr("give --mass"));
  EXPECT_THAT(refused({"modes", "--from", "line.txt", "--axis", "x", "--direction", "-z", "--mass", "1 mm"}),
              HasSubstr("--mass 1 mm: must be a mass"));
  EXPECT_THAT(refused({"modes", "--from", "x.rst", "--axis", "x", "--direction", "-z"}),
              HasSubstr("a binary result of ANSYS (.rst), which is not read"));
  EXPECT_THAT(refused({"modes", "--from", "beam.frd", "--axis", "x", "--direction", "-z", "--out", "beam.frd"}),
              HasSubstr("beam.frd"));
  EXPECT_THAT(refused({"modes", "--from", "beam.frd", "--axis", "x", "--direction", "-z", "--out", "a", "--plot", "a"}),
              HasSubstr("another output"));
}

json closing(const Workplace& here, const std::string& scene, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{"simulate", scene, "--quiet", "--json", "-"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome o = here.run(words);
  EXPECT_EQ(o.status, 0) << o.err;
  return json::parse(o.out);
}

double relative(const json& a, const json& b, const char* figure) {
  return std::abs(a["metrics"][figure].get<double>() / b["metrics"][figure].get<double>() - 1);
}

// The modes of a beam in closed form, written as a table of 101 places: the shapes have errors of a millionth.
TEST(ModesOfAFile, OfABeamCloseAsTheBeam_optimized) {
  constexpr double time = 1e-8, speed = 1e-6, height = 1e-5;
  const Workplace here;
  write(here.path() / "modes.toml", shipped("mem-gold-modes.toml"));
  write(here.path() / "mem-gold-modes.csv", shipped("mem-gold-modes.csv"));
  const json table = closing(here, "modes.toml"), beam = closing(here, "gold.toml");
  EXPECT_LE(relative(table, beam, "initial_contact_time_s"), time);
  EXPECT_LE(relative(table, beam, "impact_velocity_m_s"), speed);
  EXPECT_LE(relative(table, beam, "major_bounce_height_m"), height);
}

// The results of a search include the modes, so that they can be moved.
TEST(ModesOfAFile, StandInTheResultOfASearch_optimized) {
  const Workplace here;
  write(here.path() / "modes.toml", shipped("mem-gold-modes.toml"));
  write(here.path() / "mem-gold-modes.csv", shipped("mem-gold-modes.csv"));
  const Outcome search = here.run({"optimize", "modes.toml", "--robust", "none", "--budget", "20", "--set", "structure.modes=2",
                                   "--set", "simulate.accuracy=1e-3", "--quiet", "--out", "found"});
  EXPECT_TRUE(search.status == 0 || search.status == 4) << search.err;
  fs::create_directory(here.path() / "far");
  fs::rename(here.path() / "found" / "best.toml", here.path() / "far" / "best.toml");
  fs::remove(here.path() / "mem-gold-modes.csv");
  const json again = closing(here, "far/best.toml");
  json best = json::parse(read(here.path() / "found" / "result.json"))["best"]["metrics"];
  best.erase("status");
  EXPECT_EQ(again["metrics"], best);
}

// Returns a mesh of the beam of mem-gold.toml: 20-node bricks with Poisson's ratio 0, since the beam of a scene has no
// contraction across.
std::string mesh_of_gold() {
  constexpr int nx = 50, ny = 4, nz = 2;
  constexpr double length = 250e-6, width = 20e-6, thickness = 2e-6;
  std::map<std::array<int, 3>, int> numbers;
  std::string nodes, elements, fixed;
  const auto node = [&](int i, int j, int k) {
    const auto [found, is_new] = numbers.try_emplace({i, j, k}, static_cast<int>(numbers.size()) + 1);
    if (is_new) {
      nodes += fmt::format("{},{:.9e},{:.9e},{:.9e}\n", found->second, length * i / (2 * nx), width * (j / (2.0 * ny) - 0.5),
                           thickness * (k / (2.0 * nz) - 0.5));
      if (i == 0) fixed += fmt::format("{},\n", found->second);
    }
    return found->second;
  };
  constexpr std::array<std::array<int, 3>, 20> corners{
      {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0},
       {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}}};
  int element = 0;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        elements += fmt::format("{}", ++element);
        for (std::size_t n = 0; n < corners.size(); ++n)
          elements += fmt::format(",{}{}", n == 15 ? "\n" : "",
                                  node(2 * i + corners[n][0], 2 * j + corners[n][1], 2 * k + corners[n][2]));
        elements += "\n";
      }
  return "*NODE, NSET=ALL\n" + nodes + "*ELEMENT, TYPE=C3D20R, ELSET=E\n" + elements + "*NSET, NSET=FIX\n" + fixed +
         "*MATERIAL, NAME=AU\n*ELASTIC\n78e9,0\n*DENSITY\n19300.\n*SOLID SECTION, ELSET=E, MATERIAL=AU\n*BOUNDARY\nFIX,1,3\n"
         "*STEP\n*FREQUENCY\n8\n*NODE FILE\nU\n*END STEP\n";
}

// The program is Debian's CalculiX, if installed.
TEST(ModesOfAFile, OfAMeshByCalculixCloseAsTheBeam_slow) {
  if (std::system("command -v ccx >/dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no CalculiX; needs: calculix-ccx";
  constexpr double time = 1e-4, speed = 1e-4, height = 5e-3;
  const Workplace here;
  write(here.path() / "beam.inp", mesh_of_gold());
  ASSERT_EQ(std::system(("cd '" + here.path().string() + "' && ccx beam > ccx.txt 2>&1").c_str()), 0);
  const Outcome o = here.run(to_table);
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, testing::ContainsRegex("left out +in-plane"));
  EXPECT_THAT(o.out, HasSubstr("left out  torsional"));
  write(here.path() / "modes.toml",
        edited(shipped("mem-gold-modes.toml"), "file = \"mem-gold-modes.csv\"", "file = \"modes.csv\""));
  const json mesh = closing(here, "modes.toml"), beam = closing(here, "gold.toml");
  EXPECT_LE(relative(mesh, beam, "initial_contact_time_s"), time);
  EXPECT_LE(relative(mesh, beam, "impact_velocity_m_s"), speed);
  EXPECT_LE(relative(mesh, beam, "major_bounce_height_m"), height);
  // With up to three modes the peak force is in the first rebounds. With more modes it is in later ones, which differ in any
  // two closings.
  constexpr double force = 5e-3;
  for (const char* modes : {"structure.modes=1", "structure.modes=2", "structure.modes=3"})
    EXPECT_LE(relative(closing(here, "modes.toml", {"--set", modes}), closing(here, "gold.toml", {"--set", modes}),
                       "peak_contact_force_N"),
              force)
        << modes;
}

}  // namespace
}  // namespace softland
