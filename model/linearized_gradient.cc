#include <algorithm>
#include <array>
#include <utility>

#include "base/lanes.h"
#include "model/linearized_closing.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index row_lanes = lanes;               // rows are padded to multiples of this, whole SIMD vectors
constexpr Index most_unknowns = 2 * most_modes;  // largest number of unknowns, a multiple of row_lanes

// Adds value += gain for very many small gains with compensated summation (Kahan 1965): `left` stores by how much the rounded
// value exceeds the exact sum.
template <class Value, class Left, class Gain>
void add_compensated(Value&& value, Left&& left, const Gain& gain) {
  for (Index i = 0; i < gain.rows(); ++i) {
    for (Index j = 0; j < gain.cols(); ++j) {
      const double wanted = gain(i, j) - left(i, j), sum = value(i, j) + wanted;
      left(i, j) = (sum - value(i, j)) - wanted;
      value(i, j) = sum;
    }
  }
}

// Computes what carries a row vector of weights w back over a part of a step, x being the matrix of Magnus' series: w (exp(x) -
// 1) and, for the inputs, w phi_j(x) = sum over k of w x^k / (k + j)!, j = 1, 2, 3.
struct RowSeries {
  using Row = Eigen::Array<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, most_unknowns>;
  Row gain, phi1, phi2, phi3;

  template <class W>
  RowSeries(const double* x, Index size, Index stride, int terms, const W& w) {
    std::array<double, most_unknowns> first{}, second;
    double *term = first.data(), *next = second.data();
    Eigen::Map<Row>(term, size) = w;
    gain = Row::Zero(stride);
    phi1 = Eigen::Map<Row>(term, stride);
    phi2 = phi1 / 2;
    phi3 = phi1 / 6;
    for (int k = 1; k <= terms; ++k) {
      const double over = 1.0 / k, by1 = 1.0 / (k + 1), by2 = by1 / (k + 2), by3 = by2 / (k + 3);
      for (Index c = 0; c < stride; c += row_lanes) {
        Lane sum = Lane::Zero();
        for (Index i = 0; i < size; ++i) sum += term[i] * Eigen::Map<const Lane>(x + i * stride + c);
        sum *= over;
        Eigen::Map<Lane>{next + c} = sum;
        Eigen::Map<Lane>{gain.data() + c} += sum;
        Eigen::Map<Lane>{phi1.data() + c} += by1 * sum;
        Eigen::Map<Lane>{phi2.data() + c} += by2 * sum;
        Eigen::Map<Lane>{phi3.data() + c} += by3 * sum;
      }
      std::swap(term, next);
    }
  }
};

// Advances derivatives d, one column per parameter, over a part of a step by d' = x d + u1 + u2 s + u3 s^2 from s = 0 to 1. x
// is the matrix of Magnus' series; the vectors u are the contribution of the inputs. Their upper half, the rates of the
// coordinates, is 0 and not stored. Rows are padded to whole SIMD vectors.
using Columns = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
struct ColumnSeries {
  Columns gain, term, next;

  void carry(const double* x, Index stride, int terms, const std::array<Columns, 3>& u, const Columns& d) {
    const Index size = 2 * u[0].rows(), columns = d.cols();
    term = d.topRows(size);
    gain = Columns::Zero(size, columns);
    next.resize(size, columns);
    for (int k = 1; k <= terms; ++k) {
      const double over = 1.0 / k;
      for (Index c = 0; c < columns; c += row_lanes) {
        for (Index i = 0; i < size; ++i) {
          Lane sum = Lane::Zero();
          for (Index j = 0; j < size; ++j) sum += x[i * stride + j] * Eigen::Map<const Lane>(term.data() + j * columns + c);
          if (k <= 3 && 2 * i >= size)
            sum += Eigen::Map<const Lane>(u[static_cast<std::size_t>(k - 1)].data() + (i - size / 2) * columns + c);
          Eigen::Map<Lane>{next.data() + i* columns + c} = over * sum;
          Eigen::Map<Lane>{gain.data() + i* columns + c} += over * sum;
        }
      }
      term.swap(next);
    }
  }
};

}  // namespace

VectorXd LinearizedClosing::scaled(const FigureSlope::Weights& weights) const {
  VectorXd all(size_ + 1);
  all.head(n_) = weights.by_q / fastest_;
  all.segment(n_, n_) = weights.by_v;
  all[size_] = weights.by_shift;
  return all;
}

// Adds to the gradient the direct derivatives of figures of merit: by the breakpoints at which they are measured, and by the
// device at fixed q and v.
void LinearizedClosing::add_moved(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes, MatrixXd& gradient) const {
  for (std::size_t f = 0; f < figures.size(); ++f) {
    for (const FigureSlope::Moved& m : figures[f].moved) {
      for (const SignalSlopes::Slope& slope : slopes.at(m.drive, m.piece))
        gradient(static_cast<Index>(f), static_cast<Index>(slope.parameter)) += m.rate * slope.begin;
    }
    for (Index j = 0; j < figures[f].by_device.size(); ++j) gradient(static_cast<Index>(f), column(j)) += figures[f].by_device[j];
  }
}

// Calls add(input, parameter, a, b, c) for every input of the linearised equations (such as a voltage) and every parameter on
// which it depends. The arguments a, b, c are the derivatives of the input by the parameter at begin, middle and end of a part
// of a step.
template <class Add>
void LinearizedClosing::for_inputs(const Part& part, const SignalSlopes& slopes, Add&& add) const {
  const std::vector<std::size_t>& on = pieces(arcs_[part.arc]);
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    for (const SignalSlopes::Slope& slope : slopes.at(k, on[k])) {
      add(static_cast<Index>(k), static_cast<Index>(slope.parameter), slope.voltage(part.begin),
          slope.voltage((part.begin + part.end) / 2), slope.voltage(part.end));
    }
  }
  for (Index j = 0; j < moving_; ++j) add(dent_ + 1 + j, column(j), 1.0, 1.0, 1.0);
}

// Carries the weights of the figures back from the end of the motion to its begin, part by part. The contribution of an input
// is integrated exactly if it is a parabola in time within a part.
MatrixXd LinearizedClosing::backward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes) {
  linearize_for(figures);
  const auto count = static_cast<Index>(figures.size());
  MatrixXd gradient = MatrixXd::Zero(count, static_cast<Index>(slopes.parameters()));
  MatrixXd weights = MatrixXd::Zero(count, size_ + 1), left = weights;
  // Index of the arc, row of the figure in the gradient, and its weights.
  std::vector<std::pair<std::size_t, std::pair<Index, VectorXd>>> given;
  for (std::size_t f = 0; f < figures.size(); ++f) {
    for (const FigureSlope::Weights& w : figures[f].weights) given.push_back({w.arc, {static_cast<Index>(f), scaled(w)}});
  }
  add_moved(figures, slopes, gradient);
  std::stable_sort(given.begin(), given.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  MatrixXd at_begin(count, inputs_), at_middle(count, inputs_), at_end(count, inputs_);
  auto jump = jumps_.rbegin();
  for (std::size_t k = parts_.size(); k-- > 0;) {
    const Part& part = parts_[k];
    for (; jump != jumps_.rend() && jump->parts == k + 1; ++jump) {
      for (const auto& [moved, gained] : jump->moved) {
        const VectorXd each = weights * gained;
        for (const SignalSlopes::Slope& slope : slopes.at(moved.drive, moved.piece))
          gradient.col(static_cast<Index>(slope.parameter)) += each * slope.begin;
      }
      for (Index j = 0; j < jump->by_device.cols(); ++j) gradient.col(column(j)) += weights * jump->by_device.col(j);
      if (!jump->matrix) continue;
      weights = weights * *jump->matrix;
      left = left * *jump->matrix;
    }
    for (; part.ends_arc && !given.empty() && given.back().first == part.arc; given.pop_back())
      weights.row(given.back().second.first) += given.back().second.second.transpose();
    const Transition t = transition(k);
    const double h = part.end - part.begin;
    using Inputs = Eigen::Map<const MatrixXd>;
    const Inputs begin(t.begin, n_, inputs_), middle(t.middle, n_, inputs_), end(t.end, n_, inputs_);
    for (Index f = 0; f < count; ++f) {
      const RowSeries w(t.magnus, size_, stride_, part.terms, weights.row(f).head(size_).array());
      const auto of = [&](const auto& row) { return row.matrix().segment(n_, n_); };
      at_begin.row(f) = of(h * (w.phi1 - 3 * w.phi2 + 4 * w.phi3)).lazyProduct(begin);
      at_middle.row(f) = of(h * (4 * w.phi2 - 8 * w.phi3)).lazyProduct(middle);
      at_end.row(f) = of(h * (4 * w.phi3 - w.phi2)).lazyProduct(end);
      add_compensated(weights.row(f), left.row(f), w.gain.head(size_));
      weights(f, size_) += at_begin(f, dent_) + at_middle(f, dent_) + at_end(f, dent_);
    }
    for_inputs(part, slopes, [&](Index drive, Index parameter, double v0, double v1, double v2) {
      gradient.col(parameter) += v0 * at_begin.col(drive) + v1 * at_middle.col(drive) + v2 * at_end.col(drive);
    });
  }
  for (Index j = 0; j < moving_; ++j) gradient.col(column(j)) += weights.leftCols(size_) * rest_.col(j);
  return gradient;
}

MatrixXd LinearizedClosing::forward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes) {
  linearize_for(figures);
  const auto count = static_cast<Index>(slopes.parameters()), columns = (count + row_lanes - 1) / row_lanes * row_lanes;
  MatrixXd gradient = MatrixXd::Zero(static_cast<Index>(figures.size()), count);
  Columns d = Columns::Zero(size_ + 1, columns), left = d;
  for (Index j = 0; j < moving_; ++j) d.col(column(j)).head(size_) = rest_.col(j).array();
  ColumnSeries series;
  std::array<Columns, 3> u;
  u.fill(Columns::Zero(n_, columns));
  auto jump = jumps_.begin();
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    for (; jump != jumps_.end() && jump->parts <= k; ++jump) {
      if (jump->matrix) {
        d = (*jump->matrix * d.matrix()).array().eval();
        left = (*jump->matrix * left.matrix()).array().eval();
      }
      for (const auto& [moved, gained] : jump->moved) {
        for (const SignalSlopes::Slope& slope : slopes.at(moved.drive, moved.piece))
          d.col(static_cast<Index>(slope.parameter)) += gained.array() * slope.begin;
      }
      for (Index j = 0; j < jump->by_device.cols(); ++j) d.col(column(j)) += jump->by_device.col(j).array();
    }
    const Transition t = transition(k);
    const double h = part.end - part.begin;
    using Input = Eigen::Map<const Eigen::ArrayXd>;
    const auto at = [&](const double* inputs, Index input) { return Input(inputs + input * n_, n_); };
    for (Columns& each : u) each.setZero();
    for_inputs(part, slopes, [&](Index drive, Index parameter, double v0, double v1, double v2) {
      const auto p0 = h * v0 * at(t.begin, drive), p1 = h * v1 * at(t.middle, drive), p2 = h * v2 * at(t.end, drive);
      u[0].col(parameter) += p0;
      u[1].col(parameter) += 4 * p1 - 3 * p0 - p2;
      u[2].col(parameter) += 2 * (p0 - 2 * p1 + p2);
    });
    if (arcs_[part.arc].contact.unloading) {
      const auto p0 = (h * at(t.begin, dent_)).matrix(), p1 = (h * at(t.middle, dent_)).matrix(),
                 p2 = (h * at(t.end, dent_)).matrix();
      const auto shift = d.bottomRows<1>().matrix();
      u[0] += (p0 * shift).array();
      u[1] += ((4 * p1 - 3 * p0 - p2) * shift).array();
      u[2] += (2 * (p0 - 2 * p1 + p2) * shift).array();
    }
    series.carry(t.magnus, stride_, part.terms, u, d);
    add_compensated(d, left, series.gain);
    for (std::size_t f = 0; part.ends_arc && f < figures.size(); ++f) {
      for (const FigureSlope::Weights& w : figures[f].weights) {
        if (w.arc == part.arc) gradient.row(static_cast<Index>(f)) += scaled(w).transpose() * d.leftCols(count).matrix();
      }
    }
  }
  add_moved(figures, slopes, gradient);
  return gradient;
}

}  // namespace softland
