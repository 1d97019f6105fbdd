// Verb `status`: shows the progress of studies.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/stores.h"
#include "apps/verbs/verbs.h"
#include "base/printable.h"
#include "base/shortened.h"
#include "document/quantity.h"

namespace softland::apps {
namespace {

using nlohmann::json;

struct StatusRequest {
  std::string store;
  std::vector<std::string> more;
};

/// The state of a study (exploration or search), read from its database file.
struct State {
  std::string file;
  StoredPlan plan;
  std::int64_t points = 0, done = 0;
  std::map<std::string, std::int64_t> by_status;
  std::vector<StoredSession> sessions;
  std::optional<std::string> writer;

  [[nodiscard]] std::string part() const { return fmt::format("{}/{}", plan.shard.index, plan.shard.count); }
  /// Returns the number of rows of the database file that the last run of the study stored per second [1/s]; NaN if unknown.
  [[nodiscard]] double rate() const {
    const StoredSession& last = sessions.back();
    return last.rows > 0 && last.seconds > 0 ? static_cast<double>(last.rows) / last.seconds
                                             : std::numeric_limits<double>::quiet_NaN();
  }
};

State state_of(const std::string& file) {
  const StudyReader store(file);
  State state{.file = file,
              .plan = store.plan(),
              .points = store.plan().shard.size(store.plan().points),
              .done = 0,
              .by_status = store.by_status(),
              .sessions = store.sessions(),
              .writer = writer_of(file)};
  for (const auto& [status, rows] : state.by_status) state.done += rows;
  return state;
}

std::string text_of(const State& s) {
  std::string text = fmt::format("{}: {} of {} points", printable_line(s.file), whole(s.done), whole(s.points));
  if (s.plan.shard.count > 1) text += fmt::format(", part {} of {}", s.part(), whole(s.plan.points));
  text += "\n";
  for (const auto& [status, rows] : s.by_status) text += fmt::format("  {:<20} {:>9}\n", printable_line(status), whole(rows));
  text += fmt::format("  plan                 {}, seed {}\n", content_key(s.plan.text).hexadecimal(), s.plan.seed);
  const StoredSession& last = s.sessions.back();
  text += fmt::format("  last run             {} rows", whole(last.rows));
  if (const double rate = s.rate(); std::isfinite(rate)) {
    text += fmt::format(" in {}, {} per s", duration_prose(last.seconds), internal::plain_number(rate));
    if (s.writer && s.done < s.points)
      text += fmt::format(", {} left", duration_prose(static_cast<double>(s.points - s.done) / rate));
  }
  text += fmt::format("\n                       until {} UTC on {}, run {}\n", last.last, printable_line(last.host),
                      s.sessions.size());
  text += fmt::format("  command              {}\n", shortened(printable_line(last.command), 200));
  text += fmt::format("  program              {}\n", printable_line(last.program));
  return text + fmt::format("  written now by       {}\n", s.writer ? printable_line(*s.writer) : "nobody");
}

json json_of(const State& s) {
  json sessions = json::array();
  for (const StoredSession& one : s.sessions) {
    sessions.push_back({{"program", one.program},
                        {"processor", one.processor},
                        {"command", one.command},
                        {"host", one.host},
                        {"process", one.process},
                        {"began", one.began},
                        {"last", one.last},
                        {"seconds", one.seconds},
                        {"rows", one.rows}});
  }
  const double rate = s.rate();
  return {{"store", s.file},
          {"plan", content_key(s.plan.text).hexadecimal()},
          {"seed", s.plan.seed},
          {"shard", s.part()},
          {"points", s.points},
          {"done", s.done},
          {"by_status", s.by_status},
          {"rate_1_s", std::isfinite(rate) ? json(rate) : json()},
          {"writer", s.writer ? json(*s.writer) : json()},
          {"sessions", sessions}};
}

int status_verb(const Common& c, const StatusRequest& request) {
  static_cast<void>(reserve_outputs(c, {}));
  std::vector<std::string> files{request.store};
  files.insert(files.end(), request.more.begin(), request.more.end());
  std::string text;
  json stores = json::array();
  std::int64_t points = 0, done = 0;
  for (const std::string& file : files) {
    const State state = state_of(file);
    points += state.points;
    done += state.done;
    text += text_of(state);
    stores.push_back(json_of(state));
  }
  if (files.size() > 1) text += fmt::format("{} stores: {} of {} points\n", files.size(), whole(done), whole(points));
  print_json_or(c, {{"stores", stores}, {"points", points}, {"done", done}}, text);
  return exit_done;
}

}  // namespace

void add_status(Verb& verb) {
  const auto request = std::make_shared<StatusRequest>();
  verb.positional("STORE", request->store, "store of a study, even while another process writes to it");
  verb.more("STORES", request->more, "further stores");
  verb.with_json();
  verb.footer("Example:\n  softland status map-parts/*.sqlite");
  verb.runs([request](const Common& common) { return status_verb(common, *request); });
}

}  // namespace softland::apps
