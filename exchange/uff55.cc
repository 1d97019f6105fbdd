// Reads vibration modes in the Universal File Format: data sets 55 (motion of nodes), 15 or 2411 (positions of nodes) and 164
// (units).
//
// Numbers are in columns of 13 or more characters; there may be no blank between them, so that only a sign separates them.
// Source: Structural Dynamics Research Corporation, Universal File Datasets 15, 55, 164, 2411.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <complex>
#include <numbers>
#include <unordered_map>

#include "base/engineering.h"
#include "base/printable.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "exchange/cells.h"
#include "exchange/decoding.h"
#include "exchange/layout.h"
#include "exchange/nodal_modes.h"

namespace softland::internal {
namespace {

/// Motion of the mesh nodes in one mode, which one data set 55 gives.
struct Set55 {
  double frequency = 0, modal_mass = 0;
  long long mode = 0;
  std::vector<long long> nodes;
  std::vector<Vector3> motion;
};

class Uff55Reader {
 public:
  Uff55Reader(std::string_view text, const std::string& file) : lines_(text), refusals_(file) {}

  NodalModes read() {
    made_.format = "UFF 55";
    while (lines_.next()) {
      if (trimmed(lines_.line()).empty()) continue;
      if (!is_mark()) fail("expected the mark -1 before a data set");
      if (!lines_.next()) break;
      const std::string_view kind = trimmed(lines_.line()).substr(0, trimmed(lines_.line()).find(' '));
      if (kind == "55") {
        read_modes();
      } else if (kind == "2411" || kind == "15") {
        read_nodes(kind == "15");
      } else if (kind == "164") {
        read_units();
      } else {
        made_.left_out.push_back(fmt::format("data set {}", printable_line(shortened(kind, 10))));
        while (lines_.next() && !is_mark()) continue;
      }
    }
    join();
    return std::move(made_);
  }

 private:
  bool is_mark() const { return trimmed(lines_.line()) == "-1"; }
  [[noreturn]] void fail(const std::string& rule) const { refusals_.fail(lines_.number(), 0, rule); }
  void due(const char* what) {
    if (!lines_.next() || is_mark()) fail(fmt::format("the data set ends before {}", what));
  }

  // Returns the numbers of a line. Numbers may follow each other without a blank: a sign begins a new number unless it belongs
  // to an exponent. Exponents may be written with D.
  std::vector<double> numbers() const {
    std::vector<double> all;
    std::string text(lines_.line());
    std::replace(text.begin(), text.end(), 'D', 'E');
    const std::string_view whole = text;
    for (std::size_t begin = 0; begin < whole.size();) {
      if (whole[begin] == ' ' || whole[begin] == '\t') {
        ++begin;
        continue;
      }
      std::size_t end = begin + 1;
      while (end < whole.size() && whole[end] != ' ' && whole[end] != '\t' &&
             ((whole[end] != '-' && whole[end] != '+') || whole[end - 1] == 'E' || whole[end - 1] == 'e'))
        ++end;
      const std::optional<double> value = plain_decimal(whole.substr(begin, end - begin));
      if (!value) fail(fmt::format("\"{}\" must be a finite number", shown_cell(whole.substr(begin, end - begin))));
      all.push_back(*value);
      begin = end;
    }
    return all;
  }
  std::vector<long long> integers() const {
    std::vector<long long> all;
    for (const double value : numbers()) {
      if (value != std::round(value) || std::abs(value) > 1e15) fail(fmt::format("{} must be a whole number", value));
      all.push_back(static_cast<long long>(value));
    }
    return all;
  }

  void add_node(long long number, const Vector3& place) {
    if (!places_.emplace(number, place).second) fail(fmt::format("node {} is given twice", number));
  }

  // Reads mesh nodes. Data set 15 has number, two coordinate systems, colour and position on one line; 2411 has the position on
  // a second line.
  void read_nodes(bool in_one_line) {
    while (true) {
      if (!lines_.next()) fail("the file ends within the nodes");
      if (is_mark()) return;
      std::vector<double> all = numbers();
      if (all.empty()) fail("expected a node");
      const double number = all[0];
      if (number != std::round(number) || std::abs(number) > 1e15) fail("the number of a node must be a whole number");
      if (all.size() > 1 && all[1] > 1)
        made_.notes.emplace_back("all positions are assumed to be in one coordinate system, although nodes name several");
      if (in_one_line) {
        if (all.size() != 7) fail(fmt::format("a node must have seven numbers, but has {}", all.size()));
        add_node(static_cast<long long>(number), {all[4], all[5], all[6]});
        continue;
      }
      if (all.size() != 4) fail(fmt::format("a node must have four numbers and three in the next line, but has {}", all.size()));
      due("the position of a node");
      all = numbers();
      if (all.size() != 3) fail(fmt::format("a position must have three numbers, but has {}", all.size()));
      add_node(static_cast<long long>(number), {all[0], all[1], all[2]});
    }
  }

  // Reads the units of the file. Dividing positions by the factor of length converts them to metres.
  void read_units() {
    due("the name of the units");
    due("the factors of the units");
    const std::vector<double> factors = numbers();
    if (factors.empty() || !(factors[0] > 0)) fail("the factor of length must be positive");
    made_.length_unit = 1 / factors[0];
    while (lines_.next() && !is_mark()) continue;
  }

  void read_modes() {
    constexpr int names = 5;
    for (int k = 0; k < names; ++k) due("its five lines of names");
    due("its kind");
    const std::vector<long long> kind = integers();
    if (kind.size() < 6) fail("the kind of a data set 55 must have six numbers");
    const long long analysis = kind[1], characteristic = kind[2], type = kind[4], per_node = kind[5];
    if (analysis != 2 && analysis != 3 && analysis != 7)
      fail(fmt::format("the data set must be of the analysis type of a mode (2, 3 or 7), but has {}", analysis));
    if (characteristic != 2 && characteristic != 3)
      fail(fmt::format("the data must be motion (kind 2 or 3), but have kind {}", characteristic));
    if (type != 2 && type != 5) fail(fmt::format("numbers must be real (type 2) or complex (type 5), but have type {}", type));
    if (per_node < 3 || per_node > 6) fail(fmt::format("a node must have three or six numbers, but has {}", per_node));
    due("the numbers of its mode");
    const std::vector<long long> of_mode = integers();
    if (of_mode.size() < 4 || of_mode[0] != static_cast<long long>(of_mode.size()) - 2)
      fail("expected the number of integers and of reals, the load case and the mode");
    std::vector<double> reals;
    const auto count = static_cast<std::size_t>(std::clamp(of_mode[1], 1LL, 60LL));
    while (reals.size() < count) {
      due("its frequency");
      for (const double value : numbers()) reals.push_back(value);
    }
    const bool is_normal = analysis == 2;
    if (reals.size() != count || count < (is_normal ? 1U : 2U))
      fail(fmt::format("the mode has {} numbers; it must have {}, beginning with the frequency", reals.size(), of_mode[1]));
    Set55 set{.mode = of_mode[3]};
    // The eigenvalue of a complex mode is an angular frequency in rad/s.
    set.frequency = is_normal ? reals[0] : std::hypot(reals[0], reals[1]) / (2 * std::numbers::pi);
    set.modal_mass = is_normal && reals.size() > 1 ? reals[1] : 0;
    if (!(set.frequency >= 0)) fail("the frequency must not be negative");
    read_motion(set, static_cast<std::size_t>(per_node), type == 5);
    sets_.push_back(std::move(set));
  }

  void read_motion(Set55& set, std::size_t per_node, bool is_complex) {
    const std::size_t count = per_node * (is_complex ? 2 : 1);
    std::vector<std::vector<std::complex<double>>> values;
    while (true) {
      if (!lines_.next()) fail(fmt::format("the file ends within mode {}: the mark -1 is missing", set.mode));
      if (is_mark()) break;
      const std::vector<long long> node = integers();
      if (node.size() != 1) fail("expected the number of a node");
      if (std::find(set.nodes.begin(), set.nodes.end(), node[0]) != set.nodes.end() && set.nodes.size() < 2000)
        fail("this node is given twice");
      std::vector<double> row;
      while (row.size() < count) {
        due("the motion of its last node");
        for (const double value : numbers()) row.push_back(value);
      }
      if (row.size() != count) fail(fmt::format("the node has {} numbers; it must have {}", row.size(), count));
      set.nodes.push_back(node[0]);
      std::vector<std::complex<double>> of_node;
      for (std::size_t k = 0; k < 3; ++k)
        of_node.push_back(is_complex ? std::complex(row[2 * k], row[2 * k + 1]) : std::complex(row[k]));
      values.push_back(std::move(of_node));
    }
    if (set.nodes.empty()) fail("a data set 55 must have a node");
    put_in_phase(set, values);
  }

  void put_in_phase(Set55& set, const std::vector<std::vector<std::complex<double>>>& values) {
    constexpr double rounding = 1e-6;
    std::complex<double> squares = 0;
    double whole = 0, outside = 0;
    for (const auto& node : values) {
      for (const std::complex<double>& v : node) squares += v * v, whole += std::norm(v);
    }
    const bool is_real = squares.imag() == 0 && squares.real() >= 0;
    const std::complex<double> turn = is_real ? 1.0 : std::polar(1.0, -std::arg(squares) / 2);
    for (const auto& node : values) {
      Vector3 motion{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::complex<double> v = is_real ? node[k] : node[k] * turn;
        motion[k] = v.real();
        outside += v.imag() * v.imag();
      }
      set.motion.push_back(motion);
    }
    if (whole > 0 && std::sqrt(outside / whole) > rounding)
      made_.notes.push_back(fmt::format("{1:.2g} % of the complex mode {0}, which is out of phase, is left out", set.mode,
                                        100 * std::sqrt(outside / whole)));
  }

  void join() {
    if (sets_.empty())
      refusals_.fail(fmt::format("the file must have modes (data set 55){}",
                                 made_.left_out.empty() ? "" : ", but " + made_.left_out.front()));
    std::vector<std::string> frequencies;
    for (const Set55& set : sets_) frequencies.push_back(engineering(set.frequency, "Hz", 6));
    if (places_.empty())
      refusals_.fail(
          fmt::format("UFF 55: the file has modes of {} at {} nodes, but no positions of the nodes: "
                      "export data set 2411 or 15 into the same file",
                      fmt::join(frequencies, ", "), sets_.front().nodes.size()));
    std::unordered_map<long long, std::size_t> indices;
    for (const long long node : sets_.front().nodes) {
      const auto found = places_.find(node);
      if (found == places_.end())
        refusals_.fail(fmt::format("node {} has a motion, but lacks a position (data set 2411 or 15)", node));
      if (!indices.emplace(node, made_.nodes.size()).second)
        refusals_.fail(fmt::format("node {} is given twice in a data set 55", node));
      made_.nodes.push_back(found->second);
    }
    bool all_say = true;
    for (Set55& set : sets_) {
      if (set.nodes.size() != made_.nodes.size())
        refusals_.fail(
            fmt::format("mode {} has {} nodes, but the first mode has {}", set.mode, set.nodes.size(), made_.nodes.size()));
      NodalMode mode{.frequency = set.frequency, .modal_mass = set.modal_mass, .name = fmt::format("mode {}", set.mode)};
      mode.motion.assign(made_.nodes.size(), no_motion);
      std::vector<bool> given(made_.nodes.size());
      for (std::size_t i = 0; i < set.nodes.size(); ++i) {
        const auto found = indices.find(set.nodes[i]);
        if (found == indices.end() || given[found->second])
          refusals_.fail(
              fmt::format("mode {} must have the nodes of the first mode in their order, but has node {} in another place",
                          set.mode, set.nodes[i]));
        given[found->second] = true;
        mode.motion[found->second] = set.motion[i];
      }
      all_say = all_say && set.modal_mass > 0;
      made_.modes.push_back(std::move(mode));
    }
    if (all_say) made_.normalised_by = "the modal mass of each data set";
    std::sort(made_.notes.begin(), made_.notes.end());
    made_.notes.erase(std::unique(made_.notes.begin(), made_.notes.end()), made_.notes.end());
  }

  Lines lines_;
  Refusals refusals_;
  NodalModes made_;
  std::unordered_map<long long, Vector3> places_;
  std::vector<Set55> sets_;
};

}  // namespace

NodalModes read_uff55(std::string_view content, const std::string& file) { return Uff55Reader(content, file).read(); }

}  // namespace softland::internal
