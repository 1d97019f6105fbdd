#include "reports/contact_states_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "base/require.h"
#include "base/shortened.h"
#include "config/assumed_spread.h"
#include "studies/closing/auto_settings.h"
#include "waveforms/export.h"
#include "waveforms/signal.h"

namespace softland {
namespace {

constexpr int resistance_digits = 6;

std::string contact_prefix(const StateChannel& one) { return one.contact.empty() ? std::string() : one.contact + "_"; }
std::string device_name(std::size_t device) { return fmt::format("device_{}", device); }
std::string prefix(const StateChannel& one) {
  return (one.device ? device_name(*one.device) + "_" : std::string()) + contact_prefix(one);
}

// Returns the contact resistance at a time by linear interpolation between points; the value is constant before and after them.
double on_line(const ResistanceLine& points, double time) {
  const auto to = std::ranges::upper_bound(points, time, {}, &std::pair<double, double>::first);
  if (to == points.begin()) return points.front().second;
  if (to == points.end()) return points.back().second;
  const auto [a, from] = *(to - 1);
  return std::lerp(from, to->second, (time - a) / (to->first - a));
}

// Reads the state of one contact (channel) at times that do not decrease.
class StateReader {
 public:
  explicit StateReader(const StateChannel& channel) : channel_(channel) {}
  /// Appends the value of the channel just before, or just after, a time.
  void append(std::string& text, double time, bool after) {
    const std::vector<ClosedSpan>& spans = channel_.spans;
    while (next_ < spans.size() && (after ? spans[next_].end <= time : spans[next_].end < time)) ++next_;
    const bool is_closed = next_ < spans.size() && (after ? spans[next_].begin <= time : spans[next_].begin < time);
    text += is_closed ? ",1" : ",0";
    if (!channel_.has_resistance) return;
    text += ',';
    if (is_closed && !spans[next_].resistance.empty())
      fmt::format_to(std::back_inserter(text), "{:.{}g}", on_line(spans[next_].resistance, time), resistance_digits);
  }

 private:
  const StateChannel& channel_;
  std::size_t next_ = 0;
};

// Converts seconds to whole picoseconds.
std::int64_t picoseconds(double time) { return std::llround(1e12 * time); }

// Returns the identifier of a variable in VCD: "!", "\"", ..., "~", "!!", from all printable characters.
std::string identifier(std::size_t number) {
  constexpr std::size_t first = 33, count = 94;
  std::string text;
  for (++number; number > 0; number = (number - 1) / count) text += static_cast<char>(first + (number - 1) % count);
  return text;
}

// A change of the variable number `place` in a value change dump.
struct DumpedChange {
  std::int64_t time = 0;  // time of the change [ps]
  std::size_t place = 0;
  std::string text;
};

// Writes the changes of a value change dump in order of time. Of several changes of a variable within a picosecond, only the
// last one is written.
std::string text_of(std::vector<DumpedChange> changes) {
  std::ranges::stable_sort(changes, {}, [](const DumpedChange& one) { return std::pair(one.time, one.place); });
  std::string text;
  std::int64_t now = -1;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const auto& [time, place, what] = changes[k];
    if (k + 1 < changes.size() && changes[k + 1].time == time && changes[k + 1].place == place) continue;
    if (time != now) text += now < 0 ? "#0\n$dumpvars\n" : fmt::format("{}#{}\n", now == 0 ? "$end\n" : "", time);
    now = time;
    text += what;
  }
  return text + (now == 0 ? "$end\n" : "");
}

void dump_state(const StateChannel& one, std::size_t place, std::vector<DumpedChange>& changes) {
  const auto set = [&](double time, int state) {
    changes.push_back({picoseconds(time), place, fmt::format("{}{}\n", state, identifier(place))});
  };
  set(0, 0);
  for (const ClosedSpan& span : one.spans) {
    set(span.begin, 1);
    if (std::isfinite(span.end)) set(span.end, 0);
  }
}

void dump_resistance(const StateChannel& one, std::size_t place, std::vector<DumpedChange>& changes) {
  constexpr double step = 0.05;  // relative step of the contact resistance beyond which the dump has a new value
  const auto set = [&](double time, double resistance) {
    changes.push_back({picoseconds(time), place, fmt::format("r{:.{}g} {}\n", resistance, resistance_digits, identifier(place))});
  };
  set(0, open_resistance);
  for (const ClosedSpan& span : one.spans) {
    if (span.resistance.empty()) continue;
    auto [time, last] = span.resistance.front();
    set(time, last);
    for (const auto& [to, resistance] : span.resistance) {
      const double from = on_line(span.resistance, time), begin = time;
      while (std::abs(std::log(resistance / last)) >= step) {
        last *= resistance > last ? 1 + step : 1 / (1 + step);
        set(std::clamp(std::lerp(begin, to, (last - from) / (resistance - from)), begin, to), last);
      }
      time = to;
    }
    if (std::isfinite(span.end)) set(span.end, open_resistance);
  }
}

// Returns the state or the resistance of a channel as a piecewise linear signal. SPICE sources cannot jump: a jump becomes a
// short ramp (edge).
Signal on_edges(const StateChannel& one, bool is_resistance, double end) {
  // Duration of an edge [s]; largest half of an edge as a share of the time to the next jump, so that edges do not meet.
  constexpr double edge = 1e-9, share = 0.25;
  const auto value = [&](const ClosedSpan* span, double time) {
    if (!is_resistance) return span != nullptr ? 1.0 : 0.0;
    return span != nullptr && !span->resistance.empty() ? on_line(span->resistance, time) : open_resistance;
  };
  std::vector<std::pair<double, const ClosedSpan*>> jumps;
  for (const ClosedSpan& span : one.spans) {
    jumps.emplace_back(span.begin, &span);
    if (span.end < end) jumps.emplace_back(span.end, nullptr);
  }
  const bool begins_closed = !jumps.empty() && !(jumps.front().first > 0);
  const ClosedSpan* now = begins_closed ? jumps.front().second : nullptr;
  ResistanceLine points{{0, value(now, 0)}};
  const auto add_inside = [&](double until) {
    if (!is_resistance || now == nullptr) return;
    for (const auto& point : now->resistance)
      if (point.first > points.back().first && point.first < until) points.push_back(point);
  };
  double last = 0;
  for (std::size_t k = begins_closed ? 1 : 0; k < jumps.size(); ++k) {
    const auto [time, span] = jumps[k];
    const double next = k + 1 < jumps.size() ? jumps[k + 1].first : end;
    const double half = std::min({0.5 * edge, share * (time - last), share * std::max(0.0, next - time)});
    add_inside(time - half);
    points.emplace_back(time - half, value(now, time - half));
    points.emplace_back(time + half, value(span, time + half));
    now = span;
    last = time;
  }
  add_inside(end);
  return Signal::piecewise_linear(points, points.front().second);
}

}  // namespace

std::string contact_states_csv(const StateRecord& record) {
  std::vector<double> times{0, record.end}, jumps;
  std::size_t columns = 1;
  std::string text = "time_s";
  for (const StateChannel& one : record.channels) {
    text += fmt::format(",{}closed", prefix(one));
    if (one.has_resistance) text += fmt::format(",{}resistance_ohm", prefix(one));
    columns += one.has_resistance ? 2 : 1;
    for (const ClosedSpan& span : one.spans) {
      for (const double time : {span.begin, span.end})
        if (time > 0 && std::isfinite(time)) jumps.push_back(time);
      for (const auto& point : span.resistance) times.push_back(point.first);
    }
  }
  text += '\n';
  times.insert(times.end(), jumps.begin(), jumps.end());
  for (std::vector<double>* all : {&times, &jumps}) {
    std::ranges::sort(*all);
    all->erase(std::ranges::unique(*all).begin(), all->end());
  }
  constexpr std::size_t most = 50'000'000;
  require((times.size() + jumps.size()) * columns <= most, [&] {
    return fmt::format(
        "a table of {} columns and {} rows has more than {} numbers; a value change dump (vcd) has the changes alone", columns,
        times.size() + jumps.size(), most);
  });
  std::vector<StateReader> readers(record.channels.begin(), record.channels.end());
  const auto add_row = [&](double time, bool after) {
    fmt::format_to(std::back_inserter(text), "{}", time);
    for (StateReader& one : readers) one.append(text, time, after);
    text += '\n';
  };
  for (const double time : times) {
    if (std::ranges::binary_search(jumps, time)) add_row(time, false);
    add_row(time, true);
  }
  return text;
}

std::string contact_states_vcd(const StateRecord& record) {
  std::string text = fmt::format(
      "$version softland $end\n$comment 1 where a contact is closed, 0 where it is open; r{} where its resistance is that of an "
      "open one $end\n$timescale 1 ps $end\n$scope module softland $end\n",
      fmt::format("{:g}", open_resistance));
  std::vector<DumpedChange> changes;
  std::size_t place = 0;
  std::optional<std::size_t> module;
  for (const StateChannel& one : record.channels) {
    if (one.device != module) {
      if (module) text += "$upscope $end\n";
      text += fmt::format("$scope module {} $end\n", device_name(*one.device));
      module = one.device;
    }
    text += fmt::format("$var wire 1 {} {}closed $end\n", identifier(place), contact_prefix(one));
    dump_state(one, place++, changes);
    if (!one.has_resistance) continue;
    text += fmt::format("$var real 64 {} {}resistance_ohm $end\n", identifier(place), contact_prefix(one));
    dump_resistance(one, place++, changes);
  }
  if (module) text += "$upscope $end\n";
  text += "$upscope $end\n$enddefinitions $end\n" + text_of(std::move(changes));
  return text + fmt::format("#{}\n", picoseconds(record.end));
}

std::string contact_states_pwl(const StateRecord& record) {
  std::map<std::string, Signal> signals;
  for (const StateChannel& one : record.channels) {
    signals.emplace(prefix(one) + "closed", on_edges(one, false, record.end));
    if (one.has_resistance) signals.emplace(prefix(one) + "resistance_ohm", on_edges(one, true, record.end));
  }
  return spice_pwl(signals, record.end,
                   "States of contacts, one subcircuit each, 1 V where it is closed: Xname plus minus softland_closed; a "
                   "resistance is in volts per "
                   "ohm, for R='V(plus,minus)'");
}

std::string contact_states_text(const SceneFile& file, const ContactStatesRequest& request, const Progress& progress,
                                const NoteSink& note) {
  struct Writer {
    std::string_view name;
    std::string (*write)(const StateRecord&);
  };
  constexpr std::array writers{Writer{"csv", contact_states_csv}, Writer{"vcd", contact_states_vcd},
                               Writer{"pwl", contact_states_pwl}};
  const auto* const writer = std::ranges::find(writers, request.format, &Writer::name);
  require_field(writer != writers.end(), "contact-record", visible(request.format), [] { return "must be csv, vcd or pwl"; });
  require_request(!request.seed || request.devices,
                  [] { return fmt::format("{}: chooses devices: give {} as well", requested("seed"), requested("devices")); });
  if (!request.devices) return writer->write(contact_states(prepare_and_choose(file, false, progress), progress, note));
  SceneFile varied = file;
  if (assume_spread(varied)) note(std::string(assumed_prose));
  return writer->write(contact_states_of_devices(prepare_and_choose(varied, false, progress), *request.devices,
                                                 request.seed.value_or(1), request.jobs, progress, note));
}

}  // namespace softland
