#include "reports/generator_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/choice.h"
#include "base/require.h"
#include "config/quantity_argument.h"
#include "document/quantity.h"
#include "reports/closing_prose.h"
#include "reports/closing_record.h"
#include "studies/closing/simulate.h"

namespace softland {
namespace {

using internal::plain_number;
using internal::quantity;

// Returns sample rate and resolution of a voltage source as text: "27 MS/s, 14 bit".
std::string words(const DriverModel& source) {
  const std::string rate = internal::given_quantity(*source.sample_rate, "S/s");
  return source.bits ? fmt::format("{}, {} bit", rate, *source.bits) : rate;
}

std::string clause(const PreparedScene& p, const Closing& closing) {
  return internal::closing_clause({.subject = "the switch"}, record_of(p, closing, {}, false).best, p.duration);
}

// Returns true if the closing under the samples of a waveform does not settle although the closing under the scene's waveform
// settles, or if the closing under the samples bounces more often and higher.
bool is_worse(const Metrics& sampled, const Metrics& drawn) {
  if (drawn.settled && !sampled.settled) return true;
  constexpr double noticeable = 1.05;
  return sampled.bounce_count > drawn.bounce_count && sampled.major_bounce_height > noticeable * drawn.major_bounce_height;
}

}  // namespace

std::vector<std::string> exported_drives(const PreparedScene& p, const std::string& named) {
  const std::vector<std::string> names = p.drive_names();
  const std::vector<Signal> commanded = p.commanded(p.waveforms());
  std::vector<std::string> driven, all;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == dispersion_drive) continue;
    all.push_back(names[k]);
    if (!commanded[k].is_zero()) driven.push_back(names[k]);
  }
  if (named.empty()) return driven;
  require_field(std::ranges::find(all, named) != all.end(), "drive", named,
                [&] { return fmt::format("unknown drive; choose one of {}", fmt::join(all, ", ")); });
  return {named};
}

double amplification(const Drive& drive, const Sampling& sampling) {
  if (!sampling.amplifier) return drive.amplifier.value_or(1);
  const double factor = quantity_argument(requested("amplifier"), *sampling.amplifier, dimension::none);
  require_field(factor > 0, "amplifier", "0", [] { return "must be above 0: volts at the switch per volt of the generator"; });
  return factor;
}

std::string amplifier_prose(const Drive& drive, double factor) {
  if (factor == 1 && drive.amplifier.value_or(1) == 1) return {};
  const bool is_other = drive.amplifier && *drive.amplifier != factor;
  return fmt::format(
      "amplifier of drive '{}': voltages in the file are those at the switch divided by {}{}", drive.name,
      plain_number(factor, 6),
      is_other ? fmt::format(", not by the {} of [driver.{}]", plain_number(*drive.amplifier, 6), drive.name) : "");
}

void set_sampling(SceneFile& file, const std::vector<std::string>& drives, const Sampling& sampling) {
  // Errors about keys of the scene are reported as errors of the options that set these keys.
  const auto set = [&](std::string_view option, const std::string& told, const std::string& assignment,
                       const std::string& drive) {
    try {
      file.set(assignment);
      static_cast<void>(read_scene(file));
    } catch (const InvalidInput& error) {
      const std::string said = error.what(), before = fmt::format("--set {}: ", assignment);
      if (!said.starts_with(before)) throw;
      throw InvalidRequest(
          fmt::format("{} {}: [driver.{}] {}", requested(option), visible(told), drive, said.substr(before.size())));
    }
  };
  for (const std::string& drive : drives) {
    if (const auto& rate = sampling.rate)
      set("sample-rate", *rate, fmt::format("driver.{}.sample_rate=\"{}\"", drive, *rate), drive);
    if (const auto& bits = sampling.bits) set("bits", *bits, fmt::format("driver.{}.bits={}", drive, *bits), drive);
  }
}

void require_samples(std::string_view format, const std::string& drive, const DriverModel& source) {
  require_field(source.sample_rate.has_value(), "format", format, [&] {
    return fmt::format("drive '{}' takes no samples: give {}, or [driver.{}] a sample_rate", drive, requested("sample-rate"),
                       drive);
  });
}

std::string generator_text(const GeneratorFormat& format, const PreparedScene& p, const std::string& drive,
                           const Signal& commanded, const Sampling& sampling) {
  const DriverModel& source = p.drives.at(drive).source;
  require_samples(format.name, drive, source);
  const double rate = *source.sample_rate;
  const double factor = amplification(p.drives.at(drive), sampling);
  GeneratorSamples samples{.name = drive, .rate = rate};
  const double last = std::round(commanded.pieces().back().begin * rate);
  for (double k = 0; k <= last; ++k) samples.volts.push_back(commanded.voltage(k / rate) / factor);
  if (sampling.marker) {
    const double at = std::round(quantity_argument(requested("marker"), *sampling.marker, dimension::time) * rate);
    require_field(at >= 0 && at <= last, "marker", *sampling.marker,
                  [&] { return fmt::format("must be within the waveform, 0 to {}", quantity(last / rate, "s")); });
    samples.marker = static_cast<std::size_t>(at);
  }
  return generator_file(format, std::move(samples));
}

std::vector<std::string> sampled_prose(const PreparedScene& sampled, const PreparedScene* drawn, const std::string& drive,
                                       const Progress& progress) {
  const Closing as_sampled = simulate(sampled, false, progress);
  std::vector<std::string> all{fmt::format("as sampled ({}), the nominal design behaves as follows: {}",
                                           words(sampled.drives.at(drive).source), clause(sampled, as_sampled))};
  if (drawn == nullptr) return all;
  const Closing as_drawn = simulate(*drawn, false, progress);
  if (is_worse(as_sampled.metrics, as_drawn.metrics))
    all.push_back(
        fmt::format("warning: without sampling, {}. To keep that, use a higher rate, more bits, or a search with this [driver]",
                    clause(*drawn, as_drawn)));
  return all;
}

}  // namespace softland
