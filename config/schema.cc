#include "config/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace softland::internal {
namespace {

constexpr Range positive{.least = 0, .least_open = true};
constexpr Range not_negative{.least = 0};
constexpr Range small_error{.least = 0, .most = 0.1, .least_open = true};

/// Contact laws of asperities.
const std::vector<std::string_view> rough_contacts{"asperity-uniform", "asperity-gaussian", "adhesive", "elastic-plastic"};

/// An electrode's voltages may be multiples of its pull-in voltages.
const std::vector<Dimension> drive_voltage{dimension::voltage, dimension::static_pull_in, dimension::dynamic_pull_in};

/// Gas models that describe a gas, not a damper.
const std::vector<std::string_view> gas_films{"strip",        "veijola",       "gallis-torczynski",
                                              "near-contact", "guo-alexeenko", "reynolds"};

/// Structures that bend.
const std::vector<std::string_view> beams{"cantilever", "clamped-clamped"};

/// Waveforms of the drive `entry`, or of all without a section of their own, with levels of these dimensions.
Section waveform_section(std::string_view entry, const std::vector<Dimension>& level, std::string_view about) {
  using enum KeyType;
  std::vector<Dimension> amplitude = level;
  if (entry.empty()) amplitude.push_back(dimension::none);  // a percentage
  const std::string_view rest = entry.empty() ? "'0 V'" : "1.0";
  return {.name = "waveform",
          .entry = entry,
          .is_named = true,
          .may_vary = true,
          .selector = "family",
          .keys =
              {
                  {.name = "family",
                   .type = choice,
                   .choices = {"step", "harmonic", "pulse", "table"},
                   .required = true,
                   .about = "shape of the voltage against time"},
                  {.name = "level", .dimensions = level, .required = true, .only_for = {"step"}, .about = "held for ever"},
                  {.name = "rise_time",
                   .dimensions = {dimension::time},
                   .range = not_negative,
                   .fallback = "'0 s'",
                   .only_for = {"step"},
                   .about = "linear rise from 0 V"},
                  {.name = "base",
                   .dimensions = level,
                   .fallback = rest,
                   .only_for = {"harmonic"},
                   .about = "what the sine swings about"},
                  {.name = "rise_time",
                   .dimensions = {dimension::time},
                   .range = not_negative,
                   .fallback = "'0 s'",
                   .only_for = {"harmonic"},
                   .about = "linear rise of the base from 0 V"},
                  {.name = "amplitude",
                   .dimensions = amplitude,
                   .required = true,
                   .only_for = {"harmonic"},
                   .about = "or a percentage of the base; for the piezo, of the main hold level"},
                  {.name = "angular_frequency",
                   .dimensions = {dimension::angular_frequency},
                   .range = positive,
                   .required = true,
                   .only_for = {"harmonic"},
                   .instead_of = {"frequency"},
                   .about = "of the sine"},
                  {.name = "frequency",
                   .dimensions = {dimension::frequency},
                   .range = positive,
                   .required = true,
                   .only_for = {"harmonic"},
                   .instead_of = {"angular_frequency"},
                   .about = "of the sine"},
                  {.name = "phase",
                   .dimensions = {dimension::angle},
                   .fallback = "'0 rad'",
                   .only_for = {"harmonic"},
                   .about = "of the sine at t = 0"},
                  {.name = "start",
                   .dimensions = {dimension::time},
                   .range = not_negative,
                   .fallback = "'0 s'",
                   .only_for = {"harmonic"},
                   .about = "when the sine begins"},
                  {.name = "end",
                   .dimensions = {dimension::time},
                   .range = positive,
                   .only_for = {"harmonic"},
                   .about = "when the sine ends; absent: never"},
                  {.name = "fade",
                   .dimensions = {dimension::time},
                   .range = not_negative,
                   .fallback = "'0 s'",
                   .only_for = {"harmonic"},
                   .about = "linear fade in after start and out before end"},
                  {.name = "levels",
                   .type = quantities,
                   .dimensions = level,
                   .required = true,
                   .only_for = {"pulse"},
                   .about = "n levels; the last is held for ever"},
                  {.name = "times",
                   .type = quantities,
                   .dimensions = {dimension::time},
                   .range = not_negative,
                   .fallback = "[]",
                   .only_for = {"pulse"},
                   .about = "n - 1 times at which the edge to the next level begins"},
                  {.name = "edge",
                   .dimensions = {dimension::time},
                   .range = not_negative,
                   .fallback = "'0 s'",
                   .only_for = {"pulse"},
                   .about = "duration of every linear edge"},
                  {.name = "file",
                   .type = text,
                   .required = true,
                   .only_for = {"table"},
                   .instead_of = {"times", "voltages"},
                   .about = "CSV with time_s and a column named after the drive, relative to the scene"},
                  {.name = "times",
                   .type = quantities,
                   .dimensions = {dimension::time},
                   .range = not_negative,
                   .required = true,
                   .only_for = {"table"},
                   .instead_of = {"file"},
                   .about = "of the rows, from 0 s on"},
                  {.name = "voltages",
                   .type = quantities,
                   .dimensions = level,
                   .required = true,
                   .only_for = {"table"},
                   .instead_of = {"file"},
                   .about = "of the rows; linear between them"},
              },
          .about = about};
}

std::vector<Section> make_schema() {
  using enum KeyType;
  return {
      {.name = "", .keys = {{.name = "title", .type = text, .fallback = "''", .about = "one line that names the switch"}}},
      {.name = "structure",
       .required = true,
       .may_vary = true,
       .selector = "kind",
       .keys =
           {
               {.name = "kind",
                .type = choice,
                .choices = {"cantilever", "clamped-clamped", "plate"},
                .required = true,
                .about = "what moves"},
               {.name = "length",
                .dimensions = {dimension::length},
                .range = positive,
                .required = true,
                .only_for = beams,
                .about = "along the beam"},
               {.name = "width",
                .dimensions = {dimension::length},
                .range = positive,
                .required = true,
                .only_for = beams,
                .about = "across the beam"},
               {.name = "thickness",
                .dimensions = {dimension::length},
                .range = positive,
                .required = true,
                .only_for = beams,
                .about = "in the direction of motion"},
               {.name = "youngs_modulus",
                .dimensions = {dimension::pressure},
                .range = positive,
                .required = true,
                .only_for = beams,
                .about = "used as given unless plate_strain is on"},
               {.name = "density",
                .dimensions = {dimension::density},
                .range = positive,
                .required = true,
                .only_for = beams,
                .about = "of the beam"},
               {.name = "modes",
                .type = integer,
                .range = {.least = 1, .most = 20},
                .words = {"auto"},
                .fallback = "4",
                .only_for = beams,
                .about = "number of modes kept; auto: until the figures stop moving"},
               {.name = "damping_ratio",
                .dimensions = {dimension::none},
                .range = {.least = 0, .most = 1, .most_open = true},
                .fallback = "0.0",
                .about = "modal, the same for every mode"},
               {.name = "plate_strain",
                .type = flag,
                .fallback = "false",
                .only_for = beams,
                .about = "use E / (1 - nu^2) for a wide beam"},
               {.name = "poissons_ratio",
                .dimensions = {dimension::none},
                .range = {.least = -1, .most = 0.5, .least_open = true, .most_open = true},
                .only_for = beams,
                .about = "needed by plate_strain and biaxial"},
               {.name = "residual_stress",
                .dimensions = {dimension::pressure},
                .fallback = "'0 Pa'",
                .only_for = {"clamped-clamped"},
                .about = "along the beam before it bends, positive in tension"},
               {.name = "biaxial",
                .type = flag,
                .fallback = "false",
                .only_for = {"clamped-clamped"},
                .about = "residual_stress is that of the unreleased film: the beam keeps residual_stress (1 - nu)"},
               {.name = "stretching",
                .type = flag,
                .fallback = "true",
                .only_for = {"clamped-clamped"},
                .about = "bending stretches the beam: a cubic stiffness"},
               {.name = "mass",
                .dimensions = {dimension::mass},
                .range = positive,
                .required = true,
                .only_for = {"plate"},
                .about = "moving mass"},
               {.name = "stiffness",
                .dimensions = {dimension::stiffness},
                .range = positive,
                .required = true,
                .only_for = {"plate"},
                .about = "of all springs together"},
               {.name = "area",
                .dimensions = {dimension::area},
                .range = positive,
                .required = true,
                .only_for = {"plate"},
                .about = "of the plate"},
               {.name = "width",
                .dimensions = {dimension::length},
                .range = positive,
                .only_for = {"plate"},
                .about = "needed by gas films, fringing and rough contacts; the length is area / width"},
               {.name = "thickness",
                .dimensions = {dimension::length},
                .range = positive,
                .only_for = {"plate"},
                .about = "needed by fringing laws that depend on it"},
           },
       .about = "the moving part"},
      {.name = "gap",
       .required = true,
       .may_vary = true,
       .keys = {{.name = "electrode",
                 .dimensions = {dimension::length},
                 .range = positive,
                 .required = true,
                 .about = "rest distance beam to electrode"},
                {.name = "contact",
                 .dimensions = {dimension::length},
                 .range = positive,
                 .required = true,
                 .about = "rest distance contact point to contact plane"}},
       .about = "rest distances"},
      {.name = "electrode",
       .is_named = true,
       .may_vary = true,
       .keys = {{.name = "span",
                 .type = quantities,
                 .dimensions = {dimension::length},
                 .range = not_negative,
                 .count = 2,
                 .about = "begin and end, from the clamped end; beams only and required there"},
                {.name = "area",
                 .dimensions = {dimension::area},
                 .range = positive,
                 .about = "plates only; absent: that of the plate"},
                {.name = "fringing",
                 .type = choice,
                 .choices = {"none", "bao-2001", "meijs-fokkema", "linear"},
                 .fallback = "'meijs-fokkema'",
                 .about = "law of the fringing field"}},
       .about = "an electrode under the beam"},
      {.name = "gas",
       .may_vary = true,
       .selector = "model",
       .keys = {{.name = "model",
                 .type = choice,
                 .choices = {"strip", "veijola", "gallis-torczynski", "near-contact", "guo-alexeenko", "reynolds", "linear"},
                 .required = true,
                 .about = "law of the squeeze film"},
                {.name = "viscosity",
                 .dimensions = {dimension::viscosity},
                 .range = positive,
                 .only_for = gas_films,
                 .about = "absent: that of air at the temperature"},
                {.name = "pressure",
                 .dimensions = {dimension::pressure},
                 .range = positive,
                 .fallback = "'101325 Pa'",
                 .only_for = gas_films,
                 .about = "ambient"},
                {.name = "temperature",
                 .dimensions = {dimension::temperature},
                 .range = positive,
                 .fallback = "'300 K'",
                 .only_for = gas_films,
                 .about = "of the gas"},
                {.name = "mean_free_path",
                 .dimensions = {dimension::length},
                 .range = positive,
                 .only_for = gas_films,
                 .about = "absent: from viscosity, pressure and temperature"},
                {.name = "damping",
                 .dimensions = {dimension::viscosity},
                 .range = positive,
                 .required = true,
                 .only_for = {"linear"},
                 .instead_of = {"quality_factor"},
                 .about = "constant force per length and velocity [N s/m^2]"},
                {.name = "quality_factor",
                 .dimensions = {dimension::none},
                 .range = positive,
                 .required = true,
                 .only_for = {"linear"},
                 .instead_of = {"damping"},
                 .about = "of the first mode, instead of damping"}},
       .about = "gas between beam and electrode; absent: none"},
      {.name = "contact",
       .may_vary = true,
       .selector = "model",
       .keys =
           {
               {.name = "model",
                .type = choice,
                .choices = {"linear", "asperity-uniform", "asperity-gaussian", "adhesive", "hysteretic", "elastic-plastic",
                            "rigid"},
                .required = true,
                .about = "law of the contact force"},
               {.name = "pad_length",
                .dimensions = {dimension::length},
                .range = positive,
                .about =
                    "the pad ends at the free end, or lies about the middle between two clamps; the force acts at its centre"},
               {.name = "stiffness",
                .dimensions = {dimension::stiffness},
                .range = positive,
                .required = true,
                .only_for = {"linear", "hysteretic"},
                .about = "contact force per penetration; hysteretic: while loading"},
               {.name = "unloading_stiffness",
                .dimensions = {dimension::stiffness},
                .range = positive,
                .required = true,
                .only_for = {"hysteretic"},
                .about = "not below stiffness; restitution squared is stiffness over this"},
               {.name = "asperity_radius",
                .dimensions = {dimension::length},
                .range = positive,
                .required = true,
                .only_for = rough_contacts,
                .about = "radius of the summits"},
               {.name = "asperity_density",
                .dimensions = {dimension::area_density},
                .range = positive,
                .required = true,
                .only_for = rough_contacts,
                .about = "summits per area"},
               {.name = "asperity_height",
                .dimensions = {dimension::length},
                .range = positive,
                .required = true,
                .only_for = {"asperity-uniform", "adhesive", "elastic-plastic"},
                .about = "summit heights are uniform on [0, asperity_height]"},
               {.name = "asperity_deviation",
                .dimensions = {dimension::length},
                .range = positive,
                .required = true,
                .only_for = {"asperity-gaussian"},
                .about = "standard deviation of the summit heights; first touch at four of them above their mean"},
               {.name = "effective_modulus",
                .dimensions = {dimension::pressure},
                .range = positive,
                .required = true,
                .only_for = rough_contacts,
                .about = "E* of the pair of surfaces"},
               {.name = "hardness",
                .dimensions = {dimension::pressure},
                .range = positive,
                .required = true,
                .only_for = {"elastic-plastic"},
                .about = "of the softer surface"},
               {.name = "plasticity",
                .type = choice,
                .choices = {"zmc", "ke", "ceb"},
                .fallback = "'zmc'",
                .only_for = {"elastic-plastic"},
                .about = "law of one asperity; ceb jumps and is refused"},
               {.name = "adhesion_energy",
                .dimensions = {dimension::stiffness},
                .range = positive,
                .required = true,
                .only_for = {"adhesive"},
                .about = "work of adhesion per area of the pair of surfaces"},
               {.name = "restitution",
                .dimensions = {dimension::none},
                .range = {.least = 0, .most = 1, .most_open = true},
                .required = true,
                .only_for = {"rigid"},
                .about = "velocity after an impact over that before"},
               {.name = "damping",
                .dimensions = {dimension::slowness},
                .range = positive,
                .only_for = {"linear", "asperity-uniform", "asperity-gaussian"},
                .about = "of Hunt and Crossley: restitution about 1 - damping times impact velocity; absent: none"},
           },
       .about = "contact under the tip; absent: the tip meets nothing"},
      {.name = "piezo",
       .may_vary = true,
       .keys =
           {
               {.name = "span",
                .type = quantities,
                .dimensions = {dimension::length},
                .range = not_negative,
                .count = 2,
                .required = true,
                .about = "begin and end, from the clamped end"},
               {.name = "thickness",
                .dimensions = {dimension::length},
                .range = positive,
                .required = true,
                .about = "of the layer"},
               {.name = "youngs_modulus",
                .dimensions = {dimension::pressure},
                .range = positive,
                .required = true,
                .about = "of the layer"},
               {.name = "density",
                .dimensions = {dimension::density},
                .range = positive,
                .required = true,
                .about = "of the layer"},
               {.name = "d31",
                .dimensions = {dimension::piezo_coefficient},
                .required = true,
                .about = "negative for the usual ceramics: a positive voltage lifts the tip"},
           },
       .about = "a piezoelectric layer on the face away from the electrode"},
      {.name = "dispersion",
       .may_vary = true,
       .selector = "model",
       .keys = {{.name = "model",
                 .type = choice,
                 .choices = {"casimir", "van-der-waals", "auto"},
                 .required = true,
                 .about = "law of the force; auto: the smaller of the two at each gap"},
                {.name = "conductor",
                 .type = choice,
                 .choices = {"ideal", "gold"},
                 .fallback = "'ideal'",
                 .only_for = {"casimir", "auto"},
                 .about = "metal of the Casimir law"},
                {.name = "hamaker_constant",
                 .dimensions = {dimension::energy},
                 .range = positive,
                 .required = true,
                 .only_for = {"van-der-waals", "auto"},
                 .about = "of the pair of surfaces"},
                {.name = "equilibrium_distance",
                 .dimensions = {dimension::length},
                 .range = not_negative,
                 .fallback = "'0 m'",
                 .only_for = {"van-der-waals", "auto"},
                 .about = "where attraction and repulsion balance; 0 m: no repulsion"}},
       .about = "Casimir and van der Waals forces between beam and electrode plane; absent: none"},
      {.name = "surface", .pending = true, .about = "surface elasticity and residual stress"},
      waveform_section({}, drive_voltage, "voltage of an electrode or of the piezo; a drive without one stays at 0 V"),
      waveform_section("dispersion", {dimension::none},
                       "factor of the dispersion force, nominally 1; without one it stays there"),
      {.name = "driver",
       .is_named = true,
       .keys = {{.name = "min_voltage", .dimensions = drive_voltage, .about = "default for an electrode: 0 V"},
                {.name = "max_voltage", .dimensions = drive_voltage, .about = "default for an electrode: 1.5 Vdp"},
                {.name = "max_slew", .dimensions = {dimension::slew_rate}, .range = positive, .about = "absent: unlimited"}},
       .about = "limits of the source: hard bounds of every search"},
      {.name = "simulate",
       .always_in_force = true,
       .keys = {{.name = "duration",
                 .dimensions = {dimension::time},
                 .range = positive,
                 .about = "absent: six periods of the first mode"},
                {.name = "accuracy",
                 .dimensions = {dimension::none},
                 .range = small_error,
                 .fallback = "1e-06",
                 .instead_of = {"tolerance"},
                 .about = "target relative error of t_i, v_i and B_H"},
                {.name = "tolerance",
                 .dimensions = {dimension::none},
                 .range = small_error,
                 .instead_of = {"accuracy"},
                 .about = "relative tolerance of the integrator, instead of accuracy"}},
       .about = "the run"},
      {.name = "metrics",
       .always_in_force = true,
       .keys = {{.name = "significant_rebound",
                 .dimensions = {dimension::length},
                 .range = positive,
                 .fallback = "'1 nm'",
                 .about = "a rebound counts when it is higher"}},
       .about = "figures of merit"},
      {.name = "spread",
       .is_named = true,
       .selector = "distribution",
       .keys = {{.name = "distribution",
                 .type = choice,
                 .choices = {"normal", "lognormal", "uniform"},
                 .required = true,
                 .about = "of the key that varies; its mean is the scene's value"},
                {.name = "cov",
                 .dimensions = {dimension::none},
                 .range = {.least = 0, .most = 1, .least_open = true},
                 .required = true,
                 .instead_of = {"half_width"},
                 .about = "standard deviation over mean"},
                {.name = "half_width",
                 .range = positive,
                 .required = true,
                 .only_for = {"uniform"},
                 .instead_of = {"cov"},
                 .about = "in the unit of the key, or a percentage of its value"}},
       .about = "manufacturing spread of scene keys"},
  };
}

/// Edits (insertion, deletion, substitution, swap of neighbours) from `a` to `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

bool Range::contains(double value) const {
  return (least_open ? value > least : value >= least) && (most_open ? value < most : value <= most);
}

std::string Range::rule(std::string_view unit) const {
  const auto with_unit = [&](double value) {
    return unit.empty() ? number_text(value) : fmt::format("{} {}", number_text(value), unit);
  };
  if (most == std::numeric_limits<double>::infinity()) {
    return fmt::format("must be {} {}", least_open ? "greater than" : "at least", with_unit(least));
  }
  return fmt::format("must be in {}{}, {}{}", least_open ? '(' : '[', with_unit(least), with_unit(most), most_open ? ')' : ']');
}

bool Key::is_bare_number() const {
  const bool is_quantity = type == KeyType::quantity || type == KeyType::quantities;
  return is_quantity && dimensions.size() == 1 && dimensions.front() == dimension::none;
}

bool Key::belongs_to(std::string_view choice) const {
  return only_for.empty() || std::find(only_for.begin(), only_for.end(), choice) != only_for.end();
}

const Key* Section::find(std::string_view key, std::string_view choice) const {
  const Key* found = nullptr;
  for (const Key& candidate : keys) {
    if (candidate.name != key) continue;
    if (candidate.belongs_to(choice)) return &candidate;
    if (!found) found = &candidate;
  }
  return found;
}

const std::vector<Section>& schema() {
  static const std::vector<Section> sections = make_schema();
  return sections;
}

const Section* find_section(std::string_view name, std::string_view entry) {
  const Section* found = nullptr;
  for (const Section& section : schema()) {
    if (section.name == name && (section.entry.empty() || section.entry == entry)) found = &section;
  }
  return found;
}

std::string hint(std::string_view word, const std::vector<std::string_view>& known) {
  if (known.empty()) return {};
  constexpr std::size_t longest_word = 64;  // a longer one is no slip of the pen, and the distance costs the product of lengths
  if (word.size() <= longest_word) {
    const auto distance = [&](std::string_view name) { return edit_distance(word, name); };
    const auto nearest = *std::min_element(known.begin(), known.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
    if (distance(nearest) <= std::max<std::size_t>(2, nearest.size() / 3)) return fmt::format(" (did you mean '{}'?)", nearest);
  }
  return fmt::format(" (known: {})", fmt::join(known, ", "));
}

}  // namespace softland::internal
