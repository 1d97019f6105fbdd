// What a design-space exploration runs through: a scene, the numbers of it that vary, how they go, and what is asked of every
// point.
//
// A plan is identified by its text: the canonical scene, the variables in SI units, the study with all its options. Equal texts
// give equal points, on any machine and in any part of the plan. A point is a function of its number:
//   grid     all combinations of the values of the variables, the last one fastest
//   sample   a point set in the box of the ranges (sampling/points.h)
//   list     the rows of a table
//   nsga2    points in the box of the ranges that a search for a front finds one after the other (optimizers/nsga2.h): point k is
//            known when those before it are computed
// Values between the ends of a range are rounded to 15 significant digits, so that a finer grid meets the values of a coarser one
// exactly, and every number can be written short.
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

/// A plan as it is asked for, by options of the command line or by a file.
struct PlanRequest {
  /// Where an entry stands, for messages: "--vary gap.contact=1 um:2 um" for ("vary", 0), "map.toml:4: plan.study = "optimise"".
  using Place = std::function<std::string(std::string_view key, std::size_t number)>;

  SceneFile scene;
  std::vector<std::string> vary = {};               ///< "structure.length=245 um:275 um:7"
  std::string sample = {};                          ///< "sobol:128"; empty: a grid
  std::string pareto = {};                          ///< of a search for a front: the figures it minimises
  std::vector<std::string> columns = {};            ///< of a list: "gap.contact [um]"; empty: no list
  std::vector<std::vector<double>> rows = {};       ///< of a list
  std::string study = "simulate";                   ///< what is asked of every point
  std::map<std::string, std::string> options = {};  ///< of the study, by name
  std::uint64_t seed = 1;
  Place place = {};
};

/// The plan of a file with a section [plan]; the scene is a file named there, relative to this one, or stands in it. Throws
/// InvalidInput with file, line, key, value and rule.
[[nodiscard]] PlanRequest read_plan(const SceneFile& file);
/// Whether the file is a plan: it has a section [plan].
[[nodiscard]] bool is_plan(const SceneFile& file);
/// Columns and rows of a CSV file, whose header names keys with their units, "structure.length [um],gap.contact [um]". Throws
/// InvalidInput.
void read_list(PlanRequest& request, const std::string& path);
/// Adds options of the study, "impact-velocity=1 mm/s". Throws InvalidInput.
void add_options(PlanRequest& request, const std::vector<std::string>& told);
/// The options that have a key of their own in a [plan]; others stand in its list `options`.
inline constexpr std::string_view plan_options[] = {"certify",  "samples",   "target", "actuator",
                                                    "waveform", "optimizer", "budget"};

/// A key of the scene that a variable sets.
struct PlanKey {
  std::string path;         ///< "electrode.main.span"
  std::size_t element = 0;  ///< of a list, counted from 1; 0: the key is none
  Quantity base = {};       ///< the scene's own, where a factor varies
};

/// A number of the scene, or several by one factor.
struct PlanVariable {
  std::string name;  ///< "structure.length", "electrode.main.span[2]", "gap.electrode*gap.contact"
  std::vector<PlanKey> keys;
  Dimension dimension = {};                ///< of its values; of a factor none
  bool is_factor = false;                  ///< it multiplies the scene's own numbers
  bool is_whole = false;                   ///< a whole number
  std::vector<std::string> words = {};     ///< of a choice or a flag, whose value counts them from 1; else empty
  std::vector<double> values = {};         ///< [SI unit of `dimension`] that it takes on a grid
  double low = 0, high = 0;                ///< [SI unit of `dimension`] of the range of a sample
  bool is_logarithmic = false;             ///< equal ratios instead of equal steps
  [[nodiscard]] std::string unit() const;  ///< "m", "Vdp"; empty where there is none
};

class Plan {
 public:
  /// Throws InvalidInput, beginning with the place of the entry, for what is no plan: an unknown key, a unit of another
  /// dimension, a grid of more than `most_points`.
  explicit Plan(const PlanRequest& request);

  static constexpr std::uint64_t most_points = 1'000'000'000;

  [[nodiscard]] std::uint64_t points() const { return points_; }
  [[nodiscard]] const std::vector<PlanVariable>& variables() const { return variables_; }
  [[nodiscard]] const SceneFile& base() const { return base_; }
  [[nodiscard]] const std::string& study() const { return study_; }
  [[nodiscard]] const std::map<std::string, std::string>& options() const { return options_; }
  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  /// Whether points are found by a search for a front, and the figures that this minimises.
  [[nodiscard]] bool is_search() const { return is_search_; }
  [[nodiscard]] const std::string& pareto() const { return pareto_; }
  /// Of the variables at a place of the unit cube that stands for the box of their ranges [SI unit].
  [[nodiscard]] std::vector<double> values_in_box(std::vector<double> place) const;
  /// Of the variables at point k, in their order [SI unit]. Throws InvalidInput for the points of a search.
  [[nodiscard]] std::vector<double> values(std::uint64_t k) const;
  /// The scene at these values. It may be one that cannot be: that is for whoever reads it to say.
  [[nodiscard]] SceneFile scene(const std::vector<double>& values) const;
  /// The canonical text, a file that read_plan() takes.
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
  std::vector<std::vector<double>> rows_;  // of a list [SI unit]
  std::optional<PointSet> sample_;         // of a search: how its ranges are read
  bool is_search_ = false;
  std::uint64_t points_ = 1;
  std::optional<SamplePoints> sampled_;
  std::string text_;
};

}  // namespace softland
