#include "reports/circuit_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "base/require.h"
#include "base/select.h"
#include "model/built_beam.h"
#include "model/contact/contact_law.h"
#include "model/far_side.h"
#include "model/forces/casimir.h"
#include "model/forces/dispersion.h"
#include "model/forces/electrostatic.h"
#include "model/gas/gas_law.h"
#include "reports/formula.h"
#include "waveforms/export.h"

namespace softland {
namespace {

template <class Law>
constexpr bool only_pushes = InvertibleContact<Law> || is_damped_invertible<Law>;

// A dialect writes operands of formulas in one language, SPICE or Verilog-A.
struct Dialect {
  std::string voltage;  // name of the function for the voltage of a node: "v" in SPICE, "V" in Verilog-A
  bool has_variables;   // true if the circuit language has named numbers besides voltages of nodes
  [[nodiscard]] Formula node(const std::string& name) const { return Formula::named(fmt::format("{}({})", voltage, name)); }
  [[nodiscard]] Formula between(const std::string& name) const { return Formula::named(fmt::format("{}({},g)", voltage, name)); }
  [[nodiscard]] Formula variable(const std::string& name) const { return has_variables ? Formula::named(name) : node(name); }
};

// A quadrature point of the beam.
struct Point {
  // Local gap divided by the rest gap of the contact, and local velocity in units of contact gap / tau, as formulas: sums over
  // the modes.
  std::string gap, velocity;
  // Formula of the force of the quadrature point (load times quadrature weight), dimensionless as in the equation of dU_i/dt.
  std::string load;
  // Factor from `load` to the force on each mode: the mode shape here divided by the first mode shape at the contact.
  std::vector<double> share;
};

// The parts of the switch as formulas in one circuit language, in the scaled variables of the equations in circuit_model.h.
struct Circuit {
  // Names of the pins of electrodes, piezos and dispersion force, as Switch::drives() sorts them.
  std::vector<std::string> drives;
  double tau = 0;  // time scale 1 / omega_1 of the model [s]
  double gap = 0;  // rest gap of the contact [m]
  // Per mode i: coefficients (tau omega_i)^2 of Y_i and 2 zeta tau omega_i of U_i in the equation of motion, rest value of Y_i,
  // and deflection of the contact point, in contact gaps, per Y_i.
  std::vector<double> stiffness, friction, start, at_contact;
  // Per mode: pins of the piezos, each with its force on the mode per volt [1/V], dimensionless as in the equation of dU_i/dt.
  std::vector<std::vector<std::pair<std::string, double>>> pushes;
  std::vector<Point> points;
  std::vector<std::pair<std::string, std::string>> charges;  // pins of the electrodes, each with the formula of its charge [C]
  // Pins of the piezos, each with its current per modal velocity U_i [A], for every mode i.
  std::vector<std::pair<std::string, std::vector<double>>> currents;
  std::optional<std::string> contact;  // formula of the contact force divided by force_scale; none without a contact
  double force_scale = 0;              // unit of the dimensionless contact force [N]
  // Formulas of the deflection of the contact point in contact gaps, and of its velocity in units of contact gap / tau.
  std::string deflection, rate;
  // Formula of the tension that stretching causes in the beam; then, for each mode, the formula that times the tension is the
  // force on the mode. Empty for a beam that does not stretch.
  std::vector<std::string> tension;
};

std::string sum_of(const Dialect& d, char letter, const Eigen::VectorXd& factors, double constant) {
  Formula sum = constant;
  for (Eigen::Index i = 0; i < factors.size(); ++i) sum += Formula(factors[i]) * d.node(fmt::format("{}{}", letter, i));
  return sum.text();
}

class SubcircuitWriter {
 public:
  SubcircuitWriter(const PreparedScene& p, const Dialect& dialect)
      : p_(p), model_(p.model), device_(p.model.device()), d_(dialect) {}

  Circuit make() {
    const std::string why = why_no_circuit(model_);
    require(why.empty(), [&] { return "a model of this switch for circuits cannot be written: it has " + why; });
    const Eigen::VectorXd omega = model_.basis().angular_frequencies(), phi = model_.basis().contact_shape();
    unit_ = std::abs(phi[0]);
    c_.tau = 1 / omega[0];
    c_.gap = device_.contact_gap();
    c_.force_scale = c_.gap / (c_.tau * c_.tau * unit_ * unit_);
    const std::optional<Eigen::VectorXd> rest = p_.rest();
    require(rest.has_value(),
            "a model of this switch for circuits cannot be written: it has no rest under what its drives stand at before t = 0");
    for (Eigen::Index i = 0; i < omega.size(); ++i) {
      c_.stiffness.push_back(std::pow(c_.tau * omega[i], 2));
      c_.friction.push_back(2 * device_.structure.damping_ratio * c_.tau * omega[i]);
      c_.start.push_back((*rest)[i] * unit_ / c_.gap);
      c_.at_contact.push_back(phi[i] / unit_);
    }
    c_.pushes.resize(static_cast<std::size_t>(omega.size()));
    c_.deflection = sum_of(d_, 'y', phi / unit_, 0);
    c_.rate = sum_of(d_, 'u', phi / unit_, 0);
    find_drives();
    find_points();
    find_contact();
    find_tension();
    return std::move(c_);
  }

 private:
  void find_drives() {
    const std::vector<std::string> pins = circuit_pins(p_.drive_names());
    const std::vector<Signal> commanded = p_.commanded(p_.waveforms());
    for (std::size_t k = 0; k < pins.size(); ++k) {
      const std::string& pin = pins[k];
      const DriveKind kind = model_.drive_kind(k);
      const bool connected = kind != DriveKind::dispersion || !commanded[k].is_zero();
      if (connected) c_.drives.push_back(pin);
      if (kind == DriveKind::electrode) strengths_.push_back(d_.between(pin) * d_.between(pin));
      if (kind == DriveKind::dispersion) strengths_.push_back(connected ? Formula(1) + d_.between(pin) : Formula(1));
      if (kind == DriveKind::piezo) find_piezo(pin);
    }
  }

  void find_piezo(const std::string& pin) {
    std::vector<double> by_rate;
    for (Eigen::Index i = 0; i < model_.modes(); ++i) {
      const double moment = model_.basis().piezo_shape()[i];
      c_.pushes[static_cast<std::size_t>(i)].emplace_back(pin, moment * c_.tau * c_.tau * unit_ / c_.gap);
      by_rate.push_back(moment * c_.gap / (unit_ * c_.tau));
    }
    c_.currents.emplace_back(pin, by_rate);
  }

  void find_points() {
    std::vector<Formula> charges(device_.electrodes.size(), Formula(0));
    // Factor from a force on the beam [N] to the dimensionless force in the equation of dU_i/dt (Point::load).
    const double scale = c_.tau * c_.tau * unit_ * unit_ / c_.gap;
    for (Eigen::Index p = 0; p < model_.quadrature().points(); ++p) {
      const Eigen::VectorXd shape = model_.quadrature().shapes().row(p).head(model_.modes()) / unit_;
      const double x = model_.quadrature().positions()[p], weight = model_.quadrature().weights()[p];
      const Formula gap = Formula(c_.gap) * max(d_.variable(fmt::format("h{}", p)), Formula(model_.gap_floor() / c_.gap));
      const Formula velocity = Formula(c_.gap / c_.tau) * d_.variable(fmt::format("w{}", p));
      const Formula load = load_at(x, gap, velocity, weight, charges);
      c_.points.push_back({.gap = sum_of(d_, 'y', -shape, (device_.gap.electrode + device_.rest_offset(x)) / c_.gap),
                           .velocity = sum_of(d_, 'u', shape, 0),
                           .load = (Formula(scale * weight) * load).text(),
                           .share = {shape.begin(), shape.end()}});
    }
    for (std::size_t k = 0; k < charges.size(); ++k)
      c_.charges.emplace_back(c_.drives[k], (charges[k] * d_.between(c_.drives[k])).text());
  }

  // Returns the load on the beam at the position x [N/m]; adds the capacitance of this quadrature point to that of each
  // electrode [F].
  Formula load_at(double x, const Formula& gap, const Formula& velocity, double weight, std::vector<Formula>& capacitances) {
    const Structure& s = device_.structure;
    const LocalSection local = section_at(s, x);
    const double width = s.is_built() ? local.width_at(x) * area_left(local.holes) : s.width;
    Formula load = 0;
    for (std::size_t k = 0; k < device_.electrodes.size(); ++k) {
      const Electrode& e = device_.electrodes[k];
      const std::vector<Stretch> pads = e.pads(s.length);
      if (std::ranges::none_of(pads, [&](const Stretch& pad) { return pad.holds(x); })) continue;
      std::visit(
          [&](const auto& law) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(law)>, Bao2001Fringing>) {
              const ElectrostaticForce<std::decay_t<decltype(law)>> force{law};
              if (e.side != Side::far) {
                load += strengths_[k] * force.load(gap, velocity);
                capacitances[k] += Formula(weight) * force.capacitance(gap);
              }
              if (e.side == Side::near) return;
              const double both = device_.gap.electrode + e.gap, floor = e.gap / 100;
              load += strengths_[k] *
                      FarSide<std::decay_t<decltype(force)>>{.law = force, .both_gaps = both, .floor = floor}.load(gap, velocity);
              capacitances[k] += Formula(weight) * force.capacitance(max(Formula(both) - gap, Formula(floor)));
            }
          },
          row_of(fringing_laws, e.fringing).make(width, local.thickness));
    }
    if (device_.dispersion) load += strengths_.back() * dispersion(width, gap, velocity);
    if (!model_.gas()) return load;
    const bool is_local = s.is_built() && !std::holds_alternative<LinearGas>(*device_.gas);
    std::visit(
        [&](const auto& law) {
          load += law.load(gap, velocity);
          if (const double far = far_gap(*device_.gas); !std::isnan(far)) {
            load += FarSide<std::decay_t<decltype(law)>>{.law = law, .both_gaps = device_.gap.electrode + far, .floor = far / 100}
                        .load(gap, velocity);
          }
        },
        is_local ? gas_law(*device_.gas, width, local.thickness, 1) : *model_.gas());
    return load;
  }

  Formula dispersion(double width, const Formula& gap, const Formula& velocity) const {
    const Dispersion& force = *device_.dispersion;
    const VanDerWaals near{.hamaker_constant = force.hamaker_constant, .equilibrium_distance = force.equilibrium_distance};
    const auto along = [&](auto law) { return DispersionForce<decltype(law)>{.law = law, .width = width}.load(gap, velocity); };
    if (force.model == DispersionModel::van_der_waals) return along(near);
    if (force.model == DispersionModel::casimir) return along(IdealCasimir{});
    return along(SmallerOfBoth<IdealCasimir>{IdealCasimir{}, near});
  }

  void find_contact() {
    if (!model_.has_contact()) return;
    const Formula depth = Formula(c_.gap) * max(d_.variable("at") - Formula(1), Formula(0));
    const Formula rate = Formula(c_.gap / c_.tau) * d_.variable("rate");
    std::visit(
        [&](const auto& law) {
          using Law = std::decay_t<decltype(law)>;
          if constexpr (only_pushes<Law>) {
            if constexpr (requires { law.force(depth, rate); }) {
              c_.contact = (Formula(1 / c_.force_scale) * law.force(depth, rate)).text();
            } else {
              c_.contact = (Formula(1 / c_.force_scale) * law.force(depth)).text();
            }
          }
        },
        model_.contact());
  }

  // Makes the formulas of the tension that stretching causes in the beam, by the law of model/stretching.h.
  void find_tension() {
    if (!model_.stretching()) return;
    const MidPlaneStretching& s = *model_.stretching();
    const double q = c_.gap / unit_;  // amplitude q of the first mode at which the contact point has moved by the contact gap
    std::vector<Formula> pulls;
    Formula strain = 0;
    for (std::size_t i = 0; i < s.modes; ++i) {
      Formula pull = 0;
      for (std::size_t j = 0; j < s.modes; ++j) pull += Formula(q * s.slopes[j * s.modes + i]) * d_.node(fmt::format("y{}", j));
      strain += Formula(q) * d_.node(fmt::format("y{}", i)) * pull;
      pulls.push_back(pull);
    }
    const double scale = s.stiffness * c_.tau * c_.tau * unit_ / c_.gap;
    // Circuit::tension: the tension of the beam, then for every mode the formula that makes a force of it.
    c_.tension.push_back((Formula(scale) * strain).text());
    for (const Formula& pull : pulls) c_.tension.push_back(pull.text());
  }

  const PreparedScene& p_;
  const Switch& model_;
  const Device& device_;
  const Dialect& d_;
  Circuit c_;
  double unit_ = 1;
  std::vector<Formula> strengths_;
};

std::string title(const PreparedScene& p) {
  return fmt::format("{}: {} modes, {} quadrature points", p.scene.file.name(), p.model.modes(), p.model.quadrature().points());
}

// Returns comment lines of the circuit file, which begin with `comment`, for drives (electrodes, piezos, dispersion force)
// whose pin has another name.
std::string renamed_in(const PreparedScene& p, std::string_view comment) {
  std::string text;
  for (const std::string& line : renamed_pins(p.drive_names())) text += fmt::format("{} {}\n", comment, line);
  return text;
}

// Names that pins must not have: pins and numbers of the model itself, the ground of SPICE, and words of Verilog-AMS 2.4 (annex
// B).
constexpr std::array reserved_names{
    // names that the circuit model defines itself
    "g", "s", "d", "y", "vel", "force", "at", "rate", "line", "push", "rc", "roff", "softland_switch",
    // names that SPICE reserves
    "0", "gnd", "time", "temper", "hertz",
    // words that Verilog-AMS reserves
    "above", "abs", "absdelay", "absdelta", "abstol", "access", "acos", "acosh", "ac_stim", "aliasparam", "always", "analog",
    "analysis", "and", "asin", "asinh", "assert", "assign", "atan", "atan2", "atanh", "automatic", "begin", "branch", "buf",
    "bufif0", "bufif1", "case", "casex", "casez", "ceil", "cell", "cmos", "config", "connect", "connectmodule", "connectrules",
    "continuous", "cos", "cosh", "cross", "ddt", "ddt_nature", "ddx", "deassign", "default", "defparam", "design", "disable",
    "discipline", "discrete", "domain", "driver_update", "edge", "else", "end", "endcase", "endconfig", "endconnectrules",
    "enddiscipline", "endfunction", "endgenerate", "endmodule", "endnature", "endparamset", "endprimitive", "endspecify",
    "endtable", "endtask", "event", "exclude", "exp", "final_step", "flicker_noise", "floor", "flow", "for", "forever", "fork",
    "from", "function", "generate", "genvar", "ground", "highz0", "highz1", "hypot", "idt", "idtmod", "idt_nature", "if",
    "ifnone", "incdir", "include", "inf", "initial", "initial_step", "inout", "input", "instance", "integer", "join",
    "laplace_nd", "laplace_np", "laplace_zd", "laplace_zp", "large", "last_crossing", "liblist", "library", "limexp", "ln",
    "localparam", "log", "macromodule", "max", "medium", "merged", "min", "module", "nand", "nature", "negedge", "net_resolution",
    "nmos", "noise_table", "noise_table_log", "nor", "noshowcancelled", "not", "notif0", "notif1", "or", "output", "parameter",
    "paramset", "pmos", "posedge", "potential", "pow", "primitive", "pull0", "pull1", "pulldown", "pullup", "pulsestyle_onevent",
    "pulsestyle_ondetect", "rcmos", "real", "realtime", "reg", "release", "repeat", "resolveto", "rnmos", "rpmos", "rtran",
    "rtranif0", "rtranif1", "scalared", "showcancelled", "signed", "sin", "sinh", "slew", "small", "specify", "specparam",
    "split", "sqrt", "string", "strong0", "strong1", "supply0", "supply1", "table", "tan", "tanh", "task", "timer", "tran",
    "tranif0", "tranif1", "transition", "tri", "tri0", "tri1", "triand", "trior", "trireg", "units", "unsigned", "use", "uwire",
    "vectored", "wait", "wand", "weak0", "weak1", "while", "white_noise", "wire", "wor", "wreal", "xnor", "xor", "zi_nd", "zi_np",
    "zi_zd", "zi_zp"};

// Returns true for a name that the model gives to a mode or quadrature point: y0, u0, h0, w0, f0 and so on.
bool is_numbered(const std::string& name) {
  constexpr std::string_view letters = "yuhwf";
  return name.size() > 1 && letters.find(name.front()) != std::string_view::npos &&
         name.find_first_not_of("0123456789", 1) == std::string::npos;
}

// Appends lines to a text.
struct Lines {
  std::string& text;
  template <class... Words>
  void operator()(fmt::format_string<Words...> form, Words&&... words) const {
    text += fmt::format(form, std::forward<Words>(words)...) + "\n";
  }
};

std::string subcircuit(const Circuit& c) {
  std::string text = fmt::format(".subckt softland_switch {} g s d y vel force rc=1 roff=1e12\n", fmt::join(c.drives, " "));
  const Lines line{text};
  for (std::size_t i = 0; i < c.stiffness.size(); ++i) {
    line("Cy{0} y{0} 0 {1} ic={2}", i, c.tau, c.start[i]);
    line("Cu{0} u{0} 0 {1} ic=0", i, c.tau);
    line("Gy{0} 0 y{0} u{0} 0 1", i);
    line("Gk{0} u{0} 0 y{0} 0 {1}", i, c.stiffness[i]);
    if (c.friction[i] > 0) line("Gd{0} u{0} 0 u{0} 0 {1}", i, c.friction[i]);
    for (const auto& [pin, push] : c.pushes[i]) line("Ge{0} 0 u{0} {1} g {2}", i, pin, push);
    if (!c.tension.empty()) line("Bt{0} u{0} 0 i=v(line)*{1}", i, c.tension[i + 1]);
  }
  if (!c.tension.empty()) line("Bline line 0 v={}", c.tension.front());
  line("Bat at 0 v={}\nBrate rate 0 v={}", c.deflection, c.rate);
  for (std::size_t p = 0; p < c.points.size(); ++p) {
    const Point& point = c.points[p];
    line("Bh{0} h{0} 0 v={1}\nBw{0} w{0} 0 v={2}\nBf{0} f{0} 0 v={3}", p, point.gap, point.velocity, point.load);
    for (std::size_t i = 0; i < point.share.size(); ++i) line("Gf{0}_{1} 0 u{0} f{1} 0 {2}", i, p, point.share[i]);
  }
  if (c.contact) {
    line("Bp push 0 v={}", *c.contact);
    for (std::size_t i = 0; i < c.at_contact.size(); ++i) line("Gp{0} u{0} 0 push 0 {1}", i, c.at_contact[i]);
  }
  for (const auto& [pin, charge] : c.charges) line("Cq_{0} {0} g q='{1}'", pin, charge);
  for (const auto& [pin, by_rate] : c.currents) {
    for (std::size_t i = 0; i < by_rate.size(); ++i) line("Gi{0}_{1} {0} g u{1} 0 {2}", pin, i, by_rate[i]);
  }
  line("By y 0 v={}*v(at)\nBvel vel 0 v={}*v(rate)", 1e6 * c.gap, c.gap / c.tau);
  line("Bforce force 0 v={}", c.contact ? fmt::format("{}*v(push)", 1e6 * c.force_scale) : "0");
  line("Bs s d i=v(s,d)*(v(at)>1 ? 1/rc : 1/roff)");
  return text + ".ends softland_switch\n";
}

const Dialect spice{.voltage = "v", .has_variables = false};
const Dialect verilog{.voltage = "V", .has_variables = true};

}  // namespace

std::vector<std::string> circuit_pins(const std::vector<std::string>& drives) {
  std::vector<std::string> pins;
  for (const std::string& drive : drives) {
    std::string name = spice_name(drive);
    const bool begins_badly = name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0;
    if (begins_badly || is_numbered(name) || std::ranges::find(reserved_names, name) != reserved_names.end())
      name.insert(0, "drive_");
    std::string free = name;
    for (int n = 2; std::ranges::find(pins, free) != pins.end(); ++n) free = fmt::format("{}_{}", name, n);
    pins.push_back(std::move(free));
  }
  return pins;
}

std::vector<std::string> renamed_pins(const std::vector<std::string>& drives) {
  const std::vector<std::string> pins = circuit_pins(drives);
  std::vector<std::string> told;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    if (pins[k] != spice_name(drives[k])) told.push_back(fmt::format("drive {} is the pin {}", drives[k], pins[k]));
  }
  return told;
}

std::string why_no_circuit(const Switch& model) {
  const Device& device = model.device();
  std::vector<std::string> reasons;
  const auto add = [&](bool holds, const char* reason) {
    if (holds) reasons.emplace_back(reason);
  };
  add(device.gas && is_compressible(*device.gas), "a compressible gas film (it has states of its own)");
  add(device.gas && !std::holds_alternative<LinearGas>(*device.gas) &&
          std::ranges::any_of(local_sections(device.structure), [](const LocalSection& one) { return one.holes.exist(); }),
      "a gas film under holes");
  add(device.dispersion && device.dispersion->conductor == Conductor::gold &&
          device.dispersion->model != DispersionModel::van_der_waals,
      "a Casimir force between gold (a table)");
  add(std::ranges::any_of(device.electrodes, [](const Electrode& e) { return e.fringing == Fringing::bao_2001; }),
      "fringing by bao-2001 (its charge is an integral)");
  add(std::ranges::any_of(device.electrodes, [](const Electrode& e) { return e.dielectric.has_value(); }),
      "a dielectric on an electrode");
  add(model.contacts() > 1, "several contacts");
  add(model.device().touches_along_pad(), "a contact along its pad");
  add(model.device().closes_along_face(), "a landing along the face of a dielectric");
  for (std::size_t c = 0; c < model.contacts(); ++c) {
    if (std::visit([]<class Law>(const Law&) { return only_pushes<Law>; }, model.contact(c))) continue;
    reasons.push_back(fmt::format("the contact law {}", name_of(device.contacts[c].model)));
    break;
  }
  std::string all;
  for (std::size_t k = 0; k < reasons.size(); ++k) all += (k == 0 ? "" : k + 1 == reasons.size() ? " and " : ", ") + reasons[k];
  return all;
}

std::string spice_model(const PreparedScene& p) {
  return fmt::format("* {}\n* pins: drives, their ground g, contact s and d, y [um], vel [m/s], force [uN]\n{}{}", title(p),
                     renamed_in(p, "*"), subcircuit(SubcircuitWriter(p, spice).make()));
}

std::string spice_bench(const PreparedScene& p) {
  const Circuit c = SubcircuitWriter(p, spice).make();
  std::map<std::string, Signal> driven;  // waveform of the voltage source at each pin, by name of the pin
  const std::vector<std::string> names = circuit_pins(p.drive_names());
  const std::vector<Signal> signals = p.signals();
  std::string sources, pins;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& pin = names[k];
    if (std::ranges::find(c.drives, pin) == c.drives.end()) continue;
    driven.emplace(pin, signals[k]);
    sources += fmt::format("Xdrive_{0} {0} 0 softland_{0}\n", pin);
    pins += " " + pin;
  }
  // Choose the time step of the circuit simulator's trapezoidal rule such that the first mode has an error of 1e-6 and the
  // fastest mode has 40 steps per period. A model of a single mode is fast enough for shorter steps with a tenth of that error.
  const Eigen::VectorXd& omega = p.model.basis().angular_frequencies();
  const double step = 2 * pi / std::max(40 * omega.maxCoeff(), (omega.size() == 1 ? 8000 : 1500) * omega[0]);
  std::string text = title(p) + "\n" + renamed_in(p, "*") + subcircuit(c) + spice_pwl(driven, p.duration) + sources;
  text += fmt::format("Xswitch{} 0 s d y vel force softland_switch\nVs s 0 1\nRload d 0 50\n", pins);
  text += ".options reltol=1e-6 abstol=1e-15 vntol=1e-9 chgtol=1e-21 method=trap itl4=100\n";
  text += fmt::format(".tran {} {} 0 {} uic\n", step, p.duration, step);
  text += fmt::format(
      ".control\nrun\nmeas tran t_i when v(y)={0} rise=1\nmeas tran v_i find v(vel) when v(y)={0} rise=1\n"
      "meas tran force max v(force)\nmeas tran t_s when v(y)={0} fall=1\nmeas tran lowest min v(y) from=$&t_s\n"
      "let rebound = {0} - lowest\nprint rebound\n",
      1e6 * c.gap);
  return text + "quit\n.endc\n.end\n";
}

std::string verilog_a(const PreparedScene& p) {
  const Circuit c = SubcircuitWriter(p, verilog).make();
  const std::size_t modes = c.stiffness.size(), points = c.points.size();
  std::string text = fmt::format("// {}\n// y [um], vel [m/s], force [uN] as volts\n{}`include \"disciplines.vams\"\n\n",
                                 title(p), renamed_in(p, "//"));
  const Lines line{text};
  const std::string pins = fmt::format("{}, g, s, d, y, vel, force", fmt::join(c.drives, ", "));
  line("module softland_switch({0});\n  inout {0};\n  electrical {0};", pins);
  line("  parameter real rc = 1, roff = 1e12;");
  for (std::size_t i = 0; i < modes; ++i) line("  electrical y{0}, u{0};", i);
  for (std::size_t k = 0; k < points; ++k) line("  real h{0}, w{0}, f{0};", k);
  line("  real at, rate, push{};\n  analog begin", c.tension.empty() ? "" : ", line");
  line("    at = {};\n    rate = {};\n    push = {};", c.deflection, c.rate, c.contact.value_or("0"));
  if (!c.tension.empty()) line("    line = {};", c.tension.front());
  for (std::size_t k = 0; k < points; ++k) {
    const Point& point = c.points[k];
    line("    h{0} = {1};\n    w{0} = {2};\n    f{0} = {3};", k, point.gap, point.velocity, point.load);
  }
  for (std::size_t i = 0; i < modes; ++i) {
    std::string loads;
    for (std::size_t k = 0; k < points; ++k) loads += fmt::format(" + ({})*f{}", c.points[k].share[i], k);
    for (const auto& [pin, push] : c.pushes[i]) loads += fmt::format(" + ({})*V({},g)", push, pin);
    if (!c.tension.empty()) loads += fmt::format(" - line*{}", c.tension[i + 1]);
    line("    V(y{0}) <+ idt(V(u{0})/{1}, {2});", i, c.tau, c.start[i]);
    line("    V(u{0}) <+ idt((-{2}*V(y{0}) - {3}*V(u{0}) - ({4})*push{5})/{1}, 0);", i, c.tau, c.stiffness[i], c.friction[i],
         c.at_contact[i], loads);
  }
  for (const auto& [pin, charge] : c.charges) line("    I({0},g) <+ ddt({1});", pin, charge);
  for (const auto& [pin, by_rate] : c.currents) {
    for (std::size_t i = 0; i < by_rate.size(); ++i) line("    I({0},g) <+ ({1})*V(u{2});", pin, by_rate[i], i);
  }
  line("    V(y) <+ {}*at;\n    V(vel) <+ {}*rate;\n    V(force) <+ {}*push;", 1e6 * c.gap, c.gap / c.tau, 1e6 * c.force_scale);
  line("    I(s,d) <+ V(s,d)*(at>1 ? 1/rc : 1/roff);\n  end\nendmodule");
  return text;
}

}  // namespace softland
