// Hostile scenes and options. Each is accepted, or refused with place, key, value and rule in a message of one readable line,
// within a short time.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "tests/config/message.h"
#include "tests/config/small_scene.h"

namespace softland {
namespace {

using testing::HasSubstr;

const std::string scene(small_scene);
const std::string long_word(10'000, 'x');

std::string with_length(const std::string& value) { return edited(scene, "\"250 um\"", value); }
std::string with_line(const std::string& line) { return edited(scene, "[gap]", line + "\n[gap]"); }
std::string with_main_waveform(const std::string& keys) { return edited(scene, "family = \"step\"\nlevel = \"1.25 Vdp\"", keys); }
std::string with_electrode(const std::string& name) {
  return edited(scene, "[gas]", "[electrode." + name + "]\nspan = [\"1 um\", \"2 um\"]\n[gas]");
}
std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int k = 0; k < times; ++k) all += text;
  return all;
}
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}
std::string utf_16(const std::string& text) {
  std::string wide = "\xff\xfe";
  for (const char c : text) {
    wide += c;
    wide += '\0';
  }
  return wide;
}

struct Hostile {
  std::string name;
  std::string text;
  std::string expected;  ///< part of the message; empty if the scene is accepted
};

std::ostream& operator<<(std::ostream& out, const Hostile& hostile) { return out << hostile.name; }

std::vector<Hostile> hostile_scenes() {
  const std::string nul(1, '\0');
  std::string disjoint;
  for (int k = 0; k < 2000; ++k) {
    disjoint += fmt::format("[electrode.e{0}]\nspan = [\"{1} nm\", \"{2} nm\"]\n", k, 10 * k, 10 * (k + 1));
  }
  return {
      {"only a byte order mark", "\xef\xbb\xbf", "x.toml: section [structure] is missing"},
      {"byte order mark", "\xef\xbb\xbf" + scene, ""},
      {"lines that end as on Windows", replaced(scene, "\n", "\r\n"), ""},
      {"lines that end as on old Macs", replaced(scene, "\n", "\r"), "x.toml:1:17: not TOML"},
      {"UTF-16", utf_16(scene), "x.toml:1:1: not TOML"},
      {"Latin-1 micro sign", with_length("\"250 \xb5m\""), "x.toml:4:14: not TOML"},
      {"NUL in a value", with_length("\"250" + nul + " um\""), "x.toml:4:14: not TOML"},
      {"NUL at the end", scene + nul + nul, "x.toml:40:1: not TOML"},
      {"escaped NUL in a value", with_length(R"("250\u0000 um")"),
       R"(x.toml:4: structure.length = "250\u0000 um": must be a number and a unit)"},
      {"escape sequence in a value", with_length(R"("\u001b[31m")"),
       R"(x.toml:4: structure.length = "\u001B[31m": must be a number and a unit)"},
      {"key twice", with_line("length = \"1 um\""), "x.toml:9:10: not TOML"},
      {"section twice", scene + "[gap]\n", "x.toml:40:1: not TOML"},
      {"table and value of one name", scene + "[structure.length]\n", "x.toml:40:1: not TOML"},
      {"nested arrays", with_line("x = " + std::string(5000, '[') + std::string(5000, ']')), "not TOML"},
      {"nested tables", with_line("x = " + repeated("{a=", 5000) + "1" + repeated("}", 5000)), "not TOML"},
      {"dotted key", with_line(repeated("a.", 5000) + "a = 1"), "x.toml:9: a key has more than 16 parts"},
      {"string without end", with_length("\"250 um"), "the text is not closed on line 4: its closing quote is missing"},
      {"string over two lines", with_length("\"\"\"250 um\n\"\"\""), R"(x.toml:4: structure.length = "250 um\n": unknown unit)"},
      {"string in single quotes", with_length("'250 um'"), ""},
      {"tabulator", with_length("\"250\\tum\""), ""},
      {"printed quantity", with_length("\"250\u00a0\u00b5m\""), ""},
      {"Greek mu", with_length("\"250 \u03bcm\""), ""},
      {"full-width digits", with_length("\"\uff12 um\""),
       "x.toml:4: structure.length = \"\uff12 um\": must be a number and a unit"},
      {"Arabic digits", with_length("\"\u0662 um\""), "must be a number and a unit"},
      {"unit alone", with_length("\"um\""), "must be a number and a unit"},
      {"sum", with_length("\"1 um + 2 um\""), "unknown unit '+'"},
      {"comma", with_length("\"250,0 um\""), "must be a number and a unit"},
      {"thousands", with_length("\"1_000 um\""), "must be a number and a unit"},
      {"hexadecimal", with_length("0xff"), "x.toml:4: structure.length = 255: no unit"},
      {"infinite text", with_length("\"inf um\""), "must be a number and a unit"},
      {"bare infinity", with_length("inf"), "x.toml:4: structure.length = inf: no unit"},
      {"denormal", with_length("\"5e-324 m\""), R"(x.toml:4: structure.length = "5e-324 m": must be in [1 pm, 1 m])"},
      {"smaller than a denormal", with_length("\"1e-400 m\""), "outside the range of double precision"},
      {"negative zero", with_length("\"-0 um\""), R"(x.toml:4: structure.length = "-0 um": must be in [1 pm, 1 m])"},
      {"gap of an ion", edited(scene, "contact = \"2 um\"", "contact = \"1e-30 m\""),
       R"(x.toml:11: gap.contact = "1e-30 m": must be in [1 pm, 1 m])"},
      {"window of a lifetime", edited(scene, "accuracy = 1e-5", "duration = \"1e9 s\""),
       R"(x.toml:39: simulate.duration = "1e9 s": must be in [1 fs, 1 ks])"},
      {"window of nothing", edited(scene, "accuracy = 1e-5", "duration = \"0 s\""), "must be in [1 fs, 1 ks]"},
      {"impossible accuracy", edited(scene, "accuracy = 1e-5", "accuracy = 1e-300"), "must be in [1e-12, 0.1]"},
      {"heavy beam", edited(scene, "19300 kg/m^3", "1e25 kg/m^3"), "must be in [1e-6 kg/m^3, 1000000 kg/m^3]"},
      {"million modes", with_line("modes = 1_000_000"), "x.toml:9: structure.modes = 1000000: must be in [1, 20]"},
      {"modes beyond integers", with_line("modes = 99999999999999999999"), "x.toml:9"},
      {"modes as a boolean", with_line("modes = true"), R"(x.toml:9: structure.modes = true: expected a whole number or "auto")"},
      {"modes as a text", with_line("modes = \"4\""), R"(structure.modes = "4": expected a whole number or "auto")"},
      {"date for a number", with_length("2026-01-01T00:00:00Z"), "not a number with a unit"},
      {"time for a number", with_length("07:32:00"), "not a number with a unit"},
      {"array for a number", with_length("[\"250 um\"]"), "not a number with a unit"},
      {"table for a number", with_length("{ v = 1 }"), "not a number with a unit"},
      {"number for a title", "title = 3\n" + edited(scene, "title = \"small\"", ""), "title = 3: expected a text in quotes"},
      {"number for a section", "gap = 3\n" + edited(scene, "[gap]\nelectrode = \"3.5 um\"\ncontact = \"2 um\"\n", ""),
       "x.toml:1: gap = 3: expected a section [gap]"},
      {"array for a section", edited(scene, "[gap]", "[[gap]]"), "expected a section [gap]"},
      {"list of mixed units", edited(scene, R"(["60 um", "240 um"])", R"(["60 um", "0.24 V"])"),
       "value 2: expected a length [m], got a voltage [V]"},
      {"list of lists", edited(scene, R"(["60 um", "240 um"])", R"([["60 um"], "240 um"])"), "value 1: needs 2 values, got 1"},
      {"very long list", edited(scene, R"(["60 um", "240 um"])", "[" + repeated("\"1 um\", ", 5000) + "]"),
       "needs 2 values, got 5000"},
      {"electrode off the beam", edited(scene, R"(["60 um", "240 um"])", R"(["60 um", "1 mm"])"),
       "must end on the beam: structure.length = \"250 um\""},
      {"electrode without a name", with_electrode("\"\""), R"(x.toml:14: [electrode.""]: a name must consist of)"},
      {"electrode named as the time", with_electrode("time_s"), "x.toml:14: [electrode.time_s]: the name 'time_s' is reserved"},
      {"electrode with a long name", with_electrode(long_word), "a name must consist of at most 64 letters"},
      {"electrodes over one another",
       [] {
         std::string all = scene;
         for (int k = 0; k < 1000; ++k) all += fmt::format("[electrode.e{}]\nspan = [\"60 um\", \"240 um\"]\n", k);
         return all;
       }(),
       "must not overlap electrode."},
      {"two thousand electrodes",
       edited(edited(edited(scene, "[electrode.main]\nspan = [\"60 um\", \"240 um\"]\n", disjoint), "[waveform.main]",
                     "[waveform.e0]"),
              "1.25 Vdp", "1 V"),
       ""},
      {"value of 10 kB", with_length("\"250 " + long_word + "\""), "x.toml:4: structure.length = \"250 xxx"},
      {"number of 10 kB", with_length("\"" + std::string(10'000, '9') + " um\""), "is outside the range of double precision"},
      {"power of 10 kB", with_length("\"250 um^" + std::string(10'000, '1') + "\""), "needs an integer power between -9 and 9"},
      {"unit of 3000 factors", with_length("\"250 " + repeated("um ", 3000) + "\""), "the power of m in the unit is 10"},
      {"key of 10 kB", with_line(long_word + " = 1"), "unknown key (known: kind"},
      {"section of 10 kB", scene + "[" + long_word + "]\n", "unknown section (known: structure"},
      {"choice of 10 kB", edited(scene, "\"cantilever\"", "\"" + long_word + "\""), "unknown value (known: cantilever"},
      {"key of 10 kB twice", with_line(long_word + " = 1\n" + long_word + " = 1"), "not TOML"},
      {"table without rows", with_main_waveform("family = \"table\"\ntimes = []\nvoltages = []"),
       "a table must have at least one row"},
      {"table of one row", with_main_waveform("family = \"table\"\ntimes = [\"0 s\"]\nvoltages = [\"20 V\"]"), ""},
      {"table that goes back",
       with_main_waveform("family = \"table\"\ntimes = [\"0 s\", \"2 us\", \"1 us\"]\nvoltages = [\"1 V\", \"2 V\", \"3 V\"]"),
       "must be finite and not before the row above"},
      {"table that begins late", with_main_waveform("family = \"table\"\ntimes = [\"1 s\"]\nvoltages = [\"1 V\"]"),
       "it must be 0"},
      {"table file without a name", with_main_waveform("family = \"table\"\nfile = \"\""), "must be the name of a file"},
      {"table file with NUL in its name", with_main_waveform("family = \"table\"\nfile = \"a\\u0000b\""),
       R"(waveform.main.file = "a\u0000b": must be the name of a file)"},
      {"pulse without levels", with_main_waveform("family = \"pulse\"\nlevels = []\ntimes = []"),
       "levels of a pulse must not be empty"},
      {"voltage of a storm", with_main_waveform("family = \"step\"\nlevel = \"1e300 V\""),
       R"(waveform.main.level = "1e300 V": must be in [-1 GV, 1 GV])"},
      {"amplitude of a storm",
       with_main_waveform("family = \"harmonic\"\nbase = \"1 kV\"\namplitude = \"1e12 %\"\nfrequency = \"1 kHz\""),
       "x.toml:27: [waveform.main]: reaches 1"},
      {"limit of a storm", scene + "[driver.main]\nmax_voltage = \"1e8 V\"\n", ""},
      {"slew of nothing", scene + "[driver.main]\nmax_slew = \"1e-300 V/s\"\n", "must be in [1 uV/s, 1e24 V/s]"},
      {"spread beyond all", scene + "[spread]\n\"structure.thickness\" = { distribution = \"normal\", cov = \"200 %\" }\n",
       "must be in [1e-12, 1]"},
      {"a million comments", repeated("#\n", 1'000'000) + scene, ""},
  };
}

class Hostility : public testing::TestWithParam<Hostile> {};

TEST_P(Hostility, IsAnsweredInOneReadableLine) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string answer = message(GetParam().text);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  if (GetParam().expected.empty()) {
    EXPECT_EQ(answer, "");
  } else {
    EXPECT_THAT(answer, HasSubstr(GetParam().expected));
  }
  EXPECT_LT(answer.size(), 600U);
  EXPECT_TRUE(std::none_of(answer.begin(), answer.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; })) << answer;
  constexpr double patience = 20;  // [s]; a second usually, more on a busy machine under sanitizers
  EXPECT_LT(taken.count(), patience);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Hostility, testing::ValuesIn(hostile_scenes()), [](const auto& given) {
  std::string name = given.param.name;
  std::erase_if(name, [](char c) { return c == ','; });
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_'; });
  return name;
});

TEST(HostileOptions, AreAnsweredInOneReadableLine) {
  const std::string nul(1, '\0');
  for (const auto& [option, expected] : std::vector<std::pair<std::string, std::string>>{
           {"structure.thickness=" + long_word, "--set structure.thickness=xxx"},
           {long_word + "=1", "unknown key"},
           {"a." + long_word + ".b=1", "unknown section"},
           {repeated("a.", 5000) + "b=1", "not a key path"},
           {"structure.thickness=\"4 um\" # comment", ""},
           {"structure.thickness = 4 um", ""},
           {"structure.thickness=4 \u00b5m", ""},
           {"structure.thickness=4\u00a0\u03bcm", ""},
           {"\"structure\".'thickness'=4 um", ""},
           {"structure={}", "missing key 'kind'"},
           {"structure=", "expected a section [structure]"},
           {"structure.thickness=" + std::string(5000, '['), "must be a number and a unit"},
           {"structure.thickness={a={b={c=1}}}", "not a number with a unit"},
           {"title=\x1b[31mred", ""},
           {"structure.length=250" + nul + " um", "must be a number and a unit"},
           {"electrode.main.span=[\"60 um\"", "expected a list"},
           {"electrode.tip.span=[\"200 um\", \"250 um\"]", "must not overlap electrode.main"},
           {"simulate.duration=1e9 s", "must be in [1 fs, 1 ks]"}}) {
    const std::string answer = message(scene, {option});
    if (expected.empty()) {
      EXPECT_EQ(answer, "") << option.substr(0, 80);
    } else {
      EXPECT_THAT(answer, HasSubstr(expected)) << option.substr(0, 80);
      EXPECT_THAT(answer, HasSubstr("--set ")) << option.substr(0, 80);
    }
    EXPECT_LT(answer.size(), 600U) << option.substr(0, 80);
    EXPECT_TRUE(std::none_of(answer.begin(), answer.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
        << answer;
  }
  EXPECT_EQ(message(scene, {"structure.thickness=1 V", "structure.thickness=4 um"}), "") << "the last one counts";
}

}  // namespace
}  // namespace softland
