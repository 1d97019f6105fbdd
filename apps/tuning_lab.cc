#include "apps/tuning_lab.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/child_process.h"
#include "apps/line_reader.h"
#include "apps/streams.h"
#include "base/csv.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "base/write_whole.h"
#include "config/quantity_argument.h"
#include "document/quantity.h"
#include "reports/scene_export.h"
#include "verbs/options.h"

namespace softland::apps {
namespace {

using internal::plain_number;
using internal::quantity;
using std::chrono::milliseconds;

class CommandLab final : public TuningLab {
 public:
  CommandLab(const std::string& command, milliseconds patience)
      : name_("--device " + shortened(command)), patience_(patience), child_(command, longest_line) {}

  std::optional<ContactRecord> fire(const CommandedShot& shot, const SentSignals&) override {
    // The command may close its input after it has written its answer: read the answer before reporting a closed pipe.
    const ChildProcess::Delivery delivery = child_.tell(line_text(shot_json(shot)), patience_);
    if (delivery == ChildProcess::Delivery::late) throw late(fmt::format("did not read shot {}", shot.number));
    const LineReader::Line line = child_.next_line(patience_);
    if (line.end == LineReader::End::closed) throw ended_before(shot.number);
    if (line.end == LineReader::End::late) throw late(fmt::format("did not answer shot {}", shot.number));
    try {
      return read_record(read_line(line.text), shot.number, shot.duration());
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{}: invalid answer to shot {}: {}", name_, shot.number, error.what()));
    }
  }

  void finish() override { (void)child_.tell(line_text(end_json()), patience_); }

 private:
  [[nodiscard]] InvalidInput ended_before(int shot) {
    constexpr milliseconds to_end{500};
    const std::string ending = child_.ending(to_end);
    return InvalidInput(fmt::format("{}: {} before it answered shot {}", name_,
                                    ending.empty() ? "closed its standard input or output" : ending, shot));
  }
  [[nodiscard]] InvalidInput late(const std::string& what) const {
    return InvalidInput(fmt::format("{}: {} within {}; a longer --timeout waits longer", name_, what,
                                    quantity(static_cast<double>(patience_.count()) / 1000, "s")));
  }

  std::string name_;
  milliseconds patience_;
  ChildProcess child_;
};

// Thrown when the user answers "stop" instead of reporting what the device did.
struct Stopped {};

class HandLab final : public TuningLab {
 public:
  // Remove the files of shots (voltages for one closing each) of an earlier tuning, unless that tuning is continued.
  HandLab(HandLabRequest request, const PreparedScene& scene) : request_(std::move(request)), scene_(scene) {
    if (request_.goes_on) return;
    const std::vector<std::string> endings = sent_endings(scene_);
    std::vector<std::filesystem::path> left;
    for (const auto& entry : std::filesystem::directory_iterator(request_.folder)) {
      if (is_shot(entry.path().filename().string(), endings)) left.push_back(entry.path());
    }
    for (const std::filesystem::path& file : left) std::filesystem::remove(file);
  }

  std::optional<ContactRecord> fire(const CommandedShot& shot, const SentSignals& sent) override {
    std::vector<std::string> files;
    for (const SentFile& file : sent_files(request_.format, scene_, sent, shot.duration())) {
      const std::filesystem::path path = request_.folder / fmt::format("shot-{}{}", shot.number, file.ending);
      write_whole(path, file.text);
      files.push_back(path.string());
    }
    std::string before;
    for (const auto& [drive, amplifier] : sent.amplifiers) {
      if (request_.format != "codes")
        before += fmt::format(", {} in volts at the input of an amplifier of gain {}", drive, plain_number(amplifier, 6));
    }
    print_note(
        fmt::format("shot {}: load {} into the generator{}, play the waveform once, "
                    "and record the contact for {} from the start of the waveform",
                    shot.number, fmt::join(files, " and "), before, quantity(shot.duration(), "s")));
    try {
      return asked(shot);
    } catch (const Stopped&) {
      return std::nullopt;
    }
  }

 private:
  // Returns true if `name` is the file of a shot (voltages of one closing), such as "shot-12.csv" or "shot-12-main.arb".
  [[nodiscard]] static bool is_shot(std::string_view name, const std::vector<std::string>& endings) {
    constexpr std::string_view before = "shot-";
    if (!name.starts_with(before)) return false;
    name.remove_prefix(before.size());
    const std::size_t digits = std::min(name.size(), name.find_first_not_of("0123456789"));
    return digits > 0 && std::ranges::find(endings, name.substr(digits)) != endings.end();
  }
  [[nodiscard]] ContactRecord asked(const CommandedShot& shot) {
    ContactRecord record = answer<ContactRecord>(
        R"(at what time after the start of the waveform did the contact first close? Answer a time such as "36.1 us"; "never"; )"
        R"("file NAME" for a file with all edges; "failed" to repeat the shot; "stop" to end)",
        [&](const std::string& text) { return closing(text, shot.duration()); });
    if (record.closing_time) {
      record.bounce_count = answer<std::optional<int>>(
          R"(how often did the contact open again after that? Answer a number such as 0; "?" if unknown; "stop" to end)", count);
    }
    return record;
  }

  [[nodiscard]] ContactRecord closing(const std::string& text, double duration) const {
    if (text == "never") return {};
    if (text == "failed") return {.error = "the shot failed"};
    if (text.starts_with("file ")) {
      const std::string file(trimmed(std::string_view(text).substr(5)));
      return request_.contact ? read_contact_trace(file, *request_.contact) : read_edges_file(file);
    }
    const Quantity time = quantity_with_unit(text, dimension::time);
    if (time.dimension != dimension::time || !(time.value > 0))
      throw InvalidInput(fmt::format("{}: must be a time with its unit, such as \"36.1 us\"", visible(text)));
    if (time.value > duration)
      throw InvalidInput(
          fmt::format("{}: must not be after the end of the record, which is {} long", visible(text), quantity(duration, "s")));
    return {.closing_time = time.value};
  }

  static std::optional<int> count(const std::string& text) {
    if (text == "?") return std::nullopt;
    return verbs::whole_number<int>("bounces:", text, {.least = 0});
  }

  template <class Answer>
  Answer answer(const std::string& question, const std::function<Answer(const std::string&)>& read) {
    for (;;) {
      print_note(question);
      const LineReader::Line line = lines_.next();
      const std::string text(trimmed(line.text));
      if (line.end == LineReader::End::closed || text == "stop") throw Stopped();
      try {
        return read(text);
      } catch (const InvalidInput& error) {
        print_note(error.what());
      }
    }
  }

  HandLabRequest request_;
  const PreparedScene& scene_;
  LineReader lines_{STDIN_FILENO, std::size_t{1} << 12};
};

}  // namespace

std::unique_ptr<TuningLab> command_lab(const std::string& command, milliseconds patience) {
  return std::make_unique<CommandLab>(command, patience);
}

std::unique_ptr<TuningLab> hand_lab(HandLabRequest request, const PreparedScene& scene) {
  return std::make_unique<HandLab>(std::move(request), scene);
}

ContactRecord read_edges_file(const std::string& file) {
  ContactRecord record;
  read_csv(read_file(file), file, {"time_s", "closed"}, "time_s and closed",
           [&](std::span<const double> row, const CsvPlace& place) {
             require(row[1] == 0 || row[1] == 1, [&] { return fmt::format("{}: closed = {}: must be 1 or 0", place(), row[1]); });
             record.edges.push_back({.time = row[0], .closed = row[1] == 1});
           });
  const std::string fault = record_fault(record);
  require(fault.empty(), [&] { return fmt::format("{}: {}", file, fault); });
  return record;
}

ContactRecord read_contact_trace(const std::string& file, const ContactTraceKeys& keys) {
  ContactRecord record;
  for (const LevelEdge& edge : contact_edges(file, keys)) record.edges.push_back({.time = edge.time, .closed = edge.closed});
  return record;
}

}  // namespace softland::apps
