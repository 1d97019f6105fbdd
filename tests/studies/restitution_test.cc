// Checks the table of docs/theory/contact.md of damping and restitution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "model/closing.h"
#include "scenes.h"
#include "studies/closing/prepared.h"

namespace softland::restitution_test {
namespace {

/// Returns the numbers of the table row with this beginning.
std::vector<double> row_of_docs(const std::string& begin) {
  std::ifstream docs(std::string(SOFTLAND_SOURCE_DIR) + "/docs/theory/contact.md");
  for (std::string line; std::getline(docs, line);) {
    if (!line.starts_with(begin)) continue;
    std::replace(line.begin(), line.end(), '|', ' ');
    std::istringstream numbers(line.substr(begin.size()));
    std::vector<double> row;
    for (double number = 0; numbers >> number;) row.push_back(number);
    return row;
  }
  return {};
}

/// The speeds of the first and the second touch of a plate that loses energy only in its contact.
struct Speeds {
  double first, second;
};
Speeds speeds(double damping) {
  SceneFile file = spring_plate({"contact.stiffness=1e9 N/m", "simulate.duration=300 us"});
  if (damping > 0) file.assign("contact.damping", damping);
  const PreparedScene p = prepare(file);
  const Trajectory t = simulate_closing(p.model, p.signals(), {.duration = p.duration, .tolerance = 1e-10});
  if (t.touches.size() < 2) return {.first = 0, .second = 0};
  return {.first = t.touches[0].impact_velocity, .second = t.touches[1].impact_velocity};
}

TEST(Restitution, IsThatOfTheTableOfDampings_slow) {
  const std::vector<double> wanted = row_of_docs("| restitution $e$ |"), products = row_of_docs("| $\\kappa v$ |");
  ASSERT_EQ(wanted.size(), 8U);
  ASSERT_EQ(products.size(), wanted.size());
  const double speed = speeds(0).first;
  ASSERT_GT(speed, 0);
  EXPECT_NEAR(speeds(0).second, speed, 1e-6 * speed) << "without damping nothing is lost";
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Speeds found = speeds(products[i] / speed);
    // Drive and spring do little work during a touch on so stiff a contact.
    EXPECT_NEAR(found.second / found.first, wanted[i], 2e-3) << "kappa v = " << products[i];
    if (wanted[i] < 0.8) continue;
    EXPECT_NEAR((1 / wanted[i] - 1) / products[i], 1, 5e-3) << "the rule beside the table";
  }
  EXPECT_NEAR(speeds(0.92 / speed).second / speed, 0.51, 5e-3) << "where 1 - kappa v is 0.08";
}

}  // namespace
}  // namespace softland::restitution_test
