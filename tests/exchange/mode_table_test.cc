// Modes of other programs: the same table from every format, and the true reason for each refusal.
#include "exchange/mode_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/clamped_spline.h"
#include "base/random.h"
#include "base/require.h"
#include "tests/exchange/byte_changes.h"
#include "tests/exchange/mode_samples.h"
#include "tests/exchange/samples.h"

namespace softland {
namespace {

using test::mode_samples;
using test::ModeSample;
using test::replaced;
using testing::HasSubstr;

ModeTable parsed(const ModeSample& sample) { return parse_mode_table(sample.content, "beam.txt", sample.keys); }

std::optional<ModeTable> accepted(const std::string& content, const ModeKeys& keys) {
  try {
    return parse_mode_table(content, "beam.txt", keys);
  } catch (const InvalidInput& refusal) {
    EXPECT_FALSE(std::string_view(refusal.what()).empty());
    return std::nullopt;
  }
}

std::string refusal_of(const std::string& content, const ModeKeys& keys) {
  try {
    (void)parse_mode_table(content, "beam.txt", keys);
  } catch (const InvalidInput& refusal) {
    return refusal.what();
  }
  return "accepted";
}

const ModeSample& sample_named(const std::string& name) {
  static const std::vector<ModeSample> all = mode_samples();
  return *std::find_if(all.begin(), all.end(), [&](const ModeSample& one) { return one.name == name; });
}

TEST(ModeTable, IsTheSameFromEveryFormat) {
  for (const ModeSample& sample : mode_samples()) {
    SCOPED_TRACE(sample.name);
    const ModeTable table = parsed(sample);
    EXPECT_EQ(table.format, sample.format);
    const std::vector<double>& x = test::sample_positions();
    ASSERT_EQ(table.positions.size(), x.size());
    ASSERT_EQ(table.frequencies.size(), 2U);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(table.positions[i], x[i], sample.digits * test::sample_length);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(table.frequencies[k], test::sample_frequencies[k], sample.digits * test::sample_frequencies[k]);
      // Normalisation by a mass is exact except for the integral of a cubic through five points.
      const double scale = sample.keys.mass ? table.shapes[k].back() / test::sample_shape(k, test::sample_length) : 1;
      EXPECT_GT(scale, 0);
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_NEAR(table.shapes[k][i], scale * test::sample_shape(k, x[i]),
                    2 * sample.digits * std::abs(test::sample_shape(k, test::sample_length)));
    }
    EXPECT_TRUE(std::all_of(table.rest_offsets.begin(), table.rest_offsets.end(), [](double offset) { return offset == 0; }));
    if (sample.name.starts_with("frd") || sample.name == "table") {
      for (const double width : table.widths) EXPECT_NEAR(width, test::sample_width, sample.digits * test::sample_width);
    } else {
      EXPECT_TRUE(std::isnan(table.widths.front())) << "a line has no width";
    }
  }
}

TEST(ModeTable, LeavesOutByNameWhatDoesNotBendAlongTheDirection) {
  const ModeTable table = parsed(sample_named("frd"));
  ASSERT_EQ(table.found.size(), 4U);
  EXPECT_EQ(table.found[0].kind, ModeKind::bending);
  EXPECT_EQ(table.found[1].kind, ModeKind::in_plane);
  EXPECT_EQ(table.found[2].kind, ModeKind::bending);
  EXPECT_EQ(table.found[3].kind, ModeKind::torsional);
  EXPECT_THAT(table.left_out, testing::ElementsAre("mode 2 at 90 kHz, in-plane", "mode 4 at 300 kHz, torsional"));
  EXPECT_THAT(summary(table), HasSubstr("CalculiX .frd: 36 nodes at 6 places over 100 um, 2 modes at 25 kHz, 156 kHz"));
  EXPECT_THAT(summary(table), HasSubstr("left out: mode 2 at 90 kHz, in-plane"));
  EXPECT_THAT(summary(table), HasSubstr("lengths are taken as m (structure.length_unit changes this)"));

  ModeKeys across = sample_named("frd").keys;
  across.direction = "y";
  const ModeTable in_plane = parse_mode_table(sample_named("frd").content, "beam.txt", across);
  EXPECT_THAT(in_plane.frequencies, testing::ElementsAre(90000.0));
  EXPECT_NEAR(in_plane.widths.front(), 2e-6, 1e-11) << "the other extent is across that motion";
}

// A cantilever of mass m: the integral of its mass per length times the squared mode is 1, so that its end moves by 2 /
// sqrt(m).
TEST(ModeTable, NormalisesByAMassThatIsEvenAlongTheAxis) {
  constexpr double mass = 3e-12, root = 1.8751040687119611;  // cos z cosh z = -1
  constexpr double interpolated = 1e-6;
  const double sigma = (std::cosh(root) + std::cos(root)) / (std::sinh(root) + std::sin(root));
  std::string text = "% Model:              beam.mph\n% Length unit:        m\n% x    y    z    w (m) @ freq=1000\n";
  for (int i = 0; i <= 40; ++i) {
    const double z = root * i / 40;
    text +=
        fmt::format("{} 0 0 {}\n", 1e-4 * i / 40, -3e-7 * (std::cosh(z) - std::cos(z) - sigma * (std::sinh(z) - std::sin(z))));
  }
  const ModeTable table = parse_mode_table(text, "line.txt", {.axis = "x", .direction = "z", .mass = mass});
  EXPECT_NEAR(table.shapes[0].back(), 2 / std::sqrt(mass), interpolated * 2 / std::sqrt(mass));
}

TEST(ModeTable, TakesTheClampAtTheOtherEnd) {
  const ModeSample& sample = sample_named("frd");
  ModeKeys keys = sample.keys;
  keys.axis = "-x";
  EXPECT_THAT(refusal_of(sample.content, keys), HasSubstr("the far end does not move: reverse structure.axis"));
}

TEST(ModeTable, RefusesWithTheRule) {
  const auto edited = [](const char* name, const std::string& what, const std::string& by, const ModeKeys* keys = nullptr) {
    const ModeSample& sample = sample_named(name);
    const std::string content = replaced(sample.content, what, by);
    EXPECT_NE(content, sample.content) << what;
    return refusal_of(content, keys != nullptr ? *keys : sample.keys);
  };
  const auto keyed = [](const char* name, const auto& change) {
    ModeKeys keys = sample_named(name).keys;
    change(keys);
    return refusal_of(sample_named(name).content, keys);
  };
  // These files are incomplete.
  EXPECT_THAT(keyed("comsol", [](ModeKeys& k) { k.mass.reset(); }),
              HasSubstr("does not give the modal masses; give structure.mass"));
  EXPECT_THAT(keyed("frd", [](ModeKeys& k) { k.mass = 1e-12; }),
              HasSubstr("structure.mass: must be omitted, because the modes of the file are mass-normalised"));
  EXPECT_THAT(keyed("rom", [](ModeKeys& k) { k.length_unit.reset(); }), HasSubstr("give structure.length_unit"));
  EXPECT_THAT(keyed("rom", [](ModeKeys& k) { k.clamp.reset(); }), HasSubstr("give structure.clamp"));
  EXPECT_THAT(keyed("frd", [](ModeKeys& k) { k.axis = ""; }), HasSubstr("structure.axis is needed"));
  EXPECT_THAT(keyed("frd", [](ModeKeys& k) { k.direction = "up"; }),
              HasSubstr("structure.direction = \"up\": must be x, y or z"));
  EXPECT_THAT(keyed("frd", [](ModeKeys& k) { k.direction = "x"; }), HasSubstr("must be perpendicular to the axis"));
  EXPECT_THAT(keyed("comsol", [](ModeKeys& k) { k.direction = "y"; }), HasSubstr("must be a direction of motion in the file: z"));
  EXPECT_THAT(keyed("table", [](ModeKeys& k) { k.mass = 1; }),
              HasSubstr("must be omitted, because the table is in m, Hz and 1/sqrt(kg)"));
  EXPECT_THAT(edited("comsol", "freq=25000", "lambda=4E-9"),
              HasSubstr("the file does not hold the frequency of mode 1 (lambda=4E-9); give structure.frequencies"));
  EXPECT_THAT(refusal_of(test::sample_uff(0), sample_named("uff").keys), HasSubstr("structure.mass"));
  EXPECT_THAT(refusal_of(test::sample_uff(2, false), sample_named("uff").keys),
              HasSubstr("modes of 25 kHz, 156 kHz at 6 nodes, but no positions"));
  // These files contain no modes.
  EXPECT_THAT(edited("comsol", "w (m)", "acpr.p_t (Pa)"), HasSubstr("\"acpr.p_t (Pa) @ freq=25000\" must be a displacement"));
  EXPECT_THAT(refusal_of("$SENE    \n      25     1.0000\n", {}), HasSubstr("(.pcs), no modes; they stand in the .rom"));
  EXPECT_THAT(refusal_of("time_s,main\n0,1\n", {}), HasSubstr("unknown kind of file; modes are read from"));
  // These files are contradictory.
  EXPECT_THAT(edited("frd", " -1         7 2.0", " -1        7 2.0"),
              HasSubstr("the line of a node must have 49 columns, and has 48"));
  EXPECT_THAT(edited("frd", "MODAL", "XXXXX"), HasSubstr("accepted")) << "the kind of step is told by its number";
  EXPECT_THAT(edited("frd", "1PGK                2.46", "1PGK                2.86"), HasSubstr("from the generalised stiffness"));
  EXPECT_THAT(edited("comsol", "% Nodes:              6", "% Nodes:              7"),
              HasSubstr("the file has 6 rows, but states 7 nodes"));
  EXPECT_THAT(edited("table", "frequency_Hz,,,25000,156000", "frequency_Hz,,,25000,15600"),
              HasSubstr("the frequencies must increase"));
  EXPECT_THAT(edited("table", "mode_2", "mode_3"), HasSubstr("beam.txt:2: column 5: \"mode_3\" must be mode_2"));
  EXPECT_THAT(edited("table", "8e-05,1e-05", "8e-05,-1e-05"), HasSubstr("a width must be positive"));
  EXPECT_THAT(edited("uff", "    11\n", "    11 \n         1\n"), HasSubstr("beam.txt:")) << "a record too many";
}

TEST(ModeTable, SaysWhichModesAreMissingInAFile) {
  const ModeSample& sample = sample_named("frd");
  const ModeTable other_step =
      parse_mode_table(replaced(sample.content, "    2    1MODAL", "    0    1     "), "beam.txt", sample.keys);
  EXPECT_THAT(other_step.left_out, testing::Contains("results other than modes"));
  EXPECT_EQ(other_step.frequencies.size(), 1U);
  const std::size_t cut = sample.content.rfind(" -4  DISP");
  const ModeTable shorter = parse_mode_table(sample.content.substr(0, cut + 200), "beam.txt", sample.keys);
  EXPECT_THAT(shorter.left_out, testing::Contains("mode 4: the file ends within it"));
}

TEST(ModeTable, OfAMeshWithoutNodesIsRefused) {
  const std::string text = fmt::format(
      "    2C{:18}{:12}{:38}\n -3\n  100CL  101{:12}{:12}{:20}{:2}{:5}MODAL{:7}\n -4  DISP        4    1\n -3\n 9999\n", "", 0, 1,
      "1000.0", 0, "", 2, 1, 1);
  EXPECT_THAT(refusal_of(text, sample_named("frd").keys), HasSubstr("the nodes must precede the displacements"));
}

TEST(ModeTable, OfAHingedEndIsRefused) {
  std::string text = "x_m,mode_1\nfrequency_Hz,1000\n";
  for (int i = 0; i <= 20; ++i) text += fmt::format("{},{}\n", i * 1e-6, i * 1e5);
  EXPECT_THAT(refusal_of(text, {}), HasSubstr("the first place must be a clamp"));
}

// Modes of a table that stand still at the far end: of a clamp there, and of a hinge.
TEST(ModeTable, TellsWhetherItsFarEndIsAClamp) {
  const auto table = [](auto curve) {
    std::string text = "x_m,mode_1\nfrequency_Hz,1000\n";
    for (int i = 0; i <= 20; ++i) text += fmt::format("{},{}\n", i * 1e-6, curve(i / 20.0));
    return parse_mode_table(text, "modes.csv", {});
  };
  const ModeTable clamped = table([](double u) { return 1e6 * u * u * (1 - u) * (1 - u); });
  EXPECT_EQ(clamped.far_end, SplineEnd::clamped);
  EXPECT_THAT(summary(clamped), HasSubstr("the far end does not move in any mode, as at a clamp"));
  const ModeTable hinged = table([](double u) { return 1e6 * u * u * (1 - u); }),
                  free = table([](double u) { return 1e6 * u * u; });
  EXPECT_EQ(hinged.far_end, SplineEnd::free);
  EXPECT_EQ(free.far_end, SplineEnd::free);
  EXPECT_THAT(summary(free), testing::Not(HasSubstr("far end")));
}

// Nodes anywhere, as of tetrahedra: bending with torsion over it, and in-plane bending.
TEST(ModeTable, OfAnIrregularMeshIsFittedOnTheAxis) {
  constexpr std::size_t count = 2600;
  constexpr double fit = 2e-4;
  std::string text = fmt::format("    2C{:18}{:12}{:38}\n", "", count, 1), first, second;
  const double tip = test::sample_shape(0, test::sample_length);
  for (std::size_t i = 0; i < count; ++i) {
    const auto random = [&](std::uint64_t k) { return static_cast<double>(split_mix_64(i, k) % 100000) / 99999; };
    const double x = i < 30 ? 0 : i < 60 ? 1e-4 : 1e-4 * random(0), y = 1e-5 * (random(1) - 0.5), z = 2e-6 * (random(2) - 0.5);
    const double edge = i % 10 == 0 ? (i % 20 == 0 ? 5e-6 : -5e-6) : y, face = i % 7 == 0 ? -1e-6 : z;
    text += fmt::format(" -1{:10}{:12.5E}{:12.5E}{:12.5E}\n", i + 1, x, edge, face);
    first += fmt::format(" -1{:10}{:12.5E}{:12.5E}{:12.5E}\n", i + 1, 0.0, 0.0,
                         -test::sample_shape(0, x) + 0.3 * tip * edge / 5e-6 * x / 1e-4);
    second += fmt::format(" -1{:10}{:12.5E}{:12.5E}{:12.5E}\n", i + 1, 0.0, test::sample_shape(0, x), 0.0);
  }
  text += " -3\n";
  int number = 0;
  for (const std::string& rows : {first, second}) {
    ++number;
    text +=
        fmt::format(
            "    1PGM                1.000000E+00\n  100CL  {:3}{:12.6g}{:12}{:20}{:2}{:5}MODAL{:7}\n -4  DISP        4    1\n",
            100 + number, 1000.0 * number, count, "", 2, number, 1) +
        rows + " -3\n";
  }
  const ModeTable table = parse_mode_table(text + " 9999\n", "beam.frd", {.axis = "x", .direction = "-z"});
  ASSERT_EQ(table.frequencies.size(), 1U);
  EXPECT_EQ(table.found[1].kind, ModeKind::in_plane);
  EXPECT_THAT(table.notes, testing::Contains("an irregular mesh: motions on the axis are fitted at 101 even places"));
  for (std::size_t i = 0; i < table.positions.size(); ++i)
    EXPECT_NEAR(table.shapes[0][i], test::sample_shape(0, table.positions[i]), fit * tip) << "at " << table.positions[i];
  for (const double width : table.widths) EXPECT_NEAR(width, 1e-5, 1e-9);
}

void truncate(std::size_t cuts) {
  for (const ModeSample& sample : mode_samples()) {
    const ModeTable whole = parsed(sample);
    const std::size_t step = std::max<std::size_t>(1, sample.content.size() / cuts);
    for (std::size_t size = 0; size < sample.content.size(); size += step) {
      const std::optional<ModeTable> cut = accepted(sample.content.substr(0, size), sample.keys);
      if (!cut) continue;
      ASSERT_LE(cut->frequencies.size(), whole.frequencies.size());
      const bool told = cut->left_out != whole.left_out || cut->notes != whole.notes;
      for (std::size_t k = 0; k < cut->frequencies.size(); ++k) {
        EXPECT_EQ(cut->frequencies[k], whole.frequencies[k]) << sample.name << " cut at " << size;
        const bool same = cut->positions == whole.positions && cut->shapes[k] == whole.shapes[k];
        EXPECT_TRUE(same || told || !sample.is_mesh) << sample.name << " cut at " << size;
      }
      // A table may end with any whole line: what is there is what the rows say.
      if (!sample.is_mesh && !told) {
        for (std::size_t i = 0; i < cut->positions.size(); ++i)
          EXPECT_EQ(cut->shapes[0][i], whole.shapes[0][i]) << "cut at " << size;
      }
    }
  }
}

// A byte changes one number at most: of what is accepted and says nothing of it, one frequency or the shape of one mode. A
// position that differs moves what is at it in every mode.
void change_bytes(std::uint64_t count) {
  for (const ModeSample& sample : mode_samples()) {
    const ModeTable whole = parsed(sample);
    std::size_t taken = 0;
    for (std::uint64_t seed = 0; seed < count; ++seed) {
      const std::string content = test::changed_by_a_byte(sample.content, seed).content;
      const std::optional<ModeTable> made = accepted(content, sample.keys);
      if (!made || made->left_out != whole.left_out || made->notes != whole.notes) continue;
      ++taken;
      for (const std::vector<double>& shape : made->shapes)
        EXPECT_TRUE(std::all_of(shape.begin(), shape.end(), [](double v) { return std::isfinite(v); }))
            << sample.name << ", seed " << seed;
      if (made->positions != whole.positions) {
        std::size_t moved = 0;
        for (const double x : made->positions)
          moved += std::find(whole.positions.begin(), whole.positions.end(), x) == whole.positions.end();
        const bool all_scaled = made->positions.size() == whole.positions.size();  // a unit, or the first place
        EXPECT_TRUE(moved <= 2 || all_scaled) << sample.name << ", seed " << seed;
        continue;
      }
      ASSERT_EQ(made->frequencies.size(), whole.frequencies.size()) << sample.name << ", seed " << seed;
      std::size_t differ = 0;
      // A frequency that differs may change the order of the modes.
      const auto is_in = [](const auto& value, const auto& all) { return std::find(all.begin(), all.end(), value) != all.end(); };
      for (std::size_t k = 0; k < whole.frequencies.size(); ++k)
        differ += !is_in(whole.frequencies[k], made->frequencies) + !is_in(whole.shapes[k], made->shapes);
      EXPECT_LE(differ, 1U) << sample.name << ", seed " << seed;
    }
    EXPECT_GT(taken, 0U) << sample.name << ": every change was refused, which tests nothing";
  }
}

TEST(ModeTable, OfATruncatedFileIsRefusedOrToldOrAPart) { truncate(40); }
TEST(ModeTable, OfAChangedByteIsRefusedOrOneNumberOff) { change_bytes(200); }
TEST(ModeTable, OfManyTruncatedFilesIsRefusedOrToldOrAPart_long) { truncate(200); }
TEST(ModeTable, OfManyChangedBytesIsRefusedOrOneNumberOff_long) { change_bytes(2000); }

}  // namespace
}  // namespace softland
