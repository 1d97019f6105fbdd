#include "reports/check_report.h"

#include <fmt/format.h>

#include "base/printable.h"
#include "base/shortened.h"
#include "document/text.h"
#include "reports/pull_in_members.h"
#include "studies/closing/summits_at_hold.h"

namespace softland {

using nlohmann::json;

namespace {

// Returns pull-in voltages as JSON. A single electrode has no name in JSON; several electrodes are distinguished by name.
json by_electrode(const std::map<std::string, PullInRecord>& all) {
  json of = json::object();
  for (const auto& [name, one] : all) of[name] = internal::record_json(one);
  return all.empty() ? json() : all.size() == 1 ? of.front() : of;
}

std::map<std::string, PullInRecord> read_by_electrode(const json& from) {
  if (!from.is_object()) return {};
  if (from.contains("static_V")) return {{"", internal::read_json<PullInRecord>(from)}};
  return internal::read_json<std::map<std::string, PullInRecord>>(from);
}

}  // namespace

void members(internal::Archive& a, CheckRecord::Line& line) {
  a("name", line.name, "name of the number");
  a("value", line.value, "its value as text");
}

void members(internal::Archive& a, CheckRecord::Rest& rest) {
  a("far_end_rise_m", rest.far_end_rise, "rise of the far end above the straight shape");
  a("far_end_gap_m", rest.far_end_gap, "distance of the far end to the electrode");
  a("contact_rise_m", rest.contact_rise, "rise at the first contact above the straight shape");
  a("contact_gap_m", rest.contact_gap, "distance at the first contact to the contact plane");
  a("least_electrode_gap_m", rest.least_gap, "smallest gap to the electrodes");
}

void members(internal::Archive& a, CheckRecord& record) {
  members(a, record.origin);
  a.derived("status", std::string(to_string(Status::done)), "`done`");
  a("file", record.file, "scene file, as it was given");
  a("title", record.title, "title of the scene");
  a("natural_frequencies_rad_s", record.frequencies, "natural angular frequencies");
  a("rest_shape", record.rest_shape, "shape at rest, if it is not straight");
  a.custom("pull_in", record.pull_in, by_electrode, read_by_electrode,
           internal::OneOrMore<PullInRecord>{"pull-in voltages of the electrode"});
  a("hold_window_V", record.hold_windows, "by electrode, release voltage and voltage of the collapse onto it");
  a("dynamic_precision", record.dynamic_precision, "relative precision of the dynamic voltages");
  a("closed_state", internal::OrNull{record.closed_state}, "closed equilibrium under the hold levels");
  a("stable_path", internal::OrNull{record.stable_path}, "path of stable equilibria to the contact");
  a("duration_s", record.duration, "simulated time");
  a("tolerance", record.tolerance, "relative tolerance of the integrator");
  a("warnings", record.warnings, "warnings");
  a("lines", record.lines, "derived numbers, as `check` prints them");
}

json json_of(const CheckRecord& record) { return internal::record_json(record); }

CheckRecord read_check(const json& from) { return internal::whole_record<CheckRecord>(from); }

std::string text_of(const CheckRecord& record) {
  const std::string title = shortened(printable_line(record.title));
  std::string text = fmt::format("{}: valid{}\n\n", printable_line(record.file), title.empty() ? "" : " (" + title + ")");
  for (const CheckRecord::Line& line : record.lines) text += fmt::format("{:<20} {}\n", line.name, line.value);
  for (const std::string& warning : record.warnings) {
    if (is_few_summits_warning(warning)) continue;  // the line about the contact states this already
    text += "\n" + wrapped("warning: " + warning) + "\n";
  }
  return text;
}

}  // namespace softland
