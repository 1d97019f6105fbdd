#include "reports/seeds_report.h"

#include <gtest/gtest.h>

#include <string>

#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/record_file.h"
#include "sample_result.h"

namespace softland {
namespace {

SearchOfSeed search(std::uint64_t seed, double cost, bool goal_met = true, bool confirmed = true) {
  SearchOfSeed one{.seed = seed,
                   .status = "done",
                   .termination = "evaluation_budget",
                   .cost = cost,
                   .evaluations = 100,
                   .goal_met = goal_met,
                   .confirmed = confirmed,
                   .better_than_baseline = true};
  one.figures[&Metrics::settled] = 1;
  one.figures[&Metrics::initial_contact_time] = 40e-6;
  return one;
}

std::uint64_t best_seed(std::vector<SearchOfSeed> searches, Target target = Target::bounce, bool over_devices = false) {
  SeedsFindings seeds{.planned = searches.size(), .searches = std::move(searches)};
  rank(seeds, target, 1e-9, over_devices);
  return seeds.searches.at(seeds.best).seed;
}

TEST(SeedsReport, PrefersWhatIsConfirmedThenWhatMeetsTheGoalThenTheFigureThenTheCost) {
  EXPECT_EQ(best_seed({search(1, 0.1, true, false), search(2, 0.2), search(3, 0.05, false, false)}), 2U);
  EXPECT_EQ(best_seed({search(1, 0.3, false, false), search(2, 0.4, true, false)}), 2U);
  auto high = search(1, 0.1), low = search(2, 0.2);
  high.figures[&Metrics::major_bounce_height] = 3e-9;
  low.figures[&Metrics::major_bounce_height] = 2e-9;
  EXPECT_EQ(best_seed({high, low}), 2U);
  high.figures[&Metrics::major_bounce_height] = 0.9e-9;
  low.figures[&Metrics::major_bounce_height] = 0.1e-9;
  EXPECT_EQ(best_seed({high, low}), 1U) << "neither counts as a rebound";
  EXPECT_EQ(best_seed({search(7, 0.1), search(8, 0.1)}), 7U);
  EXPECT_EQ(best_seed({search(1, 0.1, false, false), search(2, 0.3)}, Target::bounce, true), 2U) << "the conditions hold";
  EXPECT_EQ(best_seed({search(1, 0.3), search(2, 0.1, true, false)}, Target::bounce, true), 2U);
}

TEST(SeedsReport, TellsTheSpreadAndWhatFails) {
  SeedsFindings seeds{.planned = 5, .searches = {search(1, 0.1), search(2, 0.2), search(3, 0.4, false), search(4, 0.3)}};
  seeds.searches.front().better_than_baseline = false;  // a met goal is a success nevertheless
  seeds.searches.back().better_than_baseline = seeds.searches.back().goal_met = false;
  rank(seeds, Target::bounce, 1e-9, false);
  EXPECT_EQ(internal::seeds_caption(seeds),
            "4 of 5 searches are done. The best is that of seed 1, with cost 0.1. Cost: median 0.25, quartiles 0.175 and 0.325, "
            "from 0.1 to 0.4. 2 of 4 fail; their seeds are 3 (goal not met), 4 (no better than the plain step).");
  const SeedsRecord record{.origin = origin_of("optimize", ""), .seeds = seeds};
  const nlohmann::json j = json_of(record)["seeds"];
  EXPECT_EQ(text_of(read_seeds(json_of(record))), text_of(record));
  EXPECT_EQ(json_of(read_seeds(json_of(record))), json_of(record));
  EXPECT_EQ(j["best_seed"], 1);
  EXPECT_EQ(j["goal_met"], 2);
  EXPECT_DOUBLE_EQ(j["cost"]["upper_quartile"].get<double>(), 0.325);
  // A search without a result is worse than all others.
  seeds.searches[2].cost = Metrics::unset;
  EXPECT_TRUE(json_of(SeedsRecord{.origin = {}, .seeds = seeds})["seeds"]["cost"]["most"].is_null());
  EXPECT_EQ(internal::seeds_caption(SeedsFindings{.planned = 3}), "None of 3 searches is done.");
}

TEST(SeedsReport, OfAResultIsReadBackAndStandsInEveryReport) {
  ClosingRecord result = read_closing(test::sample_optimize_result(10));
  EXPECT_EQ(page_html(closing_document(result)).find("id=\"seeds\""), std::string::npos);
  result.search->seeds = SeedsFindings{.planned = 2, .searches = {search(1, 0.1), search(2, 0.2)}, .best = 1};
  const ClosingRecord again = read_closing(json_of(result));
  ASSERT_TRUE(again.search->seeds);
  EXPECT_EQ(json_of(again)["seeds"], json_of(result)["seeds"]);
  EXPECT_EQ(again.search->seeds->best, 1U);
  EXPECT_NE(page_html(closing_document(again)).find("Searches with other seeds"), std::string::npos);
  EXPECT_NE(terminal_text(closing_document(again)).find("\n2     goal met, confirmed"), std::string::npos)
      << terminal_text(closing_document(again));
}

}  // namespace
}  // namespace softland
