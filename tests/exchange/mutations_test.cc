// Files that are cut or changed by a byte: never a crash, and never a number that the untouched part does not say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/require.h"
#include "exchange/recording.h"
#include "exchange/trace.h"
#include "tests/exchange/byte_changes.h"
#include "tests/exchange/samples.h"

namespace softland {
namespace {

using test::all_samples;
using test::Sample;

std::optional<Recording> taken(const std::string& content, const ReadKeys& keys) {
  try {
    Recording made = parse_recording(content, "x.csv", keys);
    try {
      (void)trace_of(made, keys, "main");
    } catch (const InvalidInput&) {
    }
    return made;
  } catch (const InvalidInput& refusal) {
    EXPECT_FALSE(std::string_view(refusal.what()).empty());
    return std::nullopt;
  }
}

/// The bits of a row: its time, where it stands in the file, and all values.
std::vector<double> row_of(const Recording& r, std::size_t row, bool with_time, std::size_t channels) {
  std::vector<double> all;
  if (with_time) all.push_back(r.times[row]);
  for (std::size_t c = 0; c < channels; ++c) {
    const double value = r.channels[c].values[row];
    all.push_back(std::isnan(value) ? 1e300 : value);
  }
  return all;
}

bool is_prefix_but_last(const Recording& cut, const Recording& whole, bool with_time) {
  if (cut.rows() > whole.rows() || cut.channels.size() > whole.channels.size()) return false;
  const bool told = std::any_of(cut.notes.begin(), cut.notes.end(),
                                [](const std::string& note) { return note.find("cut") != std::string::npos; });
  for (std::size_t i = 0; i + (told ? 1 : 0) < cut.rows(); ++i) {
    if (row_of(cut, i, with_time, cut.channels.size()) != row_of(whole, i, with_time, cut.channels.size())) return false;
  }
  return true;
}

void truncate_everywhere(std::size_t most) {
  for (const Sample& sample : all_samples()) {
    const std::optional<Recording> whole = taken(sample.content, sample.keys);
    ASSERT_TRUE(whole) << sample.name;
    const std::size_t step = std::max<std::size_t>(1, sample.content.size() / most);
    for (std::size_t size = 0; size < sample.content.size(); size += step) {
      const std::optional<Recording> cut = taken(sample.content.substr(0, size), sample.keys);
      // Rows that are channels: all of them or none are there; of codes the number of samples decides the times.
      const bool with_time = sample.times_stand_in_it && !cut.value_or(Recording{}).times.empty();
      if (!cut) continue;
      EXPECT_TRUE(is_prefix_but_last(*cut, *whole, with_time)) << sample.name << " cut at " << size << ":\n"
                                                               << sample.content.substr(0, size);
    }
  }
}

/// Counts the rows of either that are left when the rows that they begin and end with alike are taken away.
std::pair<std::size_t, std::size_t> different_rows(const Recording& a, const Recording& b, bool with_time) {
  std::size_t begin = 0, end = 0;
  const std::size_t least = std::min(a.rows(), b.rows()), channels = a.channels.size();
  while (begin < least && row_of(a, begin, with_time, channels) == row_of(b, begin, with_time, channels)) ++begin;
  while (begin + end < least &&
         row_of(a, a.rows() - 1 - end, with_time, channels) == row_of(b, b.rows() - 1 - end, with_time, channels))
    ++end;
  return {a.rows() - begin - end, b.rows() - begin - end};
}

void mutate(std::uint64_t count) {
  for (const Sample& sample : all_samples()) {
    const std::optional<Recording> whole = taken(sample.content, sample.keys);
    ASSERT_TRUE(whole) << sample.name;
    // A header says what codes stand for, and in which order bytes are: a change of that number is what the file says.
    const bool header_counts = sample.name == "keysight_arb" || sample.name == "gw_instek" || sample.name.starts_with("uff58b");
    for (std::uint64_t seed = 0; seed < count; ++seed) {
      const auto [content, at] = test::changed_by_a_byte(sample.content, seed);
      const std::optional<Recording> made = taken(content, sample.keys);
      if (!made || made->channels.size() != whole->channels.size() || !made->left_out.empty()) continue;  // refused, or told
      const auto line = static_cast<std::size_t>(
                            std::count(sample.content.begin(), sample.content.begin() + static_cast<std::ptrdiff_t>(at), '\n')) +
                        1;
      const bool in_header = line < whole->lines.front();
      if (header_counts && in_header) continue;
      const bool with_time = sample.times_stand_in_it && !sample.times_add_up && !in_header && !made->times.empty();
      const auto [before, after] = different_rows(*whole, *made, with_time);
      EXPECT_TRUE(before <= 2 && after <= 2)
          << sample.name << ", mutation " << seed << ": " << before << " rows become " << after << "\n"
          << content;
    }
  }
}

TEST(Mutations, AFileThatIsCutIsReadUpToThereOrRefused_long) { truncate_everywhere(200); }
TEST(Mutations, AChangedByteChangesNoOtherRow_long) { mutate(200); }
TEST(Mutations, TwoThousandChangedBytesChangeNoOtherRow_slow) { mutate(2000); }

}  // namespace
}  // namespace softland
