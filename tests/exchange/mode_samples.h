// Small files of modes in the formats of several programs. The structure is 100 um by 10 um by 2 um and clamped at x = 0.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "exchange/mode_table.h"

namespace softland::test {

struct ModeSample {
  std::string name;
  std::string content;
  std::string format;
  ModeKeys keys = {};
  double digits = 1e-12;  ///< relative error of numbers in the format
  bool is_mesh = true;
};

inline constexpr double sample_length = 100e-6, sample_width = 10e-6, sample_mass = 4e-12;
inline constexpr std::array<double, 2> sample_frequencies{25000, 156000};
inline const std::vector<double>& sample_positions() {
  static const std::vector<double> all{0, 20e-6, 40e-6, 60e-6, 80e-6, 100e-6};
  return all;
}

/// Returns the value of a mode shape in 1/sqrt(kg). It begins quadratically at x = 0, is positive at the end, and has about the
/// size of the mode of a beam with the mass sample_mass.
inline double sample_shape(std::size_t mode, double x) {
  const double u = x / sample_length, tip = 2 / std::sqrt(sample_mass);
  return mode == 0 ? tip * u * u * (6 - 4 * u + u * u) / 3 : tip * u * u * (4.8 * u - 3.8);
}

/// A node and its text "x,y,z". There are six nodes at each x, around the axis.
struct SampleNode {
  std::size_t section;
  double y, z;
};
inline std::vector<SampleNode> sample_nodes() {
  std::vector<SampleNode> all;
  for (std::size_t s = 0; s < sample_positions().size(); ++s) {
    for (const double y : {-5e-6, 0.0, 5e-6})
      for (const double z : {-1e-6, 1e-6}) all.push_back({s, y, z});
  }
  return all;
}

/// Returns a CalculiX .frd in units of length `unit` [m] and of mass `mass_unit` [kg]. It has two modes along z, one along y
/// between them, and a torsional mode at the end.
inline std::string sample_frd(double unit = 1, double mass_unit = 1, bool is_short = false) {
  const std::vector<SampleNode> nodes = sample_nodes();
  const auto line = [&](std::size_t node, double x, double y, double z) {
    return is_short ? fmt::format(" -1{:5}{:12.5E}{:12.5E}{:12.5E}\n", node, x, y, z)
                    : fmt::format(" -1{:10}{:12.5E}{:12.5E}{:12.5E}\n", node, x, y, z);
  };
  const int format = is_short ? 0 : 1;
  std::string text = "    1C\n    1UPGM               CalculiX\n";
  text += fmt::format("    2C{:18}{:12}{:38}\n", "", nodes.size(), format);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    text += line(i + 1, sample_positions()[nodes[i].section] / unit, nodes[i].y / unit, nodes[i].z / unit);
  text += " -3\n";
  const double scale = std::sqrt(mass_unit);
  const auto mode = [&](int number, double frequency, auto motion) {
    text += fmt::format("    1PGM                1.000000E+00\n    1PGK                {:12.6E}\n    1PMODE {:25}\n",
                        std::pow(2 * 3.14159265358979 * frequency, 2), number);
    text += fmt::format("  100CL  {:3}{:12.6g}{:12}{:20}{:2}{:5}MODAL{:7}\n", 100 + number, frequency, nodes.size(), "", 2,
                        number, format);
    text += " -4  DISP        4    1\n -5  D1          1    2    1    0\n";
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::array<double, 3> m = motion(sample_positions()[nodes[i].section], nodes[i]);
      text += line(i + 1, scale * m[0], scale * m[1], scale * m[2]);
    }
    text += " -3\n";
  };
  mode(1, sample_frequencies[0], [](double x, const SampleNode&) { return std::array{0.0, 0.0, -sample_shape(0, x)}; });
  mode(2, 90000, [](double x, const SampleNode&) { return std::array{0.0, sample_shape(0, x), 0.0}; });
  mode(3, sample_frequencies[1], [](double x, const SampleNode&) { return std::array{0.0, 0.0, sample_shape(1, x)}; });
  mode(4, 300000, [](double x, const SampleNode& n) {
    return std::array{0.0, -1e11 * n.z * x / sample_length, 1e11 * n.y * x / sample_length};
  });
  return text + " 9999\n";
}

/// Returns an export of COMSOL along a line. Its modes are in metres with arbitrary factors, and complex if `imaginary` is not
/// 0.
inline std::string sample_comsol(bool is_csv, double imaginary = 0) {
  const auto number = [&](double value) {
    return imaginary == 0 ? fmt::format("{:.15g}", value) : fmt::format("{:.15g}{:+.15g}i", value, imaginary * value);
  };
  std::string text =
      is_csv
          ? "% Model,beam.mph\n% Version,COMSOL 6.2\n% Dimension,3\n% Nodes,6\n% Expressions,2\n% Length unit,um\n"
          : "% Model:              beam.mph\n% Version:            COMSOL 6.2\n% Dimension:          3\n% Nodes:              6\n"
            "% Expressions:        2\n% Length unit:        um\n";
  text += is_csv ? "% x,y,z,w (m) @ freq=25000, p=1,w (m) @ freq=156000, p=1\n"
                 : "% x                       y                        z                        w (m) @ freq=25000       w (m) @ "
                   "freq=156000\n";
  for (const double x : sample_positions()) {
    // The factors do not follow from the modal mass.
    const std::string first = number(-3e-12 * sample_shape(0, x)), second = number(7e-13 * sample_shape(1, x));
    text += is_csv ? fmt::format("{:.15g},0,0,{},{}\n", x * 1e6, first, second)
                   : fmt::format("{:<25.15g}{:<25}{:<25}{:<25} {}\n", x * 1e6, 0, 0, first, second);
  }
  return text;
}

/// Returns data sets 164, 2411 and 55 with a modal mass of 2 by default.
inline std::string sample_uff(double modal_mass = 2, bool has_nodes = true) {
  std::string text = "    -1\n   164\n         1  SI\n  1.0D+00  1.0D+00  1.0D+00\n  0.0D+00\n    -1\n";
  const std::vector<double>& x = sample_positions();
  if (has_nodes) {
    text += "    -1\n  2411\n";
    for (std::size_t i = 0; i < x.size(); ++i)
      text += fmt::format("{:10}{:10}{:10}{:10}\n{:25.16E}{:25.16E}{:25.16E}\n", 11 + i, 1, 1, 11, x[i], 0.0, 0.0);
    text += "    -1\n";
  }
  for (std::size_t k = 0; k < sample_frequencies.size(); ++k) {
    text += "    -1\n    55\nNONE\nNONE\nNONE\nNONE\nNONE\n";
    text += fmt::format("{:10}{:10}{:10}{:10}{:10}{:10}\n{:10}{:10}{:10}{:10}\n", 1, 2, 2, 8, 2, 3, 2, 4, 1, k + 1);
    text += fmt::format("{:13.5E}{:13.5E}{:13.5E}{:13.5E}\n", sample_frequencies[k], modal_mass, 0.0, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i)
      text += fmt::format("{:10}\n{:13.5E}{:13.5E}{:13.5E}\n", 11 + i, 0.0, 0.0,
                          -std::sqrt(modal_mass > 0 ? modal_mass : 1) * sample_shape(k, x[i]));
    text += "    -1\n";
  }
  return text;
}

/// Returns a reduced-order model of ANSYS in um at five nodes, none of them at the clamp. Two of its three modes are used.
inline std::string sample_rom() {
  const std::vector<double>& x = sample_positions();
  std::string text =
      "RELEASE:   18.        20170726        \n       3       1       1       0       1       0\n       1       2       3\n";
  const auto row = [&](const std::vector<double>& numbers) {
    for (const double v : numbers) text += fmt::format(" {:18.11E}", v);
    text += "    \n";
  };
  row({sample_frequencies[0], sample_frequencies[1], 200000});
  row({0, 0, 0});
  row({-3.3, -0.08, 0});
  row({3.3, 0.08, 0});
  text += "       2      35      36      37      38       0       0       0       0       0\n";
  text += "       3       3       3       3       3       0       0       0       0       0\n";
  std::vector<double> places, first, second;
  for (std::size_t i = 1; i < x.size(); ++i) {
    places.push_back(x[i] * 1e6);
    first.push_back(sample_shape(0, x[i]) / sample_shape(0, sample_length));
    second.push_back(sample_shape(1, x[i]) / sample_shape(1, sample_length));
  }
  const std::vector<double> none(5, 0.0);
  for (const std::vector<double>& numbers : {places, none, none, first, second, none}) row(numbers);
  return text + "SENE    \nCAP12   \n";
}

inline std::string sample_mode_csv() {
  std::string text = "# made here\nx_m,width_m,rest_offset_m,mode_1,mode_2\nfrequency_Hz,,,25000,156000\n";
  for (const double x : sample_positions()) text += fmt::format("{},1e-05,0,{},{}\n", x, sample_shape(0, x), sample_shape(1, x));
  return text;
}

inline std::vector<ModeSample> mode_samples() {
  const ModeKeys along{.axis = "x", .direction = "-z", .prefix = "structure."};
  ModeKeys with_mass = along, rom = along, mm = along;
  with_mass.mass = sample_mass;
  rom.mass = sample_mass, rom.length_unit = 1e-6, rom.clamp = 0;
  mm.length_unit = 1e-3, mm.mass_unit = 1e3;
  constexpr double six_digits = 1e-5;
  return {
      {.name = "table", .content = sample_mode_csv(), .format = "table of modes", .is_mesh = false},
      {.name = "frd", .content = sample_frd(), .format = "CalculiX .frd", .keys = along, .digits = six_digits},
      {.name = "frd in mm and t", .content = sample_frd(1e-3, 1e3), .format = "CalculiX .frd", .keys = mm, .digits = six_digits},
      {.name = "frd, short", .content = sample_frd(1, 1, true), .format = "CalculiX .frd", .keys = along, .digits = six_digits},
      {.name = "comsol", .content = sample_comsol(false), .format = "COMSOL text", .keys = with_mass},
      {.name = "comsol, complex", .content = sample_comsol(false, 0.75), .format = "COMSOL text", .keys = with_mass},
      {.name = "comsol csv", .content = sample_comsol(true), .format = "COMSOL CSV", .keys = with_mass},
      {.name = "uff", .content = sample_uff(), .format = "UFF 55", .keys = along, .digits = six_digits},
      {.name = "rom", .content = sample_rom(), .format = "ANSYS .rom", .keys = rom, .digits = six_digits}};
}

}  // namespace softland::test
