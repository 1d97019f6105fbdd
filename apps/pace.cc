#include "apps/pace.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace softland::apps {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double Pace::to_compute() const {
  const auto taken = static_cast<double>(computed + reused), left = static_cast<double>(remaining);
  if (taken == 0) return unknown;
  const double share = static_cast<double>(reused) / taken;
  const auto rows_left = static_cast<double>(std::max<std::int64_t>(0, earlier - reused));
  return left - std::min(share * left, rows_left);
}

void WorkPace::note(std::string_view what, double part, double elapsed) {
  if (what != what_ || part < part_) {
    what_ = what;
    began_ = elapsed;
    first_part_ = part;
  }
  part_ = part;
}

std::optional<double> WorkPace::seconds_left(double elapsed) const {
  constexpr double least_done = 0.01;  // share of a stage to compute before its remaining time is estimated
  const double done = part_ - first_part_;
  if (done < least_done || part_ >= 1) return std::nullopt;
  return (elapsed - began_) * (1 - part_) / done;
}

std::string WorkPace::words(double elapsed) const {
  std::string text = fmt::format("{}: {:.0f} %, {:.0f} s", what_.value_or(""), 100 * std::clamp(part_, 0.0, 1.0), elapsed);
  if (const std::optional<double> left = seconds_left(elapsed)) text += fmt::format(", about {:.0f} s left", *left);
  return text;
}

double Pace::seconds_left() const { return computed > 0 ? to_compute() * seconds / static_cast<double>(computed) : unknown; }

}  // namespace softland::apps
