// Normalised mode shapes at the positions that a switch uses: at its quadrature points, at its contact and at the ends of its
// piezo layer. Switches with the same lengths share one object, whatever their stiffness and mass.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/gauss.h"
#include "model/beam.h"
#include "model/built_beam.h"
#include "model/device.h"
#include "model/structure/tabulated_modes.h"

namespace softland {

struct SampledModes {
  struct PanelPlaces {
    std::vector<double> corners;                         // ends of the quadrature panels along the structure [m]
    double contact = 0, piezo_begin = 0, piezo_end = 0;  // positions of the contact and of both ends of the piezo layer [m]
    std::vector<double> further_contacts;                // positions of the contacts after the first [m]
    double points_per_length = 0;
    int fewest_points = 0;  // least number of quadrature points of a panel

    [[nodiscard]] static PanelPlaces of(const Device& d, double points_per_length, int fewest_points) {
      std::set<double> corners{0, d.structure.length};
      const double length = d.structure.length, piezo_begin = d.piezo ? d.piezo->begin.on(length) : 0,
                   piezo_end = d.piezo ? d.piezo->end.on(length) : 0;
      for (const Electrode& e : d.electrodes)
        for (const Stretch& pad : e.pads(length)) corners.insert({pad.begin, std::min(pad.end, length)});
      if (d.structure.is_built()) {
        for (const double edge : edges_of_parts(d.structure)) corners.insert(edge);
      }
      for (const double kink : kinks_at_rest(d.structure)) corners.insert(kink);
      if (d.piezo) corners.insert({piezo_begin, piezo_end});
      if (d.touches_along_pad()) {
        const auto [begin, end] = d.pad();
        corners.insert({begin, end});
      }
      std::vector<double> further_contacts;
      for (std::size_t c = 1; c < d.contacts.size(); ++c) further_contacts.push_back(d.contact_position(c));
      return {.corners = {corners.begin(), corners.end()},
              .contact = d.contact_position(),
              .piezo_begin = piezo_begin,
              .piezo_end = piezo_end,
              .further_contacts = std::move(further_contacts),
              .points_per_length = points_per_length,
              .fewest_points = fewest_points};
    }
    [[nodiscard]] bool operator==(const PanelPlaces&) const = default;
  };
  PanelPlaces places;
  std::vector<GaussRule> rules;                  // Gauss rules of the quadrature panels
  std::shared_ptr<const NormalisedModes> modes;  // normalised modes of a beam; null for other structures
  TabulatedModes::Shapes table = {};             // mode shapes of a table of modes; empty for other structures
  Eigen::ArrayXd positions, weights;             // positions and weights of the quadrature points [m]
  Eigen::MatrixXd shapes;                        // mode shapes at the quadrature points, points x modes
  Eigen::VectorXd contact_shape, contact_slope, piezo_begin_slope, piezo_end_slope;
  std::vector<Eigen::VectorXd> further_contact_shapes;
  // 1 / omega^2 of the first mode of the normalised beam when it is also held at its contact: gives the in-contact period.
  double pinned_inverse_square = 0;

  template <class Modes>
  SampledModes(const Modes& normalised, double length, PanelPlaces at, const SampledModes* near) : places(std::move(at)) {
    const double end = places.corners.back();
    std::vector<double> x, w;
    for (auto corner = places.corners.begin(); std::next(corner) != places.corners.end(); ++corner) {
      const double begin = *corner, panel = *std::next(corner) - begin;
      if (panel < 1e-9 * end) continue;  // a panel without length, whose ends differ by rounding
      const int count = std::max(places.fewest_points, static_cast<int>(std::ceil(panel / end * places.points_per_length)));
      const GaussRule* known = near && rules.size() < near->rules.size() ? &near->rules[rules.size()] : nullptr;
      rules.push_back(known && static_cast<int>(known->points.size()) == count ? *known : gauss_rule(count));
      const GaussRule& rule = rules.back();
      for (std::size_t i = 0; i < rule.points.size(); ++i) {
        x.push_back(begin + panel * (1 + rule.points[i]) / 2);
        w.push_back(rule.weights[i] * panel / 2);
      }
    }
    positions = Eigen::Map<Eigen::ArrayXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    weights = Eigen::Map<Eigen::ArrayXd>(w.data(), positions.size());
    contact_shape = normalised.value(places.contact / length);
    for (const double x : places.further_contacts) further_contact_shapes.push_back(normalised.value(x / length));
    contact_slope = normalised.slope(places.contact / length);
    piezo_begin_slope = normalised.slope(places.piezo_begin / length);
    piezo_end_slope = normalised.slope(places.piezo_end / length);
    pinned_inverse_square = normalised.pinned_inverse_square(places.contact / length,
                                                             near ? std::optional(near->pinned_inverse_square) : std::nullopt);
    shapes.resize(positions.size(), contact_shape.size());
    for (Eigen::Index p = 0; p < positions.size(); ++p) shapes.row(p) = normalised.value(positions[p] / length).transpose();
  }
};

}  // namespace softland
