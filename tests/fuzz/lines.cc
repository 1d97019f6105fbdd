#include "reports/tuning_lines.h"
#include "tests/fuzz/targets.h"

namespace softland::fuzz {

// A line between a tuning and a device: an accepted line is written again unchanged.
void lines(std::string_view input) {
  nlohmann::json line;
  if (!accepted([&] { line = read_line(input); })) return;
  static_cast<void>(is_end(line));
  accepted([&] {
    const nlohmann::json once = shot_json(read_shot(line));
    check(shot_json(read_shot(read_line(line_text(once)))) == once, "a shot changes when it is read again");
  });
  accepted([&] {
    const int shot = shot_number(line);
    const nlohmann::json once = record_json(shot, read_record(line, shot));
    check(record_json(shot, read_record(read_line(line_text(once)), shot)) == once, "a record changes when it is read again");
  });
}

}  // namespace softland::fuzz
