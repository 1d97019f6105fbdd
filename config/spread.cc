#include "config/spread.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <variant>

#include "base/csv.h"
#include "base/random.h"
#include "base/read_file.h"
#include "base/require.h"
#include "config/drives.h"
#include "config/section_reader.h"
#include "config/spread_reader.h"

namespace softland {

void DeviceSpread::leave_out(std::size_t variable) {
  std::vector<Eigen::Index> rest;
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    if (i != static_cast<Eigen::Index>(variable)) rest.push_back(i);
  }
  variables.erase(variables.begin() + static_cast<std::ptrdiff_t>(variable));
  correlate(Eigen::MatrixXd(correlation(rest, rest)));
}

void DeviceSpread::correlate(const Eigen::MatrixXd& matrix) {
  correlation = matrix;
  copula.reset();
  if (correlation.isIdentity(0)) return;
  std::vector<std::string> names;
  for (const SpreadVariable& variable : variables) names.push_back(variable.name);
  copula.emplace(correlation, names);
}

void DeviceSpread::to_values(std::span<double> u) const {
  if (copula) copula->correlate(u);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (!variables[i].is_drawn_per_edge) u[i] = variables[i].distribution.quantile(u[i]);
  }
}

bool DeviceSpread::varies_drives() const {
  return std::any_of(variables.begin(), variables.end(), [](const SpreadVariable& variable) {
    return std::any_of(variable.keys.begin(), variable.keys.end(), [](const VariedKey& key) { return key.drive.has_value(); });
  });
}

double DeviceSpread::jitter(const SpreadVariable& variable, double x, std::uint64_t edge) {
  return variable.distribution.quantile(random_probability(std::bit_cast<std::uint64_t>(x), Stream::jitter, edge));
}

namespace internal {
namespace {

/// A key of the scene that an entry of [spread] varies, and the dimensions that its value may have.
struct FoundKey {
  VariedKey varied;
  std::vector<Dimension> dimensions;
};

std::function<std::string(double)> refusal_outside(const Range& range, const std::string& unit, std::string_view beyond = {}) {
  return [range, unit, beyond](double value) {
    if (range.contains(value)) return std::string();
    return beyond.empty() ? range.rule(unit) : fmt::format("{}; {}", range.rule(unit), beyond);
  };
}

struct DriveErrorRow {
  DriveError value;
  std::string_view name;
  double nominal;  // value of the source's error in the nominal design if the scene gives none [SI unit]
  Dimension dimension;
};
constexpr std::array drive_errors{
    DriveErrorRow{DriveError::gain, "gain", 1, dimension::none},
    DriveErrorRow{DriveError::offset, "offset", 0, dimension::voltage},
    DriveErrorRow{DriveError::delay, "delay", 0, dimension::time},
    DriveErrorRow{DriveError::jitter, "jitter", 0, dimension::time},
};
static_assert(is_complete<drive_errors>());

/// Returns the error of a drive's voltage source that an entry of [spread] varies. Throws InvalidInput unless the source has
/// this error.
FoundKey find_drive_error(const SceneFile::Impl& file, const Device& device, const SectionReader& in,
                          const std::vector<std::string>& parts) {
  const std::string name = fmt::format("{}", fmt::join(parts, "."));
  const auto fail = [&](const std::string& why) {
    file.fail_section(in.path(), fmt::format("'{}' is not an error of a drive, such as driver.main.gain{}", name, why));
  };
  if (parts.size() != 3) fail("");
  if (parts[1] == dispersion_drive) fail(": the dispersion force has no source");
  if (const std::string why = why_no_drive(device, parts[1]); !why.empty()) fail(": " + why);
  const auto* error = find_named(drive_errors, parts[2]);
  if (error == nullptr) fail(hint(parts[2], names_of(drive_errors)));
  const SectionReader of_drive(file, parts[0], parts[1]);
  const bool is_given = of_drive.is_present() && error->value != DriveError::jitter && of_drive.is_given(error->name);
  // Only the gain must stay in the range of its key. Offset, delay and jitter of a device may have either sign.
  const Key* const key = find_section(parts[0])->find(error->name);
  const Key any_value;
  const Key& ranged = error->value == DriveError::gain ? *key : any_value;
  return {.varied = {.path = name,
                     .unit = unit_symbol(error->dimension),
                     .nominal = is_given ? of_drive.number(error->name) : error->nominal,
                     .measured_in = error->dimension,
                     .member = {},
                     .drive = VariedDrive{.name = parts[1], .error = error->value},
                     .refusal = refusal_outside(ranged.range_of(error->dimension), unit_symbol(error->dimension), ranged.beyond)},
          .dimensions = {error->dimension}};
}

/// Returns true when an end of a span is written as "tip", the end of the beam.
bool is_tip(const SceneFile::Impl& file, const std::vector<std::string>& path, std::size_t element) {
  const toml::node* node = file.find(path);
  const toml::node* end = node != nullptr && node->is_array() ? node->as_array()->get(element - 1) : nullptr;
  return end != nullptr && end->is_string() && end->as_string()->get() == tip;
}

/// Returns the key that an entry of [spread] varies. Throws InvalidInput unless the key has a number in this scene.
FoundKey find_key(const SceneFile::Impl& file, Scene& scene, const SectionReader& in, const std::string& name) {
  std::vector<std::string> parts;
  const auto [path, given_element] = without_element(name);
  const std::size_t element = given_element.value_or(0);
  try {
    parts = split_path(path);
  } catch (const InvalidInput& error) {
    file.fail_section(in.path(), error.what());
  }
  if (parts.front() == "driver" && element == 0) return find_drive_error(file, scene.device, in, parts);
  std::vector<std::string_view> candidates;
  const std::string entry_name = parts.size() > 1 ? parts[1] : std::string();
  const Section* section = find_section(parts.front(), entry_name);
  const bool named = section && file.is_named(*section);
  const std::size_t depth = named ? 3 : 2;
  if (section && section->may_vary && parts.size() >= depth && file.find({parts.begin(), parts.end() - 1})) {
    const SectionReader of_section(file, parts[0], named ? entry_name : std::string());
    const auto holder = of_section.holder(std::span(parts).subspan(depth - 1));
    if (!holder) file.fail_section(in.path(), fmt::format("'{}' is not a key of this scene", name));
    const SectionReader& of_key = holder->first;
    for (const Key& key : of_key.keys()) {
      const std::size_t size =
          key.bound.element != nullptr && of_key.has_value(key.name) ? of_key.quantities(key.name).size() : 0;
      // A list that cannot vary is a candidate too, so that the message below says why it cannot, not that the key is unknown.
      const bool is_fixed_list = key.type == KeyType::quantities && !key.why_fixed.empty();
      const bool is_number =
          is_fixed_list                   ? true
          : key.type == KeyType::quantity ? element == 0
          : key.bound.element != nullptr
              ? (of_key.is_list(key.name) ? element >= 1 && element <= size : element == 0)
              : key.bound.place != nullptr && element >= 1 && element <= key.count && !of_key.is_nested(key.name);
      if (is_number && of_key.find(key.name) == &key && of_key.has_value(key.name)) candidates.push_back(key.name);
    }
    if (std::find(candidates.begin(), candidates.end(), parts.back()) != candidates.end()) {
      const Key& key = *of_key.find(parts.back());
      if (!key.why_fixed.empty()) file.fail_section(in.path(), fmt::format("{} cannot vary: {}", name, key.why_fixed));
      if (element > 0 && is_tip(file, parts, element)) {
        file.fail_section(
            in.path(),
            fmt::format(
                "{} is the tip of the beam in every device: write a length or a percentage of structure.length there to let it "
                "vary",
                name));
      }
      const Quantity given = of_key.quantities(key.name)[element == 0 ? 0 : element - 1];
      FoundKey found{.varied = {.path = path,
                                .element = element,
                                .unit = unit_symbol(given.dimension),
                                .nominal = given.value,
                                .measured_in = given.dimension,
                                .member = {},
                                .drive = {},
                                .refusal = {}},
                     .dimensions = {given.dimension}};
      if (key.bound.number != nullptr || key.bound.place != nullptr || key.bound.element != nullptr) {
        std::size_t entry = holder->second;
        if (section->name == "electrode") {
          const auto& all = scene.device.electrodes;
          while (entry < all.size() && all[entry].name != entry_name) ++entry;
        } else if (section->name == "contact") {
          const auto& all = scene.device.contacts;
          while (entry + 1 < all.size() && all[entry].name != entry_name) ++entry;
        }
        found.varied.member = [bound = key.bound, entry, element = element](Scene& s) -> double& {
          if (bound.number != nullptr) return bound.number(s, entry);
          if (bound.element != nullptr) return bound.element(s, entry, element > 0 ? element - 1 : 0);
          return bound.place(s, entry, element > 0 ? element - 1 : 0).value;
        };
      }
      found.varied.refusal = refusal_outside(key.range_of(given.dimension), found.varied.unit);
      return found;
    }
  }
  file.fail_section(in.path(), fmt::format("'{}' is not a key of this scene that holds one number of the device{}", name,
                                           hint(parts.back(), candidates)));
}

/// Converts the numbers of an entry of [spread], such as a standard deviation, to the unit of the varied quantity. This is the
/// SI unit of the varied key; a quantity that is a factor on the keys has no unit.
class EntryUnits {
 public:
  EntryUnits(const SectionReader& in, const std::vector<FoundKey>& keys) : in_(in), keys_(keys) {
    for (const std::string_view key :
         {"standard_deviation", "half_width", "low", "mode", "high", "truncate_low", "truncate_high"}) {
      if (in.is_given(key)) check(key, in.quantities(key).front().dimension);
    }
    if (in.is_given("values")) {
      for (const Quantity& one : in.quantities("values")) check("values", one.dimension);
    }
    if (in.is_given("unit")) check("unit", unit().dimension);
    if (in.is_given("weights")) {
      check_weights();
      return;
    }
    if (is_factor_) return;
    in_.require(ratio_.empty() || nominal() != 0, ratio_, "is relative to the value in the scene, which is 0: give it a unit");
    const auto& first = keys_.front().varied.drive;
    const bool are_one_error = first && std::all_of(keys_.begin(), keys_.end(), [&](const FoundKey& key) {
                                 return key.varied.drive && key.varied.drive->error == first->error;
                               });
    in_.require(keys_.size() == 1 || are_one_error, blamed_,
                "several keys vary by one factor: give a percentage, or weights with which one amount is added to each key");
  }

  [[nodiscard]] bool is_factor() const { return is_factor_; }
  [[nodiscard]] bool is_added() const { return in_.is_given("weights"); }
  /// Returns the value of the variable in the nominal design: 1 for a factor, 0 for an added amount, or the value of its key.
  [[nodiscard]] double nominal() const { return is_factor_ ? 1 : is_added() ? 0 : keys_.front().varied.nominal; }
  [[nodiscard]] double of(const Quantity& q) const {
    return is_factor_ || q.dimension != dimension::none ? q.value : q.value * keys_.front().varied.nominal;
  }
  [[nodiscard]] double of(std::string_view key) const { return of(in_.quantities(key).front()); }
  /// Returns the absolute value of a key that gives the width of a distribution, such as its standard deviation.
  [[nodiscard]] double width(std::string_view key) const { return std::abs(of(key)); }
  [[nodiscard]] double of(std::string_view key, double otherwise) const { return in_.is_given(key) ? of(key) : otherwise; }

  /// Returns one unit of the values in the file of an empirical distribution, as the key `unit` names it.
  [[nodiscard]] Quantity unit() const {
    try {
      return parse_quantity("1 " + in_.text("unit"));
    } catch (const InvalidInput& error) {
      in_.file().fail(in_.path("unit"), error.what());
    }
  }

 private:
  // Checks the weights with which a varied amount is added to several keys of the same unit.
  void check_weights() const {
    const std::vector<Quantity> weights = in_.quantities("weights");
    in_.require(weights.size() == keys_.size(), "weights",
                fmt::format("must be one weight for each key, but there are {} for {} keys", weights.size(), keys_.size()));
    in_.require(std::all_of(weights.begin(), weights.end(), [](const Quantity& one) { return one.value != 0; }), "weights",
                "must not be 0");
    in_.require(!is_factor_ && ratio_.empty() && !in_.is_given("cov"), "weights",
                "add an amount to the keys: give the numbers of its distribution with a unit");
    for (const FoundKey& key : keys_) {
      const bool fits = !key.varied.drive && key.varied.measured_in == keys_.front().varied.measured_in;
      in_.require(fits, "keys",
                  fmt::format("one amount cannot be added to {} and {}", keys_.front().varied.name(), key.varied.name()));
    }
  }
  // Checks the dimension of a quantity in an entry of [spread]: a plain number is relative to the varied key's value, any other
  // quantity must have the dimension of the varied key.
  void check(std::string_view key, const Dimension& given) {
    if (given == dimension::none) {
      ratio_ = key;
      return;
    }
    const std::vector<Dimension>& allowed = keys_.front().dimensions;
    const bool is_share = keys_.front().varied.element > 0 && allowed.front() == dimension::none;
    in_.require(
        !is_share, key,
        fmt::format(
            "{} is a percentage of structure.length in this scene: give a percentage of it here too, or write a length there",
            keys_.front().varied.name()));
    in_.require(std::find(allowed.begin(), allowed.end(), given) != allowed.end(), key,
                fmt::format("expected {}, got {}", describe(allowed.front()), describe(given)));
    is_factor_ = false;
    blamed_ = key;
  }

  const SectionReader& in_;
  const std::vector<FoundKey>& keys_;
  bool is_factor_ = true;
  std::string_view blamed_, ratio_;
};

/// Returns the values of an empirical distribution from a file, in the unit of the file.
std::vector<double> file_values(const SectionReader& in) {
  const std::string& name = in.text("file");
  in.require(!name.empty() && name.find('\0') == std::string::npos, "file", "must be the name of a file");
  if (!in.is_given("column")) in.fail("missing key 'column': it names the column of the file that holds the values");
  const std::string path = (in.file().directory / name).string(), &column = in.text("column");
  std::vector<double> values;
  try {
    read_csv(read_file(path), path, {column}, fmt::format("names of columns, \"{}\" among them", column),
             [&](std::span<const double> row, const CsvPlace&) { values.push_back(row[0]); });
  } catch (const InvalidInput& error) {
    in.file().fail(in.path("file"), error.what());
  }
  return values;
}

Distribution::Parameters parameters_of(const SectionReader& in, const EntryUnits& scale) {
  const double mean = scale.nominal();
  const auto deviation = [&] {
    return in.is_given("cov") ? in.number("cov") * std::abs(mean) : scale.width("standard_deviation");
  };
  switch (find_named(distribution_kinds, in.text("distribution"))->value) {
    case DistributionKind::normal:
      return Normal{.mean = mean, .standard_deviation = deviation()};
    case DistributionKind::lognormal:
      return Lognormal{.mean = mean, .standard_deviation = deviation()};
    case DistributionKind::uniform: {
      const double half =
          in.is_given("half_width") ? scale.width("half_width") : std::sqrt(3.0) * in.number("cov") * std::abs(mean);
      return Uniform{.low = mean - half, .high = mean + half};
    }
    case DistributionKind::triangular:
      return Triangular{.low = scale.of("low"), .mode = scale.of("mode", mean), .high = scale.of("high")};
    case DistributionKind::empirical:
      break;
  }
  Empirical all;
  if (in.is_given("values")) {
    for (const Quantity& one : in.quantities("values")) all.values.push_back(scale.of(one));
  } else {
    const Quantity unit = in.is_given("unit") ? scale.unit() : Quantity{.value = 1, .dimension = dimension::none};
    for (const double value : file_values(in))
      all.values.push_back(scale.of({.value = value * unit.value, .dimension = unit.dimension}));
  }
  return all;
}

/// Returns the key of [spread.NAME] that sets a parameter of its distribution.
std::string_view key_of_parameter(const SectionReader& in, std::string_view parameter) {
  for (const std::string_view key :
       {parameter, std::string_view("cov"), std::string_view("half_width"), std::string_view("file")}) {
    if (in.find(key) != nullptr && in.is_given(key)) return key;
  }
  return "distribution";
}

SpreadVariable read_variable(const SceneFile::Impl& file, Scene& scene, const std::string& name) {
  const SectionReader in(file, "spread", name);
  std::vector<std::string> paths{name};
  if (in.is_given("keys")) {
    paths = in.texts("keys");
    in.require(!paths.empty(), "keys", "must name at least one key");
    in.require(std::set<std::string>(paths.begin(), paths.end()).size() == paths.size(), "keys", "names a key twice");
  }
  std::vector<FoundKey> keys;
  for (const std::string& path : paths) keys.push_back(find_key(file, scene, in, path));
  const EntryUnits scale(in, keys);
  SpreadVariable variable{.name = name,
                          .keys = {},
                          .is_factor = scale.is_factor(),
                          .is_added = scale.is_added(),
                          .distribution = Distribution(Normal{1, 1})};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    FoundKey& key = keys[i];
    const VariedKey& varied = key.varied;
    if (scale.is_added()) key.varied.weight = in.quantities("weights")[i].value;
    if (scale.is_factor() && varied.nominal == 0) {
      in.fail(varied.drive ? fmt::format("{} is nominally 0, so that no factor changes it: give its distribution in {}",
                                         varied.name(), varied.unit)
                           : fmt::format("{} is 0 in this scene, so that no factor changes it{}", varied.name(),
                                         varied.unit.empty() ? "" : ": give it a standard_deviation in " + varied.unit));
    }
    if (varied.drive && varied.drive->error == DriveError::jitter) {
      // The value of a jitter variable on a device is the seed of random delays, not a delay itself, so any value is valid.
      variable.is_drawn_per_edge = true;
      key.varied.refusal = [](double) { return std::string(); };
    }
    variable.keys.push_back(std::move(key.varied));
  }
  try {
    variable.distribution = Distribution(parameters_of(in, scale), {.low = scale.of("truncate_low", Truncation{}.low),
                                                                    .high = scale.of("truncate_high", Truncation{}.high)});
  } catch (const InvalidParameter& error) {
    file.fail(in.path(key_of_parameter(in, error.parameter())), error.what());
  }
  for (const VariedKey& key : variable.keys) {
    if (!key.drive || key.drive->error != DriveError::gain) continue;
    const double median = DeviceSpread::value(variable, key, variable.distribution.quantile(0.5));
    if (const std::string rule = key.refusal(median); !rule.empty())
      in.fail(fmt::format("the median of {} is {}: {}", key.name(), median, rule));
  }
  return variable;
}

/// Reads the correlations of the varied quantities, [[first, second, correlation], ...].
void read_correlation(const SceneFile::Impl& file, DeviceSpread& spread) {
  const auto count = static_cast<Eigen::Index>(spread.variables.size());
  spread.correlation = Eigen::MatrixXd::Identity(count, count);
  const toml::node* node = file.find({"spread", std::string(correlation_key)});
  if (node == nullptr) return;
  const std::string path = join_path("spread", correlation_key);
  const auto require_that = [&](bool holds, std::string_view rule) {
    if (!holds) file.fail(path, rule);
  };
  constexpr std::string_view form = R"(expected a list such as [["structure.thickness", "gaps", 0.3]])";
  const toml::array* pairs = node->as_array();
  require_that(pairs != nullptr, form);
  std::vector<std::string_view> known;
  std::vector<std::string> names;
  for (const SpreadVariable& variable : spread.variables) {
    known.push_back(variable.name);
    names.push_back(variable.name);
  }
  for (const toml::node& element : *pairs) {
    const toml::array* pair = element.as_array();
    require_that(pair != nullptr && pair->size() == 3 && pair->get(0)->is_string() && pair->get(1)->is_string() &&
                     pair->get(2)->is_number(),
                 form);
    std::array<Eigen::Index, 2> at{};
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string& name = pair->get(i)->as_string()->get();
      const auto found = std::find(names.begin(), names.end(), name);
      require_that(found != names.end(), fmt::format("'{}' does not vary{}", name, hint(name, known)));
      at[i] = found - names.begin();
      require_that(!spread.variables[static_cast<std::size_t>(at[i])].is_drawn_per_edge,
                   fmt::format("'{}' has a new random value for every edge, and cannot be correlated", name));
    }
    require_that(at[0] != at[1], fmt::format("'{}' is correlated with itself", names[static_cast<std::size_t>(at[0])]));
    require_that(spread.correlation(at[0], at[1]) == 0,
                 fmt::format("the pair '{}' and '{}' is given twice", names[static_cast<std::size_t>(at[0])],
                             names[static_cast<std::size_t>(at[1])]));
    spread.correlation(at[0], at[1]) = spread.correlation(at[1], at[0]) = pair->get(2)->value<double>().value();
  }
  try {
    spread.copula.emplace(spread.correlation, names);
  } catch (const InvalidParameter& error) {
    file.fail(path, error.what());
  }
}

/// Checks that no two varied quantities set the same key.
void check_keys_once(const SceneFile::Impl& file, const DeviceSpread& spread) {
  std::set<std::string> seen;
  for (const SpreadVariable& variable : spread.variables) {
    for (const VariedKey& key : variable.keys) {
      if (!seen.insert(key.name()).second)
        file.fail_section(join_path("spread", variable.name), fmt::format("{} already varies by another entry", key.name()));
    }
  }
}

}  // namespace

void read_spread(Scene& scene, const SceneFile::Impl& file) {
  DeviceSpread spread;
  for (const std::string& name : file.names_in("spread")) spread.variables.push_back(read_variable(file, scene, name));
  check_keys_once(file, spread);
  read_correlation(file, spread);
  scene.spread = std::move(spread);
}

toml::table resolved_spread(const SceneFile::Impl& file) {
  toml::table all;
  for (const std::string& name : file.names_in("spread")) {
    const SectionReader in(file, "spread", name);
    toml::table keys = in.with_defaults();
    if (in.is_given("file")) {
      const std::string unit = in.is_given("unit") ? in.text("unit") : std::string();
      toml::array values;
      for (const double value : file_values(in))
        values.push_back(unit.empty() ? percent_text(value) : fmt::format("{} {}", number_text(value), unit));
      for (const std::string_view key : {"file", "column", "unit"}) keys.erase(key);
      keys.insert("values", std::move(values));
    }
    keys.is_inline(true);
    all.insert(name, std::move(keys));
  }
  if (const toml::node* node = file.find({"spread", std::string(correlation_key)}))
    node->visit([&](const auto& correlation) { all.insert(correlation_key, correlation); });
  return all;
}

}  // namespace internal
}  // namespace softland
