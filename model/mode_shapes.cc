#include "model/mode_shapes.h"

#include "base/require.h"
#include "model/beam.h"
#include "model/tabulated_modes.h"

namespace softland {

ModeShapes mode_shapes(const Switch& model, int places) {
  require(places >= 2, "mode shapes: there must be at least 2 places");
  const Device& device = model.device();
  const Structure& structure = device.structure;
  if (structure.kind == StructureKind::plate)
    return {.places = model.quadrature().positions().head(model.quadrature().points()),
            .shapes = model.quadrature().shapes().topRows(model.quadrature().points())};
  ModeShapes all{.places = Eigen::VectorXd::LinSpaced(places, 0, structure.length),
                 .shapes = Eigen::MatrixXd(places, model.modes())};
  if (structure.kind == StructureKind::modes) {
    for (Eigen::Index i = 0; i < places; ++i) {
      for (int k = 0; k < model.modes(); ++k) all.shapes(i, k) = structure.table->value(k, all.places[i]);
    }
    return all;
  }
  const BeamModes beam(beam_sections(device), model.modes(), beam_support(structure, device.surface));
  for (Eigen::Index i = 0; i < places; ++i) all.shapes.row(i) = beam.value(all.places[i]).transpose();
  return all;
}

}  // namespace softland
