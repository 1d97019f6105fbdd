#include "verbs/laboratory.h"

namespace softland::verbs {

LaboratoryErrors LaboratoryArguments::errors(const SceneFile& file) const {
  LaboratoryErrors known = usual_errors(file);
  known.edge_error = edge_error.value_or(known.edge_error);
  known.unseen = unseen.value_or(known.unseen);
  known.gain_error = gain_error.value_or(known.gain_error);
  known.shot_error = shot_error.value_or(known.shot_error);
  known.trigger_delay = trigger_delay.value_or(known.trigger_delay);
  if (capacitance) known.capacitance = *capacitance;
  return known;
}

}  // namespace softland::verbs
