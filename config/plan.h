// The plan of a design-space exploration: a scene, the variables (numbers of the scene that vary) with their values, and the
// study (a softland command such as simulate) of every point. A point is one combination of values of the variables.
//
// A plan is identified by its text: the canonical scene, the variables in SI units, the study with all its options. Equal texts
// give equal points on any machine. The number of a point alone determines its values, so that parts of a plan can be computed
// apart:
//   grid     all combinations of the values of the variables; the last variable changes fastest
//   sample   a point set in the box of the ranges (sampling/points.h)
//   list     the rows of a table
//   nsga2    points in the box of the ranges that a search for a Pareto front finds in sequence (optimizers/nsga2.h): point k
//            is known when all earlier points are computed
// Values between the ends of a range are rounded to 15 significant digits, so that a finer grid reproduces the values of a
// coarser one exactly, and every number has a short text.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene.h"
#include "config/units.h"
#include "sampling/points.h"

namespace softland {

/// The entries of a plan as the user gives them, by options of the command line or in a file.
struct PlanRequest {
  /// Returns the source of entry number `number` of the key, for messages: "--vary gap.contact=1 um:2 um" for ("vary", 0), or
  /// "map.toml:4: plan.study = "optimise"".
  using Place = std::function<std::string(std::string_view key, std::size_t number)>;

  SceneFile scene;
  std::vector<std::string> vary = {};               ///< ranges of varied keys: "structure.length=245 um:275 um:7"
  std::string sample = {};                          ///< point set in the ranges, with its size: "sobol:128"; empty for a grid
  std::string pareto = {};                          ///< figures of merit that a search for a Pareto front minimises
  std::vector<std::string> columns = {};            ///< columns of a list of points: "gap.contact [um]"; empty without a list
  std::vector<std::vector<double>> rows = {};       ///< values of a list of points, by row and column
  std::string study = "simulate";                   ///< study of every point: the softland command that computes the point
  std::map<std::string, std::string> options = {};  ///< options of the study of every point, by name
  std::uint64_t seed = 1;
  Place place = {};
};

/// Reads a plan file, which consists of a section [plan]. The section names the file of the scene, relative to the plan file,
/// or holds the text of the scene. Throws InvalidInput with file, line, key, value and rule.
[[nodiscard]] PlanRequest read_plan(const SceneFile& file);
/// Returns true when the file is a plan of a design-space exploration: it has a section [plan].
[[nodiscard]] bool is_plan(const SceneFile& file);
/// Reads a list of points from a CSV file, whose header names keys with their units, "structure.length [um],gap.contact [um]".
/// Throws InvalidInput.
void read_list(PlanRequest& request, const std::string& path);
/// Adds options of the study of every point, such as "impact-velocity=1 mm/s". Throws InvalidInput.
void add_options(PlanRequest& request, const std::vector<std::string>& given);
/// Options of the study that are keys of [plan] in a plan file; all other options are in the list `options` of [plan].
inline constexpr std::string_view plan_options[] = {"certify",  "samples",   "target", "actuator",
                                                    "waveform", "optimizer", "budget"};

/// A key of the scene that a variable of the plan sets.
struct PlanKey {
  std::string path;         ///< path of the key in the scene, such as "electrode.main.span"
  std::size_t element = 0;  ///< number of the list element that varies, from 1; 0 for a key without a list
  Quantity base = {};       ///< value of the key in the scene; a variable that is a factor (is_factor) multiplies this value
};

/// A variable of the plan: sets one key of the scene, or multiplies the values of several keys by one factor.
struct PlanVariable {
  std::string name;  ///< name of the variable: "structure.length", "electrode.main.span[2]", "gap.electrode*gap.contact"
  std::vector<PlanKey> keys;
  Dimension dimension = {};  ///< dimension of the variable's values; none for a factor
  bool is_factor = false;    ///< true when the variable multiplies the scene's own numbers
  bool is_whole = false;     ///< true when the variable takes whole numbers only
  /// Words of a varied key whose value is a word, such as a contact law, or true and false. The variable's value is the number
  /// of a word, counted from 1.
  std::vector<std::string> words = {};
  std::vector<double> values = {};         ///< values of the variable on a grid [SI unit of `dimension`]
  double low = 0, high = 0;                ///< range of the variable, unless it has `values` [SI unit of `dimension`]
  bool is_logarithmic = false;             ///< true for values in equal ratios instead of equal steps
  [[nodiscard]] std::string unit() const;  ///< unit of the variable, such as "m" or "Vdp"; empty for a plain number
};

class Plan {
 public:
  /// Makes the plan of a request. Throws InvalidInput, with a message that begins with the source of the entry, for an invalid
  /// plan: an unknown key, a unit of another dimension, a grid of more than `most_points`.
  explicit Plan(const PlanRequest& request);

  static constexpr std::uint64_t most_points = 1'000'000'000;

  [[nodiscard]] std::uint64_t points() const { return points_; }
  [[nodiscard]] const std::vector<PlanVariable>& variables() const { return variables_; }
  [[nodiscard]] const SceneFile& base() const { return base_; }
  [[nodiscard]] const std::string& study() const { return study_; }
  [[nodiscard]] const std::map<std::string, std::string>& options() const { return options_; }
  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  /// Returns true if a search for a Pareto front chooses the points; pareto() names the figures of merit that it minimises.
  [[nodiscard]] bool is_search() const { return is_search_; }
  [[nodiscard]] const std::string& pareto() const { return pareto_; }
  /// Returns the values of the variables [SI unit] at a point of the unit cube: coordinate 0 is `low`, 1 is `high`.
  [[nodiscard]] std::vector<double> values_in_box(std::vector<double> place) const;
  /// Returns the values of the variables at point k of the plan, in the order of the variables [SI unit]. Throws InvalidInput
  /// for the points of a search.
  [[nodiscard]] std::vector<double> values(std::uint64_t k) const;
  /// Returns the scene with these values of the variables. The scene may be invalid; read_scene() checks it.
  [[nodiscard]] SceneFile scene(const std::vector<double>& values) const;
  /// Returns the canonical text of the plan, a file that read_plan() accepts.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void read_sample(const PlanRequest& request);
  void read_variables(const PlanRequest& request);
  void read_rows(const PlanRequest& request);
  void count_points();
  [[nodiscard]] std::string canonical_text() const;

  SceneFile base_;
  std::string study_;
  std::map<std::string, std::string> options_;
  std::uint64_t seed_;
  std::string pareto_;
  std::vector<PlanVariable> variables_;
  std::vector<std::vector<double>> rows_;  // values of a list of points, by row and variable [SI unit]
  std::optional<PointSet> sample_;         // kind of point set; in a Pareto search it only marks that variables have ranges
  bool is_search_ = false;
  std::uint64_t points_ = 1;
  std::optional<SamplePoints> sampled_;
  std::string text_;
};

}  // namespace softland
