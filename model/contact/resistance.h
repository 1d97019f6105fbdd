// Electrical resistance of a closed contact: the constriction of the current to the spots at which its surfaces meet.
//
//   R1 = 4 rho l / (3 pi a^2) + G(l / a) rho / (2 a),   G(K) = (1 + 0.83 K) / (1 + 1.33 K)
//   a  = max{ sqrt(F1 / (pi H)), [3 F1 R / (4 E*)]^(1/3) },   F1 = F / n
//   R  = R1 / n + Rf / m
//
// R is the resistance of the contact, without that of the leads [Ohm]; rho resistivity of both metals, the mean of two [Ohm m];
// l mean free path of their electrons [m]; a radius of a spot [m]; F load on all spots [N], n of which share it evenly and
// conduct in parallel; H hardness of the softer metal [Pa]; Rf resistance of a film in series with each of the m contacts in
// parallel (Contact::count) [Ohm]; R (in a) radius of the summits [m] and E* effective modulus [Pa] of a law that has summits.
// A spot on a summit is elastic while its mean pressure is below the hardness, which is when the second radius is the larger
// one. Without hardness a spot is elastic at any load. A law without summits has one plastic spot for each contact.
//
// Number n of summits in contact at the interference d, of N in all: N min(d, Hm) / Hm for uniform heights, N Q(4 - d / sigma)
// for Gaussian ones, at least one for each contact. A dented summit stays in contact until its force vanishes. The load is the
// contact force; the law "adhesive" adds 2 pi R W for each summit in contact, so that a contact held by adhesion conducts. A
// contact without load is open: its conductance is 0.
//
// Limits: for l << a Holm's constriction rho / (2a) between two half spaces; for l >> a Sharvin's ballistic resistance, which
// for plastic spots does not depend on their number, since their total area is F / H. Spots do not interact: the distance
// between them exceeds their size. Heating, softening and tunnelling are neglected. Source: R. Holm, Electric Contacts (1967);
// B. Nikolic & P. B. Allen, Phys. Rev. B 60 (1999) 3963 (arXiv cond-mat/9811296), after Wexler: G is their approximation of his
// function, and R1 stays within 11 % of the plain sum of both limits.
#pragma once

#include <cstddef>
#include <span>

#include "model/device.h"

namespace softland {

class ContactResistance {
 public:
  /// Takes a valid contact; `width` is that of the moving part at the contact [m].
  ContactResistance(const Contact& contact, double width);

  /// Returns true when the contact has a resistivity. Otherwise conductance() and resistance() must not be called.
  [[nodiscard]] bool is_known() const { return is_known_; }
  /// Returns the conductance of the contact [S] at an interference [m] under a contact force [N]; 0 when open.
  [[nodiscard]] double conductance(double interference, double force) const;
  /// Returns the resistance of the contact [Ohm] at an interference [m] under a contact force [N]; NaN when open.
  [[nodiscard]] double resistance(double interference, double force) const;

  /// Returns the resistance [Ohm] of a circular contact spot of radius `radius` [m]; infinite for radius 0.
  [[nodiscard]] static double of_spot(double radius, double resistivity, double mean_free_path);

 private:
  bool is_known_;
  Conduction metal_;
  double contacts_;     // number of equal contacts in parallel
  double summits_ = 0;  // number of asperity summits; 0 for a law without summits
  double height_ = 0;   // greatest height of uniform summits, or standard deviation of Gaussian heights [m]
  bool is_gaussian_ = false;
  double radius_ = 0;    // radius of the asperity summits [m]
  double modulus_ = 0;   // effective modulus of the surfaces [Pa]
  double adhesion_ = 0;  // load that adhesion adds to a summit in contact [N]
};

/// Returns the resistance of one contact of a device, for the width of the moving part at the contact.
[[nodiscard]] ContactResistance contact_resistance(const Device& device, std::size_t contact);

/// Returns the conductance of the connection (electrical path) through several contacts [S], from those of its contacts, given
/// in the order of Device::contacts: in series for Connection::all, otherwise in parallel. NaN when a conductance is NaN
/// (unknown).
[[nodiscard]] double connection_conductance(const Device& device, std::span<const double> conductances);

/// Returns the resistance [Ohm] of a conductance [S]; NaN for 0, since an open contact has no resistance.
[[nodiscard]] double resistance_of(double conductance);

}  // namespace softland
