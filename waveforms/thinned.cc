#include "waveforms/thinned.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace softland {
namespace {

/// Chooses the rows of a voltage table that are kept: each straight line from a kept row reaches as far as the limit on the
/// integral of thinned less original voltage [V s] permits.
class Thinning {
 public:
  Thinning(const Table& table, double limit) : time_(table.time), voltage_(table.voltage), limit_(limit) {
    area_.resize(time_.size());
    for (std::size_t i = 1; i < time_.size(); ++i)
      area_[i] = area_[i - 1] + (voltage_[i - 1] + voltage_[i]) / 2 * (time_[i] - time_[i - 1]);
  }

  /// Returns the row of the voltage table to keep after the row `from`, and adds the interval between both rows to the integral
  /// of thinned less original voltage.
  std::size_t next(std::size_t from) {
    constexpr std::size_t growth = 4, least_window = 8;
    const std::size_t farthest = std::min(from + growth * last_length_ + least_window, jump_after(from));
    std::size_t to = from + 1;
    for (std::size_t j = farthest; j > from + 1; --j) {
      if (std::abs(excess_ + excess_to(from, j)) <= limit_ && stays_within(from, j)) {
        to = j;
        break;
      }
    }
    excess_ += excess_to(from, to);
    largest_ = std::max(largest_, std::abs(excess_));
    last_length_ = to - from;
    return to;
  }
  [[nodiscard]] double largest_excess() const { return largest_; }

 private:
  /// Returns the first row after `from` at which the voltage jumps (the next row has the same time), or the last row.
  std::size_t jump_after(std::size_t from) {
    if (jump_ <= from) {
      jump_ = from + 1;
      while (jump_ + 1 < time_.size() && time_[jump_ + 1] > time_[jump_]) ++jump_;
      if (time_[from + 1] == time_[from]) jump_ = from + 1;
    }
    return jump_;
  }
  /// Returns the integral of the straight line from row i to row j, less the integral of the voltage table [V s].
  [[nodiscard]] double excess_to(std::size_t i, std::size_t j) const {
    return (voltage_[i] + voltage_[j]) / 2 * (time_[j] - time_[i]) - (area_[j] - area_[i]);
  }
  bool stays_within(std::size_t i, std::size_t j) {
    const double slope = (voltage_[j] - voltage_[i]) / (time_[j] - time_[i]);
    double before = 0, largest = 0;  // thinned less original voltage at the previous row [V]; largest |integral| [V s]
    for (std::size_t k = i + 1; k <= j; ++k) {
      const double line = voltage_[i] + slope * (time_[k] - time_[i]), difference = line - voltage_[k];
      double excess = excess_ + (voltage_[i] + line) / 2 * (time_[k] - time_[i]) - (area_[k] - area_[i]);
      // Between two rows |integral of the voltage difference| is largest where the difference changes its sign.
      double most = std::abs(excess);
      if (before * difference < 0) {
        const double share = difference / (difference - before);
        excess -= difference * share * (time_[k] - time_[k - 1]) / 2;
        most = std::max(most, std::abs(excess));
      }
      if (most > limit_) return false;
      largest = std::max(largest, most);
      before = difference;
    }
    largest_ = std::max(largest_, largest);
    return true;
  }

  const std::vector<double>& time_;
  const std::vector<double>& voltage_;
  double limit_;
  std::vector<double> area_;
  double excess_ = 0, largest_ = 0;
  std::size_t last_length_ = 1, jump_ = 0;
};

}  // namespace

Thinned thinned(const Table& table, double time_constant, double largest_error) {
  const std::size_t count = table.time.size();
  if (count < 3) return {.table = table};
  Thinning thinning(table, largest_error * time_constant / 2);
  Thinned made;
  for (std::size_t row = 0;; row = thinning.next(row)) {
    made.table.time.push_back(table.time[row]);
    made.table.voltage.push_back(table.voltage[row]);
    if (row + 1 == count) break;
  }
  made.error = 2 * thinning.largest_excess() / time_constant;
  return made;
}

}  // namespace softland
