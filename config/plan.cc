#include "config/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/printable.h"
#include "base/random.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/trimmed.h"
#include "config/plan_entry.h"
#include "config/scene_file_impl.h"

namespace softland {

using namespace internal;

namespace {

constexpr std::uint64_t most_searched = 10'000'000;

/// Returns read(). If read() throws InvalidInput, puts the place of the plan's entry (option, or file and line) in front of the
/// message.
template <class Read>
auto at_place(const PlanRequest& request, std::string_view key, std::size_t number, Read&& read) {
  try {
    return read();
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{}: {}", request.place(key, number), printable_line(error.what())));
  }
}

/// Splits an entry "KEY=VALUES" or "KEY*KEY=VALUES" of a plan into the name of its variable and the text of the values.
std::pair<std::string, std::string> name_and_values(const std::string& entry) {
  const std::size_t equals = entry.find('=');
  require(equals != std::string::npos && equals > 0,
          "must be KEY=LOW:HIGH:N, KEY=LOW:HIGH:N:log or KEY=A,B,C, or KEY*KEY=VALUES with the values of one factor");
  std::string name;
  for (const std::string& key : split_trimmed(std::string_view(entry).substr(0, equals), '*'))
    name += (name.empty() ? "" : "*") + key;
  return {name, entry.substr(equals + 1)};
}

}  // namespace

std::string PlanVariable::unit() const { return unit_symbol(dimension); }

Plan::Plan(const PlanRequest& request)
    : base_(canonical(request.scene, "scene")),
      study_(request.study),
      options_(request.options),
      seed_(request.seed),
      pareto_(request.pareto) {
  if (!request.columns.empty()) {
    require(request.sample.empty() && request.vary.empty(),
            [&] { return fmt::format("{}: gives all points: nothing else may vary or be sampled", request.place("list", 0)); });
    read_rows(request);
  } else {
    if (!request.sample.empty()) at_place(request, "sample", 0, [&] { read_sample(request); });
    at_place(request, is_search_ ? "sample" : "pareto", 0, [&] {
      require(is_search_ == !pareto_.empty(),
              "a search for a Pareto front needs both its figures (pareto) and its number of points (sample nsga2:N)");
    });
    read_variables(request);
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    for (const PlanKey& key : variables_[i].keys) {
      require(seen.insert(fmt::format("{}[{}]", key.path, key.element)).second, [&] {
        return fmt::format("{}: {} varies already", request.place(request.columns.empty() ? "vary" : "list", i), key.path);
      });
    }
  }
  count_points();
  text_ = canonical_text();
}

void Plan::read_sample(const PlanRequest& request) {
  const std::vector<std::string> parts = split_trimmed(request.sample, ':');
  const bool is_latin = parts.front() == "lhs";
  is_search_ = parts.front() == "nsga2";
  const Named<PointSet>* kind = find_named(point_sets, is_latin ? "latin_hypercube" : is_search_ ? "sobol" : parts.front());
  require(kind != nullptr && parts.size() == 2, "must be sobol:N, lhs:N or, for a Pareto front, nsga2:N with N points");
  const auto count = whole_number(parts[1]);
  require(count && *count >= 1 && *count <= SamplePoints::largest_size, [&] {
    return fmt::format("'{}' must be a whole number of points from 1 to {}", shortened(parts[1]), SamplePoints::largest_size);
  });
  sample_ = kind->value;
  points_ = *count;
}

void Plan::read_variables(const PlanRequest& request) {
  const KeyFinder finder(base_);
  for (std::size_t i = 0; i < request.vary.size(); ++i) {
    at_place(request, "vary", i, [&] {
      const auto [name, values] = name_and_values(request.vary[i]);
      EntryReader reader(finder, name);
      std::vector<std::string> range = split_trimmed(values, ':');
      if (range.size() > 1) {
        variables_.push_back(std::move(reader).of_range(std::move(range), sample_.has_value()));
      } else {
        require(!sample_, "must be KEY=LOW:HIGH where points are sampled");
        variables_.push_back(std::move(reader).of_list(split_trimmed(values, ',')));
      }
    });
  }
  require(!variables_.empty() || !sample_,
          [&] { return fmt::format("{}: there is nothing to sample: give --vary KEY=LOW:HIGH", request.place("sample", 0)); });
}

void Plan::read_rows(const PlanRequest& request) {
  const KeyFinder finder(base_);
  std::vector<double> scale;
  at_place(request, "list", 0, [&] {
    for (const std::string& column : request.columns) {
      // A column name is a key and its unit, "electrode.main.span[2] [um]". A blank distinguishes the bracket of the unit from
      // that of a list element.
      const std::size_t bracket = column.find(" [");
      const std::string name(trimmed(std::string_view(column).substr(0, bracket)));
      std::string unit;
      if (bracket != std::string::npos) {
        require(column.ends_with(']'), [&] { return fmt::format("'{}' must be KEY or KEY [UNIT]", shortened(column)); });
        unit = column.substr(bracket + 2, column.size() - bracket - 3);
      }
      variables_.push_back(EntryReader(finder, name).of_list({"1 " + unit}));
      require(variables_.back().words.empty(), [&] { return fmt::format("{} must be a number", name); });
      scale.push_back(variables_.back().values.front());
      variables_.back().values.clear();
    }
  });
  for (const std::vector<double>& row : request.rows) {
    std::vector<double> values;
    for (std::size_t i = 0; i < row.size(); ++i) {
      // Conversion to SI units ends with a rounding to 15 digits, so that 245 [um] becomes the double nearest to 245e-6.
      values.push_back(scale[i] == 1 ? row[i] : in_few_digits(row[i] * scale[i]));
      require(!variables_[i].is_whole || values.back() == std::round(values.back()), [&] {
        return fmt::format("{}: {} = {} must be a whole number", request.place("list", 0), variables_[i].name, values.back());
      });
    }
    rows_.push_back(std::move(values));
  }
  require(!rows_.empty(), [&] { return fmt::format("{}: must have at least one row of points", request.place("list", 0)); });
}

void Plan::count_points() {
  if (!rows_.empty()) {
    points_ = rows_.size();
  } else if (is_search_) {
    require(points_ <= most_searched, [&] { return fmt::format("a search must have at most {} points", most_searched); });
  } else if (sample_) {
    sampled_.emplace(*sample_, variables_.size(), seed_, Stream::plan, points_);
  } else {
    for (const PlanVariable& variable : variables_) {
      require(points_ <= most_points / variable.values.size(),
              [&] { return fmt::format("the plan must have at most {} points", most_points); });
      points_ *= variable.values.size();
    }
  }
}

std::vector<double> Plan::values_in_box(std::vector<double> place) const {
  for (std::size_t i = 0; i < place.size(); ++i) {
    const PlanVariable& v = variables_[i];
    place[i] = v.is_whole ? std::min(v.high, std::floor(v.low + place[i] * (v.high - v.low + 1))) : between(v, place[i]);
  }
  return place;
}

std::vector<double> Plan::values(std::uint64_t k) const {
  require(k < points_, [&] { return fmt::format("point {} must be below {}: points are counted from 0", k, points_); });
  require(!is_search_, "the points of a search for a Pareto front are not known before they are computed");
  if (!rows_.empty()) return rows_[k];
  std::vector<double> values(variables_.size());
  if (sampled_) {
    sampled_->point(k, values);
    return values_in_box(std::move(values));
  }
  for (std::size_t i = values.size(); i-- > 0;) {
    const std::vector<double>& all = variables_[i].values;
    values[i] = all[k % all.size()];
    k /= all.size();
  }
  return values;
}

SceneFile Plan::scene(const std::vector<double>& values) const {
  SceneFile file = base_;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const PlanVariable& variable = variables_[i];
    for (const PlanKey& key : variable.keys) {
      if (!variable.words.empty()) {
        const std::string& word = variable.words.at(static_cast<std::size_t>(values[i]) - 1);
        const bool is_flag = word == "true" || word == "false";
        file.assign(key.path, is_flag ? SceneValue(word == "true") : SceneValue(word));
      } else if (variable.is_whole && !variable.is_factor) {
        file.assign(key.path, static_cast<int>(values[i]));
      } else if (variable.is_factor) {
        file.assign(key.path, {.value = key.base.value * values[i], .dimension = key.base.dimension}, key.element);
      } else {
        file.assign(key.path, {.value = values[i], .dimension = variable.dimension}, key.element);
      }
    }
  }
  return file;
}

std::string Plan::canonical_text() const {
  const auto list = [](const auto& all, auto&& text) {
    std::string joined;
    for (const auto& one : all) joined += (joined.empty() ? "" : ", ") + text(one);
    return "[" + joined + "]";
  };
  std::string text = fmt::format("[{}]\nstudy = {}\n", plan_section, internal::toml_string(study_));
  std::vector<std::string> others;
  for (const auto& [name, value] : options_) {
    if (std::ranges::find(plan_options, name) != std::end(plan_options))
      text += fmt::format("{} = {}\n", name, internal::toml_string(value));
    else
      others.push_back(internal::toml_string(name + "=" + value));
  }
  if (!others.empty()) text += fmt::format("options = {}\n", list(others, [](const std::string& one) { return one; }));
  text += fmt::format("seed = \"{}\"\n", seed_);
  if (sample_)
    text += fmt::format("sample = \"{}:{}\"\n",
                        is_search_                              ? "nsga2"
                        : *sample_ == PointSet::latin_hypercube ? "lhs"
                                                                : name_of(point_sets, *sample_),
                        points_);
  if (is_search_) text += fmt::format("pareto = {}\n", internal::toml_string(pareto_));
  if (!rows_.empty()) {
    text += fmt::format("columns = {}\nrows = {}\n",
                        list(variables_,
                             [](const PlanVariable& v) {
                               return internal::toml_string(v.unit().empty() ? v.name : fmt::format("{} [{}]", v.name, v.unit()));
                             }),
                        list(rows_, [&](const std::vector<double>& row) {
                          return list(row, [](double value) { return internal::inline_text(toml::value<double>(value)); });
                        }));
  } else {
    text += fmt::format("vary = {}\n", list(variables_, [&](const PlanVariable& v) {
                          const std::string log = v.is_logarithmic ? ":log" : "";
                          const std::string factor = v.is_factor && v.keys.size() == 1 ? " %" : "";
                          const auto number = [&](double value) {
                            return factor.empty() ? value_text(v, value) : percent_text(value);
                          };
                          if (sample_)
                            return internal::toml_string(fmt::format("{}={}:{}{}", v.name, number(v.low), number(v.high), log));
                          std::vector<std::string> values;
                          for (const double value : v.values) values.push_back(number(value));
                          return internal::toml_string(fmt::format("{}={}", v.name, fmt::join(values, ",")));
                        }));
  }
  return text + fmt::format("scene_text = {}\n", internal::toml_string(base_.text()));
}

}  // namespace softland
