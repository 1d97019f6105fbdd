#include "model/mode_shapes.h"

#include "base/require.h"
#include "model/beam.h"

namespace softland {

ModeShapes mode_shapes(const Switch& model, int places) {
  require(places >= 2, "mode shapes: there must be at least 2 places");
  const Device& device = model.device();
  const StructureKind kind = device.structure.kind;
  if (kind != StructureKind::cantilever && kind != StructureKind::clamped_clamped)
    return {.places = model.point_positions().head(model.points()), .shapes = model.point_shapes().topRows(model.points())};
  const BeamModes beam(beam_sections(device), model.modes(), beam_support(device.structure, device.surface));
  ModeShapes all{.places = Eigen::VectorXd::LinSpaced(places, 0, device.structure.length),
                 .shapes = Eigen::MatrixXd(places, model.modes())};
  for (Eigen::Index i = 0; i < places; ++i) all.shapes.row(i) = beam.value(all.places[i]).transpose();
  return all;
}

}  // namespace softland
