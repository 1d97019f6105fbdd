#include "model/linearized_closing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <variant>

#include "base/decompositions.h"
#include "base/lanes.h"
#include "integrators/quintic.h"
#include "model/contact/contact_law.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double longest_angle = 2.5;  // largest duration of a part of a step, times the norm of the equations' matrix A
constexpr int most_parts = 4096;       // largest number of parts into which an integration step is divided
// Least number of parts of a step in contact that begins or ends with a change of the contact law.
constexpr int parts_at_edge = 6;
constexpr Index lane_size = lanes;

// Returns the number of terms after which the Taylor series of the exponential of a matrix with this norm is accurate to
// rounding. It is at least 3: the contribution of drives that are quadratic in time needs 3 terms.
int terms_of_exponential(double norm) {
  constexpr int fewest = 3;
  constexpr double rounding = 1e-13;
  constexpr int most = 40;
  static const std::array<double, most> largest_norm = [] {
    std::array<double, most> norms{};
    for (int k = 1; k <= most; ++k)
      norms[static_cast<std::size_t>(k - 1)] = std::exp((std::log(rounding) + std::lgamma(k + 1)) / k);
    return norms;
  }();
  const auto found = std::find_if(largest_norm.begin(), largest_norm.end() - 1, [&](double largest) { return norm <= largest; });
  return std::max(fewest, static_cast<int>(found - largest_norm.begin()) + 1);
}

// Returns the 1-norm (largest sum of magnitudes in a column) of a matrix whose rows are padded to whole SIMD vectors.
double column_norm(const double* x, Index size, Index stride) {
  Lane largest = Lane::Zero();
  for (Index c = 0; c < stride; c += lane_size) {
    Lane sum = Lane::Zero();
    for (Index i = 0; i < size; ++i) sum += Eigen::Map<const Lane>(x + i * stride + c).abs();
    largest = largest.max(sum);
  }
  return largest.maxCoeff();
}

// Returns the ends of the parts of an integration step, as shares of its duration. Parts are shorter near a touch or
// separation, since the stiffness of a contact grows like the root of the time from there.
std::vector<double> shares_of_parts(int parts, bool after_edge, bool before_edge) {
  std::vector<double> ends;
  for (int k = 1; k <= parts; ++k) {
    const double x = static_cast<double>(k) / parts;
    const double both = x < 0.5 ? 2 * x * x : 1 - 2 * (1 - x) * (1 - x);
    ends.push_back(after_edge && before_edge ? both : after_edge ? x * x : before_edge ? 1 - (1 - x) * (1 - x) : x);
  }
  return ends;
}

// Interpolates modal coordinates, velocities and accelerations at the time t within an integration step from the recorded
// values at both ends of the step.
template <class Modal>
void move_to(double t, const RecordedMotion::Motion& from, const RecordedMotion::Motion& to, Modal& q, Modal& v,
             Modal& accelerations) {
  for (Index i = 0; i < q.size(); ++i) {
    const Quintic mode(from.time, from.q[i], from.v[i], from.accelerations[i], to.time, to.q[i], to.v[i], to.accelerations[i]);
    q[i] = mode.position(t);
    v[i] = mode.velocity(t);
    accelerations[i] = mode.acceleration(t);
  }
}

}  // namespace

std::string LinearizedClosing::refusal(const Switch& model) {
  if (model.film_states() > 0) return "the states of a compressible gas film have no derivatives here";
  if (model.contacts() > 1) return "the motion between several contacts has no derivatives here";
  if (model.device().closes_along_face()) return "a landing along the face of a dielectric has no derivatives here";
  if (model.has_contact() && is_own(model.contact()))
    return "a contact law of one's own has derivatives by differences only, which are not exact";
  return model.modes() > most_modes ? "a closing with so many modes has no derivatives here" : "";
}

LinearizedClosing::LinearizedClosing(const Switch& model, std::span<const Signal> signals, const RecordedMotion& tape,
                                     int refinement, SwitchSlopes* by_device)
    : model_(model),
      signals_(signals),
      tape_(tape),
      n_(model.modes()),
      size_(2 * n_),
      stride_((size_ + lane_size - 1) / lane_size * lane_size),
      by_device_(by_device),
      dent_(static_cast<Index>(signals.size())),
      moving_(by_device != nullptr ? static_cast<Index>(by_device->moving().size()) : 0),
      inputs_(dent_ + 1 + moving_),
      fastest_(model.basis().angular_frequencies().maxCoeff()),
      work_(model.workspace()),
      refinement_(refinement),
      pieces_(1, std::vector<std::size_t>(signals.size(), 0)),
      volts_(signals.size()) {
  for (Node* node : {&from_, &middle_, &to_}) {
    node->by_q = node->by_v = MatrixXd(n_, n_);
    node->inputs = MatrixXd(n_, inputs_);
  }
  follow_tape();
}

void LinearizedClosing::follow_tape() {
  arcs_.reserve(tape_.arcs().size() + tape_.passages().size());
  auto passage = tape_.passages().begin();
  for (std::size_t k = 0; k < tape_.arcs().size(); ++k) {
    for (; passage != tape_.passages().end() && passage->arc <= k; ++passage) note_passage(passage->change);
    enter_pieces(tape_.arcs()[k].begin);
    add_arcs(k);
  }
  for (; passage != tape_.passages().end(); ++passage) note_passage(passage->change);
}

void LinearizedClosing::note_passage(const PhaseChange& change) {
  passages_.push_back({arcs_.size(), change});
  if (!arcs_.empty() && change.kind == PhaseChange::Kind::turn) arcs_.back().turns = true;
}

// Adds an entry to pieces_, the signal pieces in use, for every drive that enters its next piece (at a breakpoint) at time t.
void LinearizedClosing::enter_pieces(double t) {
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    const std::vector<SignalPiece>& all = signals_[k].pieces();
    std::size_t piece = pieces_.back()[k];
    while (piece + 1 < all.size() && all[piece + 1].begin <= t) ++piece;
    if (piece == pieces_.back()[k]) continue;
    pieces_.push_back(pieces_.back());
    pieces_.back()[k] = piece;
  }
}

void LinearizedClosing::add_arcs(std::size_t step) {
  using Known = Eigen::Map<const VectorXd>;
  const RecordedMotion::Motion from = tape_.begin(step), to = tape_.end(step);
  Arc whole{.begin = from.time,
            .end = to.time,
            .q = Known(to.q, n_),
            .v = Known(to.v, n_),
            .accelerations = Known(to.accelerations, n_),
            .contact = tape_.arcs()[step].contact,
            .step = step,
            .pieces_entered = pieces_.size() - 1};
  const auto tip = [&](const double* of) { return model_.contact_deflection(of); };
  if (tip(from.v) * tip(to.v) < 0) {
    const Quintic contact_point(from.time, tip(from.q), tip(from.v), tip(from.accelerations), to.time, tip(to.q), tip(to.v),
                                tip(to.accelerations));
    const double turn = bracketed_zero([&](double t) { return contact_point.velocity(t); }, from.time, to.time);
    if (turn > from.time && turn < to.time) {
      Arc first = whole;
      first.end = turn;
      first.turns = true;
      move_to(turn, from, to, first.q, first.v, first.accelerations);
      arcs_.push_back(std::move(first));
      whole.begin = turn;
    } else if (turn > from.time) {
      whole.turns = true;
    } else if (!arcs_.empty()) {
      arcs_.back().turns = true;
    }
  }
  arcs_.push_back(std::move(whole));
}

void LinearizedClosing::linearize_for(const std::vector<FigureSlope>& figures) {
  std::size_t needed = 0;
  for (const FigureSlope& figure : figures) {
    for (const FigureSlope::Weights& w : figure.weights) needed = std::max(needed, arcs_[w.arc].step + 1);
  }
  if (steps_ == 0) begin_at_rest();
  while (steps_ < needed) linearize_step();
}

void LinearizedClosing::linearize_step() {
  const std::vector<RecordedMotion::PhaseEvent>& passages = tape_.passages();
  const std::size_t step = steps_++;
  const bool after_edge = next_passage_ < passages.size() && passages[next_passage_].arc <= step;
  for (; next_passage_ < passages.size() && passages[next_passage_].arc <= step; ++next_passage_) {
    goes_on_ = false;
    if (next_arc_ > 0) jump_at(passages[next_passage_], arcs_[next_arc_ - 1]);
  }
  const bool before_edge = next_passage_ < passages.size() && passages[next_passage_].arc == step + 1;
  const ContactState& contact = tape_.arcs()[step].contact;
  jump_at_pieces(tape_.begin(step), contact, arcs_[next_arc_].pieces_entered);
  add_parts(step, contact.active && after_edge, contact.active && before_edge);
}

// Computes the derivative of the rest position at the start by each device parameter: the shift of the modal coordinates that
// keeps the static forces at 0 when the parameter changes.
void LinearizedClosing::begin_at_rest() {
  rest_ = MatrixXd::Zero(size_, moving_);
  const std::vector<double> before = values_before(signals_);
  const bool is_straight = !model_.device().dispersion && !model_.device().is_charged() &&
                           std::all_of(before.begin(), before.end(), [](double v) { return v == 0; });
  const std::optional<VectorXd> rest = moving_ == 0 || is_straight ? std::nullopt : model_.open_equilibrium(before);
  if (!rest) return;
  const VectorXd &q = *rest, still = VectorXd::Zero(n_);
  MatrixXd by_q(n_, n_), by_v(n_, n_);
  model_.jacobian(q.data(), still.data(), before, false, work_, by_q, by_v);
  VectorXd force(n_);
  const MatrixXd stiffness = by_q;
  for (Index j = 0; j < moving_; ++j) {
    by_device_->accelerations(static_cast<std::size_t>(j), q.data(), still.data(), before, false, by_q, force);
    rest_.col(j).head(n_) = -fastest_ * solve_linear(stiffness, force);
  }
}

void LinearizedClosing::set_volts(double t) {
  for (std::size_t k = 0; k < volts_.size(); ++k) volts_[k] = signals_[k].pieces()[pieces_[on_][k]].voltage(t);
}

VectorXd LinearizedClosing::rates(double t, const double* q, const double* v, const ContactState& contact) {
  set_volts(t);
  VectorXd all(size_);
  all.head(n_) = fastest_ * Eigen::Map<const VectorXd>(v, n_);
  model_.accelerations(q, v, volts_, contact, work_, all.data() + n_);
  return all;
}

void LinearizedClosing::set_node(Node& node, double t, const double* q, const double* v, const ContactState& contact) {
  set_volts(t);
  model_.jacobian(q, v, volts_, contact, work_, node.by_q, node.by_v);
  for (Index j = 0; j < moving_; ++j)
    by_device_->accelerations(static_cast<std::size_t>(j), q, v, volts_, contact, node.by_q, node.inputs.col(dent_ + 1 + j));
  node.by_q /= fastest_;
  model_.drive_forces(work_, node.inputs.leftCols(dent_));
  for (std::size_t k = 0; k < volts_.size(); ++k) {
    if (model_.drive_kind(k) == DriveKind::electrode)
      node.inputs.col(static_cast<Index>(k)) *= model_.strength_slope(k, volts_[k]);
  }
  node.inputs.col(dent_).setZero();
  if (contact.active && contact.unloading) {
    const double d = model_.contact_deflection(q) - model_.contact_gap(), step = 1e-5 * (std::abs(d) + contact.shift);
    const auto force = [&](double shift) {
      ContactState moved = contact;
      moved.shift = shift;
      return contact_force(model_.contact(), d, moved, 0);
    };
    const double slope = (force(contact.shift + step) - force(contact.shift - step)) / (2 * step);
    node.inputs.col(dent_) = -slope * model_.basis().contact_shape();
  }
}

// Computes the exponent h / 6 (A0 + 4 A1 + A2) - h^2 / 12 [A1, A2 - A0] of Magnus' series for a part of duration h. A0, A1, A2
// are the matrices A of the linearised equations at begin, middle and end of the part. They have the blocks 0 and fastest_
// times the unit matrix (above), by_q and by_v (below), so that the exponent is computed block by block.
void LinearizedClosing::add_transition(double begin, double end, std::size_t arc) {
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_modes, most_modes>;
  const std::size_t at = numbers_.size();
  numbers_.resize(at + static_cast<std::size_t>(size_ * stride_ + 3 * n_ * inputs_), 0.0);
  double* here = numbers_.data() + at;
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> x(here, size_, stride_);
  const MatrixXd &k = middle_.by_q, &d = middle_.by_v;
  const Block dk = to_.by_q - from_.by_q, dd = to_.by_v - from_.by_v;
  const double h = end - begin, c = h * h / 12;
  x.topLeftCorner(n_, n_) = -c * fastest_ * dk;
  x.block(0, n_, n_, n_) = -c * fastest_ * dd;
  x.block(0, n_, n_, n_).diagonal().array() += h * fastest_;
  x.bottomLeftCorner(n_, n_) = h / 6 * (from_.by_q + 4 * k + to_.by_q) - c * (d.lazyProduct(dk) - dd.lazyProduct(k));
  x.block(n_, n_, n_, n_) = h / 6 * (from_.by_v + 4 * d + to_.by_v) - c * (d.lazyProduct(dd) - dd.lazyProduct(d) - fastest_ * dk);
  parts_.push_back({.begin = begin,
                    .end = end,
                    .arc = arc,
                    .ends_arc = end == arcs_[arc].end,
                    .terms = terms_of_exponential(column_norm(here, size_, stride_))});
  here += size_ * stride_;
  for (const Node* node : {&from_, &middle_, &to_}) here = std::copy_n(node->inputs.data(), n_ * inputs_, here);
}

LinearizedClosing::Transition LinearizedClosing::transition(std::size_t part) const {
  const Index magnus = size_ * stride_, each = n_ * inputs_;
  const double* here = numbers_.data() + static_cast<Index>(part) * (magnus + 3 * each);
  return {.magnus = here, .begin = here + magnus, .middle = here + magnus + each, .end = here + magnus + 2 * each};
}

// Returns the times at which the parts of an integration step end; every part is short enough for Magnus' series.
std::vector<double> LinearizedClosing::ends_of_parts(double t0, double t1, bool after_edge, bool before_edge) const {
  const double h = t1 - t0;
  const double norm =
      h * std::max(from_.by_q.cwiseAbs().colwise().sum().maxCoeff(), fastest_ + from_.by_v.cwiseAbs().colwise().sum().maxCoeff());
  const int least = refinement_ * (after_edge || before_edge ? parts_at_edge : 1);
  const int parts = std::min(most_parts, std::max(least, static_cast<int>(std::ceil(norm / longest_angle))));
  std::vector<double> ends;
  for (const double share : shares_of_parts(parts, after_edge, before_edge)) ends.push_back(share < 1 ? t0 + h * share : t1);
  return ends;
}

void LinearizedClosing::add_parts(std::size_t step, bool after_edge, bool before_edge) {
  const RecordedMotion::Motion from = tape_.begin(step), to = tape_.end(step);
  const ContactState& contact = tape_.arcs()[step].contact;
  if (!goes_on_) set_node(from_, from.time, from.q, from.v, contact);
  goes_on_ = true;
  const std::vector<double> ends = ends_of_parts(from.time, to.time, after_edge, before_edge);
  double begin = from.time;
  Modal q(n_), v(n_), accelerations(n_);
  const auto add = [&](double end) {
    if (!(end > begin)) return;
    move_to((begin + end) / 2, from, to, q, v, accelerations);
    set_node(middle_, (begin + end) / 2, q.data(), v.data(), contact);
    if (end < to.time) {
      move_to(end, from, to, q, v, accelerations);
      set_node(to_, end, q.data(), v.data(), contact);
    } else {
      set_node(to_, end, to.q, to.v, contact);
    }
    add_transition(begin, end, next_arc_);
    std::swap(from_, to_);
    begin = end;
  };
  auto next = ends.begin();
  for (; next_arc_ < arcs_.size() && arcs_[next_arc_].step == step; ++next_arc_) {
    const double end = arcs_[next_arc_].end;
    for (; next != ends.end() && *next < end; ++next) add(*next);
    add(end);
  }
}

// Adds the jump of the derivative d of the state by the parameters at a breakpoint of the drives, which shifts with the
// parameters and at which the right-hand side of the equations of motion changes.
void LinearizedClosing::jump_at_pieces(const RecordedMotion::Motion& here, const ContactState& contact, std::size_t entered) {
  if (on_ == entered) return;
  Jump jump{.parts = parts_.size(), .matrix = {}, .moved = {}};
  while (on_ < entered) {
    VectorXd gained = VectorXd::Zero(size_ + 1);
    gained.head(size_) = rates(here.time, here.q, here.v, contact);
    ++on_;
    gained.head(size_) -= rates(here.time, here.q, here.v, contact);
    std::size_t k = 0;
    while (pieces_[on_][k] == pieces_[on_ - 1][k]) ++k;
    jump.moved.emplace_back(FigureSlope::Moved{.drive = k, .piece = pieces_[on_][k], .rate = 0}, std::move(gained));
  }
  goes_on_ = false;
  if (!parts_.empty()) jumps_.push_back(std::move(jump));
}

void LinearizedClosing::jump_at(const RecordedMotion::PhaseEvent& passage, const Arc& before) {
  using Kind = PhaseChange::Kind;
  const Kind kind = passage.change.kind;
  if (kind == Kind::leaves) return;
  jumps_.push_back(kind == Kind::rests ? at_rest(before) : kind == Kind::turn ? turned(before) : crossed(passage, before));
  jumps_.back().parts = parts_.size();
}

// Returns the jump of the derivative d of the state by the parameters when a plate comes to rest on the contact plane. The
// plate then is where the plane is, so only derivatives of the plane's position remain.
LinearizedClosing::Jump LinearizedClosing::at_rest(const Arc& before) const {
  Jump jump{.matrix = MatrixXd::Zero(size_ + 1, size_ + 1), .moved = {}, .by_device = MatrixXd::Zero(size_ + 1, moving_)};
  for (Index j = 0; j < moving_; ++j) {
    jump.by_device(0, j) =
        -fastest_ * by_device_->interference(static_cast<std::size_t>(j), before.q.data()) / model_.basis().contact_shape()[0];
  }
  return jump;
}

// Returns the jump of the derivative d of the state by the parameters when a contact with memory begins to unload: its residual
// interference (dent) then follows from the deepest interference.
LinearizedClosing::Jump LinearizedClosing::turned(const Arc& before) const {
  Jump jump{.matrix = MatrixXd::Identity(size_ + 1, size_ + 1), .moved = {}, .by_device = MatrixXd::Zero(size_ + 1, moving_)};
  const double deepest = model_.contact_deflection(before.q.data()) - model_.contact_gap(), step = 1e-5 * deepest;
  const auto shift = [&](double d) { return dent(model_.contact(), d).shift; };
  const double slope = (shift(deepest + step) - shift(deepest - step)) / (2 * step);
  jump.matrix->bottomRows<1>().setZero();
  jump.matrix->bottomLeftCorner(1, n_) = slope / fastest_ * model_.basis().contact_shape().transpose();
  for (Index j = 0; j < moving_; ++j) {
    const auto parameter = static_cast<std::size_t>(j);
    jump.by_device(size_, j) = slope * by_device_->interference(parameter, before.q.data()) +
                               by_device_->of_contact(parameter, [&](const ContactLaw& law) { return dent(law, deepest).shift; });
  }
  return jump;
}

// Returns the jump of the derivative d of the state by the parameters where the contact law changes from one of its curves to
// another, or at an impact.
LinearizedClosing::Jump LinearizedClosing::crossed(const RecordedMotion::PhaseEvent& passage, const Arc& before) {
  const PhaseChange& change = passage.change;
  Jump jump{.matrix = MatrixXd::Identity(size_ + 1, size_ + 1), .moved = {}, .by_device = MatrixXd::Zero(size_ + 1, moving_)};
  MatrixXd& matrix = *jump.matrix;
  VectorXd normal = VectorXd::Zero(size_);
  normal.head(n_) = model_.basis().contact_shape() / fastest_;
  Modal v = before.v;
  VectorXd from = rates(passage.time, before.q.data(), v.data(), change.before);
  const double approach = normal.dot(from);
  if (change.kind == PhaseChange::Kind::impact) {
    const double restitution = model_.rigid_contact()->restitution;
    v *= -restitution;
    from.tail(n_) *= -restitution;
    matrix.block(n_, n_, n_, n_) *= -restitution;
    for (Index j = 0; j < moving_; ++j) {
      const double change_of_it = by_device_->of_contact(
          static_cast<std::size_t>(j), [](const ContactLaw& law) { return std::get<RigidContact>(law).restitution; });
      jump.by_device.col(j).segment(n_, n_) = -change_of_it * before.v;
    }
  }
  const VectorXd to = rates(passage.time, before.q.data(), v.data(), change.after);
  const VectorXd lost = (from - to) / approach;
  matrix.topLeftCorner(size_, size_) -= lost * normal.transpose();
  const double level = change.level - model_.contact_gap();
  for (Index j = 0; j < moving_; ++j) {
    const auto parameter = static_cast<std::size_t>(j);
    jump.by_device.col(j).head(size_) -=
        lost * (by_device_->interference(parameter, before.q.data()) - by_device_->edge(parameter, level));
  }
  // The contact law after the change does not depend on the residual interference, so the derivative of the interference is set
  // to 0.
  if (change.before.shift != 0 && change.after.shift == 0) matrix.bottomRows<1>().setZero();
  return jump;
}

}  // namespace softland
