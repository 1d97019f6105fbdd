#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlopt.hpp>

#include "base/nearest.h"
#include "base/require.h"
#include "optimizers/backends.h"

namespace softland {
namespace internal {
namespace {

constexpr std::array all_methods = {
    Method{"auto", Backend::search_auto, Reach::global, -1, false,
           "samples the box, then local searches from several good points; runs on all jobs (default)"},
    Method{"bobyqa", Backend::nlopt, Reach::local, nlopt::LN_BOBYQA, false,
           "local: quadratic model in a trust region; the fastest where the objective is smooth"},
    Method{"sbplx", Backend::nlopt, Reach::local, nlopt::LN_SBPLX, false,
           "local: Nelder-Mead in subspaces; copes with kinks and small jumps"},
    Method{"nelder-mead", Backend::nlopt, Reach::local, nlopt::LN_NELDERMEAD, false,
           "local: the simplex method; copes with kinks"},
    Method{"slsqp", Backend::nlopt, Reach::local, nlopt::LD_SLSQP, true,
           "finishes what cma-es began: sequential quadratic programming"},
    Method{"mma", Backend::nlopt, Reach::local, nlopt::LD_MMA, true, "finishes what cma-es began: moving asymptotes"},
    Method{"ccsaq", Backend::nlopt, Reach::local, nlopt::LD_CCSAQ, true,
           "finishes what cma-es began: separable convex quadratic approximations"},
    Method{"ipopt", Backend::ipopt, Reach::local, -1, true,
           "finishes what cma-es began: interior point with quasi-Newton Hessian; one solve at a time"},
    Method{"cma-es", Backend::cma_es, Reach::local, -1, false,
           "local to regional: evolution strategy that learns the shape of the valley; copes with kinks and jumps"},
    Method{"crs2", Backend::nlopt, Reach::global, nlopt::GN_CRS2_LM, false,
           "global: controlled random search with local mutation"},
    Method{"isres", Backend::nlopt, Reach::global, nlopt::GN_ISRES, false, "global: evolution strategy"},
    Method{"esch", Backend::nlopt, Reach::global, nlopt::GN_ESCH, false, "global: evolutionary, with Cauchy mutations"},
    Method{"direct-l", Backend::nlopt, Reach::global, nlopt::GN_DIRECT_L, false,
           "global: divides the box into ever smaller rectangles"},
    Method{"mlsl", Backend::nlopt, Reach::global, nlopt::G_MLSL, false,
           "global: multi-level single linkage, BOBYQA from spread points"},
};

struct Refusal {
  std::string_view name;
  std::string_view reason;
};
constexpr std::array refused_methods = {
    Refusal{"ags", "it crashes on non-finite values"},
    Refusal{"stogo", "it swallows exceptions and reports success"},
    Refusal{"newuoa", "it hangs on non-finite values"},
    Refusal{"newuoa-bound", "it hangs on non-finite values"},
    Refusal{"praxis", "it is not repeatable"},
    Refusal{"cobyla", "it can hang between evaluations, where no budget reaches it"},
};

}  // namespace

const Method& find_method(std::string_view name) {
  const auto found =
      std::find_if(all_methods.begin(), all_methods.end(), [&](const Method& method) { return method.name == name; });
  if (found != all_methods.end()) return *found;
  const auto broken = [&](const std::string& rule) {
    return fmt::format("{} {}: {} one of {}", requested("optimizer"), name, rule, fmt::join(optimizer_names(), ", "));
  };
  std::string plain(name);
  for (char& letter : plain)
    letter = letter == '_' ? '-' : letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter + 32) : letter;
  for (const Refusal& refusal : refused_methods) {
    if (refusal.name == plain) throw InvalidRequest(broken(fmt::format("is refused, because {}; choose", refusal.reason)));
  }
  throw InvalidRequest(broken("must be") + did_you_mean(name, {optimizer_names().begin(), optimizer_names().end()}));
}

}  // namespace internal

std::span<const std::string_view> optimizer_names() {
  static constexpr auto names_of_all = [] {
    std::array<std::string_view, internal::all_methods.size()> names;
    std::transform(internal::all_methods.begin(), internal::all_methods.end(), names.begin(),
                   [](const internal::Method& method) { return method.name; });
    return names;
  }();
  return names_of_all;
}

std::string_view optimizer_description(std::string_view name) { return internal::find_method(name).description; }

}  // namespace softland
