#include "model/linearized_closing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "integrators/quintic.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double longest_angle = 2.5;  // norm of A times the length of an arc
constexpr int most_parts = 4096;       // of a step
constexpr int parts_at_edge = 6;       // of a step that begins or ends where a contact does

// exp(x) and phi_j(x) = sum over k of x^k / (k + j)!, j = 1, 2, 3, of a matrix whose norm is small.
struct Exponentials {
  MatrixXd exp, phi1, phi2, phi3;

  explicit Exponentials(const MatrixXd& x) {
    constexpr int most = 24;
    constexpr double rounding = 1e-15;
    const MatrixXd one = MatrixXd::Identity(x.rows(), x.cols());
    const double norm = x.cwiseAbs().colwise().sum().maxCoeff();
    std::array<double, most> factor{};  // 1 / (k + 3)!
    int terms = 0;
    double power = 1, next = 1.0 / 6;
    do {
      factor[static_cast<std::size_t>(terms)] = next;
      power *= norm;
      ++terms;
      next /= terms + 3;
    } while (terms < most && power * next > rounding);
    // Paterson and Stockmeyer 1973: polynomials of x^4 whose coefficients are cubics in x.
    const MatrixXd x2 = x * x, x3 = x2 * x, x4 = x2 * x2;
    const auto cubic = [&](int k) {
      const auto at = [&](int i) { return i < terms ? factor[static_cast<std::size_t>(i)] : 0; };
      return MatrixXd(at(k) * one + at(k + 1) * x + at(k + 2) * x2 + at(k + 3) * x3);
    };
    int k = (terms - 1) / 4 * 4;
    phi3 = cubic(k);
    for (k -= 4; k >= 0; k -= 4) phi3 = cubic(k) + x4 * phi3;
    phi2.noalias() = x * phi3;
    phi2 += one / 2;
    phi1.noalias() = x * phi2;
    phi1 += one;
    exp.noalias() = x * phi1;
    exp += one;
  }
};

// Shares of a step at which its arcs end. A contact's stiffness begins and ends like a root of the time from the edge.
std::vector<double> ends_of_parts(int parts, bool after_edge, bool before_edge) {
  std::vector<double> ends;
  for (int k = 1; k <= parts; ++k) {
    const double x = static_cast<double>(k) / parts;
    const double both = x < 0.5 ? 2 * x * x : 1 - 2 * (1 - x) * (1 - x);
    ends.push_back(after_edge && before_edge ? both : after_edge ? x * x : before_edge ? 1 - (1 - x) * (1 - x) : x);
  }
  return ends;
}

}  // namespace

std::string LinearizedClosing::refusal(const Switch& model) {
  return model.film_states() > 0 ? "the states of a compressible gas film have no derivatives here" : "";
}

LinearizedClosing::LinearizedClosing(const Switch& model, std::span<const Signal> signals, const MotionTape& tape, int refinement)
    : model_(model),
      signals_(signals),
      n_(model.modes()),
      size_(2 * n_),
      fastest_(model.angular_frequencies().maxCoeff()),
      work_(model.workspace()),
      refinement_(refinement) {
  auto passage = tape.passages().begin();
  for (std::size_t k = 0; k < tape.arcs().size(); ++k) {
    for (; passage != tape.passages().end() && passage->arc <= k; ++passage) add_passage(*passage);
    const MotionTape::Arc& arc = tape.arcs()[k];
    enter_pieces(arc.begin, arc.contact);
    const bool after_edge = passage != tape.passages().begin() && std::prev(passage)->arc == k;
    const bool before_edge = passage != tape.passages().end() && passage->arc == k + 1;
    add_step(arc, arc.contact.active && after_edge, arc.contact.active && before_edge);
  }
  for (; passage != tape.passages().end(); ++passage) add_passage(*passage);
}

VectorXd LinearizedClosing::rates(double t, const VectorXd& q, const VectorXd& v, const std::vector<std::size_t>& pieces,
                                  const ContactState& contact) {
  std::vector<double> volts(signals_.size());
  for (std::size_t k = 0; k < volts.size(); ++k) volts[k] = signals_[k].pieces()[pieces[k]].voltage(t);
  VectorXd all(size_);
  all.head(n_) = fastest_ * v;
  model_.accelerations(q.data(), v.data(), volts, contact, work_, all.data() + n_);
  return all;
}

LinearizedClosing::Node LinearizedClosing::node(double t, const double* q, const double* v,
                                                const std::vector<std::size_t>& pieces, const ContactState& contact) {
  std::vector<double> volts(signals_.size());
  for (std::size_t k = 0; k < volts.size(); ++k) volts[k] = signals_[k].pieces()[pieces[k]].voltage(t);
  Node at{.a = MatrixXd::Zero(size_, size_),
          .inputs = MatrixXd::Zero(size_, static_cast<Index>(volts.size())),
          .by_shift = VectorXd::Zero(size_)};
  at.a.topRightCorner(n_, n_).diagonal().setConstant(fastest_);
  model_.jacobian(q, v, volts, contact, work_, at.a.bottomLeftCorner(n_, n_), at.a.bottomRightCorner(n_, n_));
  at.a.bottomLeftCorner(n_, n_) /= fastest_;
  model_.drive_forces(work_, at.inputs.bottomRows(n_));
  for (std::size_t k = 0; k < volts.size(); ++k) {
    if (model_.drive_kind(k) == DriveKind::electrode) at.inputs.col(static_cast<Index>(k)) *= 2 * volts[k];
  }
  if (contact.active && contact.unloading) {
    const double d = model_.contact_deflection(q) - model_.device().gap.contact, step = 1e-5 * (std::abs(d) + contact.shift);
    const auto force = [&](double shift) {
      ContactState moved = contact;
      moved.shift = shift;
      return contact_force(model_.contact(), d, moved, 0);
    };
    const double slope = (force(contact.shift + step) - force(contact.shift - step)) / (2 * step);
    at.by_shift.tail(n_) = -slope * model_.contact_shape();
  }
  return at;
}

LinearizedClosing::Transition LinearizedClosing::transition(double h, const Node& begin, const Node& middle,
                                                            const Node& end) const {
  MatrixXd magnus = h / 6 * (begin.a + 4 * middle.a + end.a);
  const MatrixXd change = end.a - begin.a;
  magnus.noalias() -= h * h / 12 * (middle.a * change);
  magnus.noalias() += h * h / 12 * (change * middle.a);
  const Exponentials e(magnus);
  // An input that is 1 at the begin, in the middle or at the end, and there the parabola's only value that is not 0.
  const MatrixXd at_begin = h * (e.phi1 - 3 * e.phi2 + 4 * e.phi3);
  const MatrixXd at_middle = h * (4 * e.phi2 - 8 * e.phi3);
  const MatrixXd at_end = h * (4 * e.phi3 - e.phi2);
  Transition t{.state = e.exp, .inputs = MatrixXd(size_, 3 * begin.inputs.cols()), .shift = VectorXd::Zero(size_)};
  for (Index k = 0; k < begin.inputs.cols(); ++k) {
    t.inputs.col(3 * k).noalias() = at_begin * begin.inputs.col(k);
    t.inputs.col(3 * k + 1).noalias() = at_middle * middle.inputs.col(k);
    t.inputs.col(3 * k + 2).noalias() = at_end * end.inputs.col(k);
  }
  if (!begin.by_shift.isZero() || !end.by_shift.isZero()) {
    t.shift = at_begin * begin.by_shift + at_middle * middle.by_shift + at_end * end.by_shift;
  }
  return t;
}

// A step in arcs that end where the contact point turns back, and are short enough.
void LinearizedClosing::add_step(const MotionTape::Arc& arc, bool after_edge, bool before_edge) {
  const double t0 = arc.begin.time, t1 = arc.end.time, h = t1 - t0;
  std::vector<Quintic> modes;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n_); ++i) {
    const std::size_t v = i + static_cast<std::size_t>(n_);
    modes.emplace_back(t0, arc.begin.state[i], arc.begin.state[v], arc.begin.rates[i], t1, arc.end.state[i], arc.end.state[v],
                       arc.end.rates[i]);
  }
  const auto tip = [&](const std::vector<double>& of) { return model_.contact_deflection(of.data()); };
  const auto speed = [&](const Knot& knot) { return model_.contact_deflection(knot.state.data() + n_); };
  const Quintic contact_point(t0, tip(arc.begin.state), speed(arc.begin), tip(arc.begin.rates), t1, tip(arc.end.state),
                              speed(arc.end), tip(arc.end.rates));
  const auto node_at = [&](double t) {
    VectorXd q(n_), v(n_);
    for (Index i = 0; i < n_; ++i) {
      q[i] = modes[static_cast<std::size_t>(i)].position(t);
      v[i] = modes[static_cast<std::size_t>(i)].velocity(t);
    }
    return node(t, q.data(), v.data(), pieces_, arc.contact);
  };
  Node from = last_ ? std::move(*last_) : node(t0, arc.begin.state.data(), arc.begin.state.data() + n_, pieces_, arc.contact);
  const double norm = h * from.a.cwiseAbs().colwise().sum().maxCoeff();
  const int least = refinement_ * (after_edge || before_edge ? parts_at_edge : 1);
  const int parts = std::min(most_parts, std::max(least, static_cast<int>(std::ceil(norm / longest_angle))));
  std::vector<std::pair<double, bool>> ends;  // time, and whether the contact point turns there
  for (const double share : ends_of_parts(parts, after_edge, before_edge))
    ends.emplace_back(share < 1 ? t0 + h * share : t1, false);
  if (speed(arc.begin) * speed(arc.end) < 0) {
    const double turn = bracketed_zero([&](double t) { return contact_point.velocity(t); }, t0, t1);
    ends.emplace_back(turn, true);
    std::sort(ends.begin(), ends.end());
  }
  double begin = t0;
  for (const auto& [end, turns] : ends) {
    if (!(end > begin)) {
      if (turns && !arcs_.empty()) arcs_.back().turns = true;
      continue;
    }
    Node middle = node_at((begin + end) / 2);
    Arc next{.begin = begin,
             .end = end,
             .q = VectorXd(n_),
             .v = VectorXd(n_),
             .accelerations = VectorXd(n_),
             .turns = turns,

             .contact = arc.contact,
             .pieces = pieces_};
    for (Index i = 0; i < n_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const bool last = end == t1;
      next.q[i] = last ? arc.end.state[k] : modes[k].position(end);
      next.v[i] = last ? arc.end.state[k + static_cast<std::size_t>(n_)] : modes[k].velocity(end);
      next.accelerations[i] = last ? arc.end.rates[k] : modes[k].acceleration(end);
    }
    Node to = node(end, next.q.data(), next.v.data(), pieces_, arc.contact);
    transitions_.push_back(transition(end - begin, from, middle, to));
    arcs_.push_back(std::move(next));
    from = std::move(to);
    begin = end;
  }
  last_ = std::move(from);
}

// Where drives go on to other pieces, f jumps at times that the waveform decides.
void LinearizedClosing::enter_pieces(const Knot& here, const ContactState& contact) {
  std::vector<std::size_t> next;
  for (const Signal& signal : signals_) next.push_back(signal.piece_at(here.time));
  if (next == pieces_) return;
  last_.reset();
  if (pieces_.empty()) {
    pieces_ = std::move(next);
    return;
  }
  const Eigen::Map<const VectorXd> q(here.state.data(), n_), v(here.state.data() + n_, n_);
  Jump jump{.arcs = arcs_.size(), .matrix = MatrixXd::Identity(size_ + 1, size_ + 1), .moved = {}};
  for (std::size_t k = 0; k < next.size(); ++k) {
    if (next[k] == pieces_[k]) continue;
    const VectorXd before = rates(here.time, q, v, pieces_, contact);
    pieces_[k] = next[k];
    const VectorXd after = rates(here.time, q, v, pieces_, contact);
    VectorXd gained = VectorXd::Zero(size_ + 1);
    gained.head(size_) = before - after;
    jump.moved.push_back({{.drive = k, .piece = next[k], .rate = 0}, std::move(gained)});
  }
  jumps_.push_back(std::move(jump));
}

void LinearizedClosing::add_passage(const MotionTape::Passage& passage) {
  using Kind = PhaseChange::Kind;
  const PhaseChange& change = passage.change;
  last_.reset();
  passages_.push_back({arcs_.size(), change});
  if (arcs_.empty() || change.kind == Kind::leaves) return;
  if (change.kind == Kind::turn) arcs_.back().turns = true;
  const Arc& before = arcs_.back();
  Jump jump{.arcs = arcs_.size(), .matrix = MatrixXd::Identity(size_ + 1, size_ + 1), .moved = {}};
  VectorXd normal = VectorXd::Zero(size_);
  normal.head(n_) = model_.contact_shape() / fastest_;
  if (change.kind == Kind::rests) {
    jump.matrix.setZero();
  } else if (change.kind == Kind::turn) {
    const double deepest = model_.contact_deflection(before.q.data()) - model_.device().gap.contact, step = 1e-5 * deepest;
    const auto shift = [&](double d) { return dent(model_.contact(), d).shift; };
    jump.matrix.bottomRows<1>().setZero();
    jump.matrix.bottomLeftCorner(1, size_) = (shift(deepest + step) - shift(deepest - step)) / (2 * step) * normal.transpose();
  } else {
    const double t = passage.here.time;
    VectorXd from = rates(t, before.q, before.v, before.pieces, change.before), v = before.v;
    if (change.kind == Kind::impact) {
      const double restitution = model_.rigid_contact()->restitution;
      v *= -restitution;
      from.tail(n_) *= -restitution;
      jump.matrix.block(n_, n_, n_, n_) *= -restitution;
    }
    const VectorXd to = rates(t, before.q, v, before.pieces, change.after);
    const double approach = normal.dot(rates(t, before.q, before.v, before.pieces, change.before));
    jump.matrix.topLeftCorner(size_, size_) -= (from - to) * normal.transpose() / approach;
    if (change.before.shift != 0 && change.after.shift == 0) jump.matrix.bottomRows<1>().setZero();  // the dent has healed
  }
  jumps_.push_back(std::move(jump));
}

VectorXd LinearizedClosing::scaled(const FigureSlope::Weights& weights) const {
  VectorXd all(size_ + 1);
  all.head(n_) = weights.by_q / fastest_;
  all.segment(n_, n_) = weights.by_v;
  all[size_] = weights.by_shift;
  return all;
}

// Calls add(column of Transition::inputs, parameter, dV/dp) for what moves the drives in an arc.
template <class Add>
void LinearizedClosing::for_inputs(std::size_t arc, const SignalSlopes& slopes, Add&& add) const {
  const Arc& at = arcs_[arc];
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    for (const SignalSlopes::Slope& slope : slopes.at(k, at.pieces[k])) {
      const auto column = static_cast<Index>(3 * k), parameter = static_cast<Index>(slope.parameter);
      add(column, parameter, slope.voltage(at.begin));
      add(column + 1, parameter, slope.voltage((at.begin + at.end) / 2));
      add(column + 2, parameter, slope.voltage(at.end));
    }
  }
}

MatrixXd LinearizedClosing::backward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes) const {
  const auto count = static_cast<Index>(figures.size());
  MatrixXd gradient = MatrixXd::Zero(count, static_cast<Index>(slopes.parameters()));
  MatrixXd weights = MatrixXd::Zero(count, size_ + 1), inputs;
  std::vector<std::pair<std::size_t, std::pair<Index, VectorXd>>> given;  // arc, figure, weights
  for (std::size_t f = 0; f < figures.size(); ++f) {
    for (const FigureSlope::Weights& w : figures[f].weights) given.push_back({w.arc, {static_cast<Index>(f), scaled(w)}});
    for (const FigureSlope::Moved& m : figures[f].moved) {
      for (const SignalSlopes::Slope& slope : slopes.at(m.drive, m.piece))
        gradient(static_cast<Index>(f), static_cast<Index>(slope.parameter)) += m.rate * slope.begin;
    }
  }
  std::stable_sort(given.begin(), given.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  auto jump = jumps_.rbegin();
  for (std::size_t arc = arcs_.size(); arc-- > 0;) {
    for (; jump != jumps_.rend() && jump->arcs == arc + 1; ++jump) {
      for (const auto& [moved, gained] : jump->moved) {
        const VectorXd each = weights * gained;
        for (const SignalSlopes::Slope& slope : slopes.at(moved.drive, moved.piece))
          gradient.col(static_cast<Index>(slope.parameter)) += each * slope.begin;
      }
      weights = weights * jump->matrix;
    }
    for (; !given.empty() && given.back().first == arc; given.pop_back())
      weights.row(given.back().second.first) += given.back().second.second.transpose();
    const Transition& t = transitions_[arc];
    inputs.noalias() = weights.leftCols(size_) * t.inputs;
    for_inputs(arc, slopes,
               [&](Index column, Index parameter, double volts) { gradient.col(parameter) += inputs.col(column) * volts; });
    weights.col(size_) += weights.leftCols(size_) * t.shift;
    weights.leftCols(size_) = (weights.leftCols(size_) * t.state).eval();
  }
  return gradient;
}

MatrixXd LinearizedClosing::forward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes) const {
  const auto count = static_cast<Index>(slopes.parameters());
  MatrixXd gradient = MatrixXd::Zero(static_cast<Index>(figures.size()), count);
  MatrixXd d = MatrixXd::Zero(size_ + 1, count);
  auto jump = jumps_.begin();
  for (std::size_t arc = 0; arc < arcs_.size(); ++arc) {
    for (; jump != jumps_.end() && jump->arcs <= arc; ++jump) {
      d = (jump->matrix * d).eval();
      for (const auto& [moved, gained] : jump->moved) {
        for (const SignalSlopes::Slope& slope : slopes.at(moved.drive, moved.piece))
          d.col(static_cast<Index>(slope.parameter)) += gained * slope.begin;
      }
    }
    const Transition& t = transitions_[arc];
    d.topRows(size_) = (t.state * d.topRows(size_) + t.shift * d.bottomRows<1>()).eval();
    for_inputs(arc, slopes, [&](Index column, Index parameter, double volts) {
      d.col(parameter).head(size_) += t.inputs.col(column) * volts;
    });
    for (std::size_t f = 0; f < figures.size(); ++f) {
      for (const FigureSlope::Weights& w : figures[f].weights) {
        if (w.arc == arc) gradient.row(static_cast<Index>(f)) += scaled(w).transpose() * d;
      }
    }
  }
  for (std::size_t f = 0; f < figures.size(); ++f) {
    for (const FigureSlope::Moved& m : figures[f].moved) {
      for (const SignalSlopes::Slope& slope : slopes.at(m.drive, m.piece))
        gradient(static_cast<Index>(f), static_cast<Index>(slope.parameter)) += m.rate * slope.begin;
    }
  }
  return gradient;
}

}  // namespace softland
