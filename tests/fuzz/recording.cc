#include "exchange/recording.h"

#include <cmath>

#include "exchange/trace.h"
#include "tests/fuzz/targets.h"

namespace softland::fuzz {

// A file of an instrument: accepted rows have one length, and a trace has finite numbers at times that do not decrease.
void recording(std::string_view input) {
  Recording read;
  if (!accepted([&] { read = parse_recording(input, "fuzz.csv"); })) return;
  check(!read.channels.empty() && read.rows() > 0, "nothing was taken");
  check(read.times.empty() || read.times.size() == read.rows(), "there are more or fewer times than rows");
  for (const Channel& channel : read.channels) check(channel.values.size() == read.rows(), "channels are of different length");
  static_cast<void>(summary(read));
  for (const ReadKeys& keys : {ReadKeys{.column_number = read.channels.front().column},
                               ReadKeys{.column_number = read.channels.front().column, .uneven = true},
                               ReadKeys{.column_number = read.channels.front().column, .interval = 1e-6}}) {
    Trace trace;
    if (!accepted([&] { trace = trace_of(parse_recording(input, "fuzz.csv", keys), keys, "main", true); })) continue;
    for (std::size_t i = 0; i < trace.times.size(); ++i) {
      check(std::isfinite(trace.times[i]) && std::isfinite(trace.values[i]), "a trace has a number that is not finite");
      check(i == 0 || trace.times[i] >= trace.times[i - 1], "the times of a trace go back");
    }
  }
}

}  // namespace softland::fuzz
