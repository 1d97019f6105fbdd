// Verb `read`: shows the content of a file from an instrument; it needs no scene.
#include <memory>
#include <string>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "config/read_keys.h"
#include "exchange/recording.h"
#include "reports/recording_report.h"

namespace softland::apps {
namespace {

struct ReadRequest {
  std::string file;
  bool plot = false;
};

int read_verb(const Common& c, const ReadRequest& request) {
  require(!request.plot || c.json != "-", "--plot --json -: both write to standard output; give --json a file name");
  const ReadKeys keys = read_keys(c.set);
  Recording recording = read_recording(request.file, keys);
  if (!keys.column.empty() || keys.column_number > 0) recording.channels = {channel_of(recording, keys, "")};
  static_cast<void>(reserve_outputs(c, {}));
  if (request.plot) {
    if (!c.json.empty()) print_json_or(c, recording_json(recording), "");
    print(recording_svg(recording));
    return exit_done;
  }
  print_json_or(c, recording_json(recording), recording_text(recording));
  return exit_done;
}

}  // namespace

void add_read(Verb& verb) {
  const auto request = std::make_shared<ReadRequest>();
  verb.positional(
      "FILE", request->file,
      "file of an oscilloscope, a data logger or a simulator: columns of numbers, SPICE PWL, VCD, UFF 58 or 58b (docs/files.md)");
  verb.flag("--plot", request->plot, "print a plot of the channels against time, as SVG");
  verb.with_set(
      "key of [waveform.NAME] that says how to read the file: column, time_column, interval, skip, time_unit or decimal");
  verb.with_json();
  verb.footer(
      "Examples:\n  softland read scope.csv\n  softland read scope.csv --plot > scope.svg\n"
      "  softland read samples.csv --set interval=\"8 ns\" --json -");
  verb.runs([request](const Common& common) { return read_verb(common, *request); });
}

}  // namespace softland::apps
