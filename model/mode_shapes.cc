#include "model/mode_shapes.h"

#include "base/require.h"
#include "model/beam.h"

namespace softland {

ModeShapes mode_shapes(const Switch& model, int places) {
  require(places >= 2, "mode shapes: places must be at least 2");
  const Device& device = model.device();
  const Structure& structure = device.structure;
  if (structure.is_rigid())
    return {.places = model.quadrature().positions().head(model.quadrature().points()),
            .shapes = model.quadrature().shapes().topRows(model.quadrature().points())};
  const Eigen::VectorXd along = Eigen::VectorXd::LinSpaced(places, 0, structure.length);
  return {.places = along, .shapes = mode_shapes_at(model, along)};
}

Eigen::MatrixXd mode_shapes_at(const Switch& model, const Eigen::VectorXd& places) {
  const Device& device = model.device();
  Eigen::MatrixXd shapes(places.size(), model.modes());
  std::visit(
      [&](const auto& kind) {
        const auto modes = kind.modes(device, nullptr);
        for (Eigen::Index i = 0; i < places.size(); ++i)
          shapes.row(i) = modes.scale() * modes.normalised()->value(places[i] / device.structure.length).transpose();
      },
      device.structure.kind);
  return shapes;
}

}  // namespace softland
