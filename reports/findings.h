// What a result says, in words computed from its numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "objectives/figures.h"

namespace softland::internal {

/// The finding in one sentence, in two parts so that a page can weigh them differently: `main` is about the winner or the single
/// run, `rest` about the baseline (empty for a single run). main + rest is the whole sentence, with its full stop.
struct Headline {
  std::string main;
  std::string rest;
  [[nodiscard]] std::string whole() const { return main + rest; }
};
[[nodiscard]] Headline headline(const nlohmann::json& result);

/// One sentence or two under each chart.
[[nodiscard]] std::string gap_caption(const nlohmann::json& result);
[[nodiscard]] std::string landing_caption(const nlohmann::json& result);
[[nodiscard]] std::string force_caption(const nlohmann::json& result);
[[nodiscard]] std::string velocity_caption(const nlohmann::json& result);
[[nodiscard]] std::string waveform_caption(const nlohmann::json& result, const std::string& drive);
[[nodiscard]] std::string search_caption(const nlohmann::json& result);
[[nodiscard]] std::string checks_caption(const nlohmann::json& result);
/// False when the winner is free of rebounds but one of its confirmations is not.
[[nodiscard]] bool checks_agree(const nlohmann::json& result);

enum class Verdict { better, worse, same, neutral };

/// How a figure changed from baseline to winner: "8.4 times lower" (a time: shorter, a count: fewer), "none left" when it became
/// 0, "unchanged"; empty when either is missing.
struct Change {
  std::string words;
  Verdict verdict = Verdict::neutral;
};
enum class Kind { size, time, count };
/// `lower_is_better`: otherwise the change is neutral, neither good nor bad.
[[nodiscard]] Change change(double before, double after, bool lower_is_better, Kind kind = Kind::size);

/// The value of a figure as text, rounded to its error where that is known; an em dash when not available; `beside` are the
/// metrics shown next to it.
[[nodiscard]] std::string figure_text(const nlohmann::json& metrics, const nlohmann::json& errors, const nlohmann::json& beside,
                                      const Figure& figure);
/// Its error beside that text; an em dash when not known.
[[nodiscard]] std::string error_text(const nlohmann::json& metrics, const nlohmann::json& errors, const Figure& figure);
/// The same in words when a number is not available but the reason is: "no contact", "not settled"; else empty.
[[nodiscard]] std::string missing_reason(const nlohmann::json& metrics, const Figure& figure);
/// Of an ill-conditioned figure of a certified result: "median 305.5 µs, 280.5 µs to 336.1 µs in 16 runs"; else empty.
[[nodiscard]] std::string cloud_text(const nlohmann::json& result, const Figure& figure);
/// What the errors of the figures are errors of.
[[nodiscard]] std::string error_heading(const nlohmann::json& result);
/// What a certificate says of the figures and of the rebound at which the runs part, in a sentence or two; empty without one.
[[nodiscard]] std::string certificate_caption(const nlohmann::json& result);
/// What the search wanted of a figure: "0", "yes", "below 323.1 µs"; empty where it wanted nothing.
[[nodiscard]] std::string goal_text(const nlohmann::json& result, const Figure& figure);
[[nodiscard]] Change figure_change(const nlohmann::json& before, const nlohmann::json& after, const Figure& figure);

/// With a capital letter at the beginning.
[[nodiscard]] std::string capitalised(std::string words);

/// "Softland's waveform" and "plain step", or "closing" for a single run.
[[nodiscard]] std::string best_label(const nlohmann::json& result);
[[nodiscard]] std::string baseline_label();

}  // namespace softland::internal
