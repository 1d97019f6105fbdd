#include "reports/tuning_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/output_lost.h"
#include "base/read_file.h"
#include "base/require.h"

namespace softland {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Returns the first unused file name among closings-1.jsonl, closings-2.jsonl, ...
fs::path free_name(const fs::path& file) {
  std::error_code ignored;
  for (int k = 1;; ++k) {
    fs::path name = file.parent_path() / fmt::format("{}-{}{}", file.stem().string(), k, file.extension().string());
    if (!fs::exists(name, ignored)) return name;
  }
}

void require_origin(const json& line, const json& origin, const std::string& place) {
  require(line.contains(origin_key), [&] { return place + ": must be the log of a tuning"; });
  for (const auto& [key, value] : origin.items()) {
    const json known = line[origin_key].value(key, json());
    require(known == value, [&, &key = key, &value = value] {
      return fmt::format("{}: its closings are of another {}: {} instead of {}; name another folder with --out", place, key,
                         known.dump(), value.dump());
    });
  }
}

}  // namespace

TuningLog::TuningLog(fs::path file, const json& origin, bool resume) : file_(std::move(file)) {
  std::error_code ignored;
  const bool exists = fs::exists(file_, ignored);
  require_request(exists || !resume,
                  [&] { return fmt::format("{}: {}: there is no such file", requested("resume"), file_.string()); });
  std::size_t size = 0;
  if (resume) {
    size = read(origin);
  } else if (exists) {
    kept_aside_ = free_name(file_);
    fs::rename(file_, kept_aside_);
  }
  open(size);
  if (size == 0) write({{origin_key, origin}});
}

TuningLog::~TuningLog() { ::close(descriptor_); }

// Reads all complete lines of the log and returns their number of bytes. An incomplete last line, as after a power cut, is
// ignored.
std::size_t TuningLog::read(const json& origin) {
  const std::string content = read_file(file_);
  const std::size_t size = content.rfind('\n') + 1;  // without a line feed, rfind() returns npos, and npos + 1 is 0
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < size; begin = content.find('\n', begin) + 1) {
    const std::string_view text = std::string_view(content).substr(begin, content.find('\n', begin) - begin);
    const std::string place = fmt::format("{}:{}", file_.string(), ++number);
    try {
      const json line = read_line(text);
      if (number == 1) {
        require_origin(line, origin, place);
        continue;
      }
      if (line.contains("recipes")) {
        recipes_ = read_recipes(line);
        continue;
      }
      require(line.contains("shot") && line.contains("record"), "must have shot and record");
      const CommandedShot shot = read_shot(line["shot"]);
      closings_.push_back(
          {.shot = line["shot"], .record = read_record(line["record"], shot.number, shot.duration()), .line = number});
    } catch (const InvalidInput& error) {
      if (std::string_view(error.what()).starts_with(place)) throw;
      throw InvalidInput(fmt::format("{}: {}", place, error.what()));
    }
  }
  return size;
}

void TuningLog::open(std::size_t size) {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const bool opened = descriptor_ >= 0 && ::ftruncate(descriptor_, static_cast<off_t>(size)) == 0;
  if (!opened) throw OutputLost(fmt::format("{}: cannot be written: {}", file_.string(), std::generic_category().message(errno)));
}

void TuningLog::write(const json& line) {
  const std::string text = line_text(line);
  std::string_view rest = text;
  const auto lost = [&] {
    return OutputLost(fmt::format("{}: cannot be written: {}", file_.string(), std::generic_category().message(errno)));
  };
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw lost();
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(descriptor_) != 0) throw lost();
}

void TuningLog::append(const std::vector<CandidateWaveform>& recipes) { write(recipes_json(recipes)); }

void TuningLog::append(const CommandedShot& shot, const ContactRecord& record) {
  write({{"shot", shot_json(shot)}, {"record", record_json(shot.number, record)}});
}

std::string TuningLog::place(const Closing& closing) const { return fmt::format("{}:{}", file_.string(), closing.line); }

}  // namespace softland
