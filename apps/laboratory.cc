#include "apps/laboratory.h"

#include "apps/values.h"
#include "config/units.h"

namespace softland::apps {

void with_laboratory(Verb& verb, LaboratoryRequest& request) {
  verb.optional("--edge-error", request.edge_error, "TIME",
                "error of the time of an edge of the contact, one standard deviation (default: 50 ns, at most "
                "a 200th of the period of the first mode)");
  verb.optional("--unseen", request.unseen, "TIME",
                "openings of the contact shorter than this are not seen (default: 100 ns, "
                "at most a 100th of that period)");
  verb.optional("--gain-error", request.gain_error, "SHARE",
                "error of the gain of a source, constant but unknown, one standard deviation (default: 0.5 %)");
  verb.optional("--shot-error", request.shot_error, "SHARE",
                "scatter of the gain from shot to shot, one standard deviation (default: 0.02 %)");
}

LaboratoryErrors laboratory_errors(const LaboratoryRequest& request, const SceneFile& file) {
  LaboratoryErrors known = usual_errors(file);
  const auto take = [](double& value, const char* option, const std::optional<std::string>& text, const Dimension& due) {
    if (text) value = quantity_of(option, *text, due);
  };
  take(known.edge_error, "--edge-error", request.edge_error, dimension::time);
  take(known.unseen, "--unseen", request.unseen, dimension::time);
  take(known.gain_error, "--gain-error", request.gain_error, dimension::none);
  take(known.shot_error, "--shot-error", request.shot_error, dimension::none);
  take(known.trigger_delay, "--trigger-delay", request.trigger_delay, dimension::time);
  return known;
}

}  // namespace softland::apps
